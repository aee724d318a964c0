#include "ayumi/repair/row_placement.hpp"

#include "ayumi/repair/clearance_rows.hpp"
#include "ayumi/repair/command_rows.hpp"
#include "ayumi/repair/foot_rows.hpp"
#include "ayumi/repair/ground_rows.hpp"
#include "ayumi/repair/joint_rows.hpp"

namespace ayumi {

using Eigen::VectorXd;

std::vector<const CommandSample*> RowPlacement::watched(int point) const {
  const int k = points[point].sample;
  std::vector<const CommandSample*> samples = {&series.samples[k]};
  for (const CommandSeries* seen : spec.seen) samples.push_back(&seen->samples[k]);
  return samples;
}

void RowPlacement::add(ConstraintBlock block, double lower, double upper) {
  const VectorXd low = VectorXd::Constant(block.rows, lower);
  const VectorXd high = VectorXd::Constant(block.rows, upper);
  add(std::move(block), low, high);
}

void RowPlacement::add(ConstraintBlock block, const VectorXd& lower, const VectorXd& upper) {
  const CollocationPoint& point = points[block.point];
  if (!point.only.empty() && !point.only.contains({block.group, block.item})) return;
  block.row = static_cast<int>(rows.lower.size());
  rows.lower.conservativeResize(block.row + block.rows);
  rows.upper.conservativeResize(block.row + block.rows);
  rows.lower.tail(block.rows) = lower;
  rows.upper.tail(block.rows) = upper;
  rows.columns.push_back(block_columns(model, block, point));
  rows.blocks.push_back(std::move(block));
}

PlacedRows place_rows(const RobotModel& model, const CommandSeries& series,
                      const CorrectionSpec& spec, const ContactPlan& plan,
                      std::vector<CollocationPoint>& points) {
  RowPlacement p{model, series, spec, plan, points};
  set_zmp_margins(p);
  const SwingGoals swings = swing_goals(p);
  const std::vector<bool> holds_dcm = where_dcm_is_held(p);
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    const bool all = points[i].only.empty();
    if (all) place_pose_rows(p, i);
    if (all) place_foot_rows(p, i, swings);
    place_joint_rows(p, i);
    if (points[i].forces_known) {
      place_ground_rows(p, i);
      place_torque_rows(p, i);
    }
    if (all) place_clearance_rows(p, i);
    if (all) place_command_rows(p, i);
    if (all && holds_dcm[i]) place_dcm_rows(p, i);
  }
  return std::move(p.rows);
}

}  // namespace ayumi
