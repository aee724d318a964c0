#pragma once
// The probability of rare failures by subset simulation (S.-K. Au, J. L. Beck, "Estimation of small
// failure probabilities in high dimensions by subset simulation", 2001). The rare event is divided
// into a chain of events that are likelier. The first event is that the severity of a run exceeds a
// level that a tenth of the samples exceeds. The next level is exceeded by a tenth of those
// samples, and so on up to the level of a failure. The samples of a level come from Markov chains
// that start at the worst samples of the level before. docs/certify.md, "Rare failures", explains
// it.

#include <functional>

#include "ayumi/base/progress.hpp"
#include "ayumi/math/statistics.hpp"
#include "ayumi/study/uncertain_task.hpp"

namespace ayumi {

struct SubsetOptions {
  long runs = 1000;    ///< number of samples of each level, a multiple of 1 / share
  double share = 0.1;  ///< share of the samples that exceed the next level
  int levels = 8;      ///< largest number of levels; the smallest probability is share^levels
  std::uint64_t seed = 1;
  int threads = 0;  ///< number of threads; 0 for all cores; results do not depend on it
};

struct SubsetResult {
  double probability = 0;
  /// The coefficient of variation of the estimate, which takes the correlation within the chains
  /// into account.
  double variation = 0;
  /// An approximate interval from a normal distribution of the logarithm. It is not exact, unlike
  /// that of clopper_pearson().
  RateInterval interval;
  std::vector<double> levels;  ///< levels of the severity
  long runs = 0;
  bool reached = false;  ///< if false, no failure was found, and `probability` is an upper bound
};

/// The probability that `severity` is at least `threshold`. `severity` is called from several
/// threads.
SubsetResult subset_simulation(size_t dimension,
                               const std::function<double(const CaseNumbers&)>& severity,
                               double threshold, double confidence, const SubsetOptions& options,
                               const Progress& progress = {});

}  // namespace ayumi
