#pragma once
// Foot-guided control, one of the baselines of DTAD: the ZMP guides the DCM to its planned place at
// the time when the next foot takes over, with the least deviation from the planned ZMP until then.
// After Sugihara and Yamamoto, "Foot-guided agile control of a biped robot through ZMP
// manipulation" (2017). docs/theory_baselines.md, "Foot-guided control".

#include <vector>

#include "ayumi/motion/command_series.hpp"

namespace ayumi {

/// The ratio of the ZMP's deviation from the plan to the DCM's deviation that brings the DCM back
/// in exactly the time T, with the smallest integral of the squared ZMP deviation:
///   2 / (1 - exp(-2 omega T)).
/// For an infinite time, it is 2.
double foot_guided_gain(double omega, double time);

class FootGuided {
 public:
  /// `least_time` is the smallest time that the DCM is given to reach its place, in units of
  /// 1/omega.
  FootGuided(const CommandSeries& series, double least_time);

  /// The gain at sample k of the series.
  double gain(long k, double omega) const;

  /// The time from sample k to the next sample at which a foot begins to support [s]; infinite if
  /// there is none.
  double time_to_support(long k) const;

 private:
  double dt_, least_time_;
  std::vector<long> supports_;  // samples at which a foot begins to support
};

}  // namespace ayumi
