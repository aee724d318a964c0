#include "ayumi/dynamics/zmp.hpp"

#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::Vector3d;

GroundReaction ground_reaction(const Vector3d& base_position,
                               const Eigen::Matrix<double, 6, 1>& wrench, double height,
                               double min_force) {
  GroundReaction result;
  result.force = wrench.head<3>();
  const Vector3d& f = result.force;
  const Vector3d n = wrench.tail<3>();
  const double h = height - base_position.z();
  result.zmp = {base_position.x(), base_position.y(), height};
  if (f.z() <= min_force) return result;
  const double x = (h * f.x() - n.y()) / f.z();
  const double y = (h * f.y() + n.x()) / f.z();
  result.zmp += Vector3d(x, y, 0);
  result.yaw_moment = n.z() - (x * f.y() - y * f.x());
  return result;
}

double omega_squared(double fz, double mass, double height_above_zmp) {
  return fz / (mass * height_above_zmp);
}

double vertical_acceleration(double fz, double mass) { return fz / mass - kGravity; }

Vector3d pendulum_zmp(const Vector3d& cog, const Vector3d& ddcog, double ground) {
  const double inverse = (cog.z() - ground) / (ddcog.z() + kGravity);
  return {cog.x() - inverse * ddcog.x(), cog.y() - inverse * ddcog.y(), ground};
}

}  // namespace ayumi
