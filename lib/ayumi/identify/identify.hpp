#pragma once
// Servo constants from a recording: the command of each joint, the angle that it measured and the
// torque that it carried. By the output-error method, the constants are those with which the
// simulated servo (identify/servo_response.hpp) comes nearest to the measured angle, by least
// squares.

#include <string>
#include <vector>

#include "ayumi/base/bounds.hpp"
#include "ayumi/base/progress.hpp"
#include "ayumi/identify/joint_loads.hpp"
#include "ayumi/model/robot_model.hpp"

namespace ayumi {

struct IdentifyOptions {
  /// Bounds of longest_lag, where it is not 0. Chosen: one tick of a servo of 1 kHz, and a time
  /// after which no robot can walk any more.
  static constexpr Bounds kLongestLag = {0.001, 0.5, "s"};

  bool per_type = false;  ///< one set of constants for all joints of one motor type
  RobotStand stand = RobotStand::feet;
  double longest_lag = 0;  ///< largest lag of a servo [s]; with 0, the value of longest_lag()
  int threads = 0;         ///< number of threads; 0 for all cores
  std::string loads_place = "load cells";  ///< place of the loads in their file, for messages
};

/// A value with its 95 % interval.
struct ServoEstimate {
  double value = 0, lower = 0, upper = 0;
  bool known = false;  ///< the recording determines it to better than half its value
};

/// The results for one joint.
struct IdentifiedJoint {
  std::string joint, type;
  bool moved = false;  ///< if false, only the mean difference from the command was found
  /// The recording shows no damping. The value of `delay` is then the whole lag; the delay alone is
  /// between 0 and the upper end of the lag, and it is not known.
  bool delay_is_lag = false;
  ServoEstimate delay;     ///< delay [s]
  ServoEstimate kp;        ///< stiffness [N m/rad]
  ServoEstimate damping;   ///< kd + viscous friction [N m s/rad]
  ServoEstimate viscous;   ///< damping minus the robot's kd [N m s/rad]
  ServoEstimate coulomb;   ///< dry friction [N m]
  ServoEstimate backlash;  ///< play of the gear [rad]
  ServoEstimate offset;    ///< mean distance of the unloaded joint from its command [rad]
  ServoEstimate lag;       ///< time by which the angle is behind a slow command [s]
  double sag = 0;          ///< change of the angle from the unloaded to the loaded foot [rad]
  bool has_sag = false;
  /// Difference of the measured and the simulated angle [rad], and the time of the largest [s].
  double mean_error = 0, largest_error = 0, largest_at = 0;
  double command_error = 0;             ///< mean of |measured - command| [rad]
  std::vector<std::string> confounded;  ///< constants that could not be distinguished, and a motion
                                        ///< that would distinguish them
};

struct Identification {
  std::vector<IdentifiedJoint> joints;  ///< the joints that the recording has, in the robot's order
  double seconds = 0;                   ///< length of the recording [s]
  /// Where the angles were measured. Only angles that were measured at the joints show the zeros of
  /// the encoders: the servo moves its joint until the encoder reads the target.
  MeasuredAt measured_at = MeasuredAt::encoder;
  std::string caution;  ///< a note that the recording may be shifted; empty if it is not
};

/// Throws Error(bad_file) "`place`: what" for a recording that cannot be that of this command: a
/// joint does not follow, counters wrap, all values are zero, or a response comes too late or too
/// early. Throws Error(usage) for an option or a rate out of range, and Error(solver) if the fit of
/// a servo fails.
Identification identify(const RobotModel& model, const RecordedMotion& motion,
                        const IdentifyOptions& options, const std::string& place,
                        const Progress& progress = {});

/// The longest time by which a response may be behind its command [s], if the options state none. A
/// recording with a longer lag is refused as shifted in time.
double longest_lag(const RobotModel& model);

/// Motor types, by dof: joints with the same limits and servo have the same type. A type has the
/// name of its first joint.
std::vector<std::string> motor_types(const RobotModel& model);

}  // namespace ayumi
