#pragma once
// ZMP from a ground wrench, and the point-mass law (14)-(17).

#include "ayumi/dynamics/robot_data.hpp"

namespace ayumi {

/// The ground wrench that a motion needs, given as ZMP, force and yaw moment.
struct GroundReaction {
  Eigen::Vector3d zmp = Eigen::Vector3d::Zero();    ///< world position on the plane z = height [m]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< force on the robot [N]
  double yaw_moment = 0;  ///< moment about the vertical through the ZMP [N m]
};

/// The ground reaction that follows from the base wrench of inverse_dynamics() (force, moment about
/// `base_position`). If the vertical force is below `min_force`, the ZMP has no meaning and stays
/// under the base.
GroundReaction ground_reaction(const Eigen::Vector3d& base_position,
                               const Eigen::Matrix<double, 6, 1>& wrench, double height,
                               double min_force = 1e-9);

/// (17): omega^2 = f_z / (m (z_G - z_Z)) [1/s^2].
double omega_squared(double fz, double mass, double height_above_zmp);

/// (14)(15): horizontal COG acceleration of the mass-concentrated model [m/s^2].
inline Eigen::Vector2d horizontal_acceleration(double omega2, const Eigen::Vector2d& cog,
                                               const Eigen::Vector2d& zmp) {
  return omega2 * (cog - zmp);
}

/// (16): vertical COG acceleration [m/s^2].
double vertical_acceleration(double fz, double mass);

/// DCM, the divergent component of motion x + dx / omega, which obeys dcm' = omega (dcm - zmp).
inline Eigen::Vector3d divergent_component(const Eigen::Vector3d& cog, const Eigen::Vector3d& dcog,
                                           double omega) {
  return cog + dcog / omega;
}

/// The ZMP from (14)(15), at the height of `ground`.
Eigen::Vector3d pendulum_zmp(const Eigen::Vector3d& cog, const Eigen::Vector3d& ddcog,
                             double ground);

}  // namespace ayumi
