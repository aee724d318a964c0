#pragma once
// The torque that each joint has to carry along a recorded motion: inverse dynamics of the rigid
// tree, with the ground's load shared between the feet.

#include "ayumi/identify/recorded_motion.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// Load of a standing leg above this frequency is quick [Hz]. Chosen: slower than a step.
inline constexpr double kQuickLoad = 5;

/// How the robot is supported while it moves.
enum class RobotStand {
  feet,  ///< it stands or walks on level ground; from the joint angles
  fixed  ///< its root is held upright and at rest: on a stand, or a robot without feet
};

struct JointLoads {
  Eigen::MatrixXd
      torque;  ///< torque of gravity, inertia and ground on the joint, rows x dof [N m, N]
  Eigen::MatrixXd
      inertia;  ///< inertia that the joint moves while the root is held, rows x dof [kg m^2, kg]
  Eigen::MatrixXd rate, acceleration;  ///< rows x dof, of the smoothed motion
  Eigen::VectorXd left_share;          ///< of the ground's load on the left foot; empty when fixed
  std::vector<Support> support;        ///< by row; empty when fixed
  /// Mean share of the standing foot in single support, by the load cells; 1 without them.
  double agreement = 1;
};

/// Rows as those of `motion.measured`; joints that it does not have keep the home posture. Angles
/// are smoothed first (kLoadCutoff). While both feet support, the left foot's share is that of
/// `motion.sensors.foot_load` where the file has it, else what the ZMP asks for.
JointLoads joint_loads(const RobotModel& model, const RecordedMotion& motion, RobotStand stand);

/// By row: the load of joint `dof` follows from the motion. While both feet stand, the legs may
/// press against each other with forces that no angle and no load cell shows. The quick part of
/// what a single standing leg carries comes from the whole robot on yielding servos and ground.
std::vector<char> load_known(const RobotModel& model, const JointLoads& loads, int dof, double dt);

/// x without the components faster than `cutoff` [Hz], without a delay: a Butterworth filter of
/// second order, forwards and backwards.
Eigen::VectorXd low_pass(const Eigen::VectorXd& x, double dt, double cutoff);

}  // namespace ayumi
