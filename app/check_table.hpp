#pragma once
// A consistency report for people.

#include <string>

#include "ayumi/check/consistency.hpp"

namespace ayumi::app {

/// "  error    support_margin  left  1.200-1.350 s, worst at 1.280 s: -9.8 mm, limit 0.0 mm" with
/// its hint, one pair of lines per finding, and a line with the most important figures.
std::string check_table(const ConsistencyReport& report);

/// Names, default tolerances, units and meanings of all kinds.
std::string tolerance_table();

}  // namespace ayumi::app
