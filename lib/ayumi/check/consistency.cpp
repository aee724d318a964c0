#include "ayumi/check/consistency.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/check/causes.hpp"
#include "ayumi/check/check_pass.hpp"
#include "ayumi/check/hints.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

CheckPass::CheckPass(const RobotModel& model, const CommandSeries& series,
                     const CheckOptions& options)
    : model(model),
      series(series),
      tolerance_of(tolerances(options, model, series)),
      friction(options.friction),
      limits(model.limits(options.profile)),
      plan(contact_plan(series)),
      collisions(model),
      dynamics(model, series, plan),
      weight(model.mass() * kGravity),
      windows(static_cast<int>(std::lround(kWindowGap / series.dt))),
      targets(static_cast<int>(std::lround(kWindowGap / series.dt))),
      square_sum(Eigen::MatrixXd::Zero(model.dof_count(), count() + 1)),
      flight_moment(count(), Eigen::Vector3d::Zero()),
      cog(count(), Eigen::Vector3d::Zero()),
      cog_deviation(count(), 0.0),
      soles{std::vector<SoleError>(count()), std::vector<SoleError>(count())},
      rough(count(), 0) {
  summary.min_zmp_margin = std::numeric_limits<double>::infinity();
  summary.min_self_clearance = std::numeric_limits<double>::infinity();
}

bool CheckPass::at_flight_edge(int k) const { return ayumi::at_flight_edge(series, k); }

namespace {

// Of the numbers of a finding: where a tolerance is a share, the finding tells the whole.
std::string unit_of(const RobotModel& model, const Violation& v) {
  const bool prismatic = v.kind >= FindingKind::joint_position &&
                         v.kind <= FindingKind::servo_step && model.dofs()[v.item].prismatic;
  switch (v.kind) {
    case FindingKind::fz_residual:
    case FindingKind::unilateral:
      return "N";
    case FindingKind::joint_position:
    case FindingKind::servo_step:
      return prismatic ? "m" : "rad";
    case FindingKind::joint_speed:
      return prismatic ? "m/s" : "rad/s";
    case FindingKind::joint_acceleration:
      return prismatic ? "m/s^2" : "rad/s^2";
    case FindingKind::joint_torque:
    case FindingKind::continuous_torque:
      return prismatic ? "N" : "N m";
    default:
      return finding_specs()[static_cast<size_t>(v.kind)].unit;
  }
}

Finding finding_of(const CheckPass& pass, const std::vector<FindingWindow>& windows,
                   const FindingWindow& window) {
  const Violation& v = window.worst;
  const double dt = pass.series.dt;
  Finding f;
  f.kind = v.kind;
  f.severity = v.severity;
  f.begin = window.first * dt;
  f.end = window.last * dt;
  f.at = v.sample * dt;
  f.worst = v.value;
  f.limit = v.limit;
  f.unit = unit_of(pass.model, v);
  f.place = place_of(pass.collisions.pairs(), v);
  f.where = where_text(pass.model, f.place);
  const Advice advice = advice_for(pass.model, window, dt, pass.friction);
  f.remedy = advice.remedy;
  f.hint = advice.remedy + advice.or_repair;
  if (window.cause >= 0) {
    const Violation& cause = windows[window.cause].worst;
    f.follows_from = std::string(name_of(cause.kind)) + " " +
                     where_text(pass.model, place_of(pass.collisions.pairs(), cause)) + " at " +
                     text::fixed(cause.sample * dt, 3) + " s";
    f.hint = f.remedy = "follows from " + f.follows_from + ": mend that first";
  }
  return f;
}

// Where acceleration bends, as beside a flight, the ZMP of single samples is thrown: for less than
// 5 ms a moment of that size turns nothing. Told as a warning.
void excuse_spikes(const CheckPass& pass, std::vector<FindingWindow>& windows) {
  constexpr double kShort = 0.005;  // [s]
  constexpr double kSmall = 3;      // times the limit
  for (FindingWindow& w : windows) {
    const double lasts = (w.last - w.first + 1) * pass.series.dt;
    if (w.worst.kind == FindingKind::zmp_residual && lasts < kShort - 1e-9 &&
        w.worst.value <= kSmall * w.worst.limit)
      w.worst.severity = Severity::warning;
  }
}

ConsistencyReport report_of(CheckPass& pass) {
  std::vector<FindingWindow> windows = pass.windows.finish();
  excuse_spikes(pass, windows);
  explain(pass, windows);
  const std::vector<FindingWindow> targets = pass.targets.finish();
  windows.insert(windows.end(), targets.begin(), targets.end());
  ConsistencyReport report;
  report.profile = pass.limits.name;
  report.summary = pass.summary;
  if (!std::isfinite(report.summary.min_zmp_margin)) report.summary.min_zmp_margin = 0;
  if (!std::isfinite(report.summary.min_self_clearance)) report.summary.min_self_clearance = 0;
  for (const FindingWindow& window : windows)
    report.findings.push_back(finding_of(pass, windows, window));
  std::stable_sort(report.findings.begin(), report.findings.end(),
                   [](const Finding& a, const Finding& b) {
                     return std::tie(a.severity, a.begin) < std::tie(b.severity, b.begin);
                   });
  report.consistent = std::none_of(report.findings.begin(), report.findings.end(),
                                   [](const Finding& f) { return f.severity == Severity::error; });
  return report;
}

}  // namespace

ConsistencyReport check_consistency(const RobotModel& model, const CommandSeries& series,
                                    const CheckOptions& options) {
  if (!model.has_soles())
    fail(ErrorCode::bad_model, model.name() +
                                   ": has no soles, so nothing can be said about its "
                                   "contacts; name them in the sidecar");
  if (series.samples.empty())
    fail(ErrorCode::bad_pattern, "the command series is empty: nothing to check");
  if (!(series.dt > 0)) fail(ErrorCode::usage, "the command series has no sample time");
  CheckPass pass(model, series, options);
  check_samples(pass);
  check_feet(pass);
  check_angular_momentum(pass);
  check_leaps(pass);
  check_servo_steps(pass);
  check_servo_targets(pass);
  check_continuous_torque(pass);
  check_self_collision(pass);
  return report_of(pass);
}

}  // namespace ayumi
