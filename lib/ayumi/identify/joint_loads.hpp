#pragma once
// The torque that each joint has to carry along a recorded motion: inverse dynamics of the rigid
// tree, with the ground's load shared between the feet.

#include "ayumi/identify/recorded_motion.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// Frequency above which the load of a standing leg is quick [Hz]. Chosen: above the frequencies of
/// a step.
inline constexpr double kQuickLoad = 5;

/// How the robot is supported while it moves.
enum class RobotStand {
  /// It stands or walks on level ground; its motion and its support follow from the joint angles.
  feet,
  fixed  ///< its root is held upright and at rest, for a robot on a stand or without feet
};

struct JointLoads {
  Eigen::MatrixXd
      torque;  ///< torque of gravity, inertia and ground on the joint, rows x dof [N m, N]
  Eigen::MatrixXd
      inertia;  ///< inertia that the joint moves while the root is held, rows x dof [kg m^2, kg]
  /// Rates and accelerations of the smoothed motion, rows x dof.
  Eigen::MatrixXd rate, acceleration;
  /// Share of the ground's load on the left foot; empty if the root is fixed.
  Eigen::VectorXd left_share;
  std::vector<Support> support;  ///< support by row; empty if the root is fixed
  /// The mean share of the load that the load cells measure on the standing foot in single support;
  /// 1 without load cells.
  double agreement = 1;
};

/// The rows are those of `motion.measured`; joints that it does not have keep the home posture.
/// Angles are smoothed first (kLoadCutoff). While both feet support the robot, the left foot's
/// share is that of `motion.sensors.foot_load` if the file has it, and otherwise the share that
/// follows from the ZMP.
JointLoads joint_loads(const RobotModel& model, const RecordedMotion& motion, RobotStand stand);

/// By row, whether the load of joint `dof` follows from the motion. While both feet stand, the legs
/// may press against each other with forces that no angle and no load cell shows. The quick part of
/// the load of a single standing leg comes from the whole robot on yielding servos and ground.
std::vector<char> load_known(const RobotModel& model, const JointLoads& loads, int dof, double dt);

/// x without the components faster than `cutoff` [Hz], without a delay, by a Butterworth filter of
/// second order that is applied forwards and backwards.
Eigen::VectorXd low_pass(const Eigen::VectorXd& x, double dt, double cutoff);

}  // namespace ayumi
