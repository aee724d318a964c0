#pragma once
// Poses of the bodies for given joint angles, with the root at the origin. The checks of the model
// itself use them; other code uses dynamics/kinematics.hpp.

#include <Eigen/Geometry>
#include <vector>

#include "ayumi/math/elementary.hpp"
#include "ayumi/model/robot_model.hpp"

namespace ayumi {

/// Pose of each body in the root body's frame at the joint angles `theta`.
inline std::vector<Eigen::Isometry3d> body_poses(const RobotModel& model,
                                                 const Eigen::VectorXd& theta) {
  std::vector<Eigen::Isometry3d> poses;
  for (const Body& body : model.bodies()) {
    if (body.parent < 0) {
      poses.push_back(Eigen::Isometry3d::Identity());
      continue;
    }
    const double q = body.ratio * theta[body.dof] + body.offset;
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    if (body.prismatic)
      motion.translation() = q * body.axis;
    else
      motion.linear() = elementary::turn_matrix(q, body.axis);
    poses.push_back(poses[body.parent] * body.placement * motion);
  }
  return poses;
}

}  // namespace ayumi
