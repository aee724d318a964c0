#include "parameter_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "ayumi/author/edit/edit.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/math/windows.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/repair/infeasibility_report.hpp"
#include "ayumi/study/retime.hpp"
#include "ayumi/task/payload_findings.hpp"

namespace ayumi::app {

namespace {

using Values = std::map<std::string, double>;

// Largest number of trials with several parameters together. Chosen: each trial costs one sampling
// and one check, 0.1 s for a walk of a few steps.
constexpr int kMostTrials = 60;
// Violation of a motion that cannot be sampled. Chosen: worse than any motion.
constexpr double kUnsampled = 1e6;
// Factor on the time from which on slowing down is not called a solution. Chosen: the same as
// kSlowest of repair/policy.hpp.
constexpr double kSlowest = 8;
// Ratio of each pace to the one before, and resolution of the search between two paces. Chosen:
// there are 15 paces up to kSlowest, and the pace is shown with two decimals.
constexpr double kPaceStep = 1.15, kPaceResolution = 0.02;
// If the windows are at least this share of a pattern's time, the whole pattern is slowed down
// instead. Chosen: the rest is then little more than the time of standing at both ends.
constexpr double kPart = 0.8;

bool whole(double value) { return value == std::round(value) && std::abs(value) >= 1; }

// Rounds to three digits for people, away from `given`.
double rounded_away(double value, double given) {
  if (value == 0) return 0;
  const double digits = std::pow(10, 2 - std::floor(std::log10(std::abs(value))));
  const double count =
      value > given ? std::ceil(value * digits - 1e-9) : std::floor(value * digits + 1e-9);
  return digits >= 1 ? count / std::round(digits) : count * std::round(1 / digits);
}

// The report on the motion with the payloads of the scenario.
ConsistencyReport with_payloads_judged(const Task& task, const CheckOptions& options) {
  ConsistencyReport report = check_consistency(task.robot, task.series, options);
  judge_payloads(task, options, report);
  return report;
}

class Search {
 public:
  Search(const Context& context, const std::string& pattern, const PatternOptions& options,
         const std::vector<std::string>& tolerances)
      : context_(context), pattern_(pattern), options_(options), tolerances_(tolerances) {}

  // The amount by which the pattern violates limits; 0 if it passes.
  double excess(const Values& values) {
    std::string words;
    PatternOptions options = options_;
    for (const auto& [name, value] : values) {
      words += (words.empty() ? "" : ", ") + name + " = " + text::brief(value);
      options.set.push_back(name + "=" + text::exact(value));
    }
    report(context_.progress(), {"trying parameters", -1, words});
    Context silent = context_;
    silent.quiet = true;
    try {
      const Task input = load_pattern(silent, pattern_, options);
      return total_violation(with_payloads_judged(input, check_options(input, tolerances_)));
    } catch (const Interrupted&) {
      throw;
    } catch (const Error&) {
      return kUnsampled;
    }
  }

  bool passes(const std::string& parameter, double value) {
    return excess({{parameter, value}}) == 0;
  }

  // Tries steps to both sides with increasing width, and then bisects the gap before the first step
  // that passes.
  bool nearest(const std::string& parameter, double given, double& passing) {
    if (whole(given) && nearest_whole(parameter, given, passing)) return true;
    double tried = 0;
    for (const double share :
         {0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.95, 1.0, 1.5, 2.0, 3.0, 5.0, 7.0}) {
      for (const double sign : {-1.0, 1.0}) {
        if (sign < 0 && share > 1) continue;
        double good = given * (1 + sign * share), bad = given * (1 + sign * tried);
        if (!passes(parameter, good)) continue;
        for (int i = 0; i < 4; ++i) {
          const double middle = 0.5 * (good + bad);
          (passes(parameter, middle) ? good : bad) = middle;
        }
        const double rounded = rounded_away(good, given);
        passing = rounded != good && passes(parameter, rounded) ? rounded : good;
        return true;
      }
      tried = share;
    }
    return false;
  }

  // Changes several parameters, at each step the one that helps most. Then moves each as near to
  // its given value as the others allow.
  PassingValues together(const Values& given) {
    Values now = given;
    double wrong = excess(now);
    for (double step = 0.5; step > 0.1 && wrong > 0;) {
      Values best;
      double least = wrong;
      for (const auto& [name, value] : given)
        for (const double sign : {-1.0, 1.0}) {
          if (value == 0 || ++trials_ > kMostTrials) continue;
          Values other = now;
          other[name] += sign * step * value;
          if (whole(value)) other[name] = now[name] + sign * std::ceil(step * std::abs(value));
          if (other[name] / value < 0.04) other[name] = 0;
          if (other[name] == now[name] || other[name] / value > 4) continue;
          const double e = excess(other);
          if (e >= least) continue;
          least = e;
          best = other;
        }
      if (trials_ > kMostTrials) return {};
      if (best.empty() || wrong - least < 1e-6) {
        step /= 2;
        continue;
      }
      now = best;
      wrong = least;
    }
    if (wrong > 0) return {};
    PassingValues result;
    for (const auto& [name, value] : given) {
      Values back = now;
      for (const double share : {1.0, 0.5}) {
        back[name] = now[name] + share * (value - now[name]);
        if (whole(value)) back[name] = std::round(back[name]);
        const double rounded = share < 1 ? rounded_away(back[name], value) : back[name];
        back[name] = whole(value) ? back[name] : rounded;
        if (back[name] == now[name] || excess(back) > 0) continue;
        now = back;
        break;
      }
    }
    for (const auto& [name, value] : given)
      if (now[name] != value) result.push_back({name, value, now[name]});
    return result;
  }

 private:
  bool nearest_whole(const std::string& parameter, double given, double& passing) {
    for (int step = 1; step <= std::min(12.0, 3 * std::abs(given)); ++step)
      for (const double sign : {-1.0, 1.0}) {
        const double value = given + sign * step;
        if (value * given <= 0 || !passes(parameter, value)) continue;
        passing = value;
        return true;
      }
    return false;
  }

  const Context& context_;
  const std::string& pattern_;
  const PatternOptions& options_;
  const std::vector<std::string>& tolerances_;
  int trials_ = 0;
};

// The time from the last key or phase before an error to the first one after it.
std::vector<std::pair<double, double>> segments_around(const Pattern& pattern,
                                                       const ConsistencyReport& check) {
  std::set<double> marks = {0, pattern.duration()};
  for (const Phase& phase : pattern.phases) marks.insert(phase.until);
  for (const Keyframe& key : pattern.keyframes) marks.insert(key.t);
  std::vector<std::pair<double, double>> all;
  for (const Finding& f : check.findings) {
    if (f.severity != Severity::error) continue;
    // Slack [s]. Chosen: a finding may extend into the next segment by a sample.
    constexpr double kSlack = 0.002;
    const auto end = marks.lower_bound(std::max(f.end - kSlack, f.at));
    auto begin = marks.upper_bound(std::min(f.begin + kSlack, f.at));
    if (begin != marks.begin()) --begin;
    const double to = end == marks.end() ? pattern.duration() : *end;
    if (*begin < to) all.emplace_back(*begin, to);
  }
  return merged(std::move(all));
}

// Whether the task passes with this pattern instead of its own.
bool passes_with(const Task& input, const Pattern& pattern, const CheckOptions& check) {
  Task other = input;
  other.pattern = pattern;
  other.series = sample(input.robot, pattern, {.dt = input.series.dt});
  return with_payloads_judged(other, check).consistent;
}

bool stretched_passes(const Context& context, const Task& input, const CheckOptions& check,
                      const std::vector<std::pair<double, double>>& windows, double factor) {
  report(context.progress(),
         {"trying a slower motion", -1, text::brief(factor) + " times as long"});
  try {
    Pattern pattern = input.pattern;
    for (auto w = windows.rbegin(); w != windows.rend(); ++w)
      pattern = stretched(input.robot, pattern, w->first, w->second, factor);
    return passes_with(input, pattern, check);
  } catch (const Interrupted&) {
    throw;
  } catch (const Error&) {
    return false;
  }
}

double passing_stretch(const Context& context, const Task& input, const CheckOptions& check,
                       const std::vector<std::pair<double, double>>& windows) {
  double low = 1, high = kPaceStep;
  while (high < kSlowest && !stretched_passes(context, input, check, windows, high)) {
    low = high;
    high *= kPaceStep;
  }
  if (high >= kSlowest) return 0;
  while (high - low > kPaceResolution) {
    const double middle = 0.5 * (low + high);
    (stretched_passes(context, input, check, windows, middle) ? high : low) = middle;
  }
  const double rounded = std::ceil(100 * high - 1e-9) / 100;
  return rounded == high || stretched_passes(context, input, check, windows, rounded) ? rounded
                                                                                      : high;
}

}  // namespace

std::vector<PassingValues> passing_parameters(const Context& context, const std::string& pattern,
                                              const PatternOptions& options,
                                              const std::vector<std::string>& tolerances) {
  std::vector<PassingValues> result;
  Search search(context, pattern, options, tolerances);
  const Pattern given = read_pattern(pattern, read_pairs(options.set, "--set"));
  for (const auto& [name, value] : given.parameters) {
    double passing = 0;
    if (value != 0 && search.nearest(name, value, passing))
      result.push_back({{name, value, passing}});
  }
  if (!result.empty() || given.parameters.size() < 2) return result;
  PassingValues values = search.together(given.parameters);
  if (!values.empty()) result.push_back(std::move(values));
  return result;
}

PassingPace passing_pace(const Context& context, const Task& input, const ConsistencyReport& check,
                         const std::vector<std::string>& tolerances) {
  PassingPace pace;
  if (!input.series.viip.empty()) return pace;
  for (const Finding& f : check.findings)
    if (f.severity == Severity::error && !is_matter_of_time(f)) return pace;
  const CheckOptions judged = check_options(input, tolerances);
  pace.tried = kSlowest;
  if (!input.pattern.table && !input.pattern.correction) {
    pace.windows = segments_around(input.pattern, check);
    double length = 0;
    for (const auto& [begin, end] : pace.windows) length += end - begin;
    if (length < kPart * input.pattern.duration())
      pace.factor = passing_stretch(context, input, judged, pace.windows);
  }
  RetimeOptions retime;
  retime.check = judged;
  retime.dt = input.series.dt;
  retime.slowest = kSlowest;
  retime.resolution = kPaceResolution;
  const FastestPace found = fastest_pace(input.robot, input.pattern, retime, context.progress());
  // The pace was found for the robot without payloads, so it has to be checked again if the
  // scenario has some.
  const bool carries =
      std::any_of(input.pattern.scenario.begin(), input.pattern.scenario.end(),
                  [](const Disturbance& d) { return std::holds_alternative<Payload>(d.what); });
  if (found.found &&
      (!carries || passes_with(input, retimed(input.robot, input.pattern, found.scale), judged)))
    pace.whole = found.scale;
  return pace;
}

}  // namespace ayumi::app
