#pragma once
// Everything that stands on the ground: blocks, fields of heights, patches of another friction, and
// the bumps that rise during a run. All places are in the frame of the floor (floor_at() of
// log_reading.hpp).

#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/render/triangles.hpp"
#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

/// The triangles of all these objects; there are none on a bare plane. Patches lie a fraction of a
/// millimetre above the plane and are darker if their friction is smaller. Of a field with more
/// than `max_nodes` on a side, only every second, third, ... node is taken.
Triangles make_scenery(const World& world, int max_nodes = 512);

/// A disc that comes up during a run.
struct RisingBump {
  GroundBlock block;          ///< the block at its full height
  double begin = 0, end = 0;  ///< interval in which it acts [s]
};
/// The bumps of a run's scenario, each at the place where it came up.
std::vector<RisingBump> rising_bumps(const RobotModel& model, const SimulationLog& log);

/// The triangles of these bumps as they are at `t`.
Triangles make_bumps(const std::vector<RisingBump>& bumps, double ground_height, double t);

/// The time in which a bump rises [s], as in sim/schedule.cpp, and the share of its height at a
/// time after its beginning.
constexpr double kBumpRise = 0.02;
double bump_share(double since);

}  // namespace ayumi
