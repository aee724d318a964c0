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
  std::string name;         ///< name of its file, without extension: "04_r_knee"
  double from = 0, to = 0;  ///< angles at the beginning and at the end [rad], of sliding joints [m]
  ReferenceTrajectory table;  ///< postures only; no ground supports the robot
};

/// One test for every joint with a motor, in the order of the devices (or of the joints if there
/// are none), with a row every `dt` [s]. The joint moves by 5 degrees (10 mm) in its positive
/// direction. It moves in the negative direction, or by less, if its position limits require this.
/// Throws Error(bad_model) if no joint has a motor.
std::vector<SignTest> sign_tests(const RobotModel& model, double dt);

}  // namespace ayumi
