#pragma once
// Searches for better gains by a coordinate search with a declared objective, a declared set of
// pushes and a fixed order. The same input gives the same gains for any number of threads.

#include <map>
#include <string>

#include "ayumi/study/push.hpp"

namespace ayumi {

/// The runs for each choice of gains: pushes in each phase and direction, and the pattern without a
/// push.
struct TuneOptions {
  /// Bounds of the options. Chosen: pushes of more than 5 capture bounds fell the robot with any
  /// gains, so they do not show which gains are better; 50 rounds take a day.
  static constexpr Bounds kLevel = {0.01, 5, "capture bounds"}, kRounds = {1, 50};

  std::vector<PushPhase> phases;  ///< phases; if empty, default_push_phases()
  int directions = 4;             ///< number of evenly spread directions, the first along +x
  double level = 0.9;             ///< level of a push, in capture bounds
  double duration = 0.02;         ///< duration of a push [s]
  double watched = 1.2;           ///< time after a push that the objective includes [s]
  std::vector<std::string> gains = {"ka", "q", "ks", "kd", "tau_z", "ankle"};
  double factor = 1.3;  ///< first step: a gain is multiplied and divided by it
  /// Number of rounds through all gains; after a round without improvement, the root of the factor
  /// is used.
  int rounds = 3;
  int threads = 0;           ///< number of threads; 0 for all cores
  SimulateOptions simulate;  ///< options of the runs; their controller has the initial gains
};

/// The objective, which has no unit; a smaller value is better. It is the mean over all pushes of
/// omega times the integral of |DCM - planned DCM| / z over the watched time, or of 10 for a push
/// that fells the robot, plus the mean of |ZMP - reference ZMP| / z of the run without a push.
struct TuneFigures {
  double objective = 0;
  double recovery = 0;        ///< part of the objective from the pushes that the robot survives
  double unpushed = 0;        ///< part of the objective from the run without a push
  int falls = 0, pushes = 0;  ///< numbers of pushes that fell the robot, and of all pushes
};

struct TuneResult {
  std::map<std::string, double> start, gains;  ///< gains by name
  TuneFigures before, after;
  int choices = 0;  ///< number of choices of gains tried
  int refused = 0;  ///< choices that were skipped because the linear loop would be unstable
};

/// Throws the same errors as push_limits(), and Error(usage) for a gain that cannot be tuned and
/// for initial gains that are unstable or with which the robot falls without a push.
TuneResult tune_gains(const RobotModel& model, const CommandSeries& series,
                      const TuneOptions& options, const Progress& progress = {});

}  // namespace ayumi
