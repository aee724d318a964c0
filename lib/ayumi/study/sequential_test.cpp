#include "ayumi/study/sequential_test.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/math/elementary.hpp"

namespace ayumi {

namespace {

/// Number of halvings of an interval of probabilities. Derived: 2^-60 is below the spacing of
/// doubles near the smallest failure probability that can be asked for.
constexpr int kHalvings = 60;

/// The course of a test, run by run: the probability of every number of failures among the tests
/// that have not stopped.
class Paths {
 public:
  /// Only numbers of failures up to `most` are followed.
  Paths(double p, size_t most) : p_(p), going_(most + 1, 0.0) { going_[0] = 1; }

  /// Adds one more run. Returns the probability of a failure beyond `most`.
  double run() {
    const double beyond = going_.back() * p_;
    for (size_t k = going_.size() - 1; k > 0; --k)
      going_[k] = going_[k] * (1 - p_) + going_[k - 1] * p_;
    going_[0] *= 1 - p_;
    return beyond;
  }
  /// Ends the tests with k failures and returns their probability.
  double take(size_t k) {
    const double taken = going_[k];
    going_[k] = 0;
    return taken;
  }
  double with(size_t k) const { return going_[k]; }

 private:
  double p_;
  std::vector<double> going_;
};

}  // namespace

long failure_free_runs(double failure, double confidence) {
  const double exact = elementary::log1p(-confidence) / elementary::log1p(-failure);
  return std::max(1L, static_cast<long>(std::ceil(exact * (1 - 1e-12))));
}

// n_0 takes as little of the permitted error as it must. Every further stage may take half of the
// error that is left, so that the sum stays below the permitted error for any number of stages.
SequentialTest::SequentialTest(double failure, double confidence, long most)
    : failure_(failure), confidence_(confidence) {
  if (!(failure > 0 && failure < 1))
    fail(ErrorCode::usage, "the failure probability must be between 0 and 1");
  if (!(confidence > 0 && confidence < 1))
    fail(ErrorCode::usage, "the confidence must be between 0 and 1");
  const long first = failure_free_runs(failure, confidence);
  if (most < first)
    fail(ErrorCode::usage,
         std::to_string(most) + " runs cannot show that the failure probability is at most " +
             text::brief(failure) + " with a confidence of " + text::brief(confidence) +
             ", even if no run fails. Give " + std::to_string(first) + " or more");
  // More failures than this cannot be certified in `most` runs, because a robot with the failure
  // probability p0 has fewer failures on average.
  const auto widest = static_cast<size_t>(static_cast<double>(most) * failure) + 1;
  Paths paths(failure, widest);
  double left = 1 - confidence;
  for (long n = 1; n <= most; ++n) {
    paths.run();
    const size_t k = plan_.size();
    if (k > widest) break;
    const bool enough = k == 0 ? n == first : paths.with(k) <= 0.5 * left;
    if (!enough || (k > 0 && n <= plan_.back())) continue;
    // Tests with fewer failures have ended earlier, so that only those with k failures end here.
    left -= paths.take(k);
    plan_.push_back(n);
  }
}

SequentialOutcome SequentialTest::outcome(const std::vector<bool>& failed) const {
  SequentialOutcome result;
  for (const bool f : failed) {
    ++result.runs;
    result.failures += f;
    const auto k = static_cast<size_t>(result.failures);
    if (k >= plan_.size()) {
      result.stopped = true;
      return result;
    }
    if (result.runs >= plan_[k]) {
      result.stopped = result.certified = true;
      return result;
    }
  }
  return result;
}

// The outcomes are ordered: certified with 0, 1, 2, ... failures, then hopeless after many runs
// down to hopeless after few. With `strictly`, the result is the probability of the better outcomes
// alone.
double SequentialTest::at_most(const SequentialOutcome& outcome, double p, bool strictly) const {
  Paths paths(p, plan_.size() - 1);
  const long last = plan_.back();
  const auto worst = static_cast<size_t>(outcome.failures);
  double certified = 0, hopeless_later = 0;
  size_t k = 0;
  for (long n = 1; n <= last; ++n) {
    const double hopeless = paths.run();
    if (!outcome.certified && (n > outcome.runs || (n == outcome.runs && !strictly)))
      hopeless_later += hopeless;
    if (n < plan_[k]) continue;
    const double taken = paths.take(k);
    if (!outcome.certified || k < worst || (k == worst && !strictly)) certified += taken;
    ++k;
  }
  return certified + hopeless_later;
}

namespace {

/// The p at which the decreasing function f crosses `level`, where f(0) is above it.
template <typename Function>
double crossing(const Function& f, double level) {
  double low = 0, high = 1;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (f(middle) > level ? low : high) = middle;
  }
  return high;
}

}  // namespace

double SequentialTest::upper_bound(const SequentialOutcome& outcome) const {
  if (!outcome.stopped) return 1;
  const double bound =
      crossing([&](double p) { return at_most(outcome, p, false); }, 1 - confidence_);
  // The plan may leave a part of the error unused. Nevertheless, a study that is not certified has
  // no bound below p0.
  return outcome.certified ? bound : std::max(bound, failure_);
}

double SequentialTest::lower_bound(const SequentialOutcome& outcome) const {
  if (!outcome.stopped || (outcome.certified && outcome.failures == 0)) return 0;
  return crossing([&](double p) { return at_most(outcome, p, true); }, confidence_);
}

double SequentialTest::power(double p) const {
  SequentialOutcome last;
  last.certified = true;
  last.failures = static_cast<long>(plan_.size()) - 1;
  return at_most(last, p, false);
}

}  // namespace ayumi
