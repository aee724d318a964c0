#pragma once
// The repair of a pattern. The pattern itself may ask for options, and its series may already have
// a correction.

#include <vector>

#include "ayumi/motion/pattern.hpp"
#include "ayumi/plan/sample_plan.hpp"
#include "ayumi/repair/repair.hpp"

namespace ayumi {

/// The author's preferences as options. The options of the check keep their defaults.
RepairOptions preferred_options(const Pattern& pattern);

/// repair() of `series`, the samples of `pattern`. If the pattern has a correction that is not
/// enough, the motion without it is repaired. Throws the same errors as repair() and sample().
RepairResult repair(const RobotModel& model, const Pattern& pattern, const CommandSeries& series,
                    const RepairOptions& options, const Progress& progress = {});

/// A place of the COG that the pattern gives and the motion does not have.
struct MissedCog {
  double t = 0;    ///< time of the key [s]; for a table, of the row that is missed most
  double off = 0;  ///< largest distance along a given coordinate [m]
};

/// A motion that was made from the plan of a pattern alone.
struct GeneratedMotion {
  RepairResult repair;                ///< its changes and its `before` are those from `start`
  CommandSeries start;                ///< the motion of inverse kinematics that was repaired
  PlannedCog cog = PlannedCog::keys;  ///< what the COG of `start` follows
  /// Whether the COG of `start` follows the ZMP of least sway (least_sway.hpp).
  bool least_sway = false;
  /// How much lower the COG of `start` is than the pattern's default_cog_height() [m].
  double lowered = 0;
  /// Where the motion misses the COG's keys or table by more than the check's tolerance of the COG,
  /// in the order of time.
  std::vector<MissedCog> missed;
};

/// Makes a motion from the plan of a pattern alone: the repair of `plan`, which sample_plan() made
/// of the pattern. If `plan` fails the check, other starts are tried, and the start with the
/// smallest violations is repaired:
///   - If no key gives the height of the COG, lower heights.
///   - If the COG keys are only goals at the beginning and the end, a COG that follows the ZMP from
///     one to the other. If there are COG keys on the way, this is tried only after the repair
///     failed.
///   - If legs lack joints, and there are neither keys of the ZMP nor COG keys on the way, a COG of
///     least sway.
///   - For a long flight, a longer time over which the feet take up the COG's speed.
/// A start that passes the check is the result as it is.
GeneratedMotion generate(const RobotModel& model, const Pattern& pattern, const CommandSeries& plan,
                         const RepairOptions& options, const Progress& progress = {});

}  // namespace ayumi
