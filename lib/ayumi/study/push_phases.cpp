// The default phases of a push study: those of the middle step of a pattern or of the steps that
// VIIP makes.
#include <cmath>

#include "ayumi/sim/simulator.hpp"
#include "ayumi/study/push.hpp"
#include "ayumi/study/runs.hpp"

namespace ayumi {

namespace {

/// A single support on the left foot.
struct Interval {
  size_t before, begin, end;  // start of the double support before it, then its own start and end
};

std::vector<Interval> left_steps(const CommandSeries& series) {
  const std::vector<CommandSample>& s = series.samples;
  std::vector<Interval> steps;
  for (size_t k = 1; k < s.size(); ++k) {
    if (s[k].support != Support::left || s[k - 1].support != Support::both) continue;
    Interval step{k - 1, k, k};
    while (step.before > 0 && s[step.before - 1].support == Support::both) --step.before;
    while (step.end < s.size() && s[step.end].support == Support::left) ++step.end;
    steps.push_back(step);
  }
  return steps;
}

/// The series in which the supports are those of the steps that VIIP makes.
CommandSeries with_viip_supports(const RobotModel& model, const CommandSeries& series,
                                 const SimulateOptions& options) {
  SimulateOptions simulate = options;
  if (simulate.controller.type != ControllerKind::viip)
    simulate.controller = {ControllerKind::viip, {}};
  simulate.scenario.clear();
  Simulator run(model, series, simulate);
  run.keep_samples(false);
  CommandSeries result = series;
  for (CommandSample& s : result.samples) {
    run.advance(1);
    s.support = run.plan().support;
  }
  return result;
}

}  // namespace

std::vector<PushPhase> default_push_phases(const RobotModel& model, const CommandSeries& given,
                                           const SimulateOptions& options) {
  const bool goals = !given.viip.empty();
  const CommandSeries series = goals ? with_viip_supports(model, given, options) : given;
  const std::vector<CommandSample>& s = series.samples;
  const std::vector<Interval> steps = left_steps(series);
  std::vector<PushPhase> phases = {{"standing", kStandingPush, true}};
  if (steps.empty()) {
    const double middle = series.dt * std::floor(static_cast<double>(s.size() - 1) / 2);
    phases.push_back({"middle", middle, false});
    return phases;
  }
  const Interval& step = steps[steps.size() / 2];
  const auto time = [&](size_t from, size_t to, double share) {
    return series.dt *
           std::round(static_cast<double>(from) + share * static_cast<double>(to - from));
  };
  phases.push_back({"mid double support", time(step.before, step.begin, 0.5), false});
  if (goals) {
    phases.erase(phases.begin());
    phases.push_back({"single support 25 %", time(step.begin, step.end, 0.25), false});
    phases.push_back({"single support 75 %", time(step.begin, step.end, 0.75), false});
    return phases;
  }
  phases.push_back({"single support 11 %", time(step.begin, step.end, 0.11), false});
  phases.push_back({"single support 44 %", time(step.begin, step.end, 0.44), false});
  phases.push_back({"single support 78 %", time(step.begin, step.end, 0.78), false});
  return phases;
}

}  // namespace ayumi
