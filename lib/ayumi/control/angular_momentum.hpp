#pragma once
// The angular momentum task of (22): if the ZMP that the law wants is outside the support, the
// trunk and the arms provide the missing moment by their acceleration. Afterwards they return
// slowly.

#include <cmath>
#include <vector>

#include "ayumi/dynamics/robot_data.hpp"

namespace ayumi {

/// The turn of the upper body relative to its command. Zero means that it moves as commanded.
struct UpperBodyTurn {
  /// Tilt of the trunk as a rotation vector in world axes [rad].
  Eigen::Vector3d lean = Eigen::Vector3d::Zero();
  Eigen::Vector3d lean_rate = Eigen::Vector3d::Zero();  ///< rate of this tilt [rad/s]
  Eigen::VectorXd joints;       ///< turn of each joint by dof; zero except for the arms [rad]
  Eigen::VectorXd joint_rates;  ///< rates of these turns [rad/s]
};

/// How far the trunk can still turn about the world's x and y axes, in the negative and in the
/// positive direction, until a joint that turns it is at its position limit [rad].
struct TurnRoom {
  Eigen::Vector2d below = Eigen::Vector2d::Constant(INFINITY);
  Eigen::Vector2d above = Eigen::Vector2d::Constant(INFINITY);
};

/// The coordinates s are the trunk's tilt about the world's x and y axes and the joints of the arms
/// (and of the head): all joints that the trunk carries. When the COG is kept in place, the rates
/// ds have the angular momentum A_G ds about the COG (docs/theory.md, "Angular momentum"). Among
/// all accelerations with A_G dds = dL, the law chooses the ones that are nearest to zero in the
/// norm W, as in (23). Each of them respects the range, the speed limit and the torque limit of its
/// joint.
class AngularMomentumTask {
 public:
  /// The joints have the robot's own weights.
  AngularMomentumTask(const RobotModel& model, const ActuatorLimits& limits);

  /// Sets W = diag(weight) from now on [dof]. The trunk has the largest weight of the hip joints,
  /// which turn it.
  void weigh(const Eigen::VectorXd& weight);

  /// One tick of dt [s]. `moment` is dL about the COG in world axes [N m]; its vertical part is not
  /// used. `data` has the positions of the reference, `commanded` has the joints of the plan [rad],
  /// and `tilt` is the tilt of the plan's trunk about the world's x and y axes [rad]. `room` is the
  /// turn of the trunk that the position limits of the leg joints still allow. `omega` is sqrt(g/z)
  /// [1/s]; the rate at which the turn returns is proportional to it.
  const UpperBodyTurn& update(const Eigen::Vector3d& moment, const RobotData& data,
                              const Eigen::VectorXd& commanded, const Eigen::Vector2d& tilt,
                              const TurnRoom& room, double omega, double dt);

  /// Whether the turn and its rate are zero.
  bool at_rest() const { return turn_.isZero(0) && rate_.isZero(0); }

  /// A_G at these positions: the angular momentum about the COG for a unit rate of each coordinate;
  /// the first two are those of the trunk [N m s].
  const Eigen::Matrix3Xd& matrix(const RobotData& data);

  /// The dofs of the coordinates from the third on.
  const std::vector<int>& joints() const { return joints_; }

 private:
  void bound(const Eigen::VectorXd& commanded, const Eigen::Vector2d& tilt, const TurnRoom& room,
             double dt);
  void accelerate(const Eigen::Vector3d& moment);

  const RobotModel* model_;
  std::vector<int> joints_, hips_;
  std::vector<bool> carried_;            // whether a body is the trunk or is carried by it
  Eigen::VectorXd weight_;               // weight of each coordinate
  Eigen::VectorXd speed_, torque_;       // limits of each coordinate [rad/s], [N m]
  Eigen::VectorXd rotor_;                // rotor inertia of each coordinate [kg m^2]
  std::vector<SpatialInertia> subtree_;  // workspace, by body
  Eigen::Matrix3Xd matrix_;              // matrix A_G
  Eigen::VectorXd inertia_;              // inertia about the axis of each coordinate [kg m^2]
  Eigen::VectorXd turn_, rate_, acceleration_;  // s, ds, dds
  Eigen::VectorXd low_, high_;                  // bounds of dds
  std::vector<bool> held_;  // whether the acceleration of a coordinate is at a bound
  UpperBodyTurn result_;
};

}  // namespace ayumi
