#pragma once
// A consistency report for people.

#include <string>
#include <vector>

#include "ayumi/check/consistency.hpp"
#include "ayumi/check/likely_mistakes.hpp"

namespace ayumi::app {

enum class Shown {
  causes,   ///< one entry for each group of findings, at most kMostGroups
  findings  ///< every finding
};

/// Groups that fit on one screen with the figures below them. Chosen: two lines each, of 40.
inline constexpr int kMostGroups = 10;

/// "  error    support_margin  left, 1.200-1.350 s, worst at 1.280 s: -9.8 mm, limit 0.0 mm" with
/// its hint, and lines with the most important figures.
std::string check_table(const ConsistencyReport& report, const RobotModel& model,
                        Shown shown = Shown::causes);

/// False where the robot states no limit of this kind for any motor.
bool has_limit(const ConsistencyReport& report, FindingKind kind);

/// "joint speed 62 % (l_knee at 1.20 s), ...": the largest share of each limit.
std::string shares_of_limits(const ConsistencyReport& report);

/// A line for each cause, with this heading.
std::string mistake_words(const std::vector<Mistake>& mistakes,
                          const char* heading = "likely cause:");

/// What a search that found no cause tried.
std::string search_words(const std::vector<Mistake>& mistakes);

/// Names, default tolerances, units and meanings of all kinds.
std::string tolerance_table();

}  // namespace ayumi::app
