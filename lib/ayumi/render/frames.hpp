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
  foot  ///< Sigma_0 of the paper: at the middle of the supporting sole, x to its toes, z up
};
const std::vector<std::string>& frame_names();
/// Throws Error(usage) for an unknown name, with the known ones.
Frame frame_of(const std::string& name);

/// The log with all places and directions in that frame. The supporting foot is the one planned
/// down; of two, the one that carried before; in flight, and while that sole is tilted, as it was
/// last. Throws Error(usage) for a robot without soles in the frame of the foot.
SimulationLog in_frame(const RobotModel& model, SimulationLog log, Frame frame);

/// Throws Error(usage) where ground that is not a resting level plane would have to move with the
/// foot.
void require_level_ground(const SimulationLog& log, Frame frame);

}  // namespace ayumi
