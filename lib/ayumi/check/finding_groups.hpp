#pragma once
// Findings as people read them: one group for each cause. A walk with swings that are too fast has
// the same finding at each step and on both sides, and each of them has consequences; but the
// author has to correct only one thing.

#include <string>
#include <vector>

#include "ayumi/check/consistency.hpp"

namespace ayumi {

/// A consequence of the errors of a group.
struct GroupConsequence {
  FindingKind kind = FindingKind::cog_residual;
  int count = 0;  ///< number of findings
  int worst = 0;  ///< the worst of them, as an index into ConsistencyReport::findings
};

/// Findings of one kind and severity, at one place or at this place and its mirror image.
struct FindingGroup {
  std::vector<int> members = {};         ///< indices into ConsistencyReport::findings, by time
  int worst = 0;                         ///< index of the member that is furthest beyond its limit
  std::vector<std::string> places = {};  ///< the places of all members in words, each place once
  /// Consequences in the order of their first finding.
  std::vector<GroupConsequence> consequences = {};
};

/// Whether a value is further beyond its limit than another one of its kind.
bool is_further_beyond(const Finding& a, const Finding& b);

/// Every finding is a member of one group, or a consequence of a member. Groups are in the order of
/// their first member: errors first, then by time. For a robot without a mirror image, left and
/// right are separate groups.
std::vector<FindingGroup> finding_groups(const ConsistencyReport& report, const RobotModel& model);

}  // namespace ayumi
