#pragma once
// Warnings about a robot description that is valid but suspicious.

#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"

namespace ayumi {

struct ModelWarning {
  /// What a warning concerns: links, joints, pairs of a left and a right joint, the actuator limits
  /// or the home posture.
  enum class Subject { link, joint, joint_pairs, limits, posture };
  Subject subject = Subject::link;
  std::string where;    ///< links, joints or field, e.g. "link head", "links head, neck"
  std::string message;  ///< the suspicion and the remedy
};

/// One warning for each cause. It names all links or joints that have this cause, or the first few
/// and their number. The function tests for:
///   - an inertia that is implausible for mass and size (triangle inequality, placeholders, equal
///     tensors on many links);
///   - missing limits, and efforts or speeds that are placeholders;
///   - left-right asymmetry of masses, lengths and limits (partners are found by their places, not
///     by their names);
///   - soles that are not level in the home posture, and a COG outside the soles;
///   - sign conflicts of encoders between left and right;
///   - joints without servo or encoder;
///   - missing collision shapes, and meshes that are far larger than the robot.
std::vector<ModelWarning> diagnose(const RobotModel& model);

/// Feet and bodies of more than 5 % of the robot's mass that have no collision shape, by name.
std::vector<std::string> bodies_without_collision_shapes(const RobotModel& model);

/// Whether both legs have collision shapes, so that a clearance means something.
bool legs_have_collision_shapes(const RobotModel& model);

}  // namespace ayumi
