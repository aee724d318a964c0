#include "ayumi/sim/log_events.hpp"

#include <algorithm>

#include "ayumi/base/counted.hpp"

namespace ayumi {

const std::vector<std::string>& event_kind_names() {
  static const std::vector<std::string> names = {
      "case",       "controller", "calibration", "push", "disturbance",
      "saturation", "contact",    "touchdown",   "fell", "log"};
  return names;
}

const char* name_of(EventKind kind) {
  return event_kind_names()[static_cast<size_t>(kind)].c_str();
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
