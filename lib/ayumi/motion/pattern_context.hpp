#pragma once
// Named postures as a pattern sees them: its own first, then the robot's.

#include <map>
#include <string>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// Joints a posture sets [rad]: those it names when it is the pattern's own, all when it is the
/// robot's. Throws Error(bad_pattern) "file: place: ..." for an unknown posture or joint.
std::map<std::string, double> posture_joints(const RobotModel& model, const Pattern& pattern,
                                             const std::string& name, const std::string& place);

/// theta of the pattern's default posture [rad]; joints it leaves out as in the robot's home.
Eigen::VectorXd default_posture(const RobotModel& model, const Pattern& pattern);

/// COG height above the soles when no key says one: the pattern's, else that of its default posture
/// [m]. Throws Error(bad_pattern) when it is not a positive number.
double default_cog_height(const RobotModel& model, const Pattern& pattern);

/// Index of a joint a pattern names. Throws Error(bad_pattern) for an unknown or mimicking one.
int find_joint(const RobotModel& model, const std::string& joint, const std::string& place);

/// "file: place", or `place` alone when it already names its file (keyframes do).
std::string in_file(const Pattern& pattern, const std::string& place);

}  // namespace ayumi
