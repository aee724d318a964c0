#pragma once
// The demand of a planned motion at one sample, as the check examines it: played as planned, or
// more slowly to find out whether the speed is the cause of an error.

#include "ayumi/demand/contact_plan.hpp"
#include "ayumi/demand/ground_demand.hpp"

namespace ayumi {

struct SampleDynamics {
  Vector6d wrench = Vector6d::Zero();                ///< wrench of the ground about the base origin
  Eigen::Vector3d ddcog = Eigen::Vector3d::Zero();   ///< acceleration of the COG [m/s^2]
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< moment of the wrench about the COG [N m]
  GroundDemand use;                                  ///< demand on the ground, if a foot supports
  Eigen::VectorXd torque;                            ///< torques of the motors [dof]
};

/// Examines one sample after the other. The results are valid until the next call of at().
class MotionDynamics {
 public:
  /// The arguments must outlive this object.
  MotionDynamics(const RobotModel& model, const ActuatorLimits& actuators,
                 const CommandSeries& series, const ContactPlan& plan);

  /// Inverse dynamics of sample k with its rates times `pace` and its accelerations times the
  /// square of `pace`: the same path, played more slowly.
  const SampleDynamics& at(int k, double pace = 1);

  /// Sample k of a flight, with the acceleration of the base changed so that the robot needs no
  /// external wrench. The motor torques then do not contain a force and a moment that no ground can
  /// give.
  const SampleDynamics& free_flight(int k);

  const RobotData& data() const { return data_; }       ///< positions and rates of that sample
  const SupportPlane& plane() const { return plane_; }  ///< empty in flight
  /// Planned soles of the supporting feet, by Side.
  const std::array<Eigen::Isometry3d, 2>& soles() const { return soles_; }

 private:
  void update_plane(int k);
  void evaluate(int k);

  const RobotModel& model_;
  const ActuatorLimits& actuators_;
  const CommandSeries& series_;
  const ContactPlan& plan_;
  RobotData data_;
  RobotState state_;
  Eigen::VectorXd acceleration_;
  SampleDynamics now_;
  std::array<int, 2> plane_of_ = {-1, -1};
  std::array<Eigen::Isometry3d, 2> soles_ = {Eigen::Isometry3d::Identity(),
                                             Eigen::Isometry3d::Identity()};
  SupportPlane plane_;
};

}  // namespace ayumi
