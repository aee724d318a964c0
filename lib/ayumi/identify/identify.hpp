#pragma once
// Servo constants from a recording: the command of each joint, the angle that it measured and the
// torque that it carried. The output-error method: the constants with which the simulated servo
// (identify/servo_response.hpp) comes nearest to the measured angle, by least squares.

#include <string>
#include <vector>

#include "ayumi/base/progress.hpp"
#include "ayumi/identify/joint_loads.hpp"
#include "ayumi/model/robot_model.hpp"

namespace ayumi {

struct IdentifyOptions {
  bool per_type = false;  ///< one set of constants for all joints of one motor type
  RobotStand stand = RobotStand::feet;
  double longest_lag = 0;  ///< largest lag of a servo [s]; 0: the value of longest_lag()
  int threads = 0;         ///< 0: all cores
  std::string loads_place = "load cells";  ///< of their file, for messages
};

/// A value with its 95 % interval.
struct ServoEstimate {
  double value = 0, lower = 0, upper = 0;
  bool known = false;  ///< the recording determines it to better than half its value
};

/// The results for one joint.
struct IdentifiedJoint {
  std::string joint, type;
  bool moved = false;         ///< false: only the mean difference from the command was found
  bool delay_is_lag = false;  ///< the recording shows no damping: `delay` is the whole lag
  ServoEstimate delay;        ///< [s]
  ServoEstimate kp;           ///< [N m/rad]
  ServoEstimate damping;      ///< kd + viscous [N m s/rad]
  ServoEstimate viscous;      ///< damping minus the robot's kd [N m s/rad]
  ServoEstimate coulomb;      ///< [N m]
  ServoEstimate backlash;     ///< [rad]
  ServoEstimate offset;       ///< mean distance of the unloaded joint from its command [rad]
  double lag = 0;             ///< time by which the angle is behind a slow command [s]
  double sag = 0;             ///< change of the angle from the unloaded to the loaded foot [rad]
  bool has_sag = false;
  double mean_error = 0, largest_error = 0, largest_at = 0;  ///< measured - simulated [rad], [s]
  double command_error = 0;                                  ///< mean |measured - command| [rad]
  std::vector<std::string> confounded;  ///< constants that could not be distinguished, and a motion
                                        ///< that would distinguish them
};

struct Identification {
  std::vector<IdentifiedJoint> joints;  ///< the joints that the recording has, in the robot's order
  double seconds = 0;                   ///< length of the recording [s]
  std::string caution;  ///< a note that the recording may be shifted; empty: it is not
};

/// Throws Error(bad_file) "`place`: what" for a recording that cannot be of this command: a joint
/// that does not follow, counters that wrap, all zeros, an answer that comes too late or too early.
Identification identify(const RobotModel& model, const RecordedMotion& motion,
                        const IdentifyOptions& options, const std::string& place,
                        const Progress& progress = {});

/// By how much an answer may be behind its command [s]: what comes later is a shifted recording.
double longest_lag(const RobotModel& model);

/// Motor types: joints with the same limits and servo, by dof. Named by their first joint.
std::vector<std::string> motor_types(const RobotModel& model);

}  // namespace ayumi
