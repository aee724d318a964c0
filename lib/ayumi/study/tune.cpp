#include "ayumi/study/tune.hpp"

#include <charconv>
#include <cmath>

#include "ayumi/base/text.hpp"
#include "ayumi/control/capture_bound.hpp"
#include "ayumi/control/gain_design.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/study/runs.hpp"

namespace ayumi {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// Part of the objective for a push that fells the robot. Chosen: far above the part of a push that
/// is survived (about 1), so that the search avoids falls first. No measured case changes between
/// half and twice the value (constants.md).
constexpr double kFall = 10;
/// Relative improvement of the objective that a step needs. Chosen: a smaller improvement is not
/// worth a change of the gains. No measured case changes between half and twice the value
/// (constants.md).
constexpr double kImprovement = 1e-3;
/// Time before its push at which a branch begins [s]. Chosen: as short as 20 ticks. The runs are
/// equal up to the push, so that the objective changes only in its eighth digit. Between half and
/// twice the value, figures change by less than 5 %.
constexpr double kBranchLead = 0.02;
/// Factor below which the search ends. Chosen: three square roots of the default factor 1.3 give
/// 1.033, so the search continues for three rounds without an improvement. No measured case changes
/// between half and twice the value (constants.md).
constexpr double kSmallestFactor = 1.03;

using Gains = std::map<std::string, double>;

/// The gains that may be tuned, with their present values.
Gains tunable(const DtadParams& p) {
  return {{"q", p.pole_ratio},        {"ka", p.zmp_gain},       {"ks", p.pull_rate},
          {"kd", p.pull_damping},     {"tau_z", p.zmp_filter},  {"washout", p.offset_time},
          {"kz", p.height_stiffness}, {"dz", p.height_damping}, {"kaz", p.fz_gain},
          {"ankle", p.ankle_share},   {"conform", p.compliance}};
}

double height(const CommandSample& command) { return command.cog.z() - command.zmp.z(); }

struct Tuner {
  const RobotModel& model;
  const CommandSeries& series;
  const TuneOptions& options;
  CommandSeries stand;
  std::vector<PushPhase> phases;
  std::vector<LoopModel> loops;
  std::atomic<bool> stop = false;

  ControllerSpec controller(const Gains& gains) const;
  bool stable(const Gains& gains) const {
    return weakest_loop(loops, dtad_params(model, controller(gains))).analysis.stable;
  }
  const CommandSeries& series_of(const PushPhase& phase) const {
    return phase.standing ? stand : series;
  }
  Simulator begin(const PushPhase& phase, const Gains& gains) const;
  double push(const Simulator& baseline, const PushPhase& phase, int direction) const;
  double unpushed(const Gains& gains) const;
  TuneFigures evaluate(const Gains& gains);
};

ControllerSpec Tuner::controller(const Gains& gains) const {
  ControllerSpec spec = options.simulate.controller;
  for (const auto& [name, value] : gains) {
    std::erase_if(spec.gains, [&, &n = name](const auto& entry) { return entry.first == n; });
    spec.gains.emplace_back(name, value);
  }
  return spec;
}

Simulator Tuner::begin(const PushPhase& phase, const Gains& gains) const {
  SimulateOptions simulate = options.simulate;
  simulate.controller = controller(gains);
  simulate.scenario.clear();
  Simulator run(model, series_of(phase), simulate);
  run.keep_samples(false);
  run.advance(std::max(0l, std::lround((phase.at - kBranchLead) / series.dt)));
  return run;
}

/// omega times the integral of |DCM - planned DCM| / z, or kFall if the robot fell.
double Tuner::push(const Simulator& baseline, const PushPhase& phase, int direction) const {
  const double angle = 2 * M_PI * direction / options.directions;
  const CommandSeries& plan = series_of(phase);
  const Vector2d u(elementary::cos(angle), elementary::sin(angle));
  const long k = std::lround(phase.at / plan.dt);
  const double bound = capture_bound(capture_region(model, plan, k), u);
  if (!(bound > 0)) return 0;
  Simulator run = baseline;
  const Push push{.magnitude = options.level * bound, .direction = {u.x(), u.y(), 0}};
  run.set_scenario({{.at = phase.at, .duration = options.duration, .what = push}});
  double sum = 0;
  const double end = phase.at + options.duration + options.watched;
  while (run.time() < end && run.advance(1) && !run.fell()) {
    if (stop) throw Interrupted();
    const double z = height(run.command(run.tick() - 1));
    sum += std::sqrt(kGravity / z) * plan.dt * divergence(run) / z;
  }
  return run.fell() ? kFall : sum;
}

double Tuner::unpushed(const Gains& gains) const {
  SimulateOptions simulate = options.simulate;
  simulate.controller = controller(gains);
  simulate.scenario.clear();
  Simulator run(model, series, simulate);
  run.keep_samples(false);
  double sum = 0;
  long ticks = 0;
  for (; run.advance(1) && !run.fell(); ++ticks) {
    if (stop) throw Interrupted();
    const SimulationSample& s = run.last_sample();
    sum += (s.measured_zmp - s.reference_zmp).head<2>().norm() / height(run.command(ticks));
  }
  return run.fell() ? kFall : sum / static_cast<double>(std::max(1l, ticks));
}

TuneFigures Tuner::evaluate(const Gains& gains) {
  std::vector<std::optional<Simulator>> baselines(phases.size());
  double unpushed_cost = 0;
  in_parallel(phases.size() + 1, options.threads, stop, [&](size_t i) {
    if (i == phases.size())
      unpushed_cost = unpushed(gains);
    else
      baselines[i] = begin(phases[i], gains);
  });
  const size_t directions = static_cast<size_t>(options.directions);
  std::vector<double> costs(phases.size() * directions);
  in_parallel(costs.size(), options.threads, stop, [&](size_t i) {
    costs[i] =
        push(*baselines[i / directions], phases[i / directions], static_cast<int>(i % directions));
  });
  TuneFigures f;
  f.pushes = static_cast<int>(costs.size());
  for (const double cost : costs) {
    if (cost >= kFall)
      ++f.falls;
    else
      f.recovery += cost;
  }
  f.recovery /= f.pushes;
  f.unpushed = unpushed_cost;
  f.objective = f.recovery + kFall * f.falls / f.pushes + f.unpushed;
  return f;
}

void check(const TuneOptions& options, const CommandSeries& series, const Gains& known) {
  const auto refuse = [](const std::string& why) { fail(ErrorCode::usage, "tune: " + why); };
  if (series.samples.empty())
    fail(ErrorCode::bad_pattern, "the motion has no samples. Sample a pattern first");
  if (options.simulate.controller.type != ControllerKind::dtad)
    refuse("controller '" + name_of(options.simulate.controller.type) +
           "' has no gains to tune. Use dtad");
  require_within("tune: the number of directions", options.directions, PushOptions::kDirections);
  require_within("tune: the size of a push", options.level, TuneOptions::kLevel);
  if (!(options.factor > 1)) refuse("factor must exceed 1");
  require_within("tune: the number of rounds", options.rounds, TuneOptions::kRounds);
  require_within("tune: the number of threads", options.threads, kThreadBounds);
  if (options.gains.empty()) refuse("give at least one gain");
  std::vector<std::string> names;
  for (const auto& [name, value] : known) names.push_back(name);
  for (const std::string& name : options.gains)
    if (!known.count(name))
      refuse("gain '" + name + "' cannot be tuned" + text::suggestion(name, names) +
             " (gains that can be tuned: " + text::join(names, ", ") + ")");
  for (const PushPhase& phase : options.phases)
    if (!phase.standing &&
        !(phase.at >= kBranchLead && phase.at + options.duration <= series.duration()))
      refuse("a push at " + text::brief(phase.at) + " s is not possible. Give a time from " +
             text::brief(kBranchLead) + " to " + text::brief(series.duration() - options.duration) +
             " s");
}

/// The value with four digits, as a person writes it into a file.
double rounded(double value) {
  const std::string digits = text::brief(value);
  std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return value;
}

}  // namespace

TuneResult tune_gains(const RobotModel& model, const CommandSeries& series,
                      const TuneOptions& options, const Progress& progress) {
  const Gains known = tunable(dtad_params(model, options.simulate.controller));
  check(options, series, known);
  Tuner tuner{.model = model,
              .series = series,
              .options = options,
              .stand = standing_series(series),
              .phases = options.phases,
              .loops = stance_loops(model, model.limits(options.simulate.profile),
                                    height(series.samples.front()), series.dt)};
  if (tuner.phases.empty()) tuner.phases = default_push_phases(model, series, options.simulate);
  TuneResult result;
  for (const std::string& name : options.gains) result.start[name] = known.at(name);
  refuse_unstable(tuner.loops, dtad_params(model, tuner.controller(result.start)));
  result.gains = result.start;
  result.before = result.after = tuner.evaluate(result.start);
  if (result.before.unpushed >= kFall)
    fail(ErrorCode::usage,
         "tune: with the initial gains the robot falls without a push. Start from other gains");

  double factor = options.factor;
  for (int round = 0; round < options.rounds && factor > kSmallestFactor; ++round) {
    bool better = false;
    for (const std::string& name : options.gains) {
      const double before = result.gains[name];
      for (const double value : {rounded(before * factor), rounded(before / factor)}) {
        Gains gains = result.gains;
        gains[name] = value;
        if (value == before) continue;
        if (!tuner.stable(gains)) {
          ++result.refused;
          continue;
        }
        const TuneFigures figures = tuner.evaluate(gains);
        ++result.choices;
        report(progress, {"tuning", static_cast<double>(round) / options.rounds,
                          "objective " + text::fixed(figures.objective, 4) + " with " + name +
                              " = " + text::brief(value)});
        if (figures.objective > (1 - kImprovement) * result.after.objective) continue;
        result.gains = gains;
        result.after = figures;
        better = true;
        break;
      }
    }
    if (!better) factor = std::sqrt(factor);
  }
  return result;
}

}  // namespace ayumi
