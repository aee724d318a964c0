#include "ayumi/sim/log_events.hpp"

#include <gtest/gtest.h>

namespace ayumi {
namespace {

std::vector<SimulationEvent> events_of(const std::vector<EventKind>& kinds) {
  std::vector<SimulationEvent> events;
  for (const EventKind kind : kinds)
    events.push_back({static_cast<double>(events.size()), kind, ""});
  return events;
}

std::vector<EventKind> kinds_of(const std::vector<SimulationEvent>& events) {
  std::vector<EventKind> kinds;
  for (const SimulationEvent& event : events) kinds.push_back(event.kind);
  return kinds;
}

using Kinds = std::vector<EventKind>;
using enum EventKind;

TEST(LogEvents, EachKindHasItsName) {
  EXPECT_STREQ(name_of(study_case), "case");
  EXPECT_STREQ(name_of(touchdown), "touchdown");
  EXPECT_STREQ(name_of(EventKind::log), "log");
  ASSERT_EQ(event_kind_names().size(), static_cast<size_t>(EventKind::log) + 1);
  for (const EventKind kind : {study_case, controller, calibration, push, disturbance, saturation,
                               contact, touchdown, fell, EventKind::log})
    EXPECT_EQ(event_kind_names()[static_cast<size_t>(kind)], name_of(kind));
}

TEST(LogEvents, TheLastTouchdownsAreLeftOutFirst) {
  std::vector<SimulationEvent> events =
      events_of({push, touchdown, touchdown, touchdown, saturation, fell});
  limit_events(events, 6);
  EXPECT_EQ(events.size(), 6u);
  limit_events(events, 5);
  EXPECT_EQ(kinds_of(events), (Kinds{push, touchdown, saturation, fell, EventKind::log}));
  EXPECT_EQ(events[1].t, 1);
  EXPECT_EQ(events.back().text, "2 events left out");
  EXPECT_EQ(events.back().t, 5);
}

TEST(LogEvents, OthersFollowIfThereAreStillTooMany) {
  std::vector<SimulationEvent> events =
      events_of({push, touchdown, disturbance, touchdown, disturbance});
  limit_events(events, 3);
  EXPECT_EQ(kinds_of(events), (Kinds{push, disturbance, EventKind::log}));
  EXPECT_EQ(events.back().text, "3 events left out");
}

}  // namespace
}  // namespace ayumi
