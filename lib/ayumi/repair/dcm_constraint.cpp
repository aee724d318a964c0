// Where the plan has its divergent component xi, and with it how far a push may throw it: supports
// stay as they are planned, so what one direction gains the opposite one loses. A posture that is
// wrong for a moment takes the COG with it, and the least change leaves it there. The ZMP beside
// it: a controller that keeps to COG and feet takes what only a limb's swing asks for as a push.
#include <algorithm>
#include <cmath>

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/repair/correction_problem.hpp"

namespace ayumi {

using Eigen::Vector2d;

namespace {

double over_omega(const CommandSample& plan) {
  return std::sqrt((plan.cog.z() - plan.zmp.z()) / kGravity);
}

Vector2d planned_xi(const CommandSample& plan) {
  return (plan.cog + over_omega(plan) * plan.dcog).head<2>();
}

// Whether the ground carries, and the plan has a xi.
bool carried(const CollocationPoint& at, const CommandSample& plan) {
  return at.known && !at.plane.empty() && plan.cog.z() > plan.zmp.z();
}

}  // namespace

// Around where the posture is off a plan that is right; where both agree and the motion is at fault
// all the same, xi has to move.
void CorrectionProblem::measure_capture() {
  constexpr double kAround = 0.5;  // [s]
  constexpr double kOff = 0.014;   // of the COG's height: what a push study can tell
  keeps_xi_.assign(instants_.size(), false);
  if (!spec_.gentle_swings || spec_.trust != Trust::posture) return;
  RobotData data(model_);
  std::vector<double> times, off;
  for (const CollocationPoint& at : instants_) {
    const CommandSample& plan = series_.samples[at.sample];
    const double t = at.sample * series_.dt;
    times.push_back(t);
    if (!carried(at, plan) || within(spec_.wrong_plan, t)) continue;
    update_positions(model_, plan.state, data);
    update_velocities(model_, plan.state, data);
    const Vector2d xi = (data.cog + over_omega(plan) * data.dcog).head<2>();
    if ((xi - planned_xi(plan)).norm() > spec_.watched_share * kOff * (plan.cog.z() - plan.zmp.z()))
      off.push_back(t);
  }
  for (size_t i = 0; i < times.size(); ++i)
    keeps_xi_[i] = std::any_of(off.begin(), off.end(),
                               [&](double t) { return std::abs(t - times[i]) <= kAround; }) &&
                   !within(spec_.wrong_plan, times[i]);
}

void CorrectionProblem::place_capture_block(int instant) {
  CollocationPoint& at = instants_[static_cast<size_t>(instant)];
  const CommandSample& plan = series_.samples[at.sample];
  if (!keeps_xi_[static_cast<size_t>(instant)] || !carried(at, plan)) return;
  at.xi = planned_xi(plan);
  ConstraintBlock block = block_of(ConstraintGroup::capture, instant, 0, 4);
  block.factor = over_omega(plan);
  block.wrench_rows = planned_zmp_rows(instant);
  const Eigen::Vector4d spare(spec_.xi_spare, spec_.xi_spare, spec_.zmp_spare, spec_.zmp_spare);
  add_block(std::move(block), 0, 0);
  lower_.tail<4>() = -spare;
  upper_.tail<4>() = spare;
}

}  // namespace ayumi
