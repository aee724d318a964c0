#pragma once
// The first day with a robot whose encoder signs are unproven: one slow, small motion per joint,
// from the home posture and back, while the robot hangs free.

#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/reference_trajectory.hpp"

namespace ayumi {

struct SignTest {
  int dof = 0;
  std::string name;           ///< of its file, without extension: "04_r_knee"
  double from = 0, to = 0;    ///< [rad], sliding joints [m]
  ReferenceTrajectory table;  ///< plain postures; no ground carries the robot
};

/// One test for every joint with a motor, in the order of devices (else of joints), one row each
/// `dt` [s]. The joint moves by 5 degrees (10 mm) in its positive direction; in the negative one,
/// or less far, where its position limits ask for that. Throws Error(bad_model) where no joint has
/// a motor.
std::vector<SignTest> sign_tests(const RobotModel& model, double dt);

}  // namespace ayumi
