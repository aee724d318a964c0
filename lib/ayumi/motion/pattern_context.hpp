#pragma once
// Names in a pattern: postures of the pattern, then of the robot; joints; places for messages.

#include <map>
#include <string>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// Joints that a posture sets [rad]: the named ones of the pattern's posture, all of the robot's.
/// Throws Error(bad_pattern) "file: place: ..." for an unknown posture or joint.
std::map<std::string, double> posture_joints(const RobotModel& model, const Pattern& pattern,
                                             const std::string& name, const std::string& place);

/// theta of the pattern's default posture [rad]; other joints are as in the robot's home.
Eigen::VectorXd default_posture(const RobotModel& model, const Pattern& pattern);

/// COG height above the soles without keys: the pattern's, else that of its default posture [m].
/// Throws Error(bad_pattern) when it is not a positive number.
double default_cog_height(const RobotModel& model, const Pattern& pattern);

/// Index of a joint that a pattern names. Throws Error(bad_pattern) for an unknown or mimic joint.
int find_joint(const RobotModel& model, const std::string& joint, const std::string& place);

/// JSON pointer of a phase or keyframe in the pattern's file. Those of a block that repeats share
/// one; those of patterns that are no file count from the first.
std::string pointer_of_phase(const Pattern& pattern, size_t i);
std::string pointer_of_keyframe(const Pattern& pattern, size_t i);

/// "file: phases/3", for messages.
std::string place_of_phase(const Pattern& pattern, size_t i);

/// "file: place", or `place` alone when it contains the file, as those of keyframes do.
std::string in_file(const Pattern& pattern, const std::string& place);

}  // namespace ayumi
