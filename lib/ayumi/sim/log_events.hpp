#pragma once
// The number of events of a log is bounded, because reports and plots show each of them.

#include <vector>

#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

/// Largest number of events of a log. Chosen: the longest log, half an hour, has about 4000
/// touchdowns of a walk with two steps per second. With half of the value, such a log is still
/// whole; with twice, a report of a log with this number takes twice the time.
inline constexpr size_t kMostLogEvents = 10'000;

/// Leaves out events, given in the order of their times, beyond `most`: first the last touchdowns,
/// because the result counts the steps, and then the last other ones. The last event then says how
/// many are left out.
void limit_events(std::vector<SimulationEvent>& events, size_t most = kMostLogEvents);

}  // namespace ayumi
