#pragma once
// What both halves of ViipJump share, viip_jump.cpp and viip_jump_flight.cpp.

#include <algorithm>
#include <array>
#include <cmath>

#include "ayumi/control/support.hpp"
#include "ayumi/dynamics/robot_data.hpp"
#include "ayumi/math/rotation.hpp"

namespace ayumi::jump {

inline double smooth(double x) {
  const double s = std::clamp(x, 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

inline Eigen::Vector2d middle_of(const RobotModel& model,
                                 const std::array<Eigen::Isometry3d, 2>& feet) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Side side : {Side::left, Side::right}) {
    const Eigen::Vector2d& c = model.sole(side).center;
    sum += 0.5 * (feet[static_cast<size_t>(side)] * Eigen::Vector3d(c.x(), c.y(), 0)).head<2>();
  }
  return sum;
}

inline double heading_of(const std::array<Eigen::Isometry3d, 2>& feet) {
  const Eigen::Vector3d x = feet[0].linear().col(0) + feet[1].linear().col(0);
  return std::atan2(x.y(), x.x());
}

// Angular momentum about the COG per generalised velocity: 3 x (6 + dof).
inline Eigen::MatrixXd angular_momentum_rows(const RobotData& data, const Eigen::MatrixXd& M) {
  return M.middleRows<3>(3) - skew(data.cog_offset) * M.topRows<3>();
}

}  // namespace ayumi::jump
