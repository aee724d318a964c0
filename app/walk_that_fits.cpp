#include "walk_that_fits.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/check/consistency.hpp"
#include "ayumi/limits/limit.hpp"
#include "ayumi/plan/sample.hpp"

namespace ayumi::app {

namespace {

// Whether no joint and no servo target exceeds its limits, no bodies collide, and the feet are in
// their places and within reach.
bool posture_fits(const RobotModel& model, const WalkParameters& walk) {
  // Sample period [s]. Chosen: only postures are judged, 45 of them in a swing of 0.45 s.
  constexpr double kTick = 0.01;
  try {
    const ConsistencyReport report =
        check_consistency(model, sample(model, walk_pattern(model, walk), {.dt = kTick}));
    return std::none_of(report.findings.begin(), report.findings.end(), [](const Finding& f) {
      return f.severity == Severity::error &&
             (is_of_posture(f) || f.kind == FindingKind::table_position);
    });
  } catch (const Error& error) {
    if (error.code() == ErrorCode::internal) throw;
    return false;
  }
}

}  // namespace

std::string what_fits(const RobotModel& model, const WalkParameters& asked) {
  struct Measure {
    double WalkParameters::*value;
    const char* option;
    double unit, step;
  };
  if (posture_fits(model, asked)) return "";
  for (const Measure& m : {Measure{&WalkParameters::side, "--side", 1, 1e-3},
                           Measure{&WalkParameters::turn, "--turn", std::numbers::pi / 180, 0.5}}) {
    const double given = asked.*m.value / m.unit;
    int fits = 0, fails = static_cast<int>(std::ceil(std::abs(given) / m.step));
    WalkParameters walk = asked;
    const auto at = [&](int steps) {
      walk.*m.value = std::copysign(steps * m.step, given) * m.unit;
      return posture_fits(model, walk);
    };
    if (fails == 0 || !at(0)) continue;
    while (fails - fits > 1) {
      const int middle = (fits + fails) / 2;
      (at(middle) ? fits : fails) = middle;
    }
    return std::string(m.option) + " " + text::brief(std::copysign(fits * m.step, given)) +
           " is the most that the legs can reach";
  }
  return "";
}

}  // namespace ayumi::app
