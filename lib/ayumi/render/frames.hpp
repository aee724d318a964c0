#pragma once
// A common frame for the motion of a robot and its command. The plan has a frame of its own, in
// which the supporting foot is at its planned place. If a foot slips or lands at another place, the
// two frames differ.

#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

enum class Frame {
  world,
  foot  ///< Sigma_0 of the paper: at the middle of the supporting sole, x towards its toes, z up
};
const std::vector<std::string>& frame_names();
/// The frame of that name. Throws Error(usage) with the known names for an unknown one.
Frame frame_of(const std::string& name);

/// The log with all places and directions in that frame. The supporting foot is the one that is
/// planned on the ground; if both are, it is the one that carried the robot before. In flight, and
/// while that sole is tilted, the frame stays as it was last. Throws Error(usage) for a robot
/// without soles in the frame of the foot.
SimulationLog in_frame(const RobotModel& model, SimulationLog log, Frame frame);

/// Throws Error(usage) if the ground is not a resting level plane, because it would have to move
/// with the foot.
void require_level_ground(const SimulationLog& log, Frame frame);

}  // namespace ayumi
