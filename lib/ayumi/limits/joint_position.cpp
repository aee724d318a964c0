// A limited joint stays within its range, narrowed at both ends by the robot's soft margin m:
//   lower + m <= theta <= upper - m.
// The figure is |theta - middle| over half of that range.
#include <algorithm>

#include "ayumi/base/text.hpp"
#include "ayumi/limits/judged_motion.hpp"
#include "ayumi/limits/row_site.hpp"

namespace ayumi {

namespace {

// Tolerance of the angle [rad] or [m]. Chosen: a motion that is planned exactly at the limit keeps
// the limit, except for the rounding of a table with four decimals. No measured case changes
// between half and twice the value (constants.md).
constexpr double kPositionTolerance = 1e-4;
constexpr double kLeastHalfRange =
    1e-9;  // prevents a division by zero for a joint without a range [rad]

struct Range : AngleRange {
  double half() const { return 0.5 * (upper - lower); }
  double share(double theta) const {
    return std::abs(theta - 0.5 * (lower + upper)) / std::max(half(), kLeastHalfRange);
  }
};

Range range_of(const Dof& dof, double margin) { return {{dof.lower + margin, dof.upper - margin}}; }

void judge_joint_positions(JudgedMotion& motion, const JudgedSample& s) {
  const double margin = motion.model.description().soft_limit_margin;
  for (int i = 0; i < motion.model.dof_count(); ++i) {
    const Dof& dof = motion.model.dofs()[i];
    if (!dof.limited) continue;
    const double theta = s.command.state.theta[i];
    const Range range = range_of(dof, margin);
    const double lower = range.lower, upper = range.upper;
    motion.raise(FindingKind::joint_position, range.share(theta), s.k, i);
    const double beyond = std::max(lower - theta, theta - upper);
    if (beyond > motion.tolerance(FindingKind::joint_position))
      motion.add(FindingKind::joint_position, i, s.k, theta, theta > upper ? upper : lower, beyond);
  }
}

const RowKind kPositionRows = {
    .name = "position", .unit = &RowPrices::angle, .beyond_check = true, .order = {3, 0}};

void place_position_rows(RowSite& site) {
  const RowSettings& settings = site.settings;
  const double margin = site.model.description().soft_limit_margin;
  for (int i = 0; i < site.model.dof_count(); ++i) {
    const Dof& dof = site.model.dofs()[i];
    const Range allowed = range_of(dof, margin);
    const Range range = range_of(dof, margin + settings.joint_margin);
    if (!dof.limited || site.is_locked(i) || range.half() < 0) continue;
    for (int point = 0; point < site.count(); ++point) {
      const double used = site.most(
          point, [&](const CommandSample& sample) { return range.share(sample.state.theta[i]); });
      if (used <= settings.watched_share) continue;
      const auto [lower, upper] = range_with_given(range, allowed, site.given(point).state.theta[i],
                                                   site.tolerance(FindingKind::joint_position));
      site.add(kPositionRows, point, i, JointRow{JointQuantity::angle, i}, 1, lower, upper).active =
          settings.active;
    }
  }
}

const char* position_unit(const JudgedMotion& motion, const Violation& v) {
  return joint_unit(motion, v, "rad", "m");
}

Advice position_advice(const JudgedMotion& motion, const FindingWindow& window) {
  const Violation& v = window.worst;
  const Dof& dof = motion.model.dofs()[v.item];
  const double beyond = std::abs(v.value - v.limit);
  return {"move " + dof.name + " back by " +
              (dof.prismatic ? in_mm(beyond) : angle_size(beyond, motion.degrees)) +
              " in this window",
          kOrRepair};
}

std::string position_infeasibility(const Finding& f, double violation) {
  const bool prismatic = f.unit == "m";
  return f.where + " goes " +
         (prismatic ? in_mm(violation) : angle_size(violation, f.in_degrees, 1)) +
         " beyond its limit";
}

}  // namespace

const Limit& joint_position_limit() {
  static const Limit limit = {.findings = {{.kind = FindingKind::joint_position,
                                            .unit = "rad",
                                            .tolerance = kPositionTolerance,
                                            .meaning = "angle by which a joint is beyond its limit",
                                            .figure = {.key = "max_joint_position_ratio",
                                                       .label = "largest joint angle",
                                                       .unit = "% of half the range",
                                                       .scale = 100,
                                                       .share_name = "joint position",
                                                       .line = 6},
                                            .repair = {.is_of_one_joint = true},
                                            .finding_unit = position_unit,
                                            .place = joint_place,
                                            .advice = position_advice,
                                            .infeasibility = position_infeasibility}},
                              .judge_sample = judge_joint_positions,
                              .place_rows = place_position_rows};
  return limit;
}

}  // namespace ayumi
