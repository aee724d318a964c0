#pragma once
// The forces that the motion of a law's reference body requires, for laws whose motion is not
// planned in advance: the rate of its angular momentum, which moves the ZMP, and the torques of its
// joints. docs/theory.md, "VIIP".

#include "ayumi/demand/ground_demand.hpp"
#include "ayumi/dynamics/robot_data.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

class ReferenceDynamics {
 public:
  ReferenceDynamics(const RobotModel& model, const ActuatorLimits& limits, double dt);

  /// The reference body at `state`, anchored on the sole of `anchor`, has moved by the joint rates
  /// `dtheta` [rad/s] in this tick. `plan` contains feet and support. `places` are the places of
  /// the ZMP when one foot alone carries the robot, by Side, plan frame [m].
  void update(const RobotState& state, Side anchor, const Eigen::VectorXd& dtheta,
              const CommandSample& plan, const std::array<Eigen::Vector2d, 2>& places);

  /// The rate of the angular momentum about the COG after a filter [N m].
  const Eigen::Vector3d& momentum_rate() const { return momentum_rate_; }

  /// tau / kp by dof [rad]. If the servo target is ahead of the posture by this angle, the joint
  /// does not sag. Zero in the first two ticks.
  const Eigen::VectorXd& lead() const { return lead_; }

 private:
  std::array<Vector6d, 2> foot_wrenches(const CommandSample& plan,
                                        const std::array<Eigen::Vector2d, 2>& places,
                                        const Vector6d& wrench) const;

  const RobotModel* model_;
  ActuatorLimits limits_;
  double dt_;
  RobotData data_;
  Eigen::VectorXd velocity_, acceleration_, lead_;
  Eigen::Vector3d momentum_rate_ = Eigen::Vector3d::Zero();
};

}  // namespace ayumi
