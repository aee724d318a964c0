// For each controller, one baseline runs without a push. Just before the pushes of each phase it is
// copied, and every push of that phase continues from the copy. Level i is an impulse of i step B,
// where B is the capture bound. A level is survived if the nominal push and all its variations are
// survived. The search first probes levels, narrows [survived, failed] to one step, and then tries
// levels below it that were skipped; a failure there moves the limit down. A run counts as survived
// as soon as it is in the set around the baseline from which the robot stands (study/recorded_run);
// a run that does not get there continues to its end.
#include "ayumi/study/push.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <mutex>

#include "ayumi/base/text.hpp"
#include "ayumi/control/capture_bound.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/math/random.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/sim/simulator.hpp"
#include "ayumi/study/recorded_run.hpp"
#include "ayumi/study/runs.hpp"

namespace ayumi {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// Distance of the DCM from the plan, in units of z, below which a robot has recovered. Chosen: 10
/// mm for z = 0.22 m, a third of the half-width of HOAP-1's sole. With half of the value, the
/// recovery in the push while walking takes 0.054 s instead of 0.019 s; with twice, the recovery in
/// the push while standing takes 0 s instead of 0.019 s.
constexpr double kNearPlan = 0.045;
/// Size of the inner part of the set around the unpushed run, as a share of the set. Measured in 12
/// motions without sensor noise and with pushes of up to 2.2 B: in one motion, runs that have been
/// in this part leave the whole set later, by at most 0.56 of its bounds. In the other motions,
/// such runs stay inside 0.83 of the set (docs/measurements/pushes.md, "Early verdicts").
constexpr double kWellInside = 1.0 / 3;
/// Tilt beyond which a stance foot is tilted [rad]. Chosen: above the tilt that the compliance of a
/// loaded sole allows. No measured case changes between half and twice the value (constants.md).
constexpr double kTiltedFoot = 2 * M_PI / 180;
/// Directions in which the nearest edge of the support is searched. Chosen: one every 5 degrees;
/// the distance is then at most 0.1 % too large. No measured case changes between half and twice
/// the value (constants.md).
constexpr int kEdgeDirections = 72;
/// Level at which the search begins, in capture bounds. Chosen: near the limits of HOAP-1 and
/// humanoid30 (docs/measurements/pushes.md). It changes the number of runs, and it changes a limit
/// only if a robot survives a push but not a smaller one.
constexpr double kGuess = 1.2;
constexpr double kOpenLoopGuess = 0.4;
constexpr double kStandingOpenLoopGuess = 1.0;
/// First step away from that level with control, in levels; in open loop it is 1. Chosen: limits
/// with control lie farther apart.
constexpr int kStride = 3;
/// Ticks between two tests of a run. Chosen: 10 ms, short against 1/omega. No measured case changes
/// between half and twice the value (constants.md).
constexpr long kTicksPerTest = 10;

double near_distance(const Simulator& run) {
  const CommandSample& cmd = run.plan();
  return kNearPlan * (cmd.cog.z() - cmd.zmp.z());
}

/// A whole run without a push.
struct Unpushed {
  RecordedRun states;
  // Values by tick, each of which is the largest from this tick on.
  std::vector<double> divergence = {};  // distance of the DCM in units of z
  std::vector<double> foot_tilt = {};   // tilt of the stance foot [rad]
  double trunk_tilt = 0;                // largest tilt of the trunk in the whole run [rad]
};

/// A simulator just before the pushes of a phase, the course of the run without a push, and whether
/// the robot then stands.
struct PushBaseline {
  std::optional<Simulator> simulator;
  std::shared_ptr<const Unpushed> unpushed;
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

  PushLimit find(int guess, int stride);

 private:
  struct Variation {
    double time, angle;
  };
  Simulator pushed(double impulse, const Variation& variation) const;
  bool survives(Simulator& run);
  bool survives(int level);
  bool is_decided(const Simulator& run) const;
  PushFigures figures();
  double impulse(int level) const { return level * options_.step * case_.bound; }

  const PushBaseline& baseline_;
  const PushOptions& options_;
  const PushCase& case_;
  double dt_;
  bool plan_moves_;  // the plan follows the robot, so that a small distance from it shows nothing
  const std::atomic<bool>& stop_;
  std::vector<Variation> variations_;
  std::map<int, bool> tried_;
  size_t hardest_ = 0;  // the variation that failed last is tried first
  int runs_ = 0;
};

Simulator Search::pushed(double impulse, const Variation& variation) const {
  Simulator run = *baseline_.simulator;
  run.gather_verdict_only();
  const double angle = case_.direction + variation.angle;
  const Push push{.magnitude = impulse,
                  .direction = {elementary::cos(angle), elementary::sin(angle), 0}};
  run.set_scenario(
      {{.at = case_.phase.at + variation.time, .duration = options_.duration, .what = push}});
  return run;
}

// Simulates until the run is in the set from which the robot stands, or until its end.
bool Search::survives(Simulator& run) {
  const double after = case_.phase.at + options_.time_spread + options_.duration;
  while (run.advance(kTicksPerTest) && !run.fell()) {
    if (stop_) throw Interrupted();
    if (!plan_moves_ && run.time() > after && baseline_.unpushed->states.contains(run)) return true;
  }
  return !run.fell() && run.result().outcome == Outcome::stands;
}

bool Search::survives(int level) {
  const auto found = tried_.find(level);
  if (found != tried_.end()) return found->second;
  std::vector<size_t> order = {hardest_};
  for (size_t i = 0; i < variations_.size(); ++i)
    if (i != hardest_) order.push_back(i);
  for (const size_t i : order) {
    Simulator run = pushed(impulse(level), variations_[i]);
    ++runs_;
    if (survives(run)) continue;
    hardest_ = i;
    return tried_[level] = false;
  }
  return tried_[level] = true;
}

// Whether the figures of a run do not change any more. The run then stays in the set around the
// unpushed run, in which no larger value follows than those that were already seen.
bool Search::is_decided(const Simulator& run) const {
  const Unpushed& unpushed = *baseline_.unpushed;
  if (plan_moves_ || options_.simulate.sensor_noise || !unpushed.states.contains(run, kWellInside))
    return false;
  const auto k = static_cast<size_t>(run.tick());
  return unpushed.divergence[k] + RecordedRun::dcm_bound() <= kNearPlan &&
         unpushed.foot_tilt[k] + RecordedRun::tilt_bound() <= kTiltedFoot &&
         run.result().max_tilt >=
             unpushed.trunk_tilt + RecordedRun::tilt_bound() + unpushed.states.reference_turn(run);
}

PushFigures Search::figures() {
  PushFigures f;
  Simulator run = pushed(options_.reference_level * case_.bound, {0, 0});
  ++runs_;
  const double end = case_.phase.at + options_.duration;
  double far = end;
  bool decided = false;
  for (long k = 1; !decided && run.advance(1) && !run.fell(); ++k) {
    if (stop_) throw Interrupted();
    if (run.last_estimate().foot_tilt.norm() > kTiltedFoot) f.foot_tilt += dt_;
    if (divergence(run) > near_distance(run)) far = run.time();
    decided = k % kTicksPerTest == 0 && run.time() > end && is_decided(run);
  }
  f.survives = decided || (!run.fell() && run.result().outcome == Outcome::stands);
  f.recovery = std::max(0.0, far - end);
  f.trunk_tilt = run.result().max_tilt;
  return f;
}

PushLimit Search::find(int guess, int stride) {
  PushLimit limit;
  if (!baseline_.stands || case_.bound <= 0) return limit;
  const int cap = std::max(1, static_cast<int>(std::lround(options_.cap / options_.step)));
  tried_[0] = true;
  int probe = guess;
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
    fail(ErrorCode::bad_pattern, "the motion has no samples. Sample a pattern first");
  require_within("push: the number of directions", options.directions, PushOptions::kDirections);
  require_within("push: the resolution of the search", options.step, PushOptions::kStep);
  require_within("push: the largest push", options.cap, PushOptions::kCap);
  require_within("push: the number of variations", options.replicas, PushOptions::kReplicas);
  require_within("push: the duration of a push", options.duration, PushOptions::kDuration);
  if (options.cap < options.step)
    refuse("the largest push is " + text::exact(options.cap) +
           " capture bounds; it must be at least the resolution of the search, " +
           text::exact(options.step) + " capture bounds");
  for (const PushPhase& phase : options.phases)
    if (!phase.standing && !(phase.at >= options.time_spread + series.dt &&
                             phase.at + options.duration <= series.duration()))
      refuse("a push at " + text::brief(phase.at) + " s is not possible. Give a time from " +
             text::brief(options.time_spread + series.dt) + " to " +
             text::brief(series.duration() - options.duration) + " s");
}

/// Data that the jobs of a study share.
struct Study {
  const RobotModel& model;
  const CommandSeries& series;
  const PushOptions& options;
  CommandSeries stand;
  std::vector<PushPhase> phases;
  std::vector<ControllerSpec> controllers;  // controllers, of which open loop comes first
  // Baselines, phase by phase, and in each phase controller by controller.
  std::vector<PushBaseline> baselines;
  std::atomic<bool> stop = false;

  const CommandSeries& series_of(const PushPhase& phase) const {
    return phase.standing ? stand : series;
  }
  void run_baselines(size_t controller, bool standing);
  PushCase plan(size_t i) const;
  double standing_edge_bound() const;
  bool plan_moves(const ControllerSpec& controller) const;
  void search(size_t i, PushCase& found);
};

// Runs a controller to the end, standing or not. During the run, it is copied for each phase.
void Study::run_baselines(size_t controller, bool standing) {
  std::vector<std::pair<long, PushBaseline*>> branches;  // baselines to copy, by tick
  for (size_t p = 0; p < phases.size(); ++p)
    if (phases[p].standing == standing)
      branches.emplace_back(static_cast<long>((phases[p].at - options.time_spread) / series.dt) - 1,
                            &baselines[p * controllers.size() + controller]);
  if (branches.empty()) return;
  SimulateOptions simulate = options.simulate;
  simulate.controller = controllers[controller];
  simulate.scenario.clear();
  Simulator run(model, standing ? stand : series, simulate);
  run.keep_samples(false);
  const auto unpushed = std::make_shared<Unpushed>(Unpushed{RecordedRun(simulate.world)});
  const auto take_figures = [&] {
    unpushed->divergence.push_back(kNearPlan * divergence(run) / near_distance(run));
    unpushed->foot_tilt.push_back(run.last_estimate().foot_tilt.norm());
  };
  unpushed->divergence = unpushed->foot_tilt = {0};  // values before the first tick
  const auto branch = [&] {
    for (const auto& [tick, baseline] : branches)
      if (std::max(0L, tick) == run.tick()) baseline->simulator = run;
  };
  // Whether a run that continues from one of the copies is tested after this tick.
  const auto tested = [&] {
    return std::any_of(branches.begin(), branches.end(), [&](const auto& b) {
      const long since = run.tick() - std::max(0L, b.first);
      return since > 0 && since % kTicksPerTest == 0;
    });
  };
  branch();
  while (run.advance(1) && !run.fell()) {
    if (stop) throw Interrupted();
    branch();
    take_figures();
    if (tested()) unpushed->states.record(run);
  }
  take_figures();
  for (std::vector<double>* values : {&unpushed->divergence, &unpushed->foot_tilt})
    for (size_t k = values->size() - 1; k > 0; --k)
      (*values)[k - 1] = std::max((*values)[k - 1], (*values)[k]);
  unpushed->trunk_tilt = run.result().max_tilt;
  const bool stands = !run.fell() && run.result().outcome == Outcome::stands;
  for (const auto& [tick, baseline] : branches) {
    baseline->unpushed = unpushed;
    baseline->stands = stands;
  }
}

// VIIP chooses its footholds, so that there are no planned ones. The bound is then m omega times
// the distance of the ZMP to the nearest edge of the support at the start of the pattern [N s], the
// same for every direction.
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
    const double guess = c > 0                  ? kGuess
                         : found.phase.standing ? kStandingOpenLoopGuess
                                                : kOpenLoopGuess;
    const PushLimit limit =
        search.find(static_cast<int>(std::lround(guess / options.step)), c > 0 ? kStride : 1);
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
    report(progress, {"pushing", static_cast<double>(finished) / static_cast<double>(count), what});
  };
  if (!all_known) {
    study.baselines.resize(study.phases.size() * study.controllers.size());
    in_parallel(2 * study.controllers.size(), options.threads, study.stop, [&](size_t i) {
      study.run_baselines(i / 2, i % 2 == 1);
      const std::lock_guard lock(mutex);
      report_progress("simulating first without a push");
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
