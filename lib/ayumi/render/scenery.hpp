#pragma once
// What stands on the ground: blocks, fields of heights, patches of another friction, and the bumps
// that rise during a run. All in the floor's frame, log_reading's floor_at().

#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/render/triangles.hpp"
#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

/// Empty on a bare plane. Patches lie a fraction of a millimetre above it, darker if their friction
/// is smaller. Of a field with more than `max_nodes` a side only every second, third, ... node is
/// taken.
Triangles make_scenery(const World& world, int max_nodes = 512);

/// A disc that comes up during a run.
struct RisingBump {
  GroundBlock block;          ///< fully up
  double begin = 0, end = 0;  ///< while it acts [s]
};
/// The bumps of a run's scenario, each where it came up.
std::vector<RisingBump> rising_bumps(const RobotModel& model, const SimulationLog& log);

/// Those bumps as they are at `t`.
Triangles make_bumps(const std::vector<RisingBump>& bumps, double ground_height, double t);

/// Time in which a bump rises [s], as in sim/schedule.cpp, and the share of its height so long
/// after its begin.
constexpr double kBumpRise = 0.02;
double bump_share(double since);

}  // namespace ayumi
