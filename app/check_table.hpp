#pragma once
// A consistency report for people.

#include <string>
#include <vector>

#include "ayumi/check/consistency.hpp"
#include "ayumi/check/likely_mistakes.hpp"
#include "screen.hpp"

namespace ayumi::app {

enum class Shown {
  causes,   ///< one entry for each group of findings, at most kMostGroups
  findings  ///< one entry for every finding
};

/// The verdict of the check, coloured.
std::string painted_verdict(const ConsistencyReport& report);

/// Largest number of groups that are shown. Chosen: an author corrects causes one after the other,
/// and then checks again.
inline constexpr int kMostGroups = 10;

/// Entries such as
///   "  error    support_margin  left foot, at 1.280 s: -9.8 mm, limit 0.0 mm",
/// or with "1.200-1.350 s, worst at 1.280 s" for a window, each with its hint.
std::vector<AnswerPart> finding_parts(const ConsistencyReport& report, const RobotModel& model,
                                      Shown shown);

/// The entries of finding_parts(), and lines with the most important figures.
std::vector<AnswerPart> check_parts(const ConsistencyReport& report, const RobotModel& model,
                                    Shown shown = Shown::causes);

/// Number of rows that an answer with this report may take.
size_t rows_for(const ConsistencyReport& report);

/// The line below an answer that was shortened, which says where more is shown.
std::string where_more_is(const ConsistencyReport& report);

/// The largest share of each limit, such as "joint speed 62 % (l_knee at 1.20 s), ...".
std::string shares_of_limits(const ConsistencyReport& report, const RobotModel& model);

/// A line for each sentence, below this heading. The first line is never left out; if others are
/// left out, their number is stated.
std::vector<AnswerPart> remark_parts(const std::string& heading,
                                     const std::vector<std::string>& sentences,
                                     Worth worth = Worth::remark);

/// A line for each cause.
std::vector<AnswerPart> mistake_parts(const std::vector<Mistake>& mistakes, bool consistent);

/// The changes that a search tried without finding a cause.
std::vector<AnswerPart> search_parts(const std::vector<Mistake>& mistakes);

/// A table of the names, default tolerances, units and meanings of all kinds of findings.
std::string tolerance_table();

}  // namespace ayumi::app
