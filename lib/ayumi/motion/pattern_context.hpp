#pragma once
// Names in a pattern: postures of the pattern, then of the robot; joints; places for messages.

#include <map>
#include <string>

#include "ayumi/base/error.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// Joints that a posture sets [rad]: the named ones of the pattern's posture, all of the robot's.
/// Throws Error(bad_pattern) "file: place: ..." for an unknown posture or joint.
std::map<std::string, double> posture_joints(const RobotModel& model, const Pattern& pattern,
                                             const std::string& name, const SourcePlace& place);

/// theta of the pattern's default posture [rad]; other joints are as in the robot's home.
Eigen::VectorXd default_posture(const RobotModel& model, const Pattern& pattern);

/// COG height above the soles without keys: the pattern's, else that of its default posture [m].
/// Throws Error(bad_pattern) when it is not a positive number.
double default_cog_height(const RobotModel& model, const Pattern& pattern);

/// Index of a joint that a pattern names. Throws Error(bad_pattern) for an unknown or mimic joint.
int find_joint(const RobotModel& model, const std::string& joint, const SourcePlace& place);

/// JSON pointer of a phase or keyframe in the pattern's file. Those of a block that repeats share
/// one; those of patterns that are no file count from the first.
std::string pointer_of_phase(const Pattern& pattern, size_t i);
std::string pointer_of_keyframe(const Pattern& pattern, size_t i);

/// Places for messages: a phase; a keyframe; what a JSON pointer, or words, name in the pattern's
/// file.
SourcePlace place_of_phase(const Pattern& pattern, size_t i);
SourcePlace place_of_keyframe(const Pattern& pattern, size_t i);
SourcePlace in_file(const Pattern& pattern, const std::string& inside);

}  // namespace ayumi
