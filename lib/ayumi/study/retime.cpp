#include "ayumi/study/retime.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/author/edit/edit.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/limits/amount_text.hpp"
#include "ayumi/limits/limit.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/plan/viip_phases.hpp"

namespace ayumi {

namespace {

/// Factor between scales that get faster. Chosen: a bracket of 25 % takes 7 bisections to 0.2 %. No
/// measured case changes between half and twice the value (constants.md).
constexpr double kFasterStep = 1.25;
/// Factor between scales that get slower, up to kLargeScale. Chosen: small, because the range of
/// scales that pass can be short: held poses heat the motors when they last longer. No measured
/// case changes between half and twice the value (constants.md).
constexpr double kSlowerStep = 1.05;
/// Scale beyond which the search goes slower by kFasterStep.
constexpr double kLargeScale = 3;
/// Fraction of the excess of a joint's speed by which the scale grows at once. Chosen: below 1, so
/// that the first scale that passes is not skipped. No measured case changes between half and twice
/// the value (constants.md).
constexpr double kSpeedStep = 0.8;
/// Factor between the scales that are tried beyond the fastest scale that passes: 0.5 % each, and
/// 18 % in all kBeyondSteps of them. Chosen: a compromise, since each scale costs one sampling and
/// one check. No measured case changes between half and twice the value (constants.md).
constexpr double kBeyondStep = 1.005;
// The number of these scales. No measured case changes between half and twice the value
// (constants.md).
constexpr int kBeyondSteps = 40;

struct Trial {
  bool passes = false;
  std::string reason;    // reason why the scale does not pass
  double too_quick = 1;  // largest ratio of a joint's speed to its limit
  bool of_posture = false;
};

class PaceSearch {
 public:
  PaceSearch(const RobotModel& model, const Pattern& pattern, const RetimeOptions& options,
             const Progress& progress)
      : model_(model), pattern_(pattern), options_(options), progress_(progress) {}

  FastestPace run() {
    Trial now = trial(1);
    double passing = 1, failing = 1;
    FastestPace result;
    if (now.passes) {
      do {
        passing = failing;
        failing = std::max(options_.fastest, passing / kFasterStep);
        if (passing <= options_.fastest) break;
      } while (trial(failing).passes);
      result.bounded = passing > options_.fastest;
    } else {
      reason_ = now.reason;
      result.by_posture = now.of_posture && pattern_.table;
      if (result.by_posture) return finish(result);
      do {
        failing = passing;
        passing *= std::max(passing < kLargeScale ? kSlowerStep : kFasterStep,
                            1 + kSpeedStep * (now.too_quick - 1));
        if (passing > options_.slowest) return finish(result);
        now = trial(passing);
      } while (!now.passes);
      result.bounded = true;
    }
    result.found = true;
    while (result.bounded) {
      passing = edge(passing, failing);
      const double quicker = beyond(passing);
      if (quicker == 0) break;
      passing = quicker;
      for (failing = passing / kBeyondStep; failing > options_.fastest && trial(failing).passes;
           failing /= kBeyondStep)
        passing = failing;
      result.bounded = failing > options_.fastest;
    }
    result.scale = rounded(passing);
    return finish(result);
  }

 private:
  FastestPace finish(FastestPace result) {
    if (result.bounded || !result.found) result.limited_by = reason_;
    result.evaluations = evaluations_;
    return result;
  }

  // The smallest scale that passes, between a scale that passes and one that does not.
  double edge(double passing, double failing) {
    while (passing / failing > 1 + options_.resolution) {
      const double middle = std::sqrt(passing * failing);
      (trial(middle).passes ? passing : failing) = middle;
    }
    return passing;
  }

  // The fastest of the next scales that passes, or 0 if none does. A pattern with flights may pass
  // again at a faster scale, because other samples then lie on the edges of the flights. The reason
  // for the first failure is kept.
  double beyond(double passing) {
    const std::string reason = reason_;
    double found = 0, scale = passing;
    for (int i = 0; i < kBeyondSteps && scale / kBeyondStep > options_.fastest; ++i) {
      scale /= kBeyondStep;
      if (trial(scale).passes) found = scale;
    }
    reason_ = reason;
    return found;
  }

  // The scale is rounded up to three decimals (four below 0.5) if the rounded scale passes too.
  double rounded(double scale) {
    const double digits = scale < 0.5 ? 1e4 : 1e3;
    const double up = std::ceil(digits * scale) / digits;
    return up != scale && trial(up).passes ? up : scale;
  }

  Trial trial(double scale) {
    report(progress_, {"changing the timing", -1, "scale " + text::fixed(scale, 4)});
    ++evaluations_;
    try {
      const CommandSeries series =
          sample(model_, retimed(model_, pattern_, scale), {.dt = options_.dt});
      const ConsistencyReport check = check_consistency(model_, series, options_.check);
      if (check.consistent) return {true, ""};
      return failed(check, series.duration());
    } catch (const Error& error) {
      if (error.code() != ErrorCode::bad_pattern) throw;
      reason_ = error.what();
    }
    return {.reason = reason_};
  }

  Trial failed(const ConsistencyReport& check, double duration) {
    Trial trial;
    const Finding* shown = nullptr;
    for (const Finding& f : check.findings) {
      if (f.severity != Severity::error) continue;
      if (f.kind == FindingKind::joint_speed || f.kind == FindingKind::table_step)
        trial.too_quick = std::max(trial.too_quick, std::abs(f.worst) / f.limit);
      if (!shown || (is_of_posture(f) && !trial.of_posture)) shown = &f;
      trial.of_posture = is_of_posture(*shown);
    }
    reason_ = kind_place_and_time(*shown) + ": " + amount_text(*shown) +
              " (when the motion takes " + text::fixed(duration, 3) + " s)";
    trial.reason = reason_;
    return trial;
  }

  const RobotModel& model_;
  const Pattern& pattern_;
  const RetimeOptions& options_;
  const Progress& progress_;
  std::string reason_;  // reason why the last scale failed
  int evaluations_ = 0;
};

}  // namespace

FastestPace fastest_pace(const RobotModel& model, const Pattern& pattern,
                         const RetimeOptions& options, const Progress& progress) {
  require_within("the resolution of the scale", options.resolution, RetimeOptions::kResolution);
  refuse_viip_phases(pattern, "retimed");
  return PaceSearch(model, pattern, options, progress).run();
}

}  // namespace ayumi
