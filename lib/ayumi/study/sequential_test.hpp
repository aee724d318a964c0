#pragma once
// A sequential test of "the robot fails with a probability of at most p0". It looks at the runs one
// after the other. With k failures it certifies as soon as n_k runs are done, and it gives up if k
// failures can no longer be certified within the largest number of runs. The plan n_0 < n_1 < ...
// is fixed before the first run, and the probability that a robot with a failure probability above
// p0 is ever certified is at most 1 - confidence. docs/certify.md proves this and the bounds.

#include <vector>

namespace ayumi {

/// The point at which a test stopped.
struct SequentialOutcome {
  bool stopped = false;    ///< if false, more runs are needed
  bool certified = false;  ///< if false after the stop, the test is hopeless
  long runs = 0;           ///< number of runs up to the stop
  long failures = 0;       ///< number of failures among them
};

class SequentialTest {
 public:
  /// p0 = `failure` and `confidence` are in (0, 1). Throws Error(usage) if `most` runs cannot
  /// certify a robot that never fails.
  SequentialTest(double failure, double confidence, long most);

  double failure() const { return failure_; }
  double confidence() const { return confidence_; }
  /// n_k, the number of runs that certifies k failures, with as many entries as `most` runs allow.
  const std::vector<long>& plan() const { return plan_; }

  /// The outcome for the runs in their order, where true is a failure. Runs after the stop do not
  /// count.
  SequentialOutcome outcome(const std::vector<bool>& failed) const;

  /// One-sided bounds of the failure probability after the test has stopped, each with the
  /// confidence of the test. They take the stopping into account.
  double upper_bound(const SequentialOutcome& outcome) const;
  double lower_bound(const SequentialOutcome& outcome) const;

  /// The probability that a robot with the failure probability p is certified.
  double power(double p) const;

 private:
  double at_most(const SequentialOutcome& outcome, double p, bool strictly) const;

  double failure_, confidence_;
  std::vector<long> plan_;
};

/// The number of runs without a failure that certifies: the smallest n with
///   (1 - failure)^n <= 1 - confidence.
long failure_free_runs(double failure, double confidence);

}  // namespace ayumi
