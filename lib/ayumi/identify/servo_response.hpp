#pragma once
// One joint with its servo, driven by its recorded command and loaded by a given torque: what
// identification compares with the recording. All quantities are divided by the stiffness kp, so
// that they are seen in the angle:
//   kp = 1/s:  s J ddphi = u(t - delay) - phi - D dphi - C sgn(dphi) - s tau,
//   theta = phi + offset - backlash/2 sgn(tau)
// with J the inertia of rotor and link, tau what else acts on the joint. Dry friction holds the
// joint at rest. Implicit midpoint rule in steps of at most kResponseStep, or as the law says.
//   In a recording that shows no damping, the joint is without J and D: phi then goes where the
// error exceeds the dry friction, |u(t - delay) - phi - s tau| <= C.

#include <Eigen/Core>
#include <vector>

namespace ayumi {

/// The constants of a servo as the angle shows them.
struct ServoConstants {
  double delay = 0;       ///< of the command [s]
  double compliance = 0;  ///< s = 1/kp [rad/(N m)]
  double damping = 0;     ///< D = (kd + viscous)/kp [s]
  double dry = 0;         ///< C = coulomb/kp [rad]
  double backlash = 0;    ///< whole play [rad]
  double offset = 0;      ///< [rad]
};

/// What a servo does between two rows of its command.
enum class CommandLaw {
  linear,  ///< it goes from one to the next
  held,    ///< it holds each until the next
  stepped  ///< held, in the simulator's own steps: implicit Euler from row to row
};

/// A joint's recording. Vectors of the measured rate have one entry per measured row.
struct JointRecording {
  double command_dt = 0.001, dt = 0.001;  ///< [s]
  bool at_once = false;                   ///< the angle follows the late command without J and D
  CommandLaw law = CommandLaw::linear;
  Eigen::VectorXd command;       ///< [rad]
  Eigen::VectorXd measured;      ///< [rad]
  Eigen::VectorXd torque;        ///< of the rigid tree on the joint [N m]
  Eigen::VectorXd inertia;       ///< inertia that the joint moves, its rotor included [kg m^2]
  Eigen::VectorXd link_inertia;  ///< without the rotor [kg m^2]
  Eigen::VectorXd acceleration;  ///< with which `torque` was computed [rad/s^2]
  Eigen::VectorXd rate;          ///< of the smoothed motion [rad/s]
  std::vector<Eigen::Index> compared;  ///< rows that a fit compares, ascending
  bool load_known = true;              ///< `torque` is right at these rows
  Eigen::VectorXd own_share;           ///< of the weight on the foot of its leg; empty: of no leg
  std::vector<Eigen::Index> settled;   ///< rows where one foot carries the robot, ascending
};

/// A joint settles in this time after its start, or after a time in which its load was not known
/// [s]. Chosen: ten time constants of a small servo.
inline constexpr double kSettle = 0.1;

/// The command at time t, constant before its first and after its last row.
double command_at(const JointRecording& recording, double t);

/// The measured angle that each of these servos gives: one column for each, one row per measured
/// row. Rows far from those that are compared keep the measured angle. The joint starts anew after
/// each such gap. Several servos together take less time than one after the other, with the same
/// numbers.
void servo_responses(const JointRecording& recording, const std::vector<ServoConstants>& constants,
                     Eigen::MatrixXd& theta);

/// The angle of the joint at the torque `tau` at rest, against its command [rad].
double sag(const ServoConstants& constants, double tau);

}  // namespace ayumi
