#pragma once
// The push study: for each gait phase and direction, the largest impulse through the COG that the
// robot survives, in open loop and with each controller. The search brackets and bisects over
// levels, which are multiples of a fraction of the capture bound. A level is survived when the
// nominal push and its small seeded variations of time and direction are all survived.

#include <functional>
#include <optional>

#include "ayumi/sim/simulate.hpp"

namespace ayumi {

/// Time of a push in the gait.
struct PushPhase {
  std::string name;
  double at = 0;          ///< start of the push [s]
  bool standing = false;  ///< the robot stands in the pattern's first posture
};

struct PushOptions {
  /// Bounds of the options. Chosen: one direction in each degree; beyond the others, a study takes
  /// days (a finer step, more variations) or its pushes are no longer pushes (20 capture bounds,
  /// 1 s).
  static constexpr Bounds kDirections = {1, 360}, kReplicas = {0, 100},
                          kStep = {0.005, 1, "capture bounds"}, kCap = {0.1, 20, "capture bounds"},
                          kDuration = {0.001, 1, "s"};

  std::vector<PushPhase> phases;            ///< phases; if empty, default_push_phases()
  std::vector<ControllerSpec> controllers;  ///< laws in addition to open loop
  int directions = 8;          ///< number of evenly spread directions, the first along +x
  double duration = 0.02;      ///< duration of a push [s]
  double step = 0.06;          ///< step of the search, in capture bounds
  double cap = 2.4;            ///< largest level that is tried, in capture bounds
  int replicas = 2;            ///< variations in addition to the nominal push
  double time_spread = 0.005;  ///< largest deviation of a variation [s]
  double direction_spread = 3 * M_PI / 180;  ///< largest deviation of a variation [rad]
  double reference_level = 0.45;             ///< level of the moderate push, in capture bounds
  int threads = 0;           ///< number of threads; 0 for all cores; results do not depend on it
  SimulateOptions simulate;  ///< options of the runs; their controller and scenario are not used
};

/// The response to the moderate push (reference_level).
struct PushFigures {
  bool survives = false;
  double foot_tilt = 0;  ///< time during which the stance foot is tilted by more than 2 degrees [s]
  /// Time from the push until the DCM stays within 10 mm (for z = 0.22 m) of the plan [s].
  double recovery = 0;
  double trunk_tilt = 0;  ///< largest tilt of the trunk [rad]
};

/// The largest impulse such that it and all smaller levels that were tried are survived.
struct PushLimit {
  double impulse = 0;   ///< impulse [N s]
  bool capped = false;  ///< the largest level that was tried is survived
  PushFigures moderate;
  int runs = 0;  ///< number of simulations of the search
};

/// The results for one phase and direction.
struct PushCase {
  PushPhase phase;
  double direction = 0;  ///< direction of the push, from +x anticlockwise [rad]
  /// capture_bound() and edge_bound() [N s]. Patterns with VIIP goals have no planned footholds;
  /// both bounds are then m omega times the distance to the nearest edge of the support at the
  /// start.
  double bound = 0, edge_bound = 0;
  /// The mass of the robot [kg], and the height of its planned COG above its planned ZMP [m]: J/m
  /// and J/(m sqrt(g z)) compare pushes of different robots.
  double mass = 0, height = 0;
  /// Limit in open loop; for patterns with VIIP goals, that of VIIP without feedback.
  PushLimit open_loop;
  std::vector<PushLimit> limits;  ///< limits by PushOptions::controllers
};

/// J/m [m/s], which is the speed that an impulse J [N s] gives to the COG.
double push_speed(const PushCase& push, double impulse);
/// J/(m sqrt(g z)), which is that speed without a unit.
double push_froude(const PushCase& push, double impulse);

/// Figures over a group of cases, in capture bounds.
struct PushSummary {
  /// Smallest and mean limit with the controller, and the same in open loop.
  double worst = 0, mean = 0, open_worst = 0, open_mean = 0;
  double worst_speed = 0, mean_speed = 0;    ///< J/m of the worst case, and the mean [m/s]
  double worst_froude = 0, mean_froude = 0;  ///< J/(m sqrt(g z)) of the worst case, and the mean
  /// Number of cases whose limit is more than one search step below that of open loop.
  int below_open = 0;
  int cases = 0;
};

/// The default phases: standing, and for the middle step on the left foot the middle of the double
/// support before it and 11, 44 and 78 % of the single support. A pattern without such a step gets
/// standing and its middle. A pattern with VIIP goals gets, for the middle step that VIIP makes
/// under `options`, the middle of the double support and 25 and 75 % of the single support. VIIP
/// then has the gains of the controller of `options`, if this controller is viip.
std::vector<PushPhase> default_push_phases(const RobotModel& model, const CommandSeries& series,
                                           const SimulateOptions& options);

/// Finished cases of an earlier study, by index. They are not computed again.
using KnownCases = std::vector<std::optional<PushCase>>;
/// This function is called after each finished case with its index, and never from two threads at
/// once.
using PushCaseDone = std::function<void(size_t, const PushCase&)>;

/// The cases, phase by phase and in each phase direction by direction. Throws the same errors as
/// simulate(), and Error(usage) for counts, steps or times out of range.
std::vector<PushCase> push_limits(const RobotModel& model, const CommandSeries& series,
                                  const PushOptions& options, const KnownCases& known = {},
                                  const PushCaseDone& done = {}, const Progress& progress = {});

/// The summary of controller c over the standing cases or over the others.
PushSummary summarize(const std::vector<PushCase>& cases, size_t c, bool standing, double step);

}  // namespace ayumi
