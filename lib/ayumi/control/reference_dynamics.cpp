// The acceleration is computed as the filtered difference of the velocities of two ticks. It cannot
// be taken from the plan, because the motion also contains the law's response to measurements.
// Inverse dynamics give the wrench of the ground about the base. In double support, the two feet
// share the wrench in the ratio in which the ZMP lies between the places of their soles, so the
// shares change continuously while the ZMP moves from foot to foot. The centre of pressure of each
// sole is displaced from the place of the sole by the same vector by which the ZMP is displaced
// from the line between both places.
#include "ayumi/control/reference_dynamics.hpp"

#include <algorithm>

#include "ayumi/demand/ground_demand.hpp"
#include "ayumi/dynamics/cog_jacobian.hpp"
#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/plan/foot_plan.hpp"

namespace ayumi {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

// Time constant of the low pass of the acceleration [s]. Chosen: a few ticks, enough against the
// noise of a difference.
constexpr double kAccelerationFilter = 0.005;

}  // namespace

ReferenceDynamics::ReferenceDynamics(const RobotModel& model, const ActuatorLimits& limits,
                                     double dt)
    : model_(&model),
      limits_(limits),
      dt_(dt),
      data_(model),
      lead_(VectorXd::Zero(model.dof_count())) {}

void ReferenceDynamics::update(const RobotState& state, Side anchor, const VectorXd& dtheta,
                               const CommandSample& plan, const std::array<Vector2d, 2>& places) {
  update_positions(*model_, state, data_);
  const VectorXd velocity = anchored_velocity_map(*model_, data_, anchor) * dtheta;
  if (velocity_.size() == 0) {
    velocity_ = velocity;
    acceleration_ = VectorXd::Zero(velocity.size());
  }
  const double share = std::min(1.0, dt_ / kAccelerationFilter);
  acceleration_ += share * ((velocity - velocity_) / dt_ - acceleration_);
  velocity_ = velocity;

  RobotState moving = state;
  moving.base_velocity = velocity.head<3>();
  moving.base_angular_velocity = velocity.segment<3>(3);
  moving.dtheta = dtheta;
  const VectorXd force = inverse_dynamics(*model_, moving, acceleration_, data_);
  const Vector6d wrench = force.head<6>();
  momentum_rate_ = wrench.tail<3>() - data_.cog_offset.cross(Vector3d(wrench.head<3>()));

  const VectorXd torque = motor_torques(*model_, limits_, moving, acceleration_, force,
                                        foot_wrenches(plan, places, wrench), data_);
  for (int j = 0; j < model_->dof_count(); ++j) {
    const double kp = limits_.servo[static_cast<size_t>(j)].kp, peak = limits_.peak_torque[j];
    lead_[j] = kp > 0 ? std::clamp(torque[j], -peak, peak) / kp : 0.0;
  }
}

std::array<Vector6d, 2> ReferenceDynamics::foot_wrenches(const CommandSample& plan,
                                                         const std::array<Vector2d, 2>& places,
                                                         const Vector6d& wrench) const {
  std::array<Vector6d, 2> feet = {Vector6d::Zero(), Vector6d::Zero()};
  if (plan.support == Support::none) return feet;
  if (plan.support != Support::both) {
    feet[plan.support == Support::left ? 0 : 1] = wrench;
    return feet;
  }
  const Vector3d f = wrench.head<3>(), n = wrench.tail<3>();
  std::array<Vector3d, 2> place;
  for (size_t s = 0; s < 2; ++s) place[s] << places[s], plan.feet[s].translation().z();
  // The point at the height of the soles about which the moment of the wrench is vertical.
  const Vector3d& base = data_.base_position;
  const double down = 0.5 * (place[0].z() + place[1].z()) - base.z();
  const Vector3d zmp =
      base + Vector3d(down * f.x() - n.y(), down * f.y() + n.x(), 0) / f.z() + Vector3d(0, 0, down);
  const Vector3d across = place[0] - place[1];
  const double left = std::clamp(across.dot(zmp - place[1]) / across.squaredNorm(), 0.0, 1.0);
  const Vector3d off = zmp - (left * place[0] + (1 - left) * place[1]);
  const Vector3d free_moment = n - (zmp - base).cross(f);
  for (size_t s = 0; s < 2; ++s) {
    const double share = s == 0 ? left : 1 - left;
    feet[s].head<3>() = share * f;
    feet[s].tail<3>() = share * ((place[s] + off - base).cross(f) + free_moment);
  }
  return feet;
}

}  // namespace ayumi
