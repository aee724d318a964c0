#pragma once
// Edits of patterns: each function returns a new pattern and reads or writes no file.

#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"
#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// The motion as a table with the file name `table`: theta, base, commanded COG, ZMP and f_z of
/// every sample. Phases with footholds, world, controller, scenario and tolerances stay; keys are
/// removed except weights and foot poses. `series` is the sampled pattern. Throws
/// Error(bad_pattern) for a phase with a goal, which has no sampled motion.
Pattern baked(const RobotModel& model, const Pattern& pattern, const CommandSeries& series,
              const std::string& table);

/// Map of a robot onto its mirror image in its x z plane.
struct MirrorMap {
  std::vector<int> dof;   ///< the dof on the other side; the same dof for one in the middle
  std::vector<int> sign;  ///< +1 or -1: theta of the image
  std::vector<int> link;  ///< the link on the other side
};
/// Throws Error(bad_model) that names the joint without a counterpart within 5 mm.
MirrorMap mirror_map(const RobotModel& model);

/// Exchanges left and right in feet, joints, y coordinates, pushes, table and correction. Mirrored
/// twice, a pattern is unchanged. Throws as mirror_map, and Error(bad_pattern) for an unknown
/// joint.
Pattern mirrored(const RobotModel& model, const Pattern& pattern);

/// The pattern with all times multiplied by `scale`. f_z keys get the vertical acceleration of the
/// new times; ZMP and f_z columns of a table are no longer valid and come from the full model. A
/// push keeps its duration. Throws Error(usage) unless 0.01 <= scale <= 100, and as baked().
Pattern retimed(const RobotModel& model, const Pattern& pattern, double scale);

/// The pattern with the time from `begin` to `end` [s] multiplied by `factor` and the rest shifted;
/// keys, phases and f_z keys as in retimed(). Throws Error(usage) for a factor or window out
/// of range, Error(bad_pattern) for a table or a correction, and as retimed().
Pattern stretched(const RobotModel& model, const Pattern& pattern, double begin, double end,
                  double factor);

/// A pattern and its samples.
struct MotionPart {
  const Pattern& pattern;
  const CommandSeries& series;
};

/// Two motions in sequence as a table of posture and base (COG, ZMP and f_z are those of the full
/// model). The second motion is moved over the ground and turned so that it begins where the feet
/// of the first one stand, with its footholds, keys and scenario. `over` [s] is the time of a
/// transition from rest to rest with both feet still; with 0 there is none, and the postures have
/// to agree within 2e-4 rad. World and controller are those of the first motion. Throws
/// Error(bad_pattern) when a foot is in the air at the join, the feet stand differently (1 mm, 0.01
/// rad) or the legs do not reach, and as baked().
Pattern joined(const RobotModel& model, const MotionPart& first, const MotionPart& second,
               double over, const std::string& table);

struct Ramps {
  double in = 1, out = 1;  ///< [s]; 0: none
  std::string posture = "home";
};
/// The motion with transitions from a named posture to its first posture and back at the end, as a
/// table. The feet stay in their places, and the named posture has its COG above their middle.
/// Throws as joined().
Pattern ramped(const RobotModel& model, const MotionPart& motion, const Ramps& ramps,
               const std::string& table);

}  // namespace ayumi
