#pragma once
// The angular momentum task of (22): if the ZMP that the law asks for is outside the support, the
// trunk and the arms supply the missing moment by their acceleration, and return slowly.

#include <vector>

#include "ayumi/dynamics/robot_data.hpp"

namespace ayumi {

/// How the upper body turns against its command. Zero: as commanded.
struct UpperBodyTurn {
  Eigen::Vector3d lean = Eigen::Vector3d::Zero();       ///< of the trunk, rotation vector in world
                                                        ///< axes [rad]
  Eigen::Vector3d lean_rate = Eigen::Vector3d::Zero();  ///< [rad/s]
  Eigen::VectorXd joints;                               ///< by dof, zero except for the arms [rad]
  Eigen::VectorXd joint_rates;                          ///< [rad/s]
};

/// The coordinates s are the trunk's tilt about the world's x and y axes and the joints of the arms
/// (and of the head): all joints that the trunk carries. When the COG is kept in place, the rates
/// ds have the angular momentum A_G ds about the COG (docs/theory.md, "Angular momentum"). Of all
/// accelerations with A_G dds = dL, the law takes the ones that are nearest to zero in the norm W,
/// as in (23), each within the range, the speed and the torque of its joint.
class AngularMomentumTask {
 public:
  /// The joints have the robot's own weights.
  AngularMomentumTask(const RobotModel& model, const ActuatorLimits& limits);

  /// W = diag(weight) from now on [dof]. The trunk has the largest weight of the hips, which turn
  /// it.
  void weigh(const Eigen::VectorXd& weight);

  /// One tick of dt [s]. `moment`: dL about the COG, world axes; its vertical part is not used
  /// [N m]. `data` holds the positions of the reference, `commanded` the joints of the plan [rad],
  /// `tilt` the tilt of the plan's trunk about the world's x and y axes [rad];
  /// omega = sqrt(g / z) [1/s] is the unit of the rate at which the turn is given back.
  const UpperBodyTurn& update(const Eigen::Vector3d& moment, const RobotData& data,
                              const Eigen::VectorXd& commanded, const Eigen::Vector2d& tilt,
                              double omega, double dt);

  /// A_G at these positions: angular momentum about the COG by rate of each coordinate, the trunk's
  /// two first [N m s].
  const Eigen::Matrix3Xd& matrix(const RobotData& data);

  /// The dofs of the coordinates from the third on.
  const std::vector<int>& joints() const { return joints_; }

 private:
  void bound(const Eigen::VectorXd& commanded, const Eigen::Vector2d& tilt, double dt);
  void accelerate(const Eigen::Vector3d& moment);

  const RobotModel* model_;
  std::vector<int> joints_, hips_;
  std::vector<bool> carried_;                   // by body: the trunk, or carried by it
  Eigen::VectorXd weight_;                      // by coordinate
  Eigen::VectorXd speed_, torque_;              // by coordinate [rad/s], [N m]
  Eigen::VectorXd rotor_;                       // by coordinate [kg m^2]
  std::vector<SpatialInertia> subtree_;         // by body, scratch
  Eigen::Matrix3Xd matrix_;                     // A_G
  Eigen::VectorXd inertia_;                     // about each coordinate's axis [kg m^2]
  Eigen::VectorXd turn_, rate_, acceleration_;  // s, ds, dds
  Eigen::VectorXd low_, high_;                  // bounds of dds
  std::vector<bool> held_;                      // by coordinate: its acceleration is at a bound
  UpperBodyTurn result_;
};

}  // namespace ayumi
