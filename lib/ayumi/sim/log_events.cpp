#include "ayumi/sim/log_events.hpp"

#include <algorithm>

#include "ayumi/base/counted.hpp"

namespace ayumi {

const char* name_of(EventKind kind) {
  switch (kind) {
    case EventKind::study_case:
      return "case";
    case EventKind::controller:
      return "controller";
    case EventKind::calibration:
      return "calibration";
    case EventKind::push:
      return "push";
    case EventKind::disturbance:
      return "disturbance";
    case EventKind::saturation:
      return "saturation";
    case EventKind::contact:
      return "contact";
    case EventKind::touchdown:
      return "touchdown";
    case EventKind::fell:
      return "fell";
    case EventKind::log:
      return "log";
  }
  return "";
}

const std::vector<std::string>& event_kind_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (int kind = 0; kind <= static_cast<int>(EventKind::log); ++kind)
      all.emplace_back(name_of(static_cast<EventKind>(kind)));
    return all;
  }();
  return names;
}

void limit_events(std::vector<SimulationEvent>& events, size_t most) {
  if (events.size() <= most || most == 0) return;
  const double last = events.back().t;
  const size_t before = events.size();
  size_t surplus = before - (most - 1);  // one place is for the note
  std::reverse(events.begin(), events.end());
  const auto is_surplus = [&](const SimulationEvent& event) {
    if (surplus == 0 || event.kind != EventKind::touchdown) return false;
    --surplus;
    return true;
  };
  std::vector<SimulationEvent> kept;
  for (SimulationEvent& event : events)
    if (!is_surplus(event)) kept.push_back(std::move(event));
  std::reverse(kept.begin(), kept.end());
  kept.resize(std::min(kept.size(), most - 1));
  const size_t left_out = before - kept.size();
  events = std::move(kept);
  events.push_back({last, EventKind::log, text::counted(left_out, "event") + " left out"});
}

}  // namespace ayumi
