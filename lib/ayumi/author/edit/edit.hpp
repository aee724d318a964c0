#pragma once
// Pattern surgery: each takes a pattern and gives another one; nothing is read or written.

#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"
#include "ayumi/motion/pattern.hpp"

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

/// The time from `begin` to `end` [s] takes `factor` times as long, what follows is that much
/// later; keys, phases and f_z keys as in retimed(). Throws Error(usage) for a factor or window out
/// of range, Error(bad_pattern) for a table or a correction, and as retimed().
Pattern stretched(const RobotModel& model, const Pattern& pattern, double begin, double end,
                  double factor);

/// A pattern and its samples.
struct MotionPart {
  const Pattern& pattern;
  const CommandSeries& series;
};

/// One motion after the other as a table (posture and base; COG, ZMP and f_z are then those of the
/// full model). The second is moved over the ground, and turned, to begin where the feet of the
/// first stand; its footholds, keys and scenario come along. `over` [s]: a transition from rest to
/// rest with both feet still; 0: none, the postures must agree within 2e-4 rad. World and
/// controller are the first one's. Throws Error(bad_pattern) where one foot is in the air at the
/// join, the feet stand otherwise (1 mm, 0.01 rad) or the legs do not reach; and as baked().
Pattern joined(const RobotModel& model, const MotionPart& first, const MotionPart& second,
               double over, const std::string& table);

struct Ramps {
  double in = 1, out = 1;  ///< [s]; 0: none
  std::string posture = "home";
};
/// The motion with a way to its first posture from a named one, and back to that at the end, as a
/// table. The feet stay where the motion has them, the COG is above their middle. Throws as
/// joined().
Pattern ramped(const RobotModel& model, const MotionPart& motion, const Ramps& ramps,
               const std::string& table);

}  // namespace ayumi
