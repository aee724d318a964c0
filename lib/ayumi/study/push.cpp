// For each phase and controller one baseline runs up to just before the push and is copied for
// every push. Level i is an impulse of i step B, with B the capture bound. A level is survived when
// the nominal push and all its variations are survived. The search probes, narrows [survived,
// failed] to one step, then tries levels below it that were skipped; a failure there moves the
// limit down. A run counts as survived as soon as the DCM has stayed near the plan for kNearTime;
// at the limit itself the nominal run continues to its end.
#include "ayumi/study/push.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>

#include "ayumi/base/text.hpp"
#include "ayumi/control/capture_bound.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/math/random.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/sim/simulator.hpp"
#include "ayumi/study/runs.hpp"

namespace ayumi {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// Distance of the DCM from the plan, in units of z, below which a run is near the plan. Chosen: 10
/// mm for z = 0.22 m, a third of the half-width of HOAP-1's sole. Half: push while walking,
/// recovery [s] 0.019 to 0.054; twice: push while standing, recovery [s] 0.019 to 0.
constexpr double kNearPlan = 0.045;
/// Time from the push before which a DCM near the plan does not show that the robot survives [s].
/// Chosen: 5 / omega for z = 0.22 m, after which an error that grows has grown by a factor of 150.
/// No measured case changes from half to twice (constants.md).
constexpr double kSettlingTime = 0.8;
/// Time for which the DCM has to stay near the plan [s]. Chosen: 2 / omega for z = 0.22 m, in which
/// an error that grows leaves the neighbourhood of the plan. No measured case changes from half to
/// twice (constants.md).
constexpr double kNearTime = 0.3;
/// Tilt beyond which a stance foot is tilted [rad]. Chosen: above the tilt that the compliance of a
/// loaded sole allows. No measured case changes from half to twice (constants.md).
constexpr double kTiltedFoot = 2 * M_PI / 180;
/// Directions in which the nearest edge of the support is searched. Chosen: one every 5 degrees;
/// the distance is then at most 0.1 % too large. No measured case changes from half to twice
/// (constants.md).
constexpr int kEdgeDirections = 72;
/// Ticks between two tests of a run. Chosen: 10 ms, short against 1/omega. No measured case changes
/// from half to twice (constants.md).
constexpr long kTicksPerTest = 10;

double near_distance(const Simulator& run) {
  const CommandSample& cmd = run.plan();
  return kNearPlan * (cmd.cog.z() - cmd.zmp.z());
}

/// A simulator just before the pushes of a phase, and whether the robot stands without a push.
struct PushBaseline {
  std::optional<Simulator> simulator;
  bool stands = false;
};

/// The search of one limit.
class Search {
 public:
  Search(const PushBaseline& baseline, const PushOptions& options, const PushCase& push, double dt,
         bool plan_moves, std::uint64_t seed, const std::atomic<bool>& stop)
      : baseline_(baseline),
        options_(options),
        case_(push),
        dt_(dt),
        plan_moves_(plan_moves),
        stop_(stop) {
    Random random(seed);
    const auto spread = [&](double width) { return width * (2 * random.uniform() - 1); };
    variations_.push_back({0, 0});
    for (int i = 0; i < options.replicas; ++i) {
      const double time = spread(options.time_spread);
      variations_.push_back({time, spread(options.direction_spread)});
    }
  }

  PushLimit find(int guess);

 private:
  struct Variation {
    double time, angle;
  };
  Simulator pushed(double impulse, const Variation& variation) const;
  bool comes_near(Simulator& run);
  bool survives(Simulator& run);
  bool survives(int level);
  bool survives_to_the_end(int level);
  PushFigures figures();
  double impulse(int level) const { return level * options_.step * case_.bound; }

  const PushBaseline& baseline_;
  const PushOptions& options_;
  const PushCase& case_;
  double dt_;
  bool plan_moves_;  // the plan follows the robot, so that nearness to it shows nothing
  const std::atomic<bool>& stop_;
  std::vector<Variation> variations_;
  std::map<int, bool> tried_;
  std::optional<std::pair<int, Simulator>> nominal_;  // the last that survived, by level
  int runs_ = 0;
};

Simulator Search::pushed(double impulse, const Variation& variation) const {
  Simulator run = *baseline_.simulator;
  const double angle = case_.direction + variation.angle;
  const Push push{.magnitude = impulse,
                  .direction = {elementary::cos(angle), elementary::sin(angle), 0}};
  run.set_scenario(
      {{.at = case_.phase.at + variation.time, .duration = options_.duration, .what = push}});
  return run;
}

// Goes on until the run shows that the robot survives, or to its end.
bool Search::comes_near(Simulator& run) {
  double near_since = -1;
  while (run.advance(kTicksPerTest) && !run.fell()) {
    if (stop_) throw Interrupted();
    if (plan_moves_ || run.time() < case_.phase.at + kSettlingTime) continue;
    if (divergence(run) > near_distance(run))
      near_since = -1;
    else if (near_since < 0)
      near_since = run.time();
    else if (run.time() - near_since > kNearTime)
      return true;
  }
  return false;
}

// To its end.
bool Search::survives(Simulator& run) {
  while (run.advance(kTicksPerTest) && !run.fell())
    if (stop_) throw Interrupted();
  return !run.fell() && run.result().outcome == Outcome::stands;
}

bool Search::survives(int level) {
  const auto found = tried_.find(level);
  if (found != tried_.end()) return found->second;
  bool all = true;
  for (size_t i = 0; all && i < variations_.size(); ++i) {
    Simulator run = pushed(impulse(level), variations_[i]);
    ++runs_;
    all = comes_near(run) || survives(run);
    if (all && i == 0) nominal_ = {level, std::move(run)};
  }
  return tried_[level] = all;
}

// The nominal push. Goes on with the run that came near the plan, where that is the last one.
bool Search::survives_to_the_end(int level) {
  if (!nominal_ || nominal_->first != level)
    nominal_ = {level, pushed(impulse(level), variations_[0])};
  ++runs_;
  return survives(nominal_->second);
}

PushFigures Search::figures() {
  PushFigures f;
  Simulator run = pushed(options_.reference_level * case_.bound, {0, 0});
  ++runs_;
  const double end = case_.phase.at + options_.duration;
  double far = end;
  while (run.advance(1) && !run.fell()) {
    if (stop_) throw Interrupted();
    if (run.last_estimate().foot_tilt.norm() > kTiltedFoot) f.foot_tilt += dt_;
    if (divergence(run) > near_distance(run)) far = run.time();
  }
  f.survives = !run.fell() && run.result().outcome == Outcome::stands;
  f.recovery = std::max(0.0, far - end);
  f.trunk_tilt = run.result().max_tilt;
  return f;
}

PushLimit Search::find(int guess) {
  PushLimit limit;
  if (!baseline_.stands || case_.bound <= 0) return limit;
  const int cap = std::max(1, static_cast<int>(std::lround(options_.cap / options_.step)));
  tried_[0] = true;
  int probe = guess, stride = 3, verified = 0;
  for (;;) {
    int low = 0, high = cap + 1;
    for (const auto& [level, survived] : tried_) {
      if (!survived) {
        high = level;
        break;
      }
      low = level;
    }
    if (high - low > 1) {
      const bool open = high == cap + 1;
      if (probe <= low || probe >= high)
        probe = open ? low + stride : low == 0 ? high - stride : (low + high) / 2;
      if (open || low == 0) stride *= 2;
      probe = std::clamp(probe, low + 1, high - 1);
      survives(probe);
      continue;
    }
    limit.impulse = impulse(low);
    limit.capped = high == cap + 1;
    if (low == 0) break;
    if (verified != low) {
      verified = low;
      tried_[low] = survives_to_the_end(low);
      if (!tried_[low]) continue;
    }
    bool prefix = true;
    for (int level : {low - 1, 3 * low / 4, low / 2})
      prefix = prefix && (level <= 0 || survives(level));
    if (prefix) break;
  }
  limit.moderate = figures();
  limit.runs = runs_;
  return limit;
}

void check_options(const PushOptions& options, const CommandSeries& series) {
  const auto refuse = [](const std::string& text) { fail(ErrorCode::usage, "push: " + text); };
  if (series.samples.empty())
    fail(ErrorCode::bad_pattern, "the motion has no samples; sample a pattern first");
  if (options.directions < 1 || options.directions > 360)
    refuse("directions: " + std::to_string(options.directions) + "; give 1 to 360");
  if (!(options.step > 0) || !(options.cap >= options.step))
    refuse("the resolution of the search must be above 0 and at most the largest push (--cap)");
  if (options.replicas < 0) refuse("the number of replicas must not be negative");
  for (const PushPhase& phase : options.phases)
    if (!phase.standing && !(phase.at >= options.time_spread + series.dt &&
                             phase.at + options.duration <= series.duration()))
      refuse("time " + text::brief(phase.at) + " s is outside the pattern (0 to " +
             text::brief(series.duration()) + " s)");
}

/// Data that the jobs of a study share.
struct Study {
  const RobotModel& model;
  const CommandSeries& series;
  const PushOptions& options;
  CommandSeries stand;
  std::vector<PushPhase> phases;
  std::vector<ControllerSpec> controllers;  // open loop first
  std::vector<PushBaseline> baselines;      // phase by phase, controller by controller
  std::atomic<bool> stop = false;

  const CommandSeries& series_of(const PushPhase& phase) const {
    return phase.standing ? stand : series;
  }
  void run_baseline(size_t i);
  PushCase plan(size_t i) const;
  double standing_edge_bound() const;
  bool plan_moves(const ControllerSpec& controller) const;
  void search(size_t i, PushCase& found);
};

void Study::run_baseline(size_t i) {
  const PushPhase& phase = phases[i / controllers.size()];
  SimulateOptions simulate = options.simulate;
  simulate.controller = controllers[i % controllers.size()];
  simulate.scenario.clear();
  Simulator run(model, series_of(phase), simulate);
  run.keep_samples(false);
  const long before = static_cast<long>((phase.at - options.time_spread) / series.dt) - 1;
  run.advance(before);
  baselines[i].simulator = run;
  while (run.advance(kTicksPerTest) && !run.fell())
    if (stop) throw Interrupted();
  baselines[i].stands = !run.fell() && run.result().outcome == Outcome::stands;
}

// VIIP chooses its footholds, so that there are no planned ones. The bound is then the distance to
// the nearest edge of the support at the start of the pattern, the same for every direction.
double Study::standing_edge_bound() const {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kEdgeDirections; ++i) {
    const double angle = 2 * M_PI * i / kEdgeDirections;
    least = std::min(least,
                     edge_bound(model, stand, 0, {elementary::cos(angle), elementary::sin(angle)}));
  }
  return least;
}

PushCase Study::plan(size_t i) const {
  const size_t directions = static_cast<size_t>(options.directions);
  PushCase result;
  result.phase = phases[i / directions];
  result.direction = 2 * M_PI * static_cast<double>(i % directions) / options.directions;
  const Vector2d u(elementary::cos(result.direction), elementary::sin(result.direction));
  const CommandSeries& plan = series_of(result.phase);
  const long k = std::lround(result.phase.at / plan.dt);
  result.bound = capture_bound(capture_region(model, plan, k), u);
  result.edge_bound = edge_bound(model, plan, k, u);
  const CommandSample& now =
      plan.samples[std::min(static_cast<size_t>(k), plan.samples.size() - 1)];
  result.mass = model.mass();
  result.height = now.cog.z() - now.zmp.z();
  if (!series.viip.empty()) result.bound = result.edge_bound = standing_edge_bound();
  return result;
}

bool Study::plan_moves(const ControllerSpec& controller) const {
  return !series.viip.empty() ||
         (has_dtad_gains(controller.type.kind) && dtad_params(model, controller).moves_footholds());
}

void Study::search(size_t i, PushCase& found) {
  const size_t phase = i / static_cast<size_t>(options.directions);
  for (size_t c = 0; c < controllers.size(); ++c) {
    const PushBaseline& baseline = baselines[phase * controllers.size() + c];
    Search search(baseline, options, found, series.dt, plan_moves(controllers[c]),
                  options.simulate.seed + 1000 * i, stop);
    const PushLimit limit =
        search.find(static_cast<int>(std::lround((c == 0 ? 0.8 : 1.2) / options.step)));
    if (c == 0)
      found.open_loop = limit;
    else
      found.limits.push_back(limit);
  }
}

}  // namespace

std::vector<PushCase> push_limits(const RobotModel& model, const CommandSeries& series,
                                  const PushOptions& options, const KnownCases& known,
                                  const PushCaseDone& done, const Progress& progress) {
  check_options(options, series);
  // Phases and open loop use the gains of the gait that is studied, since these set the step times.
  const auto gait =
      std::find_if(options.controllers.begin(), options.controllers.end(),
                   [](const ControllerSpec& c) { return c.type == ControllerKind::viip; });
  ControllerSpec open{ControllerKind::none, {}};
  if (!series.viip.empty()) {
    open.type = {ControllerKind::viip, Demonstration::no_feedback};
    if (gait != options.controllers.end()) open.gains = gait->gains;
  }
  Study study{model, series, options, standing_series(series), options.phases, {open}, {}};
  SimulateOptions simulate = options.simulate;
  if (gait != options.controllers.end()) simulate.controller = *gait;
  if (study.phases.empty()) study.phases = default_push_phases(model, series, simulate);
  for (const ControllerSpec& c : options.controllers) study.controllers.push_back(c);
  const size_t count = study.phases.size() * static_cast<size_t>(options.directions);
  const bool all_known =
      known.size() == count &&
      std::all_of(known.begin(), known.end(), [](const auto& c) { return c.has_value(); });
  std::mutex mutex;
  size_t finished = 0;
  const auto report_progress = [&](const std::string& what) {
    report(progress, {"push", static_cast<double>(finished) / static_cast<double>(count), what});
  };
  if (!all_known) {
    study.baselines.resize(study.phases.size() * study.controllers.size());
    in_parallel(study.baselines.size(), options.threads, study.stop, [&](size_t i) {
      study.run_baseline(i);
      const std::lock_guard lock(mutex);
      report_progress("baselines");
    });
  }
  std::vector<PushCase> cases(count);
  in_parallel(count, options.threads, study.stop, [&](size_t i) {
    const bool have = i < known.size() && known[i];
    cases[i] = have ? *known[i] : study.plan(i);
    if (!have) study.search(i, cases[i]);
    const std::lock_guard lock(mutex);
    ++finished;
    if (!have && done) done(i, cases[i]);
    report_progress(std::to_string(finished) + " of " + std::to_string(count) + " cases");
  });
  return cases;
}

double push_speed(const PushCase& push, double impulse) { return impulse / push.mass; }

double push_froude(const PushCase& push, double impulse) {
  return push_speed(push, impulse) / std::sqrt(kGravity * push.height);
}

PushSummary summarize(const std::vector<PushCase>& cases, size_t c, bool standing, double step) {
  PushSummary s;
  s.worst = s.open_worst = s.worst_speed = s.worst_froude = std::numeric_limits<double>::infinity();
  for (const PushCase& push : cases) {
    if (push.phase.standing != standing || push.bound <= 0) continue;
    const double ratio = push.limits.at(c).impulse / push.bound;
    const double open = push.open_loop.impulse / push.bound;
    const double speed = push_speed(push, push.limits[c].impulse);
    const double froude = push_froude(push, push.limits[c].impulse);
    s.worst_speed = std::min(s.worst_speed, speed);
    s.worst_froude = std::min(s.worst_froude, froude);
    s.mean_speed += speed;
    s.mean_froude += froude;
    s.worst = std::min(s.worst, ratio);
    s.open_worst = std::min(s.open_worst, open);
    s.mean += ratio;
    s.open_mean += open;
    s.below_open += ratio < open - 1.001 * step;
    ++s.cases;
  }
  if (s.cases == 0) return {};
  s.mean /= s.cases;
  s.open_mean /= s.cases;
  s.mean_speed /= s.cases;
  s.mean_froude /= s.cases;
  return s;
}

}  // namespace ayumi
