#include "ayumi/repair/collocation.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "ayumi/dynamics/kinematics.hpp"

namespace ayumi {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

bool inside_a_window(const CorrectionSpec& spec, double begin, double end) {
  return std::any_of(spec.windows.begin(), spec.windows.end(),
                     [&](const auto& w) { return begin >= w.first && end <= w.second; });
}

// Times that are closer than this are equal [s]. Chosen: above rounding, below the sample period.
constexpr double kTimeRounding = 1e-9;

bool locked_within(const CorrectionSpec& spec, double begin, double end) {
  return std::any_of(spec.locked_windows.begin(), spec.locked_windows.end(), [&](const auto& w) {
    return begin < w.second + kTimeRounding && end > w.first - kTimeRounding;
  });
}

bool is_locked(const CorrectionSpec& spec, int column) {
  return column >= 6 && !spec.locked.empty() && spec.locked[column - 6];
}

bool rests_within(const CorrectionSpec& spec, int column, double begin, double end) {
  if (column < 6 || spec.resting.empty()) return false;
  const std::vector<TimeWindow>& windows = spec.resting[static_cast<size_t>(column - 6)];
  return std::any_of(windows.begin(), windows.end(), [&](const TimeWindow& w) {
    return begin >= w.first - kTimeRounding && end <= w.second + kTimeRounding;
  });
}

// If the first or last posture is at fault, it has to move. Then one variable moves all three
// control points of this end, so that the motion still begins or ends with its original speed.
void free_end(const CorrectionSpec& spec, int first, double time, CorrectionVariables& v) {
  const double reach =
      (time == 0 ? 1 : -1) * v.zero.spacing;  // influence of these three control points
  if (!inside_a_window(spec, time, time) || !spec.free_ends[first == 0 ? 0 : 1]) return;
  for (const double kept : spec.kept_times)
    if (std::abs(kept - time) <= v.zero.spacing) return;
  const double begin = std::min(time, time + 3 * reach), end = std::max(time, time + 3 * reach);
  if (locked_within(spec, begin, end)) return;
  for (int j = 0; j < v.index.cols(); ++j)
    if (!is_locked(spec, j) && !rests_within(spec, j, begin, end))
      v.index.block<3, 1>(first, j).setConstant(v.count++);
}

struct SampleChoice {
  std::set<int> all, knots;
  std::map<int, std::vector<std::pair<const RowKind*, int>>> only;
};

SampleChoice choose_samples(const CommandSeries& series, const ContactPlan& plan,
                            const CorrectionSpec& spec, const CorrectionTrack& track) {
  SampleChoice choice;
  const int count = static_cast<int>(series.samples.size());
  const int places = spec.points_per_knot * static_cast<int>(track.coefficients.rows() - 3);
  for (int i = 0; i <= places; ++i) {
    const double t = i * track.spacing / spec.points_per_knot;
    const int sample = std::min(count - 1, static_cast<int>(std::lround(t / series.dt)));
    choice.all.insert(sample);
    if (i % spec.points_per_knot == 0) choice.knots.insert(sample);
  }
  for (const auto* times : {&spec.extra_times, &spec.kept_times})
    for (const double t : *times)
      choice.all.insert(std::clamp(static_cast<int>(std::lround(t / series.dt)), 0, count - 1));
  for (const auto& intervals : plan.intervals)
    for (const ContactInterval& interval : intervals) {
      choice.all.insert(interval.first);
      choice.all.insert(interval.last);
    }
  // Adds the points beside the ends of a flight, where differences of samples become valid again.
  for (int k = 1; k < count; ++k) {
    if (at_flight_edge(series, k) == at_flight_edge(series, k - 1)) continue;
    choice.all.insert(k - 1);
    choice.all.insert(k);
  }
  for (const ActiveLimit& limit : spec.active)
    if (!choice.all.contains(limit.sample))
      choice.only[limit.sample].emplace_back(limit.kind, limit.item);
  for (const auto& [sample, rows] : choice.only) choice.all.insert(sample);
  return choice;
}

// Sets the contact, the ground and the planned places of one foot.
void set_foot(const ContactPlan& plan, Side side, CollocationPoint& point) {
  const int s = static_cast<int>(side), k = point.sample;
  const int i = plan.index[s][k];
  const int last = static_cast<int>(plan.intervals[s].size()) - 1;
  const ContactInterval& here = plan.intervals[s][i];
  // A swing at the beginning or the end of the motion has only one place.
  const ContactInterval& before = plan.intervals[s][i > 0 ? i - 1 : std::min(last, 1)];
  const ContactInterval& after = plan.intervals[s][i < last ? i + 1 : std::max(0, last - 1)];
  const bool lower = before.sole.translation().z() < after.sole.translation().z();
  point.contact[s] = here.contact;
  point.ground[s] = here.contact ? here.sole : lower ? before.sole : after.sole;
  point.place[s] = k - here.first < here.last - k ? before.sole : after.sole;
}

CollocationPoint point_at(const RobotModel& model, const CommandSeries& series,
                          const ContactPlan& plan, int k) {
  CollocationPoint point;
  point.sample = k;
  point.forces_known = !at_flight_edge(series, k);
  for (Side side : {Side::left, Side::right}) set_foot(plan, side, point);
  point.plane = support_plane(model, plan.support(k), point.ground);
  RobotData data(model);
  const CommandSample& sample = series.samples[k];
  update_positions(model, sample.state, data);
  point.path = {sole_pose(model, data, Side::left), sole_pose(model, data, Side::right)};
  if (point.plane.empty()) point.plane.frame.translation() = sample.cog;
  return point;
}

}  // namespace

MatrixXd CorrectionVariables::coefficients(const VectorXd& x) const {
  return index.unaryExpr([&x](int variable) { return variable < 0 ? 0.0 : x[variable]; });
}

VectorXd CorrectionVariables::values(const MatrixXd& c) const {
  VectorXd x = VectorXd::Zero(count);
  for (Index i = 0; i < index.rows(); ++i)
    for (Index j = 0; j < index.cols(); ++j)
      if (index(i, j) >= 0) x[index(i, j)] = c(i, j);
  return x;
}

bool CorrectionVariables::act_at(const SplineWeights& weights) const {
  for (int i = 0; i < 4; ++i)
    if (weights.value[i] > 0 && index.row(weights.first + i).maxCoeff() >= 0) return true;
  return false;
}

CorrectionVariables correction_variables(const RobotModel& model, const CommandSeries& series,
                                         const CorrectionSpec& spec) {
  CorrectionVariables v;
  const int intervals =
      std::max(1, static_cast<int>(std::ceil(series.duration() / spec.spacing - 1e-9)));
  v.zero.begin = 0;
  v.zero.spacing = std::max(series.duration(), series.dt) / intervals;
  v.zero.joints = model.dof_names();
  v.zero.coefficients = MatrixXd::Zero(intervals + 3, model.velocity_count());
  const int rows = intervals + 3, columns = model.velocity_count();
  v.index.setConstant(rows, columns, -1);
  for (int i = 3; i < rows - 3; ++i) {
    const double begin = (i - 3) * v.zero.spacing, end = (i + 1) * v.zero.spacing;
    if (!inside_a_window(spec, begin, end) || locked_within(spec, begin, end)) continue;
    for (int j = 0; j < columns; ++j)
      if (!is_locked(spec, j) && !rests_within(spec, j, begin, end)) v.index(i, j) = v.count++;
  }
  free_end(spec, 0, 0, v);
  free_end(spec, rows - 3, series.duration(), v);
  return v;
}

std::vector<CollocationPoint> collocation_points(const RobotModel& model,
                                                 const CommandSeries& series,
                                                 const ContactPlan& plan,
                                                 const CorrectionSpec& spec,
                                                 const CorrectionVariables& variables) {
  const SampleChoice choice = choose_samples(series, plan, spec, variables.zero);
  std::vector<CollocationPoint> points;
  for (const int k : choice.all) {
    const SplineWeights weights = correction_weights(variables.zero, k * series.dt);
    if (!variables.act_at(weights)) continue;
    CollocationPoint point = point_at(model, series, plan, k);
    point.weights = weights;
    point.at_knot = choice.knots.contains(k);
    if (const auto few = choice.only.find(k); few != choice.only.end()) point.only = few->second;
    points.push_back(std::move(point));
  }
  return points;
}

}  // namespace ayumi
