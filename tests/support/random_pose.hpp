#pragma once
// A body at a random place with a random attitude.

#include "ayumi/math/rotation.hpp"
#include "tests/support/random_robot.hpp"

namespace ayumi::test {

/// A pose with no coordinate farther than `reach` [m] from 0.
inline Eigen::Isometry3d random_pose(Random& random, double reach) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = random.vector(reach);
  pose.linear() = exp_rotation(random.vector(3)).toRotationMatrix();
  return pose;
}

}  // namespace ayumi::test
