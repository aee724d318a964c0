#pragma once
// A certificate: many runs of one task, each with values drawn from its uncertainty, until a
// sequential test has decided whether the robot fails with a probability of at most p0. The runs
// have numbers, and the decision only depends on their results in the order of these numbers.
// Therefore it is the same for any number of threads and shards. docs/certify.md describes the
// method.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "ayumi/base/progress.hpp"
#include "ayumi/math/statistics.hpp"
#include "ayumi/study/sequential_test.hpp"
#include "ayumi/study/uncertain_task.hpp"

namespace ayumi {

struct CertifyOptions {
  double failure = 0.01;     ///< the probability p0
  double confidence = 0.95;  ///< confidence of every statement
  long most = 0;             ///< largest number of runs; 0 for ten times failure_free_runs()
  bool all = false;          ///< runs all of them; the verdict stays that of the sequential test
  std::uint64_t seed = 1;
  int threads = 0;  ///< number of threads; 0 for all cores; results do not depend on it
  /// Only the cases whose number divided by `shards` leaves the remainder `shard` are run. All of
  /// these are run, without a verdict.
  long shard = 0, shards = 1;
};

/// Results by the number of the case. An entry is empty if the result is not known.
using KnownResults = std::vector<std::optional<CaseResult>>;
/// This function is called between runs with all known results, and never from two threads at once.
using ResultsKnown = std::function<void(const KnownResults&)>;

/// The number of cases that the options may need.
long most_cases(const CertifyOptions& options);

/// Runs the cases that the test needs, or those of the shard; known ones are not run again. Cases
/// after the stop of the test stay empty. All values are drawn and checked before the first run.
KnownResults run_cases(const UncertainTask& task, const CertifyOptions& options,
                       const KnownResults& known = {}, const ResultsKnown& save = {},
                       const Progress& progress = {});

/// Does the same for chosen numbers of cases.
void run_numbers(const UncertainTask& task, const std::vector<long>& numbers,
                 const CertifyOptions& options, KnownResults& results, const ResultsKnown& save,
                 const Progress& progress);

/// Bounds of the quantile 1 - p0 of the largest errors of a run: COG [m], torque as a share of its
/// limit, and tilt of a supporting foot [rad]. Each has the confidence of the test. They are
/// computed from the first runs, as many as a certificate without a failure needs. Runs that fell
/// count as infinitely bad; an infinite value means that there is no bound.
struct QuantileBounds {
  double cog_error = 0, torque = 0, foot_tilt = 0;
  long runs = 0;  ///< number of runs; 0 if the test stopped before
};

struct Certificate {
  SequentialOutcome outcome;
  double upper = 1, lower = 0;  ///< one-sided bounds of the failure probability
  long falls = 0, unsettled = 0;
  QuantileBounds largest;
};
/// The verdict on results in the order of their numbers. More results than the test needs do not
/// change it.
Certificate certificate(const CertifyOptions& options, const KnownResults& results);

/// The failures of two laws or patterns in the same cases.
struct PairedComparison {
  long pairs = 0, both = 0, only_first = 0, only_second = 0;
  double p_value = 1;  ///< McNemar's exact test, two-sided
  RateInterval
      difference;  ///< interval of the difference of the failure probabilities, first - second
};
PairedComparison compare(const KnownResults& first, const KnownResults& second, double confidence);

/// The influence of one value on the outcome of the runs.
struct ValueInfluence {
  std::string name;
  double correlation =
      0;  ///< Spearman's rank correlation of the value and the severity() of the run
  /// Failures and runs in the lower and the upper half of the values; each half has the same
  /// probability.
  std::array<long, 2> failures = {0, 0}, runs = {0, 0};
  std::array<RateInterval, 2> rate;  ///< intervals of Clopper and Pearson
};
/// The influences in the order of UncertainTask::values(). Values that are the same in all runs are
/// left out.
std::vector<ValueInfluence> influences(const UncertainTask& task, const CertifyOptions& options,
                                       const KnownResults& results);

/// The numbers of the worst cases by severity(), the worst first.
std::vector<long> worst_cases(const KnownResults& results, size_t count);

}  // namespace ayumi
