#pragma once
// One joint with its servo, driven by its recorded command and loaded by a given torque.
// Identification compares its angle with the recording. All quantities are divided by the stiffness
// kp, so that they are seen in the angle:
//   kp = 1/s:  s J ddphi = u(t - delay) - phi - D dphi - C sgn(dphi) - s tau,
//   theta = phi + offset - backlash/2 sgn(tau)
// where J is the inertia of rotor and link, and tau is the other torque on the joint. Dry friction
// holds the joint at rest. The equations are solved by the implicit midpoint rule in steps of at
// most kResponseStep, except under CommandLaw::stepped.
//   In a recording that shows no damping, the joint has no J and D: phi then only moves where the
// error would exceed the dry friction, so that |u(t - delay) - phi - s tau| <= C.

#include <Eigen/Core>
#include <vector>

namespace ayumi {

/// The constants of a servo as the angle shows them.
struct ServoConstants {
  double delay = 0;       ///< delay of the command [s]
  double compliance = 0;  ///< s = 1/kp [rad/(N m)]
  double damping = 0;     ///< D = (kd + viscous)/kp [s]
  double dry = 0;         ///< C = coulomb/kp [rad]
  double backlash = 0;    ///< whole play of the gear [rad]
  double offset = 0;      ///< zero offset [rad]
};

/// What a servo does between two rows of its command.
enum class CommandLaw {
  linear,  ///< the command goes gradually from one row to the next
  held,    ///< the command of a row is held until the next row
  /// The command is held, and the simulator's own steps are used: implicit Euler from row to row.
  stepped
};

/// A joint's recording. All vectors of values except `command` have one entry per measured row.
struct JointRecording {
  double command_dt = 0.001, dt = 0.001;  ///< time between rows of command and recording [s]
  bool at_once = false;                   ///< the angle follows the late command without J and D
  CommandLaw law = CommandLaw::linear;
  Eigen::VectorXd command;       ///< commanded angle [rad]
  Eigen::VectorXd measured;      ///< measured angle [rad]
  Eigen::VectorXd torque;        ///< torque of the rigid tree on the joint [N m]
  Eigen::VectorXd inertia;       ///< inertia that the joint moves, its rotor included [kg m^2]
  Eigen::VectorXd link_inertia;  ///< the same inertia without the rotor [kg m^2]
  Eigen::VectorXd acceleration;  ///< acceleration with which `torque` was computed [rad/s^2]
  Eigen::VectorXd rate;          ///< rate of the smoothed motion [rad/s]
  std::vector<Eigen::Index> compared;  ///< rows that a fit compares, in rising order
  bool load_known = true;              ///< `torque` is right at these rows
  /// Share of the weight on the foot of its leg; empty if it belongs to no leg.
  Eigen::VectorXd own_share;
  std::vector<Eigen::Index> settled;  ///< rows in which one foot carries the robot, in rising order
};

/// Time in which a joint settles after its start, or after its load was not known [s]. Chosen: ten
/// time constants of a small servo.
inline constexpr double kSettle = 0.1;

/// The command at time t, constant before its first and after its last row.
double command_at(const JointRecording& recording, double t);

/// The measured angle that each of these servos gives, with one column for each and one row per
/// measured row. Rows far from those that are compared keep the measured angle. The joint starts
/// anew after each such gap. Simulating several servos together takes less time than one after the
/// other, and gives the same numbers.
void servo_responses(const JointRecording& recording, const std::vector<ServoConstants>& constants,
                     Eigen::MatrixXd& theta);

/// The angle of the joint at rest under the torque `tau`, relative to its command [rad].
double sag(const ServoConstants& constants, double tau);

}  // namespace ayumi
