#include "ayumi/repair/repair_pattern.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "ayumi/base/error.hpp"
#include "ayumi/dynamics/inverse_kinematics.hpp"
#include "ayumi/motion/pattern_context.hpp"
#include "ayumi/motion/repair_preferences.hpp"
#include "ayumi/repair/infeasibility_report.hpp"
#include "ayumi/repair/least_sway.hpp"

namespace ayumi {

namespace policy = repair_policy;

RepairOptions preferred_options(const Pattern& pattern) {
  const RepairPreferences wishes = without_keyframes(pattern);
  RepairOptions options;
  options.locked_joints = wishes.joints;
  options.locked_feet = wishes.feet;
  options.locked_windows = wishes.windows;
  options.joint_weights = wishes.weights;
  options.trust = wishes.trust.value_or(options.trust);
  options.zmp_margin = wishes.margin;
  options.safety = wishes.safety.value_or(options.safety);
  return options;
}

RepairResult repair(const RobotModel& model, const Pattern& pattern, const CommandSeries& series,
                    const RepairOptions& options, const Progress& progress) {
  RepairResult result = repair(model, series, options, progress);
  if (result.status == RepairStatus::already_consistent || !pattern.correction) return result;
  Pattern plain = pattern;
  plain.correction.reset();
  return repair(model, sample(model, plain, {.dt = series.dt}, progress), options, progress);
}

namespace {

// A start of a generated motion, and how wrong it is.
struct PlanStart {
  CommandSeries series = {};
  PlannedCog cog = PlannedCog::keys;
  bool least_sway = false;
  double lowered = 0;  // [m]
  double violation = 0;
};

bool has_key(const Pattern& pattern, std::optional<double> Keyframe::*coordinate) {
  return (pattern.table && !pattern.table->cog.empty()) ||
         std::any_of(pattern.keyframes.begin(), pattern.keyframes.end(),
                     [&](const Keyframe& key) { return (key.*coordinate).has_value(); });
}

// Whether the author gives the COG places along the ground at both ends only, and gives the ZMP no
// place. A key less than a sample before the end counts as one at the end.
bool has_only_goals(const Pattern& pattern, double dt) {
  const double end = pattern.duration() - dt;
  const auto on_the_way = [&](const Keyframe& key) {
    return key.zmp || ((key.cog_x || key.cog_y) && key.t > 0 && key.t < end);
  };
  const bool rows = pattern.table && !(pattern.table->cog.empty() && pattern.table->zmp.empty());
  return !rows && std::none_of(pattern.keyframes.begin(), pattern.keyframes.end(), on_the_way);
}

// Duration of the longest flight [s]; 0 if there is none.
double longest_flight(const Pattern& pattern) {
  double longest = 0, begin = 0;
  for (const Phase& phase : pattern.phases) {
    if (phase.support == Support::none) longest = std::max(longest, phase.until - begin);
    begin = phase.until;
  }
  return longest;
}

// Makes starts of a generated motion from the plan of a pattern, and judges them by the check.
class PlanStarts {
 public:
  PlanStarts(const RobotModel& model, const Pattern& pattern, const RepairOptions& options,
             double dt, const Progress& progress)
      : model_(model),
        pattern_(pattern),
        options_(options),
        sampling_{.dt = dt, .threads = options.check.threads},
        progress_(progress),
        height_(default_cog_height(model, pattern)) {
    shares_ = {1};
    // Where no key gives the height of the COG, lower ones are tried: bent legs reach farther.
    if (!has_key(pattern, &Keyframe::cog_height))
      shares_.insert(shares_.end(), std::begin(policy::generation::kHeights),
                     std::end(policy::generation::kHeights));
  }

  double violation_of(const CommandSeries& series) const {
    const ConsistencyReport check = check_consistency(model_, series, options_.check);
    return check.consistent ? 0 : total_violation(check);
  }

  // The start with the smallest violation; `best` if none is better.
  PlanStart better_than(PlanStart best, const PlanLead& lead) const {
    const bool as_planned =
        lead.cog == PlannedCog::keys && !lead.zmp && lead.flight_ramp == kFlightRamp;
    for (const double share : shares_) {
      if (best.violation == 0) break;
      if (share == 1 && as_planned) continue;  // this is the plan itself
      PlanStart here = {
          .cog = lead.cog, .least_sway = lead.zmp.has_value(), .lowered = (1 - share) * height_};
      try {
        Pattern lower = pattern_;
        if (share < 1) lower.cog_height = share * height_;
        here.series = sample_plan(model_, lower, sampling_, progress_, lead);
      } catch (const Error& error) {  // only this start is impossible
        if (error.code() != ErrorCode::bad_pattern) throw;
        continue;
      }
      here.violation = violation_of(here.series);
      if (here.violation < best.violation) best = std::move(here);
    }
    return best;
  }

 private:
  const RobotModel& model_;
  const Pattern& pattern_;
  const RepairOptions& options_;
  SampleOptions sampling_;
  const Progress& progress_;
  double height_;
  std::vector<double> shares_;
};

std::vector<MissedCog> missed_places(const RobotModel& model, const Pattern& pattern,
                                     const CommandSeries& series, const CheckOptions& options) {
  const double tolerance = tolerances(options, model, series)[FindingKind::cog_residual];
  std::vector<MissedCog> missed;
  const auto cog_at = [&](double t) {
    const auto last = static_cast<long>(series.samples.size()) - 1;
    const long k = std::clamp(std::lround(t / series.dt), 0L, last);
    return series.samples[static_cast<size_t>(k)].cog;
  };
  for (const Keyframe& key : pattern.keyframes) {
    MissedCog here{key.t};
    const std::optional<double> given[] = {key.cog_x, key.cog_y, key.cog_height};
    for (int i = 0; i < 3; ++i)
      if (given[i]) here.off = std::max(here.off, std::abs(cog_at(key.t)[i] - *given[i]));
    if (here.off > tolerance) missed.push_back(here);
  }
  if (pattern.table) {
    MissedCog worst;
    for (size_t k = 0; k < pattern.table->cog.size(); ++k) {
      const double t = pattern.table->dt * static_cast<double>(k);
      const double off = (cog_at(t) - pattern.table->cog[k]).cwiseAbs().maxCoeff();
      if (off > worst.off) worst = {t, off};
    }
    if (worst.off > tolerance) missed.push_back(worst);
  }
  std::stable_sort(missed.begin(), missed.end(),
                   [](const MissedCog& a, const MissedCog& b) { return a.t < b.t; });
  return missed;
}

}  // namespace

GeneratedMotion generate(const RobotModel& model, const Pattern& pattern, const CommandSeries& plan,
                         const RepairOptions& options, const Progress& progress) {
  const PlanStarts starts(model, pattern, options, plan.dt, progress);
  const auto made_from = [&](PlanStart start) {
    GeneratedMotion made;
    made.repair = repair(model, start.series, options, progress);
    if (made.repair.status == RepairStatus::already_consistent)
      made.repair.status = RepairStatus::repaired;
    made.start = std::move(start.series);
    made.cog = start.cog;
    made.least_sway = start.least_sway;
    made.lowered = start.lowered;
    made.missed = missed_places(model, pattern, made.repair.series, options.check);
    return made;
  };
  PlanStart start = {.series = plan, .violation = starts.violation_of(plan)};
  start = starts.better_than(std::move(start), {});
  // A ramp is at most half of a flight, so a longer one than that gives the same plan once more.
  const double longest_ramp = longest_flight(pattern) / 2;
  double tried = kFlightRamp;
  for (const double ramp : policy::generation::kFlightRamps) {
    if (longest_ramp > tried) start = starts.better_than(std::move(start), {.flight_ramp = ramp});
    tried = ramp;
  }
  const bool may_lead = has_key(pattern, &Keyframe::cog_x) || has_key(pattern, &Keyframe::cog_y);
  const bool only_goals = has_only_goals(pattern, plan.dt);
  if (may_lead && only_goals)
    start = starts.better_than(std::move(start), {.cog = PlannedCog::zmp});
  const PlannedCog follows = may_lead ? PlannedCog::zmp : PlannedCog::keys;
  const bool lacks_joints =
      InverseKinematics(model, default_posture(model, pattern)).lacks_joints();
  if (lacks_joints && only_goals)
    for (const double smooth : policy::generation::kSwaySmooth) {
      if (start.violation == 0) break;
      const auto zmp = zmp_of_least_sway(model, plan, smooth, progress);
      if (zmp) start = starts.better_than(std::move(start), {.cog = follows, .zmp = zmp});
    }
  GeneratedMotion made = made_from(std::move(start));
  if (made.repair.status == RepairStatus::repaired || made.repair.partial || !may_lead ||
      only_goals)
    return made;
  PlanStart led = starts.better_than({.violation = std::numeric_limits<double>::infinity()},
                                     {.cog = PlannedCog::zmp});
  if (led.series.samples.empty()) return made;
  GeneratedMotion other = made_from(std::move(led));
  const bool helps = other.repair.status == RepairStatus::repaired || other.repair.partial;
  return helps ? std::move(other) : std::move(made);
}

}  // namespace ayumi
