#include "ayumi/demand/motion_demand.hpp"

#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::Vector3d;
using Eigen::VectorXd;

MotionDynamics::MotionDynamics(const RobotModel& model, const ActuatorLimits& actuators,
                               const CommandSeries& series, const ContactPlan& plan)
    : model_(model), actuators_(actuators), series_(series), plan_(plan), data_(model) {}

// The support only changes at the ends of contact intervals.
void MotionDynamics::update_plane(int k) {
  const std::array<int, 2> now = {plan_.index[0][k], plan_.index[1][k]};
  if (now == plane_of_) return;
  plane_of_ = now;
  for (Side side : {Side::left, Side::right})
    soles_[static_cast<int>(side)] = plan_.at(side, k).sole;
  plane_ = support_plane(model_, series_.samples[k].support, soles_);
}

const SampleDynamics& MotionDynamics::at(int k, double pace) {
  const CommandSample& s = series_.samples[k];
  update_plane(k);
  state_ = s.state;
  acceleration_ = s.acceleration;
  if (pace != 1) {
    state_.base_velocity *= pace;
    state_.base_angular_velocity *= pace;
    state_.dtheta *= pace;
    acceleration_ *= pace * pace;
  }
  evaluate(k);
  return now_;
}

// The wrench is linear in the acceleration of the base.
const SampleDynamics& MotionDynamics::free_flight(int k) {
  const Vector6d wrench = at(k).wrench;
  Eigen::Matrix<double, 6, 6> inertia;
  for (int i = 0; i < 6; ++i) {
    acceleration_[i] += 1;
    inertia.col(i) = inverse_dynamics(model_, state_, acceleration_, data_).head<6>() - wrench;
    acceleration_[i] -= 1;
  }
  acceleration_.head<6>() -= inertia.lu().solve(wrench);
  evaluate(k);
  return now_;
}

void MotionDynamics::evaluate(int k) {
  const CommandSample& s = series_.samples[k];
  const VectorXd force = inverse_dynamics(model_, state_, acceleration_, data_);
  const Vector3d base = s.state.base.position;
  now_.wrench = force.head<6>();
  now_.ddcog = now_.wrench.head<3>() / model_.mass() - Vector3d(0, 0, kGravity);
  now_.moment = now_.wrench.tail<3>() + (base - data_.cog).cross(Vector3d(now_.wrench.head<3>()));
  now_.use = plane_.empty() ? GroundDemand{}
                            : ground_demand(plane_, plane_wrench(plane_, base, now_.wrench),
                                            contact_threshold(model_));
  const auto foot = foot_wrenches(model_, s.support, soles_, plane_, now_.use, base, now_.wrench);
  now_.torque = motor_torques(model_, actuators_, state_, acceleration_, force, foot, data_);
}

}  // namespace ayumi
