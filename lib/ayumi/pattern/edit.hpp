#pragma once
// Pattern surgery: each takes a pattern and gives another one; nothing is read or written.

#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/pattern/command_series.hpp"
#include "ayumi/pattern/pattern.hpp"

namespace ayumi {

/// The motion as a table: theta, base, commanded COG, ZMP and f_z of every sample, under the file
/// name `table`. Phases with their footholds, world, controller, scenario and tolerances stay; keys
/// go, but for weights and foot poses. `series` is the pattern sampled. Throws Error(bad_pattern)
/// for a phase with a goal, which has no motion of its own.
Pattern baked(const RobotModel& model, const Pattern& pattern, const CommandSeries& series,
              const std::string& table);

/// How a robot maps onto its mirror image in its x z plane.
struct MirrorMap {
  std::vector<int> dof;   ///< the dof on the other side; itself in the middle
  std::vector<int> sign;  ///< +1 or -1: theta of the image
  std::vector<int> link;  ///< the link on the other side
};
/// Throws Error(bad_model) naming the joint without a counterpart within 5 mm.
MirrorMap mirror_map(const RobotModel& model);

/// Left for right: feet, joints, y coordinates, pushes, table and correction. Mirrored twice a
/// pattern is what it was. Throws as mirror_map, and Error(bad_pattern) for an unknown joint.
Pattern mirrored(const RobotModel& model, const Pattern& pattern);

/// The pattern in `scale` of its time. f_z keys keep the vertical acceleration that the new time
/// gives; ZMP and f_z columns of a table no longer hold and are left to the full model. A push
/// keeps its duration. Throws Error(usage) unless 0.01 <= scale <= 100, and as baked().
Pattern retimed(const RobotModel& model, const Pattern& pattern, double scale);

}  // namespace ayumi
