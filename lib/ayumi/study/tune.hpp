#pragma once
// Better gains by search: coordinate by coordinate on an objective that is declared, over a set of
// pushes that is declared, in an order that is fixed. The same input gives the same gains for any
// number of threads.

#include <map>
#include <string>

#include "ayumi/study/push.hpp"

namespace ayumi {

/// What is tried on every choice of gains: each phase pushed in each direction, and the unpushed
/// pattern.
struct TuneOptions {
  std::vector<PushPhase> phases;  ///< empty: default_push_phases()
  int directions = 4;             ///< evenly spread, the first along +x
  double level = 0.9;             ///< of a push, times the capture bound
  double duration = 0.02;         ///< of a push [s]
  double watched = 1.2;           ///< time after a push that counts [s]
  std::vector<std::string> gains = {"ka", "q", "ks", "kd", "tau_z", "ankle"};
  double factor = 1.3;       ///< first step up and down
  int rounds = 3;            ///< through all gains; a dry round halves the step
  int threads = 0;           ///< 0: all cores
  SimulateOptions simulate;  ///< its controller is the start
};

/// The objective: the mean over all pushes of omega times the integral of |xi - cmd xi| / z over
/// the watched time, and 10 for each that fell; plus the same mean of the unpushed run's
/// |ZMP - ref ZMP| / z. Smaller is better, without dimension.
struct TuneFigures {
  double objective = 0;
  double recovery = 0;  ///< the part of the pushes that did not fall
  double unpushed = 0;  ///< the part of the unpushed run
  int falls = 0, pushes = 0;
};

struct TuneResult {
  std::map<std::string, double> start, gains;  ///< by name
  TuneFigures before, after;
  int choices = 0;  ///< of gains tried
  int refused = 0;  ///< left out: the linear loop would be unstable
};

/// Throws as push_limits() does, and Error(usage) for a gain that cannot be tuned, a start that is
/// unstable or falls unpushed.
TuneResult tune_gains(const RobotModel& model, const CommandSeries& series,
                      const TuneOptions& options, const Progress& progress = {});

}  // namespace ayumi
