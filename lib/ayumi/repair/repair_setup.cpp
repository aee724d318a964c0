#include "ayumi/repair/repair_setup.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "ayumi/base/text.hpp"
#include "ayumi/demand/collision_scan.hpp"
#include "ayumi/math/linear_solve.hpp"
#include "ayumi/math/windows.hpp"
#include "ayumi/motion/correction.hpp"
#include "ayumi/repair/weighted_change.hpp"

namespace ayumi {

namespace policy = repair_policy;

namespace {

std::vector<bool> locked_dofs(const RobotModel& model, const std::vector<std::string>& names) {
  std::vector<bool> locked(model.dof_count(), false);
  for (const std::string& name : names) {
    const int dof = model.find_dof(name);
    if (dof < 0)
      fail(ErrorCode::usage, "locked joint '" + name + "': the robot '" + model.name() +
                                 "' has no such joint" + text::suggestion(name, model.dof_names()));
    locked[dof] = true;
  }
  return locked;
}

void require_windows(const std::vector<TimeWindow>& windows) {
  for (const auto& [begin, end] : windows)
    if (!(begin <= end) || !std::isfinite(begin) || !std::isfinite(end))
      fail(ErrorCode::usage, "locked window " + text::exact(begin) + ".." + text::exact(end) +
                                 " s: the window must not end before it begins");
}

// The times of locked windows without length, moved to the nearest samples.
std::vector<double> kept_times(const std::vector<TimeWindow>& windows,
                               const CommandSeries& series) {
  std::set<long> samples;
  for (const auto& [begin, end] : windows)
    if (begin == end)
      samples.insert(std::clamp(std::lround(begin / series.dt), 0L,
                                static_cast<long>(series.samples.size()) - 1));
  std::vector<double> times;
  for (const long k : samples) times.push_back(static_cast<double>(k) * series.dt);
  return times;
}

// The duration of the shortest flight [s]; unbounded for a motion without a flight.
double shortest_flight(const CommandSeries& series) {
  double shortest = kNoBound;
  for (const CommandSeries::Flight& flight : series.flights())
    shortest = std::min(shortest, static_cast<double>(flight.last + 1 - flight.first) * series.dt);
  return shortest;
}

}  // namespace

double safe_margin(const RobotModel& model) {
  double least = kNoBound;
  for (Side side : {Side::left, Side::right}) {
    const ConvexPolygon polygon(model.sole(side).polygon);
    least = std::min(least, polygon.margin(polygon.centroid()));
  }
  return policy::zmp::kSafeShare * least;
}

bool flight_is_at_fault(const ConsistencyReport& report) {
  return std::any_of(report.findings.begin(), report.findings.end(), [](const Finding& f) {
    return f.severity == Severity::error && spec_of(f.kind).repair.in_flight;
  });
}

double spacing_of_faults(const CommandSeries& series, const ConsistencyReport& report,
                         double finest) {
  double spacing = flight_is_at_fault(report)
                       ? shortest_flight(series) / policy::knots::kInFaultyFlight
                       : kNoBound;
  for (const Finding& f : report.findings)
    if (spec_of(f.kind).repair.is_brief && f.severity == Severity::error)
      spacing = std::min(spacing, std::max((f.end - f.begin) / policy::knots::kInSlip, finest));
  return spacing;
}

std::vector<TimeWindow> windows_around(const std::vector<Finding>& findings, double pad) {
  std::vector<TimeWindow> windows;
  for (const Finding& f : findings)
    if (f.severity == Severity::error || spec_of(f.kind).repair.warnings_too ||
        !f.follows_from.empty())
      windows.emplace_back(f.begin - pad, f.end + pad);
  return merged(std::move(windows));
}

void add_error_times(const ConsistencyReport& report, double dt, std::vector<double>& times) {
  for (const Finding& f : report.findings) {
    if (f.severity != Severity::error) continue;
    const double length = f.end - f.begin;
    const int steps = std::clamp(static_cast<int>(std::lround(length / dt)), 1,
                                 policy::collocation::kMostPerError);
    for (int i = 0; i <= steps; ++i) times.push_back(f.begin + length * i / steps);
    times.push_back(f.at);
  }
}

CorrectionTrack trimmed(const CorrectionTrack& track) {
  const Eigen::MatrixXd c =
      (track.coefficients * policy::report::kWritten).array().round() / policy::report::kWritten;
  Eigen::Index first = c.rows(), last = -1;
  for (Eigen::Index i = 0; i < c.rows(); ++i) {
    if (c.row(i).isZero(0)) continue;
    first = std::min(first, i);
    last = i;
  }
  CorrectionTrack result;
  result.spacing = track.spacing;
  if (last < 0) {
    result.coefficients.setZero(4, 6);
    return result;
  }
  first = std::max<Eigen::Index>(0, first - 3);
  last = std::min(c.rows() - 1, last + 3);
  result.begin = track.begin + track.spacing * static_cast<double>(first);
  std::vector<Eigen::Index> columns = {0, 1, 2, 3, 4, 5};
  for (Eigen::Index j = 6; j < c.cols(); ++j) {
    if (c.col(j).isZero(0)) continue;
    columns.push_back(j);
    result.joints.push_back(track.joints[j - 6]);
  }
  result.coefficients = c(Eigen::seq(first, last), columns);
  return result;
}

// Only control points that already differ from zero are changed. The first and the last three are
// zero or tied to each other. The second pass removes the rounding of the first.
CorrectionTrack kept_at(CorrectionTrack track, const std::vector<double>& times) {
  Eigen::MatrixXd& c = track.coefficients;
  const double end = track.begin + track.spacing * static_cast<double>(c.rows() - 3);
  std::vector<double> inside;
  for (const double t : times)
    if (t > track.begin && t < end) inside.push_back(t);
  if (inside.empty()) return track;
  const auto count = static_cast<Eigen::Index>(inside.size());
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(count, c.rows()), free = all;
  for (Eigen::Index i = 0; i < count; ++i) {
    const SplineWeights weights = correction_weights(track, inside[static_cast<size_t>(i)]);
    all.row(i).segment<4>(weights.first) = weights.value.transpose();
  }
  for (Eigen::Index row = 3; row < c.rows() - 3; ++row)
    if (!c.row(row).isZero(0)) free.col(row) = all.col(row);
  for (int pass = 0; pass < 2; ++pass) c -= solve_least_norm(free, all * c);
  return track;
}

CorrectionSpec repair_spec(const RobotModel& model, const CommandSeries& series,
                           const RepairOptions& options) {
  require_windows(options.locked_windows);
  CorrectionSpec spec;
  spec.spacing = std::min(options.knot_spacing, shortest_flight(series) / policy::knots::kInFlight);
  spec.locked = locked_dofs(model, options.locked_joints);
  spec.locked_feet = options.locked_feet;
  for (const auto& window : options.locked_windows)
    if (window.first < window.second) spec.locked_windows.push_back(window);
  spec.kept_times = kept_times(options.locked_windows, series);
  spec.weights = weight_factors(model, options.joint_weights);
  spec.trust = options.trust;
  spec.threads = options.check.threads;
  spec.tolerance = tolerances(options.check, model, series);
  spec.profile = options.check.profile;
  spec.friction = options.check.friction;
  const double least = tolerances(options.check)[FindingKind::support_margin];
  const double safe = options.trust == Trust::zmp ? least : safe_margin(model);
  spec.safe_margin = options.zmp_margin.value_or(safe) + policy::kFirstBackoff.zmp;
  spec.zmp_margin = std::min(spec.safe_margin, least + policy::kFirstBackoff.zmp);
  spec.swing_goals = options.safety > 0;
  if (!spec.swing_goals) spec.safe_margin = spec.zmp_margin;
  return spec;
}

std::vector<TimeWindow> wrong_plan(const ConsistencyReport& report) {
  constexpr double kAround = policy::dcm::kWrongPlanAround;
  std::vector<TimeWindow> windows;
  for (const Finding& f : report.findings)
    if (f.severity == Severity::error && spec_of(f.kind).repair.is_of_plan)
      windows.emplace_back(f.begin - kAround, f.end + kAround);
  return windows;
}

void add_near_pairs(const RobotModel& model, const CommandSeries& series,
                    const CollisionModel& collisions, std::vector<int>& pairs) {
  constexpr double kNear = policy::clearance::kWatchedBodies;
  std::set<int> near(pairs.begin(), pairs.end());
  scan_clearance(model, series, collisions, kNear, kNear, [&](int pair, int, double clearance) {
    if (clearance < kNear) near.insert(pair);
  });
  pairs.assign(near.begin(), near.end());
}

bool locked_out(const CorrectionSpec& spec, const ConsistencyReport& report) {
  for (const Finding& f : report.findings) {
    const RepairTraits& traits = spec_of(f.kind).repair;
    if (f.severity != Severity::error || traits.is_mean) continue;
    const int dof = dof_of(f);
    const bool joint = dof >= 0 && spec.locked[dof] && traits.is_of_one_joint;
    const bool window = within(spec.locked_windows, f.at);
    const bool posture =
        is_of_posture(f) && std::any_of(spec.kept_times.begin(), spec.kept_times.end(),
                                        [&](const double t) { return t >= f.begin && t <= f.end; });
    if (joint || window || posture) return true;
  }
  return false;
}

// A finding that is a mean over many samples is not an error of the posture at the end of the
// motion.
std::array<bool, 2> faulty_ends(const ConsistencyReport& report, double duration, double spacing) {
  std::array<bool, 2> ends = {};
  for (const Finding& f : report.findings) {
    if (f.severity != Severity::error || spec_of(f.kind).repair.is_mean) continue;
    if (f.begin < spacing) ends[0] = true;
    if (f.end > duration - spacing) ends[1] = true;
  }
  return ends;
}

}  // namespace ayumi
