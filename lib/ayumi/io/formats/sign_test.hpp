#pragma once
// Tables for the first day with a robot whose encoder signs are not yet verified. Each file moves
// one joint slowly and by a small angle, and back, while the robot hangs free. The other joints
// have the target 0 where possible, because a wrong sign does not change 0.

#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/reference_trajectory.hpp"

namespace ayumi {

struct SignTest {
  int dof = 0;
  std::string name;  ///< name of its file, without extension: "04_r_knee"
  /// First angle, and angle to which the joint moves before it returns [rad], of sliding joints
  /// [m].
  double from = 0, to = 0;
  ReferenceTrajectory table;  ///< plain postures without a servo lead; no ground supports the robot
};

/// The posture in which sign tests begin: every joint at 0, or at the position limit that is
/// nearest to 0 [rad, m]. In the home posture, a joint with a wrong sign would receive the opposite
/// of its angle, and would jump by twice this angle, often into its end stop. Throws
/// Error(bad_model) if parts of the robot overlap in this posture.
Eigen::VectorXd sign_test_start(const RobotModel& model);

/// One test for every joint with a motor, in the order of the devices (or of the joints if there
/// are none), with a row every `dt` [s]. Each test begins in the posture `start`. The joint moves
/// by 5 degrees (10 mm) in its positive direction. It moves in the negative direction, or by less,
/// if its position limits require this, and in the other direction if parts of the robot would
/// overlap. Throws Error(bad_model) if no joint has a motor, or if parts overlap in the posture
/// `start` or at the end of a motion in either direction.
std::vector<SignTest> sign_tests(const RobotModel& model, const Eigen::VectorXd& start, double dt);

}  // namespace ayumi
