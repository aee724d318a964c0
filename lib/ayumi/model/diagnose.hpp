#pragma once
// Warnings about a robot description that is valid but suspicious.

#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"

namespace ayumi {

struct ModelWarning {
  std::string where;    ///< link, joint or field, e.g. "link head"
  std::string message;  ///< the suspicion and the remedy
};

/// Tests for: inertia that is implausible for mass and size (triangle inequality, placeholders,
/// equal tensors on many links), mass on the root link that URDF readers drop, missing limits,
/// effort or speed that are placeholders, left-right asymmetry of masses, lengths and limits, soles
/// not level at the home posture, a COG outside the soles, sign conflicts of encoders between left
/// and right, joints without servo or encoder, missing collision shapes, meshes far larger than the
/// robot.
std::vector<ModelWarning> diagnose(const RobotModel& model);

}  // namespace ayumi
