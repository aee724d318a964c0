#include "ayumi/study/retime.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/author/edit/edit.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/limits/limit.hpp"
#include "ayumi/plan/sample.hpp"

namespace ayumi {

namespace {

constexpr double kStep = 1.25;    // while it gets faster
constexpr double kSlower = 1.05;  // what passes may end soon: motors warm up where a pose lasts
constexpr double kMuchSlower = 3;
constexpr double kOfSpeed = 0.8;  // of the way to where a speed that is too high would do
constexpr double kLook = 1.005;   // from scale to scale beyond an edge
constexpr int kLooks = 40;

struct Trial {
  bool passes = false;
  std::string reason;    // why not
  double too_quick = 1;  // largest joint speed over its limit
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
        failing = std::max(options_.fastest, passing / kStep);
        if (passing <= options_.fastest) break;
      } while (trial(failing).passes);
      result.bounded = passing > options_.fastest;
    } else {
      reason_ = now.reason;
      result.by_posture = now.of_posture && pattern_.table;
      if (result.by_posture) return finish(result);
      do {
        failing = passing;
        passing *=
            std::max(passing < kMuchSlower ? kSlower : kStep, 1 + kOfSpeed * (now.too_quick - 1));
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
      for (failing = passing / kLook; failing > options_.fastest && trial(failing).passes;
           failing /= kLook)
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

  // The least passing scale between one that passes and one that does not.
  double edge(double passing, double failing) {
    while (passing / failing > 1 + options_.resolution) {
      const double middle = std::sqrt(passing * failing);
      (trial(middle).passes ? passing : failing) = middle;
    }
    return passing;
  }

  // What breaks may hold again a little faster (samples fall otherwise on the edges of flights):
  // the fastest scale of the next ones that passes, 0 when none does. The reason stays that of the
  // edge.
  double beyond(double passing) {
    const std::string reason = reason_;
    double found = 0, scale = passing;
    for (int i = 0; i < kLooks && scale / kLook > options_.fastest; ++i) {
      scale /= kLook;
      if (trial(scale).passes) found = scale;
    }
    reason_ = reason;
    return found;
  }

  // Three decimals for people, four of short times, where they pass too.
  double rounded(double scale) {
    const double digits = scale < 0.5 ? 1e4 : 1e3;
    const double up = std::ceil(digits * scale) / digits;
    return up != scale && trial(up).passes ? up : scale;
  }

  Trial trial(double scale) {
    report(progress_, {"retime", -1, "scale " + text::fixed(scale, 4)});
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
    const Finding* told = nullptr;
    for (const Finding& f : check.findings) {
      if (f.severity != Severity::error) continue;
      if (f.kind == FindingKind::joint_speed)
        trial.too_quick = std::max(trial.too_quick, std::abs(f.worst) / f.limit);
      if (!told || (is_of_posture(f) && !trial.of_posture)) told = &f;
      trial.of_posture = is_of_posture(*told);
    }
    reason_ = std::string(name_of(told->kind)) + " " + told->where + " at " +
              text::fixed(told->at, 3) + " s of " + text::fixed(duration, 3) +
              " s: " + text::brief(told->worst) + " " + told->unit + ", limit " +
              text::brief(told->limit);
    trial.reason = reason_;
    return trial;
  }

  const RobotModel& model_;
  const Pattern& pattern_;
  const RetimeOptions& options_;
  const Progress& progress_;
  std::string reason_;  // of the last scale that failed
  int evaluations_ = 0;
};

}  // namespace

FastestPace fastest_pace(const RobotModel& model, const Pattern& pattern,
                         const RetimeOptions& options, const Progress& progress) {
  return PaceSearch(model, pattern, options, progress).run();
}

}  // namespace ayumi
