#pragma once
// How hard may the robot be pushed? For every gait phase and direction the largest survivable
// impulse through the COG: bracketing and bisection over levels that are multiples of a share of
// the capture bound, each level with small seeded variations of time and direction that must all
// survive, open loop beside the controllers.

#include <functional>
#include <optional>

#include "ayumi/sim/simulate.hpp"

namespace ayumi {

/// When a push comes.
struct PushPhase {
  std::string name;
  double at = 0;          ///< start of the push [s]
  bool standing = false;  ///< on the robot standing in the pattern's first posture, else walking
};

struct PushOptions {
  std::vector<PushPhase> phases;             ///< empty: default_push_phases()
  std::vector<ControllerSpec> controllers;   ///< besides open loop
  int directions = 8;                        ///< evenly spread, the first along +x
  double duration = 0.02;                    ///< of a push [s]
  double step = 0.06;                        ///< of the search, times the capture bound
  double cap = 2.4;                          ///< largest level tried, times the capture bound
  int replicas = 2;                          ///< variations besides the nominal push
  double time_spread = 0.005;                ///< of a variation, either way [s]
  double direction_spread = 3 * M_PI / 180;  ///< of a variation, either way [rad]
  double reference_level = 0.45;             ///< of the figures of a moderate push, times bound
  int threads = 0;                           ///< 0: all cores; results do not depend on it
  SimulateOptions simulate;                  ///< its controller and scenario are not used
};

/// What a moderate push (reference_level) does.
struct PushFigures {
  bool survives = false;
  double foot_tilt = 0;  ///< time the stance foot is tilted by more than 2 degrees [s]
  double recovery =
      0;  ///< from the push until xi stays within 10 mm (at z = 0.22 m) of the plan [s]
  double trunk_tilt = 0;  ///< largest [rad]
};

/// Largest impulse all of whose tried smaller levels survive too.
struct PushLimit {
  double impulse = 0;   ///< [N s]
  bool capped = false;  ///< the largest level tried survived
  PushFigures moderate;
  int runs = 0;  ///< simulations that found it
};

/// One phase and direction.
struct PushCase {
  PushPhase phase;
  double direction = 0;  ///< of the push, from +x anticlockwise [rad]
  /// capture_bound(), edge_bound() [N s]. In patterns with VIIP goals both are m omega times the
  /// way to the nearest edge of the stand they start from: there are no planned footholds.
  double bound = 0, edge_bound = 0;
  PushLimit open_loop;            ///< with VIIP goals: their pendulum without feedback
  std::vector<PushLimit> limits;  ///< by PushOptions::controllers
};

/// Figures over a group of cases, limits as shares of the capture bound.
struct PushSummary {
  double worst = 0, mean = 0, open_worst = 0, open_mean = 0;
  int below_open = 0;  ///< cases more than one search step below open loop
  int cases = 0;
};

/// Standing, and around the middle step on the left foot: middle of the double support before it
/// and 11, 44 and 78 % of the single support. Patterns without such a step: standing and their
/// middle. With VIIP goals: the middle of the double support and 25 and 75 % of the single support
/// of the middle step that VIIP makes under `options`, with the gains of their controller if that
/// is viip.
std::vector<PushPhase> default_push_phases(const RobotModel& model, const CommandSeries& series,
                                           const SimulateOptions& options);

/// A finished case by its index, or nothing: taken over instead of being worked out again.
using KnownCases = std::vector<std::optional<PushCase>>;
/// Called in turn (never at once) after each finished case with its index.
using PushCaseDone = std::function<void(size_t, const PushCase&)>;

/// The cases in the order phase by phase, direction by direction. Throws as simulate() does and
/// Error(usage) for counts, steps or times out of range.
std::vector<PushCase> push_limits(const RobotModel& model, const CommandSeries& series,
                                  const PushOptions& options, const KnownCases& known = {},
                                  const PushCaseDone& done = {}, const Progress& progress = {});

/// Of controller c over the standing or the other cases.
PushSummary summarize(const std::vector<PushCase>& cases, size_t c, bool standing, double step);

}  // namespace ayumi
