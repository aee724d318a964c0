#pragma once
// What a bare URDF does not say: the direction that the robot faces, its soles, its home posture,
// its servos and sensors. Each guess has a reason. A bare URDF is read with these guesses, and
// `ayumi init` writes them down. In the library, only files of io/robot include it.

#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"

namespace ayumi {

/// The reason for the values of one key, and what a person should check.
struct GuessReason {
  std::string why, check;
};

/// A value that a URDF contains only because the format requires one: "position limits", "speed
/// limits" or "effort limits".
struct PlaceholderLimits {
  std::string what;
  std::string value;  ///< value as it is written, with its unit
  std::vector<std::string> joints;
};

/// A robot that guess_robot() has completed.
struct RobotGuess {
  RobotDescription robot;
  std::string facing = "x";  ///< direction in the URDF's root link; `robot` itself faces x
  GuessReason facing_reason, sole_reason, home_reason, servo_reason;
  std::string rounded_soles;  ///< what to do about rounded soles; empty if the soles are flat
  /// What to do about other links that stand on the ground; empty if there are none.
  std::string more_feet;
  std::vector<PlaceholderLimits> placeholders;
};

/// Fills soles, home posture and servos where `robot` has none, and turns a robot without a sidecar
/// so that it faces x.
/// - Feet: the two lowest bodies beside each other with every joint at 0, or at the limit nearest
///   to 0. The names say which foot is the left one; otherwise, the longer end of the feet is the
///   front. Left, right and front follow from each other.
/// - Soles: the hull of what lies within 1 mm of the ground, thinned to at most 8 corners from the
///   inside. Feet without shapes are taken for boxes that have their masses and inertias.
/// - Home: bent knees, with the COG over the middle of the soles and all joints inside their
///   limits.
/// - Servos: full effort of each joint at an error of 0.2 rad, and for legs at least 20 m g z per
///   rad.
/// The inferred values are added to `assumptions`.
RobotGuess guess_robot(RobotDescription robot);

/// Makes a joint fixed at 0, also for the order of joints that the robot's file gives.
void hold_joint(RobotDescription& robot, JointDescription& joint);

/// Makes joints whose links weigh nothing fixed at 0, because the torque of a motor cannot move
/// them, and `assumptions` says so. Returns their names.
std::vector<std::string> hold_joints_without_mass(RobotDescription& robot);

/// Some MJCF files model the play of a gear by a passive joint of at most 4 deg beside a driven
/// joint with the same axis. Such joints become fixed at 0, the servo gets this backlash, and
/// `assumptions` says so. Returns their names.
std::vector<std::string> hold_play_of_gears(RobotDescription& robot);

/// Joints that a motor could move, but that have no actuator in files that state actuators.
std::vector<std::string> passive_joints(const RobotDescription& robot);

/// The open points in addition to the guesses: joints without an actuator, and missing meshes, of
/// which at most `most` are named. There is one sentence for each.
std::vector<std::string> gaps_of_the_files(const RobotDescription& robot, size_t most);

/// Limits that are placeholders: equal position limits on most joints or on most joints of the
/// legs, speeds above 60 rad/s, efforts above m g z that are equal on all joints or on all joints
/// of the legs, and efforts above five times m g z (with the mass m and the COG height z).
std::vector<PlaceholderLimits> placeholder_limits(const RobotModel& model);

/// The motion of a joint by a positive angle in the home posture, such as "a positive angle bends
/// the knee".
std::string direction_in_words(const RobotModel& model, int dof);

}  // namespace ayumi
