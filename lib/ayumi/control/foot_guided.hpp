#pragma once
// Foot-guided control, one of the baselines of DTAD: the ZMP guides the DCM to its planned place at
// the time when the next foot takes over, with the least deviation from the planned ZMP until then.
// After Sugihara and Yamamoto, "Foot-guided agile control of a biped robot through ZMP
// manipulation" (2017). docs/theory_baselines.md, "Foot-guided control".

#include <vector>

#include "ayumi/motion/command_series.hpp"

namespace ayumi {

/// Ratio of the ZMP's deviation from the plan to the DCM's that brings the DCM back in exactly the
/// time T with the least integral of the squared deviation of the ZMP: 2 / (1 - exp(-2 omega T)).
/// It is 2 for an infinite time.
double foot_guided_gain(double omega, double time);

class FootGuided {
 public:
  /// `least_time`: least time for this, in units of 1/omega.
  FootGuided(const CommandSeries& series, double least_time);

  /// At sample k of the series.
  double gain(long k, double omega) const;

  /// From sample k to the next one at which a foot begins to support [s]; infinite when there is
  /// none.
  double time_to_support(long k) const;

 private:
  double dt_, least_time_;
  std::vector<long> supports_;  // samples at which a foot begins to support
};

}  // namespace ayumi
