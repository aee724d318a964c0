#pragma once
// The quickest timing along a motion: it slows the motion only where a limit binds. The path is the
// motion at the fastest uniform pace at which all of it is within the limits. It is not the motion
// as it was given, because the COG that is solved from the ZMP depends on the pace. Along the path,
// math/path_timing finds the quickest timing within the rows of study/path_limits. This timing is
// then made smooth, sampled and checked. Where the check finds an error, a smaller share of the
// limits may be used, and the next round begins. If the caller gives a ground, the motion is also
// simulated in open loop: the robot has to stand if it stands at the uniform pace.
//
// Where nothing moves, no limit binds: such pauses keep their length, or are passed at the largest
// pace.

#include <optional>
#include <string>
#include <vector>

#include "ayumi/base/bounds.hpp"
#include "ayumi/base/progress.hpp"
#include "ayumi/check/consistency.hpp"
#include "ayumi/motion/pattern.hpp"
#include "ayumi/study/path_limits.hpp"

namespace ayumi {

struct LocalRetimeOptions {
  /// Bounds of PathLimitOptions::most_margin, where it is not infinite. Chosen: no sole is so wide
  /// that its middle is a metre from its edge.
  static constexpr Bounds kMostMargin = {0, 1, "m"};

  PathLimitOptions path;     ///< the search sets its smallest margin and its pauses
  bool keep_pauses = false;  ///< pauses last as long as in the given pattern
  /// The ground on which the robot should stand in open loop if it stands at the uniform pace;
  /// nothing if this does not matter.
  std::optional<World> world = {};
  double dt = 0.001;                    ///< period of sampling [s]
  double fastest = 0.05, slowest = 20;  ///< range of the uniform scale of the path
};

struct LocalPace {
  bool found = false;        ///< a timing passes the check
  Pattern pattern;           ///< the pattern with this timing, usually as a table
  CommandSeries series;      ///< samples of the pattern
  ConsistencyReport report;  ///< check of the samples
  /// False if the robot falls in open loop with this timing although it stands at the uniform pace.
  /// Nothing if no motion was simulated.
  std::optional<bool> stands;
  /// The reason why the motion cannot be simulated, in words, if it should have been.
  std::string not_simulated;
  bool uniform = false;   ///< the motion at the uniform pace, because with other timings it falls
  double scale = 1;       ///< duration divided by that of the given pattern
  double path_scale = 1;  ///< uniform scale of the path, or of the motion if it is uniform
  std::vector<BindingLimit>
      binding;     ///< limits that decide the pace; the one with the largest share comes first
  int rounds = 0;  ///< number of timings that were checked
  std::string limited_by;   ///< the reason why none was found, in words
  bool by_posture = false;  ///< limited by the posture, which no timing can change
};

/// The table of the result gets the file name `table`. Flights keep their pace. Throws
/// Error(bad_pattern) in the same cases as sample() for a pattern that cannot be sampled, and for a
/// phase with a goal, and Error(usage) for a margin out of bounds or a name that is no file name.
LocalPace fastest_local_pace(const RobotModel& model, const Pattern& pattern,
                             const std::string& table, const LocalRetimeOptions& options,
                             const Progress& progress = {});

}  // namespace ayumi
