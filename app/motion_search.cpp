#include "motion_search.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/check/consistency.hpp"
#include "ayumi/control/gain_design.hpp"
#include "ayumi/limits/amount_text.hpp"
#include "ayumi/limits/limit.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/repair/infeasibility_report.hpp"
#include "ayumi/task/task.hpp"
#include "simulation.hpp"

namespace ayumi::app {

namespace {

// Largest number of motions that are sampled, and of those that are checked in full. Chosen:
// sampling a walk of 12 s at kCoarse takes 0.05 s and a full check takes 0.5 s, so a search ends
// within ten seconds; on 14 robots and 69 variants of them, the longest search took 8 s.
constexpr int kMostSampled = 90, kMostChecked = 8;
// Largest number of motions that are simulated. Chosen: a walk of 12 s takes 0.3 to 1 s.
constexpr int kMostSimulated = 5;
// Sample period of the first check [s]. Chosen: only postures are judged, 45 of them in a swing of
// 0.45 s.
constexpr double kCoarse = 0.01;

bool cannot_be_done(const Error& error) {
  return error.code() == ErrorCode::bad_pattern || error.code() == ErrorCode::usage;
}

std::string text_of(const Finding& finding) {
  return kind_place_and_time(finding) + ": " + finding.hint;
}

// The error in the postures of a motion; "" if there is none.
std::string wrong_posture(const RobotModel& model, const Pattern& pattern) {
  const ConsistencyReport report =
      check_consistency(model, sample(model, pattern, {.dt = kCoarse}));
  for (const Finding& finding : report.findings)
    if (finding.severity == Severity::error &&
        (is_of_posture(finding) || finding.kind == FindingKind::table_position))
      return text_of(finding);
  return "";
}

// The errors of a motion: the first one, and the one that exceeds its limit most.
struct Wrong {
  std::string first, worst;
  double severity = 0;
};

// The errors of all limits, judged by the strongest profile of the robot.
Wrong wrong_motion(const RobotModel& model, const Pattern& pattern) {
  const Judgement judged = judge(make_task(pattern, model, "", {}));
  if (judged.good() || !judged.motion_need.sufficient.empty()) return {};
  Wrong wrong;
  for (const Finding& finding : judged.report.findings) {
    if (finding.severity != Severity::error) continue;
    if (wrong.first.empty()) wrong.first = text_of(finding);
    const double severity = severity_of(finding);
    if (severity <= wrong.severity) continue;
    wrong.severity = severity;
    wrong.worst = kind_place_and_time(finding) + ": " + amount_text(finding);
  }
  if (wrong.first.empty())
    wrong.first = judged.report.findings.empty() ? "the motion does not pass the check"
                                                 : text_of(judged.report.findings.front());
  return wrong;
}

// All combinations of indices into the lists of values, sorted by the sum of the indices.
std::vector<std::vector<size_t>> nearest_first(const std::vector<Dial>& dials) {
  std::vector<std::vector<size_t>> all = {{}};
  for (const Dial& dial : dials) {
    std::vector<std::vector<size_t>> longer;
    for (const auto& places : all)
      for (size_t i = 0; i < dial.values.size(); ++i) {
        longer.push_back(places);
        longer.back().push_back(i);
      }
    all = std::move(longer);
  }
  const auto sum = [](const std::vector<size_t>& v) {
    return std::accumulate(v.begin(), v.end(), size_t{0});
  };
  std::stable_sort(all.begin(), all.end(),
                   [&](const auto& a, const auto& b) { return sum(a) < sum(b); });
  return all;
}

}  // namespace

std::string end_in_simulation(const RobotModel& model, const Pattern& pattern) {
  Task task = make_task(pattern, model, "", {});
  const Judgement judged = judge(task);
  // This is the profile that write_new_pattern() chooses.
  if (pattern.profile.empty() && !judged.motion_need.sufficient.empty())
    task.profile = judged.motion_need.sufficient.front();
  const SimulateOptions options = simulate_options(task);
  const CommandSample& first = task.series.samples.front();
  const std::string unstable = instability(model, model.limits(task.profile), options.controller,
                                           first.cog.z() - first.zmp.z(), task.series.dt);
  if (!unstable.empty()) return unstable;
  const SimulationLog log = simulate(task, options);
  return log.result.outcome == Outcome::fell ? outcome_text(log) : "";
}

SearchResult search_motion(const RobotModel& model, const std::vector<Dial>& dials,
                           const std::function<Pattern(const std::vector<double>&)>& make,
                           const Progress& progress, bool simulated) {
  SearchResult result;
  int checked = 0, runs = 0;
  // Severity of the worst error of the motion that is nearest to passing.
  double nearest = HUGE_VAL;
  // Indices of the other dials for which the postures passed, but not speeds, torques or ZMP.
  // Another posture does not correct these.
  std::set<std::vector<size_t>> hopeless;
  std::vector<double> accepted;
  for (const std::vector<size_t>& places : nearest_first(dials)) {
    std::vector<size_t> others;
    for (size_t i = 0; i < dials.size(); ++i)
      if (!dials[i].posture) others.push_back(places[i]);
    if (hopeless.contains(others)) continue;
    std::vector<double> values;
    for (size_t i = 0; i < dials.size(); ++i) values.push_back(dials[i].values[places[i]]);
    std::string wrong;
    try {
      Pattern pattern = make(values);
      pattern.file.clear();
      wrong = wrong_posture(model, pattern);
      if (wrong.empty()) {
        ++checked;
        const Wrong motion = wrong_motion(model, pattern);
        wrong = motion.first;
        if (!motion.worst.empty() && motion.severity < nearest) {
          nearest = motion.severity;
          result.nearest = motion.worst;
          result.nearest_values = values;
        }
        if (wrong.empty() && simulated) {
          ++runs;
          wrong = end_in_simulation(model, pattern);
          if (!wrong.empty() && result.falls.empty()) {
            result.falls = wrong;
            accepted = values;
          }
        }
        if (!wrong.empty()) hopeless.insert(others);
      }
    } catch (const Error& error) {
      if (!cannot_be_done(error)) throw;
      wrong = error.what();
      if (result.tried == 0) result.refused = true;
    }
    ++result.tried;
    report(progress, {"look for a motion that passes", result.tried / double(kMostSampled), ""});
    if (result.tried == 1) {
      result.values = values;
      result.limit = wrong;
    }
    if (wrong.empty()) {
      result.found = true;
      result.values = values;
      result.falls.clear();
      return result;
    }
    if (result.tried == kMostSampled || checked == kMostChecked || runs == kMostSimulated) break;
  }
  if (!accepted.empty()) {
    result.found = true;
    result.values = accepted;
  }
  return result;
}

bool postures_pass(const RobotModel& model, const std::function<Pattern()>& make) {
  try {
    Pattern pattern = make();
    pattern.file.clear();
    return wrong_posture(model, pattern).empty();
  } catch (const Error& error) {
    if (!cannot_be_done(error)) throw;
    return false;
  }
}

std::string changed_values(const std::vector<Dial>& dials, const std::vector<double>& values) {
  std::vector<std::string> changed;
  for (size_t i = 0; i < dials.size(); ++i)
    if (values[i] != dials[i].values.front())
      changed.push_back(dials[i].name + " " + text::brief(values[i]) + " " + dials[i].unit);
  return text::join(changed, ", ");
}

}  // namespace ayumi::app
