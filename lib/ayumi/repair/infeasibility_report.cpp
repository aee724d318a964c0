// Played s times slower, a motion has its rates divided by s and its accelerations by s^2. The
// check itself judges the slowed window, so every kind of finding is scaled by the same route.
#include "ayumi/repair/infeasibility_report.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "ayumi/base/text.hpp"
#include "ayumi/repair/correction_problem.hpp"

namespace ayumi {

namespace {

constexpr double kSlowest = 8;  // more is not called a matter of time

// The window and a little around it; contacts are those of the whole motion at every sample.
CommandSeries slowed(const CommandSeries& series, const Finding& f, double factor) {
  CommandSeries part;
  part.dt = series.dt * factor;
  part.joint_weight = series.joint_weight;
  const auto count = static_cast<long>(series.samples.size());
  const long first = std::clamp(std::lround(f.begin / series.dt) - 2, 0L, count - 1);
  const long last = std::clamp(std::lround(f.end / series.dt) + 2, first, count - 1);
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

bool passes(const RobotModel& model, const CommandSeries& series, const Finding& f, double factor,
            const CheckOptions& options) {
  const ConsistencyReport report = check_consistency(model, slowed(series, f, factor), options);
  return std::none_of(report.findings.begin(), report.findings.end(), [&](const Finding& other) {
    return other.severity == Severity::error && other.kind == f.kind && other.where == f.where;
  });
}

double excess_of(const Finding& f) {
  if (spec_of(f.kind).is_ratio()) return std::abs(f.worst / f.limit);
  return std::abs(f.worst - f.limit);
}

// Excesses of different kinds side by side: shares of a limit, centimetres, tenths of a radian.
double rank(const Obstacle& o) {
  if (o.is_ratio) return o.excess - 1;
  if (o.finding.unit == "m") return o.excess / 0.01;
  if (o.finding.unit == "N") return o.excess / 10;
  return o.excess / 0.1;
}

std::string window_text(const Finding& f) {
  const std::string begin = text::fixed(f.begin, 2), end = text::fixed(f.end, 2);
  return begin == end ? "at " + text::fixed(f.at, 3) + " s" : "at " + begin + "-" + end + " s";
}

std::string what(const Finding& f, double excess) {
  if (const auto text = spec_of(f.kind).obstacle) return text(f, excess);
  return std::string(name_of(f.kind)) + " of " + f.where + " is " + text::brief(f.worst) +
         " against " + text::brief(f.limit) + " " + f.unit;
}

}  // namespace

bool is_matter_of_time(const Finding& f) {
  if (f.kind == FindingKind::continuous_torque) return false;  // the window is the motor's
  const LimitClass limit_class = spec_of(f.kind).limit_class;
  return limit_class == LimitClass::rate || limit_class == LimitClass::force;
}

double total_excess(const ConsistencyReport& report) {
  std::map<std::pair<std::string, std::string>, double> worst;
  for (const Finding& f : report.findings) {
    if (f.severity != Severity::error) continue;
    Obstacle o;
    o.finding = f;
    o.excess = excess_of(f);
    o.is_ratio = spec_of(f.kind).is_ratio();
    double& w = worst[{name_of(f.kind), f.where}];
    w = std::max(w, rank(o));
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

// What of its time is locked, in words; empty: nothing.
std::string time_lock(const Finding& f, const RepairOptions& options) {
  std::string instant;
  for (const auto& [begin, end] : options.locked_windows) {
    if (begin < end && f.at >= begin && f.at <= end) return "that window is locked";
    if (begin == end && is_of_posture(f) && f.begin <= begin && f.end >= begin)
      instant = "the posture at " + text::brief(begin) + " s is locked";
  }
  return instant;
}

bool at_locked_joint(const Finding& f, const RepairOptions& options) {
  return std::find(options.locked_joints.begin(), options.locked_joints.end(), f.where) !=
         options.locked_joints.end();
}

}  // namespace

double time_factor(const RobotModel& model, const CommandSeries& series, const Finding& finding,
                   const CheckOptions& options) {
  if (!is_matter_of_time(finding) || !passes(model, series, finding, kSlowest, options)) return 0;
  double low = 1, high = kSlowest;
  while (high - low > 0.01) {
    const double middle = 0.5 * (low + high);
    (passes(model, series, finding, middle, options) ? high : low) = middle;
  }
  return high;
}

std::vector<Obstacle> obstacles(const RobotModel& model, const CommandSeries& series,
                                const ConsistencyReport& report, const RepairOptions& options) {
  const auto locked = [&](const Finding& f) {
    return at_locked_joint(f, options) || !time_lock(f, options).empty();
  };
  const auto is_error = [](const Finding& f) { return f.severity == Severity::error; };
  const bool by_lock = std::any_of(report.findings.begin(), report.findings.end(),
                                   [&](const Finding& f) { return is_error(f) && locked(f); });
  std::map<std::pair<std::string, std::string>, Obstacle> worst;
  for (const Finding& f : report.findings) {
    if (!is_error(f) || (by_lock && !locked(f))) continue;
    Obstacle o;
    o.finding = f;
    o.excess = excess_of(f);
    o.is_ratio = spec_of(f.kind).is_ratio();
    const auto found = worst.try_emplace({name_of(f.kind), f.where}, o).first;
    if (o.excess > found->second.excess) found->second = o;
  }
  std::vector<Obstacle> result;
  for (auto& entry : worst) {
    Obstacle& o = entry.second;
    o.time_factor = time_factor(model, series, o.finding, options.check);
    o.text = what(o.finding, o.excess) + " " + window_text(o.finding) + ", ";
    if (at_locked_joint(o.finding, options))
      o.text += o.finding.where + " is locked; unlock it, or else: ";
    else if (const std::string lock = time_lock(o.finding, options); !lock.empty())
      o.text += lock + "; unlock it, or else: ";
    o.text += remedy(o);
    result.push_back(std::move(o));
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const Obstacle& a, const Obstacle& b) { return rank(a) > rank(b); });
  return result;
}

}  // namespace ayumi
