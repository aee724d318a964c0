#pragma once
// Tables for the first day with a robot whose encoder signs are not yet verified. There is one
// slow, small motion for each joint, from the home posture and back, while the robot hangs free.

#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/reference_trajectory.hpp"

namespace ayumi {

struct SignTest {
  int dof = 0;
  std::string name;  ///< name of its file, without extension: "04_r_knee"
  /// Home angle, and angle to which the joint moves before it returns [rad], of sliding joints [m].
  double from = 0, to = 0;
  ReferenceTrajectory table;  ///< plain postures without a servo lead; no ground supports the robot
};

/// One test for every joint with a motor, in the order of the devices (or of the joints if there
/// are none), with a row every `dt` [s]. The joint moves by 5 degrees (10 mm) in its positive
/// direction. It moves in the negative direction, or by less, if its position limits require this.
/// Throws Error(bad_model) if no joint has a motor.
std::vector<SignTest> sign_tests(const RobotModel& model, double dt);

}  // namespace ayumi
