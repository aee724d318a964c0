#include "ayumi/check/mistake_trials.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <utility>

#include "ayumi/author/generate/pattern_builder.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/in_parallel.hpp"
#include "ayumi/check/consistency.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/plan/sample.hpp"

namespace ayumi {

namespace {

// Number of samples of a trial. Chosen: a walk of 7 s then has a step of 5 ms, and 50 trials take a
// second of processor time; this step is that of coarse servos.
constexpr double kTrialSamples = 1500;
// Number of joints with which Newton's method places a leg exactly, and the number of trials as
// which one trial counts if a leg has fewer joints. Measured: 1500 postures of Open Duck (five
// joints) take 36 ms, and of HOAP-1 (six joints) 14 ms.
constexpr size_t kWholeLeg = 6;
constexpr int kLackingCost = 2;
// Number of trials after which no further group of changes is tried if no change has removed a good
// share of the errors or findings. Measured: with 60, all planted mistakes of tests/check are found
// as with 300. For a recorded motion in which many bodies touch, 300 trials take 9 s of processor
// time and find nothing more.
constexpr int kPatience = 60;
// The longest step of a trial [s]. Chosen: twenty samples in a swing of 0.2 s.
constexpr double kLongestStep = 0.01;
// Number of trials after which a person may stop the search. Chosen: so many trials of a walk take
// 0.1 s.
constexpr size_t kTrialsBetweenReports = 4;
// An error is slight if it exceeds its limit by less than an amount that depends on its unit: a
// share of the length of a leg for [m], of the weight for [N], of the product of both for [N m], an
// angle for [rad], and a share of the limit for all other units. Chosen: if a unit, digit, sign,
// foot or side is wrong, the value is wrong by its whole size, and its errors are large, too. A
// motion whose errors are all slight is near its limits.
constexpr double kSlightShare = 0.25, kSlightLength = 0.015, kSlightForce = 0.05,
                 kSlightAngle = 0.05;
// Number of errors whose windows show where the mistake may be. Chosen: one mistake is near the
// first error that it causes; the second error is used because the first one may last for the whole
// motion.
constexpr int kFirstErrors = 2;

bool is_slight(const RobotModel& model, const Finding& f) {
  const double beyond = std::abs(f.worst - f.limit);
  const double leg = leg_length(model), weight = model.mass() * kGravity;
  if (spec_of(f.kind).is_ratio())
    return std::abs(f.worst) <= (1 + kSlightShare) * std::abs(f.limit);
  if (f.unit == "m") return beyond <= kSlightLength * leg;
  if (f.unit == "rad") return beyond <= kSlightAngle;
  if (f.unit == "N") return beyond <= kSlightForce * weight;
  if (f.unit == "N m") return beyond <= kSlightForce * weight * leg;
  return beyond <= kSlightShare * std::abs(f.limit);
}

}  // namespace

bool needs_servo_period(FindingKind kind) {
  return kind == FindingKind::table_step || kind == FindingKind::table_position ||
         kind == FindingKind::table_rest || kind == FindingKind::servo_step ||
         kind == FindingKind::motor_acceleration;
}

Trials::Trials(const RobotModel& model, const Pattern& pattern, const CheckOptions& options,
               const Progress& progress, int most)
    : model_(model), options_(options), progress_(progress), most_(most) {
  options_.threads = 1;
  threads_ = options.threads;
  const double step = std::min(pattern.duration() / kTrialSamples, kLongestStep);
  const double period = model.description().servo_period;
  ticks_ = static_cast<int>(std::max(1.0, std::floor(step / period)));
  for (const Side side : {Side::left, Side::right})
    if (model.leg(side).size() < kWholeLeg) leg_cost_ = kLackingCost;
}

int Trials::quick_cost(const Pattern& pattern) const {
  const double samples = pattern.duration() / (ticks_ * model_.description().servo_period);
  return std::max(leg_cost_, static_cast<int>(std::floor(samples / kTrialSamples)));
}

TrialOutcome Trials::exactly(Pattern pattern, const Mend& mend) const {
  report(progress_, {"looking for the cause", -1, ""});  // may stop the search
  mend(pattern);
  TrialOutcome outcome = of(pattern, true);
  outcome.table_alone = !outcome.good();
  return outcome;
}

TrialOutcome Trials::of(const Pattern& pattern, bool exact) const {
  TrialOutcome outcome;
  const double dt = (exact ? 1 : ticks_) * model_.description().servo_period;
  try {
    CheckOptions options = options_;
    options.friction = pattern.world.friction;
    const ConsistencyReport report =
        check_consistency(model_, sample(model_, pattern, {.dt = dt, .threads = 1}), options);
    outcome.errors = outcome.findings = 0;
    outcome.slight = outcome.of_table = true;
    for (const Finding& f : report.findings) {  // errors are in order of time
      if (!exact && needs_servo_period(f.kind)) continue;
      if (f.severity != Severity::error && f.cause < 0) continue;
      ++outcome.findings;
      outcome.slight = outcome.slight && is_slight(model_, f);
      if (f.severity != Severity::error) continue;
      if (const auto* pair = std::get_if<BodyPairPlace>(&f.place))
        outcome.meeting.emplace_back(pair->a, pair->b);
      outcome.of_table = outcome.of_table && needs_servo_period(f.kind);
      if (outcome.errors++ < kFirstErrors) outcome.windows.push_back({f.begin, f.end});
    }
  } catch (const Error& error) {
    if (error.code() != ErrorCode::bad_pattern && error.code() != ErrorCode::usage) throw;
  }
  return outcome;
}

std::vector<TrialOutcome> Trials::after(const Pattern& pattern, const std::vector<Mend>& mends) {
  std::vector<TrialOutcome> outcomes(mends.size());
  // Only a few versions exist at once, because a long pattern needs much memory.
  std::vector<std::pair<size_t, Pattern>> mended;
  const auto try_mended = [&] {
    report(progress_, {"looking for the cause", -1, ""});  // may stop the search
    std::atomic<bool> stop = false;
    in_parallel(mended.size(), threads_, stop,
                [&](size_t i) { outcomes[mended[i].first] = of(mended[i].second); });
    mended.clear();
  };
  if (!mends.empty() && !promising_ && tried_ >= kPatience) {
    ended_ = true;
    return outcomes;
  }
  for (size_t i = 0; i < mends.size(); ++i) {
    if (made_ >= most_) {
      ended_ = true;
      break;
    }
    std::optional<Pattern> version(pattern);  // empty if the change cannot be made
    try {
      mends[i](*version);
    } catch (const Error&) {
      version.reset();
    }
    // The cost of a trial grows with the duration of the motion that is tried. A change that
    // lengthens the motion may be too costly where a later one is not.
    const double cost =
        static_cast<double>(quick_cost(version ? *version : pattern)) * (exact_ ? ticks_ : 1);
    if (made_ + cost > most_) {
      ended_ = true;
      continue;
    }
    made_ += static_cast<int>(cost);
    ++tried_;
    if (version) mended.emplace_back(i, std::move(*version));
    if (mended.size() == kTrialsBetweenReports) try_mended();
  }
  if (!mended.empty()) try_mended();
  return outcomes;
}

}  // namespace ayumi
