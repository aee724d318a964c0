// If a motion is played s times slower, its rates are divided by s and its accelerations by s^2.
// The check itself judges the slowed window, so every kind of finding is scaled in the same way.
#include "ayumi/repair/infeasibility_report.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "ayumi/base/sentence.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/limits/amount_text.hpp"
#include "ayumi/limits/limit.hpp"
#include "ayumi/repair/constraint_relaxation.hpp"

namespace ayumi {

namespace policy = repair_policy;

namespace {

// Plays the window and a few samples around it more slowly. The contacts are those of the whole
// motion.
CommandSeries slowed(const CommandSeries& series, const Finding& f, double factor) {
  CommandSeries part;
  part.dt = series.dt * factor;
  const auto count = static_cast<long>(series.samples.size());
  const long first = std::clamp(
      std::lround(f.begin / series.dt) - policy::infeasible::kSamplesAround, 0L, count - 1);
  const long last = std::clamp(std::lround(f.end / series.dt) + policy::infeasible::kSamplesAround,
                               first, count - 1);
  if (const Eigen::VectorXd* weight = series.joint_weight_at(first))
    part.joint_weight = {{0, *weight}};
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

InfeasibilityCause cause_of(const Finding& f) {
  InfeasibilityCause cause;
  cause.finding = f;
  cause.violation = violation_of(f);
  cause.is_ratio = spec_of(f.kind).is_ratio();
  return cause;
}

// Scales violations so that different kinds can be compared, as shares of a limit, in centimetres,
// or in tenths of a radian.
double severity_of(const InfeasibilityCause& cause) {
  if (cause.is_ratio) return cause.violation - 1;
  if (cause.finding.unit == "m") return cause.violation / policy::infeasible::kLength;
  if (cause.finding.unit == "N") return cause.violation / policy::infeasible::kForce;
  return cause.violation / policy::infeasible::kOther;
}

std::string window_text(const Finding& f) {
  const std::string begin = text::fixed(f.begin, 2), end = text::fixed(f.end, 2);
  return begin == end ? "at " + text::fixed(f.at, 3) + " s" : "at " + begin + "-" + end + " s";
}

std::string violation_text(const Finding& f, double violation) {
  if (const auto text = spec_of(f.kind).infeasibility) return text(f, violation);
  const ShownUnit unit = shown_unit(f.unit, f.in_degrees);
  return kind_and_place(f.kind, f.where) + " is " + text::brief(f.worst * unit.scale) + " " +
         unit.name + ", but the limit is " + text::brief(f.limit * unit.scale) + " " + unit.name;
}

std::string words_of(const InfeasibilityCause& cause) {
  return violation_text(cause.finding, cause.violation) + " " + window_text(cause.finding);
}

// The worst finding of each kind and place.
template <class Wanted>
std::vector<InfeasibilityCause> worst_of(const ConsistencyReport& report, const Wanted& wanted) {
  std::map<std::pair<std::string, std::string>, InfeasibilityCause> worst;
  for (const Finding& f : report.findings) {
    if (!wanted(f)) continue;
    const InfeasibilityCause cause = cause_of(f);
    const auto found = worst.try_emplace({name_of(f.kind), f.where}, cause).first;
    if (cause.violation > found->second.violation) found->second = cause;
  }
  std::vector<InfeasibilityCause> result;
  for (auto& entry : worst) result.push_back(std::move(entry.second));
  return result;
}

bool is_error(const Finding& f) { return f.severity == Severity::error; }

void most_severe_first(std::vector<InfeasibilityCause>& causes) {
  std::stable_sort(causes.begin(), causes.end(),
                   [](const InfeasibilityCause& a, const InfeasibilityCause& b) {
                     return severity_of(a) > severity_of(b);
                   });
}

}  // namespace

bool is_matter_of_time(const Finding& f) {
  const FindingSpec& spec = spec_of(f.kind);
  return !spec.repair.is_mean &&
         (spec.limit_class == LimitClass::rate || spec.limit_class == LimitClass::force);
}

double severity_of(const Finding& finding) { return severity_of(cause_of(finding)); }

double total_violation(const ConsistencyReport& report) {
  double sum = 0;
  for (const InfeasibilityCause& cause : worst_of(report, is_error))
    sum += std::max(0.0, severity_of(cause));
  return sum;
}

std::vector<std::string> remaining_errors(const ConsistencyReport& check) {
  std::vector<InfeasibilityCause> causes = worst_of(check, is_error);
  most_severe_first(causes);
  std::vector<std::string> words;
  for (const InfeasibilityCause& cause : causes) words.push_back(words_of(cause));
  return words;
}

namespace {

std::string remedy(const InfeasibilityCause& cause) {
  if (cause.time_factor > 1)
    return "stretch this window to " +
           text::fixed(std::ceil(10 * cause.time_factor - 1e-9) / 10, 1) + " times its length";
  // If the reason has words of its own, they have already stated the fact, and only the action
  // follows.
  const Finding& finding = cause.finding;
  const bool states_fact = spec_of(finding.kind).infeasibility && !finding.action.empty();
  return states_fact ? finding.action : finding.remedy;
}

// The lock that covers the time of a finding, in words; empty if there is none.
std::string time_lock(const Finding& f, const RepairOptions& options) {
  std::string posture;
  for (const auto& [begin, end] : options.locked_windows) {
    if (begin < end && f.at >= begin && f.at <= end) return "This window is locked";
    if (begin == end && is_of_posture(f) && f.begin <= begin && f.end >= begin)
      posture = "The posture at " + text::brief(begin) + " s is locked";
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

std::vector<InfeasibilityCause> infeasibility_report(const RobotModel& model,
                                                     const CommandSeries& series,
                                                     const ConsistencyReport& report,
                                                     const RepairOptions& options) {
  const auto locked = [&](const Finding& f) {
    return at_locked_joint(f, options) || !time_lock(f, options).empty();
  };
  const bool by_lock = std::any_of(report.findings.begin(), report.findings.end(),
                                   [&](const Finding& f) { return is_error(f) && locked(f); });
  std::vector<InfeasibilityCause> result =
      worst_of(report, [&](const Finding& f) { return is_error(f) && (!by_lock || locked(f)); });
  for (InfeasibilityCause& cause : result) {
    cause.time_factor = time_factor(model, series, cause.finding, options.check);
    cause.text = words_of(cause);
    if (is_matter_of_time(cause.finding) && cause.time_factor <= 1)
      cause.text += ". The error remains even if this window is stretched to " +
                    text::brief(policy::infeasible::kSlowest) + " times its length";
    if (at_locked_joint(cause.finding, options))
      cause.text += ". " + cause.finding.where +
                    " is locked. Unlock this joint, or change the pattern: " + remedy(cause);
    else if (const std::string lock = time_lock(cause.finding, options); !lock.empty())
      cause.text += ". " + lock + ". Remove the lock, or change the pattern: " + remedy(cause);
    else
      cause.text = text::two_sentences(cause.text, remedy(cause));
  }
  most_severe_first(result);
  return result;
}

void solve_relaxed(RepairState& state) {
  const CorrectionProblem& problem = *state.problem;
  const Nlp hard = problem.nlp();
  const Nlp relaxed = with_all_limits_relaxed(problem, hard, state.series.dt);
  NlpOptions options = nlp_options(state, false);
  options.max_iterations = std::min(options.max_iterations, policy::infeasible::kMostIterations);
  options.least_violating = nullptr;
  options.most_work = work_left(state, 0);
  const NlpSolution solution =
      solve(relaxed, options, state.progress, "repairing, searching for the reasons");
  const double violation = state.result.constraint_violation;
  note_work(state, relaxed, solution);
  state.result.constraint_violation = violation;
  const bool cut_short = solution.status == NlpStatus::iteration_limit;
  if (cut_short)
    state.cut_short_by = solution.out_of_work
                             ? "largest allowed amount of computation for a motion of this duration"
                             : "largest allowed number of iterations";
  // If even the nearby motion with the smallest violation violates a limit, no nearby motion
  // passes. A search that was stopped early does not show this.
  if (solution.status != NlpStatus::failed)
    state.status = cut_short ? NlpStatus::iteration_limit : NlpStatus::infeasible;
  take(state, problem.track(solution.x.head(problem.variable_count())));
  // If the search was stopped early, its motion has errors that the search itself made. Then the
  // errors of the given motion show what prevents a repair.
  RepairResult& result = state.result;
  if (!cut_short && total_violation(result.check) < total_violation(state.as_given.check)) return;
  result.correction = state.as_given.correction;
  result.series = state.as_given.series;
  result.check = state.as_given.check;
}

}  // namespace ayumi
