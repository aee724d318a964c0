#pragma once
// The demands of a planned motion on the ground, the motors and the feet, and their distance from
// what was commanded. Each quantity is computed here but not judged: the report evaluates it, and
// the nonlinear program constrains it.

#include <Eigen/Dense>
#include <array>

#include "ayumi/dynamics/robot_data.hpp"
#include "ayumi/math/polygon.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

using Vector6d = Eigen::Matrix<double, 6, 1>;

/// The place where the robot stands: the plane of the supporting soles, and the convex hull of the
/// soles in this plane. The plane has the mean origin and the mean normal of the soles; if the feet
/// are at different heights, it is between them.
struct SupportPlane {
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();  ///< z is the normal
  ConvexPolygon polygon;                                    ///< polygon in its x y plane [m]

  bool empty() const { return polygon.empty(); }
};

/// The plane for the sole poses (by Side); empty if no foot supports.
SupportPlane support_plane(const RobotModel& model, Support support,
                           const std::array<Eigen::Isometry3d, 2>& soles);

/// The base wrench of inverse_dynamics (with the moment about `base_position`), converted to the
/// origin and the axes of the plane.
Vector6d plane_wrench(const SupportPlane& plane, const Eigen::Vector3d& base_position,
                      const Vector6d& base_wrench);

/// A matrix of edges x 6. Its product with plane_wrench() is f_n times the distance of the ZMP
/// inside each edge [N m].
Eigen::Matrix<double, Eigen::Dynamic, 6> support_rows(const SupportPlane& plane);

/// Share of the weight above which the ZMP of the ground force has a meaning. Chosen: below it,
/// rounding errors dominate the moment that determines the ZMP. The normal force of motions in
/// contact is far larger (normal_force.cpp warns at 5 %), so that only samples next to flights come
/// near this share. The estimator of a controller and the commands of an imported motion take 5 %
/// instead: load cells and differences are noisier. No measured case changes between half and twice
/// the value (constants.md).
inline constexpr double kContactThreshold = 0.02;

/// The normal force of a robot above which the ZMP of the ground force has a meaning [N].
double contact_threshold(const RobotModel& model);

/// The ground force in the axes of the plane, and the ZMP if it has a meaning (f_n > min_force).
struct GroundDemand {
  double normal_force = 0;      ///< force along the normal [N]
  double tangential_force = 0;  ///< force along the plane [N]
  bool has_zmp = false;
  Eigen::Vector2d zmp = Eigen::Vector2d::Zero();        ///< ZMP in the plane [m]
  Eigen::Vector3d zmp_world = Eigen::Vector3d::Zero();  ///< ZMP in the world [m]
  double margin = 0;      ///< distance of the ZMP inside the polygon [m]
  double yaw_moment = 0;  ///< moment about the normal through the ZMP [N m]
};
GroundDemand ground_demand(const SupportPlane& plane, const Vector6d& plane_wrench,
                           double min_force);

/// The lever of the yaw moment that friction can resist without moving the ZMP [m]. It is the mean
/// distance from the ZMP over the largest part of the polygon that is symmetric about the ZMP, for
/// an even pressure. The result is a lower bound of the possible lever. It is 0 if the ZMP is
/// outside the polygon.
double torsional_friction_arm(const ConvexPolygon& polygon, const Eigen::Vector2d& zmp);

/// The ground wrench shared between the feet, each about the base origin (force, moment), by Side.
/// One supporting foot takes all of it. Two feet share it so that each centre of pressure stays in
/// its own sole if the ZMP is in their hull; the sum of the shares is exactly the whole.
std::array<Vector6d, 2> foot_wrenches(const RobotModel& model, Support support,
                                      const std::array<Eigen::Isometry3d, 2>& soles,
                                      const SupportPlane& plane, const GroundDemand& use,
                                      const Eigen::Vector3d& base_position,
                                      const Vector6d& base_wrench);

/// The sign of dry friction changes gradually over twice this joint rate [rad/s]. Chosen: far below
/// the rates of a motion (0.1 rad/s and more) and above the rounding of differences, so that the
/// friction torque is continuous. No measured case changes between half and twice the value
/// (constants.md).
inline constexpr double kCoulombRate = 0.01;

/// The motor torques [dof]: `force` of inverse_dynamics without the contribution of the ground at
/// the feet, plus rotor inertia, viscous and Coulomb friction of the servo. `data` is in the state
/// in which inverse_dynamics() left it.
Eigen::VectorXd motor_torques(const RobotModel& model, const ActuatorLimits& actuators,
                              const RobotState& state, const Eigen::VectorXd& acceleration,
                              const Eigen::VectorXd& force,
                              const std::array<Vector6d, 2>& foot_wrench, const RobotData& data);

/// The deviation of a sole from the pose that it should keep.
struct SoleError {
  double slip = 0;  ///< largest horizontal displacement of a corner, in the plane of `planned` [m]
  double penetration = 0;  ///< deepest corner below that plane [m]
  double gap = 0;          ///< highest corner above it [m]
  double lowest = 0;       ///< lowest corner above it (negative below) [m]
};
SoleError sole_error(const Sole& sole, const Eigen::Isometry3d& actual,
                     const Eigen::Isometry3d& planned);

}  // namespace ayumi
