#pragma once
// Looks up names in a pattern: postures of the pattern and then of the robot, joints, and places
// for messages.

#include <map>
#include <string>

#include "ayumi/base/error.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// The joints that a posture sets [rad]. A posture of the pattern sets the joints that it names,
/// and a posture of the robot sets all joints. Throws Error(bad_pattern) "file: place: ..." for an
/// unknown posture or joint, or an angle that is not finite.
std::map<std::string, double> posture_joints(const RobotModel& model, const Pattern& pattern,
                                             const std::string& name, const SourcePlace& place);

/// The theta of the pattern's default posture [rad]; joints that it does not name are as in the
/// robot's home.
Eigen::VectorXd default_posture(const RobotModel& model, const Pattern& pattern);

/// The height of the COG above the soles if there are no keys [m]: that of the pattern, or else
/// that of its default posture. Throws Error(bad_pattern) if it is not a positive number.
double default_cog_height(const RobotModel& model, const Pattern& pattern);

/// The index of a joint that a pattern names. Throws Error(bad_pattern) for an unknown or mimic
/// joint.
int find_joint(const RobotModel& model, const std::string& joint, const SourcePlace& place);

/// The JSON pointer of a phase or keyframe in the pattern's file. The copies of a block that
/// repeats share one pointer; in patterns that come from no file, the number is counted from the
/// first phase or keyframe.
std::string pointer_of_phase(const Pattern& pattern, size_t i);
std::string pointer_of_keyframe(const Pattern& pattern, size_t i);

/// Places for messages: those of a phase, of a keyframe, and of what a JSON pointer or words name
/// in the pattern's file.
SourcePlace place_of_phase(const Pattern& pattern, size_t i);
SourcePlace place_of_keyframe(const Pattern& pattern, size_t i);
SourcePlace in_file(const Pattern& pattern, const std::string& inside);

}  // namespace ayumi
