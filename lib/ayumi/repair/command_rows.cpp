// DCM = COG + COG rate / omega, omega = sqrt(g / z). Its derivatives follow from those of the COG
// and of its rate: for a function c(x, t), d(c')/dx is half of d(c'')/dx', and m c'' is the ground
// force, whose derivative by the correction's rate is known.
#include "ayumi/repair/command_rows.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/dynamics/cog_jacobian.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/repair/ground_rows.hpp"

namespace ayumi {

namespace policy = repair_policy;

using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

double pendulum_time(const CommandSample& plan) {  // 1 / omega [s]
  return std::sqrt((plan.cog.z() - plan.zmp.z()) / kGravity);
}

Vector2d planned_dcm(const CommandSample& plan) {
  return (plan.cog + pendulum_time(plan) * plan.dcog).head<2>();
}

// Whether the ground carries the robot there, so that the plan has a DCM.
bool has_dcm(const CollocationPoint& at, const CommandSample& plan) {
  return at.forces_known && !at.plane.empty() && plan.cog.z() > plan.zmp.z();
}

VectorXd dcm_values(const RobotModel& model, const ConstraintBlock& block,
                    const CollocationPoint& point, const PointState& state) {
  const CorrectedMotion& m = state.motion;
  const Vector3d rate = cog_jacobian_floating(model, *state.data) * m.state.velocity();
  const Vector3d dcm = state.data->cog + block.factor * rate;
  VectorXd values(4);
  values << dcm.head<2>() - point.dcm, ground_values(block, point, state);
  return values;
}

std::array<MatrixXd, 3> dcm_derivatives(const RobotModel& model, const ConstraintBlock& block,
                                        const CollocationPoint& point, const PointState& state) {
  const auto zmp = ground_derivatives(block, point, state);
  const MatrixXd cog = state.cog_by.topRows<2>();
  const MatrixXd rate = 0.5 / model.mass() * state.wrench_by[1].topRows<2>();
  const MatrixXd dcm[] = {cog + block.factor * rate, block.factor * cog, 0 * cog};
  std::array<MatrixXd, 3> by;
  for (int k = 0; k < 3; ++k) {
    by[k].resize(4, cog.cols());
    by[k] << dcm[k], zmp[k];
  }
  return by;
}

}  // namespace

VectorXd command_values(const RobotModel& model, const ConstraintBlock& block,
                        const CollocationPoint& point, const PointState& state) {
  if (block.group == ConstraintGroup::pose) return state.change;
  if (block.group == ConstraintGroup::dcm) return dcm_values(model, block, point, state);
  return state.data->cog - point.cog;
}

std::array<MatrixXd, 3> command_derivatives(const RobotModel& model, const ConstraintBlock& block,
                                            const CollocationPoint& point,
                                            const PointState& state) {
  if (block.group == ConstraintGroup::dcm) return dcm_derivatives(model, block, point, state);
  std::array<MatrixXd, 3> by;
  if (block.group == ConstraintGroup::pose)
    by[0].setIdentity(block.rows, model.velocity_count());
  else
    by[0] = state.cog_by;
  return by;
}

std::vector<bool> where_dcm_is_held(const RowPlacement& p) {
  std::vector<bool> held(p.points.size(), false);
  if (!p.spec.swing_goals || p.spec.trust != Trust::posture) return held;
  RobotData data(p.model);
  std::vector<double> times, off;
  for (const CollocationPoint& at : p.points) {
    const CommandSample& plan = p.series.samples[at.sample];
    const double t = at.sample * p.series.dt;
    times.push_back(t);
    if (!has_dcm(at, plan) || within(p.spec.wrong_plan, t)) continue;
    update_positions(p.model, plan.state, data);
    update_velocities(p.model, plan.state, data);
    const Vector2d dcm = (data.cog + pendulum_time(plan) * data.dcog).head<2>();
    if ((dcm - planned_dcm(plan)).norm() >
        p.spec.watched_share * policy::dcm::kOff * (plan.cog.z() - plan.zmp.z()))
      off.push_back(t);
  }
  for (size_t i = 0; i < times.size(); ++i)
    held[i] =
        std::any_of(off.begin(), off.end(),
                    [&](double t) { return std::abs(t - times[i]) <= policy::dcm::kAround; }) &&
        !within(p.spec.wrong_plan, times[i]);
  return held;
}

void place_pose_rows(RowPlacement& p, int point) {
  const int k = p.points[point].sample;
  for (const double t : p.spec.kept_times) {
    if (std::lround(t / p.series.dt) != k) continue;
    p.add(block_of(ConstraintGroup::pose, point, 0, p.model.velocity_count()),
          -policy::stance::kLockedPose, policy::stance::kLockedPose);
    return;
  }
}

void place_command_rows(RowPlacement& p, int point) {
  const CollocationPoint& at = p.points[point];
  if (p.spec.trust == Trust::cog) {
    const double band = policy::kTrustedShare * p.tolerance(FindingKind::cog_residual);
    p.add(block_of(ConstraintGroup::cog, point, 0, 3), -band, band);
  }
  if (p.spec.trust != Trust::zmp || at.plane.empty() || !at.forces_known) return;
  ConstraintBlock block = block_of(ConstraintGroup::zmp, point, 0, 2);
  block.wrench_rows = planned_zmp_rows(p, point);
  const double band = policy::kTrustedShare * p.tolerance(FindingKind::zmp_residual);
  p.add(std::move(block), -band, band);
}

void place_dcm_rows(RowPlacement& p, int point) {
  CollocationPoint& at = p.points[point];
  const CommandSample& plan = p.series.samples[at.sample];
  if (!has_dcm(at, plan)) return;
  at.dcm = planned_dcm(plan);
  ConstraintBlock block = block_of(ConstraintGroup::dcm, point, 0, 4);
  block.factor = pendulum_time(plan);
  block.wrench_rows = planned_zmp_rows(p, point);
  const Eigen::Vector4d slack(p.spec.dcm_slack, p.spec.dcm_slack, p.spec.zmp_slack,
                              p.spec.zmp_slack);
  p.add(std::move(block), -slack, slack);
}

}  // namespace ayumi
