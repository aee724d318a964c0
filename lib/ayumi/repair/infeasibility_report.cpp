// Played s times slower, a motion has its rates divided by s and its accelerations by s^2. The
// check itself judges the slowed window, so every kind of finding is scaled by the same route.
#include "ayumi/repair/infeasibility_report.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "ayumi/base/text.hpp"
#include "ayumi/limits/limit.hpp"
#include "ayumi/repair/constraint_relaxation.hpp"

namespace ayumi {

namespace policy = repair_policy;

namespace {

// The window and a few samples around it, played slower. Contacts stay those of the whole motion.
CommandSeries slowed(const CommandSeries& series, const Finding& f, double factor) {
  CommandSeries part;
  part.dt = series.dt * factor;
  part.joint_weight = series.joint_weight;
  const auto count = static_cast<long>(series.samples.size());
  const long first = std::clamp(
      std::lround(f.begin / series.dt) - policy::infeasible::kSamplesAround, 0L, count - 1);
  const long last = std::clamp(std::lround(f.end / series.dt) + policy::infeasible::kSamplesAround,
                               first, count - 1);
  for (long k = first; k <= last; ++k) {
    CommandSample s = series.samples[static_cast<size_t>(k)];
    s.state.base_velocity /= factor;
    s.state.base_angular_velocity /= factor;
    s.state.dtheta /= factor;
    s.acceleration /= factor * factor;
    s.dcog /= factor;
    s.ddcog /= factor * factor;
    part.samples.push_back(std::move(s));
  }
  return part;
}

bool passes_slowed(const RobotModel& model, const CommandSeries& series, const Finding& f,
                   double factor, const CheckOptions& options) {
  const ConsistencyReport report = check_consistency(model, slowed(series, f, factor), options);
  return std::none_of(report.findings.begin(), report.findings.end(), [&](const Finding& other) {
    return other.severity == Severity::error && other.kind == f.kind && other.where == f.where;
  });
}

double violation_of(const Finding& f) {
  if (spec_of(f.kind).is_ratio()) return std::abs(f.worst / f.limit);
  return std::abs(f.worst - f.limit);
}

Obstacle obstacle_of(const Finding& f) {
  Obstacle o;
  o.finding = f;
  o.excess = violation_of(f);
  o.is_ratio = spec_of(f.kind).is_ratio();
  return o;
}

// Comparable for violations of different kinds: shares of a limit, centimetres, tenths of a radian.
double severity_of(const Obstacle& o) {
  if (o.is_ratio) return o.excess - 1;
  if (o.finding.unit == "m") return o.excess / policy::infeasible::kLength;
  if (o.finding.unit == "N") return o.excess / policy::infeasible::kForce;
  return o.excess / policy::infeasible::kOther;
}

std::string window_text(const Finding& f) {
  const std::string begin = text::fixed(f.begin, 2), end = text::fixed(f.end, 2);
  return begin == end ? "at " + text::fixed(f.at, 3) + " s" : "at " + begin + "-" + end + " s";
}

std::string violation_text(const Finding& f, double violation) {
  if (const auto text = spec_of(f.kind).obstacle) return text(f, violation);
  return std::string(name_of(f.kind)) + " of " + f.where + " is " + text::brief(f.worst) +
         " against " + text::brief(f.limit) + " " + f.unit;
}

}  // namespace

bool is_matter_of_time(const Finding& f) {
  if (f.kind == FindingKind::continuous_torque) return false;  // the window is the motor's
  const LimitClass limit_class = spec_of(f.kind).limit_class;
  return limit_class == LimitClass::rate || limit_class == LimitClass::force;
}

double total_violation(const ConsistencyReport& report) {
  std::map<std::pair<std::string, std::string>, double> worst;
  for (const Finding& f : report.findings) {
    if (f.severity != Severity::error) continue;
    double& severity = worst[{name_of(f.kind), f.where}];
    severity = std::max(severity, severity_of(obstacle_of(f)));
  }
  double sum = 0;
  for (const auto& entry : worst) sum += entry.second;
  return sum;
}

namespace {

std::string remedy(const Obstacle& o) {
  if (o.time_factor > 1)
    return "that window needs to be " + text::fixed(std::ceil(10 * o.time_factor - 1e-9) / 10, 1) +
           " times longer";
  return (is_matter_of_time(o.finding) ? "slowing that window down does not help: " : "") +
         o.finding.remedy;
}

// Which lock covers the time of a finding, in words; empty: none.
std::string time_lock(const Finding& f, const RepairOptions& options) {
  std::string posture;
  for (const auto& [begin, end] : options.locked_windows) {
    if (begin < end && f.at >= begin && f.at <= end) return "that window is locked";
    if (begin == end && is_of_posture(f) && f.begin <= begin && f.end >= begin)
      posture = "the posture at " + text::brief(begin) + " s is locked";
  }
  return posture;
}

bool at_locked_joint(const Finding& f, const RepairOptions& options) {
  return std::find(options.locked_joints.begin(), options.locked_joints.end(), f.where) !=
         options.locked_joints.end();
}

}  // namespace

double time_factor(const RobotModel& model, const CommandSeries& series, const Finding& finding,
                   const CheckOptions& options) {
  if (!is_matter_of_time(finding) ||
      !passes_slowed(model, series, finding, policy::infeasible::kSlowest, options))
    return 0;
  double low = 1, high = policy::infeasible::kSlowest;
  while (high - low > policy::infeasible::kFactorStep) {
    const double middle = 0.5 * (low + high);
    (passes_slowed(model, series, finding, middle, options) ? high : low) = middle;
  }
  return high;
}

std::vector<Obstacle> infeasibility_report(const RobotModel& model, const CommandSeries& series,
                                           const ConsistencyReport& report,
                                           const RepairOptions& options) {
  const auto locked = [&](const Finding& f) {
    return at_locked_joint(f, options) || !time_lock(f, options).empty();
  };
  const auto is_error = [](const Finding& f) { return f.severity == Severity::error; };
  const bool by_lock = std::any_of(report.findings.begin(), report.findings.end(),
                                   [&](const Finding& f) { return is_error(f) && locked(f); });
  std::map<std::pair<std::string, std::string>, Obstacle> worst;
  for (const Finding& f : report.findings) {
    if (!is_error(f) || (by_lock && !locked(f))) continue;
    const Obstacle o = obstacle_of(f);
    const auto found = worst.try_emplace({name_of(f.kind), f.where}, o).first;
    if (o.excess > found->second.excess) found->second = o;
  }
  std::vector<Obstacle> result;
  for (auto& entry : worst) {
    Obstacle& o = entry.second;
    o.time_factor = time_factor(model, series, o.finding, options.check);
    o.text = violation_text(o.finding, o.excess) + " " + window_text(o.finding) + ", ";
    if (at_locked_joint(o.finding, options))
      o.text += o.finding.where + " is locked; unlock it, or else: ";
    else if (const std::string lock = time_lock(o.finding, options); !lock.empty())
      o.text += lock + "; unlock it, or else: ";
    o.text += remedy(o);
    result.push_back(std::move(o));
  }
  std::stable_sort(result.begin(), result.end(), [](const Obstacle& a, const Obstacle& b) {
    return severity_of(a) > severity_of(b);
  });
  return result;
}

void solve_relaxed(RepairState& state) {
  const CorrectionProblem& problem = *state.problem;
  const Nlp hard = problem.nlp();
  const Nlp relaxed = with_all_limits_relaxed(problem, hard, state.series.dt);
  NlpOptions options = nlp_options(state, false);
  options.max_iterations = std::min(options.max_iterations, policy::infeasible::kMostIterations);
  options.least_violating = nullptr;
  const NlpSolution solution =
      solve(relaxed, options, state.progress, "repair, what is in the way");
  const double violation = state.result.constraint_violation;
  note_work(state, relaxed, solution);
  state.result.constraint_violation = violation;
  // The motion nearby that violates least still violates a limit: nothing passes.
  if (solution.status != NlpStatus::failed) state.status = NlpStatus::infeasible;
  state.relaxation_cut_short = solution.status == NlpStatus::iteration_limit;
  take(state, problem.track(solution.x.head(problem.variable_count())));
  // A search that stopped before its end has errors of its own making: then those of the given
  // motion show what stands in the way.
  RepairResult& result = state.result;
  if (!state.relaxation_cut_short &&
      total_violation(result.check) < total_violation(state.as_given.check))
    return;
  result.correction = state.as_given.correction;
  result.series = state.as_given.series;
  result.check = state.as_given.check;
}

}  // namespace ayumi
