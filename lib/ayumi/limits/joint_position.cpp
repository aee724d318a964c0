// A limited joint stays within its range, narrowed at both ends by the robot's soft margin m:
//   lower + m <= theta <= upper - m.
// The figure is |theta - middle| over half of that range.
#include <algorithm>

#include "ayumi/base/text.hpp"
#include "ayumi/limits/judged_motion.hpp"

namespace ayumi {

namespace {

// [rad] or [m] Chosen: a motion planned onto the limit meets it but for the rounding of a table
// with four decimals. No measured case changes from half to twice (constants.md).
constexpr double kPositionTolerance = 1e-4;
constexpr double kLeastHalfRange = 1e-9;  // so that a joint without range divides by no zero [rad]

void judge_joint_positions(JudgedMotion& motion, const JudgedSample& s) {
  const double margin = motion.model.description().soft_limit_margin;
  for (int i = 0; i < motion.model.dof_count(); ++i) {
    const Dof& dof = motion.model.dofs()[i];
    if (!dof.limited) continue;
    const double theta = s.command.state.theta[i];
    const double lower = dof.lower + margin, upper = dof.upper - margin;
    const double half = 0.5 * (upper - lower);
    motion.raise(FindingKind::joint_position,
                 std::abs(theta - 0.5 * (lower + upper)) / std::max(half, kLeastHalfRange));
    const double beyond = std::max(lower - theta, theta - upper);
    if (beyond > motion.tolerance(FindingKind::joint_position))
      motion.add(FindingKind::joint_position, i, s.k, theta, theta > upper ? upper : lower, beyond);
  }
}

const char* position_unit(const JudgedMotion& motion, const Violation& v) {
  return joint_unit(motion, v, "rad", "m");
}

Advice position_advice(const JudgedMotion& motion, const FindingWindow& window) {
  const Violation& v = window.worst;
  const Dof& dof = motion.model.dofs()[v.item];
  const double excess = std::abs(v.value - v.limit);
  return {"move " + dof.name + " back by " +
              (dof.prismatic ? in_mm(excess) : text::fixed(excess * 180 / EIGEN_PI, 2) + " deg") +
              " in this window",
          kOrRepair};
}

std::string position_obstacle(const Finding& f, double excess) {
  const bool prismatic = f.unit == "m";
  return f.where + " goes " +
         (prismatic ? in_mm(excess) : text::fixed(std::abs(excess) * 180 / EIGEN_PI, 1) + " deg") +
         " beyond its limit";
}

}  // namespace

const Limit& joint_position_limit() {
  static const Limit limit = {.findings = {{.kind = FindingKind::joint_position,
                                            .unit = "rad",
                                            .tolerance = kPositionTolerance,
                                            .meaning = "joint angle beyond its limit",
                                            .figure = {.key = "max_joint_position_ratio",
                                                       .label = "largest joint angle",
                                                       .unit = "% of half the range",
                                                       .scale = 100,
                                                       .share_name = "position",
                                                       .line = 6},
                                            .finding_unit = position_unit,
                                            .place = joint_place,
                                            .advice = position_advice,
                                            .obstacle = position_obstacle}},
                              .judge_sample = judge_joint_positions};
  return limit;
}

}  // namespace ayumi
