#include "ayumi/repair/rough_motion.hpp"

#include <algorithm>
#include <map>

#include "ayumi/math/windows.hpp"
#include "ayumi/motion/correction.hpp"
#include "ayumi/motion/smooth_motion.hpp"
#include "ayumi/repair/infeasibility_report.hpp"

namespace ayumi {

namespace policy = repair_policy;

namespace {

bool may_change(const CommandSeries& series, const RepairOptions& options) {
  const bool locked = !options.locked_joints.empty() || !options.locked_windows.empty() ||
                      options.locked_feet[0] || options.locked_feet[1];
  return !locked && options.trust == Trust::posture &&
         std::none_of(series.samples.begin(), series.samples.end(),
                      [](const CommandSample& s) { return s.support == Support::none; });
}

std::vector<TimeWindow> jumps(const ConsistencyReport& check, double around) {
  std::vector<TimeWindow> windows;
  for (const Finding& f : check.findings)
    if (f.kind == FindingKind::joint_acceleration)
      windows.emplace_back(f.begin - around, f.end + around);
  return merged(std::move(windows));
}

// Whether smooth curves follow less than half of the power of the accelerations.
bool is_noisy(const CommandSeries& series, double spacing) {
  const CommandSeries smooth = smoothed(series, {{0, series.duration(), spacing}});
  double followed = 0, lost = 0;
  for (size_t k = 0; k < series.samples.size(); ++k) {
    const auto dof = series.samples[k].state.theta.size();
    const Eigen::VectorXd given = series.samples[k].acceleration.tail(dof),
                          curve = smooth.samples[k].acceleration.tail(dof);
    followed += curve.squaredNorm();
    lost += (given - curve).squaredNorm();
  }
  return lost > followed;
}

// How far limits of rates and forces are exceeded, as causes or as consequences. Errors of the
// posture do not count, because a smooth correction can remove them.
double roughness(const ConsistencyReport& check) {
  std::map<std::pair<FindingKind, std::string>, double> worst;
  for (const Finding& f : check.findings) {
    const bool counts = f.severity == Severity::error || !f.follows_from.empty();
    if (!counts || !is_matter_of_time(f)) continue;
    double& most = worst[{f.kind, f.where}];
    most = std::max(most, severity_of(f));
  }
  double sum = 0;
  for (const auto& entry : worst) sum += entry.second;
  return sum;
}

}  // namespace

std::vector<SmoothWindow> rough_windows(const RobotModel& model, const CommandSeries& series,
                                        const ConsistencyReport& check,
                                        const RepairOptions& options) {
  const double spacing = options.knot_spacing, end = series.duration();
  std::vector<SmoothWindow> best;
  double least = policy::rough::kGain * roughness(check);
  if (least == 0 || !may_change(series, options)) return best;
  std::vector<std::vector<TimeWindow>> choices;
  if (const auto around = jumps(check, policy::rough::kAround * spacing); !around.empty())
    choices.push_back(around);
  if (is_noisy(series, spacing)) choices.push_back({{0, end}});
  for (const std::vector<TimeWindow>& windows : choices) {
    std::vector<SmoothWindow> tried;
    for (const TimeWindow& w : windows)
      tried.push_back({std::max(0.0, w.first), std::min(end, w.second), spacing});
    const double violation =
        roughness(check_consistency(model, apply_smoothing(model, series, tried), options.check));
    if (violation >= least) continue;
    least = policy::rough::kGain * violation;
    best = tried;
  }
  return best;
}

}  // namespace ayumi
