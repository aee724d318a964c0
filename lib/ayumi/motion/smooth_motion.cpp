// With the control points c of a cubic spline with n intervals of the length h,
//   x = (c_0 + 4 c_1 + c_2)/6,  x' = (c_2 - c_0)/(2h),  x'' = (c_0 - 2 c_1 + c_2)/h^2
// at the first knot; so place, speed and acceleration determine the first three control points, and
// in the same way the last three. The others minimise the squares of the differences.
#include "ayumi/motion/smooth_motion.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "ayumi/motion/correction.hpp"
#include "ayumi/motion/differentiate.hpp"

namespace ayumi {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;

namespace {

// Windows with fewer steps than this are left as they are. Derived: four intervals of two steps.
constexpr int kFewestSteps = 8;

// Base position, quaternion and joints of one sample, and their first and second derivatives.
struct Columns {
  RowVectorXd place, speed, acceleration;
};

Eigen::Vector4d quaternion_rate(const Eigen::Quaterniond& q, const Eigen::Vector3d& w) {
  return 0.5 * (Eigen::Quaterniond(0, w.x(), w.y(), w.z()) * q).coeffs();
}

// `sign` is that of the quaternion.
Columns columns_of(const CommandSample& sample, double sign) {
  const RobotState& state = sample.state;
  const Index size = 7 + state.theta.size();
  Columns c = {RowVectorXd(size), RowVectorXd(size), RowVectorXd(size)};
  const Eigen::Quaterniond& q = state.base.attitude;
  const Eigen::Vector3d w = state.base_angular_velocity, dw = sample.acceleration.segment<3>(3);
  c.place << state.base.position.transpose(), sign * q.coeffs().transpose(),
      state.theta.transpose();
  c.speed << state.base_velocity.transpose(), sign * quaternion_rate(q, w).transpose(),
      state.dtheta.transpose();
  c.acceleration << sample.acceleration.head<3>().transpose(),
      sign * (quaternion_rate(q, dw) - 0.25 * w.squaredNorm() * q.coeffs()).transpose(),
      sample.acceleration.tail(state.theta.size()).transpose();
  return c;
}

// The first three control points; for the last three, `h` is negative and their order is reversed.
MatrixXd end_points(const Columns& at, double h, bool rests) {
  MatrixXd points(3, at.place.size());
  const double moves = rests ? 0 : 1;
  const RowVectorXd step = moves * h * at.speed, bend = moves * h * h * at.acceleration;
  points.row(0) = at.place - step + bend / 3;
  points.row(1) = at.place - bend / 6;
  points.row(2) = at.place + step + bend / 3;
  return points;
}

// The control points between the three known ones at both ends.
void solve_middle(const CorrectionTrack& track, const MatrixXd& places, double dt,
                  MatrixXd& points) {
  const Index count = points.rows(), free = count - 6;
  if (free <= 0) return;
  std::vector<Eigen::Triplet<double>> entries;
  MatrixXd right = MatrixXd::Zero(free, points.cols());
  for (Index k = 0; k < places.rows(); ++k) {
    const SplineWeights w = correction_weights(track, static_cast<double>(k) * dt);
    RowVectorXd rest = places.row(k);
    for (int i = 0; i < 4; ++i) {
      const Index at = w.first + i;
      if (at < 3 || at >= count - 3) rest -= w.value[i] * points.row(at);
    }
    for (int i = 0; i < 4; ++i) {
      const Index row = w.first + i - 3;
      if (row < 0 || row >= free) continue;
      right.row(row) += w.value[i] * rest;
      for (int j = 0; j < 4; ++j)
        if (const Index column = w.first + j - 3; column >= 0 && column < free)
          entries.emplace_back(static_cast<int>(row), static_cast<int>(column),
                               w.value[i] * w.value[j]);
    }
  }
  Eigen::SparseMatrix<double> normal(free, free);
  normal.setFromTriplets(entries.begin(), entries.end());
  points.middleRows(3, free) =
      Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(normal).solve(right);
}

// The first and the last sample of a window.
struct Span {
  int first = 0, end = 0, last_of_motion = 0;
};

Span span_of(const CommandSeries& series, const SmoothWindow& window) {
  const long last = static_cast<long>(series.samples.size()) - 1;
  const auto at = [&](double t) {
    return static_cast<int>(std::clamp(std::lround(t / series.dt), 0L, last));
  };
  return {at(window.begin), at(window.end), static_cast<int>(last)};
}

void smooth_window(CommandSeries& series, const SmoothWindow& window) {
  const auto [first, end, last] = span_of(series, window);
  const double length = static_cast<double>(end - first) * series.dt;
  if (end - first < kFewestSteps) return;
  // At least two samples lie between two knots, so that the squares determine every control point.
  const Index count =
      std::clamp(std::round(length / window.spacing), 4.0, static_cast<double>((end - first) / 2)) +
      3;
  CorrectionTrack track;
  track.spacing = length / static_cast<double>(count - 3);
  track.coefficients.setZero(count, 6);
  const auto sample = [&](long k) -> CommandSample& {
    return series.samples[static_cast<size_t>(k)];
  };
  MatrixXd places(end - first + 1, 7 + sample(0).state.theta.size());
  std::array<Columns, 2> ends;
  double sign = 1;
  for (long k = first; k <= end; ++k) {
    if (k > first && sample(k).state.base.attitude.dot(sample(k - 1).state.base.attitude) < 0)
      sign = -sign;
    const Columns columns = columns_of(sample(k), sign);
    places.row(k - first) = columns.place;
    if (k == first) ends[0] = columns;
    if (k == end) ends[1] = columns;
  }
  MatrixXd points(count, places.cols());
  points.topRows<3>() = end_points(ends[0], track.spacing, first == 0);
  points.bottomRows<3>() = end_points(ends[1], -track.spacing, end == last).colwise().reverse();
  solve_middle(track, places, series.dt, points);
  for (long k = first + 1; k < end; ++k) {  // at its ends, the curve has the place of the motion
    const SplineWeights w = correction_weights(track, static_cast<double>(k - first) * series.dt);
    const VectorXd x = points.middleRows<4>(w.first).transpose() * w.value;
    RobotState& state = sample(k).state;
    state.base.position = x.head<3>();
    state.base.attitude = Eigen::Quaterniond(Eigen::Vector4d(x.segment<4>(3))).normalized();
    state.theta = x.tail(x.size() - 7);
  }
}

// Velocities and accelerations where the curve changes them: in the window and, because differences
// use two neighbours, next to it. All other samples keep those of the motion. A curve rests at the
// ends of the motion.
void fill_rates_of(CommandSeries& series, const SmoothWindow& window) {
  const auto [first, end, last] = span_of(series, window);
  if (end - first < kFewestSteps) return;
  const int middle = (first + end) / 2;
  fill_rates(series.samples, std::max(first - 1, 0), middle, series.dt, first == 0);
  fill_rates(series.samples, middle, std::min(end + 1, last) + 1, series.dt, end == last);
}

}  // namespace

CommandSeries smoothed(const CommandSeries& series, const std::vector<SmoothWindow>& windows) {
  CommandSeries result = series;
  for (const SmoothWindow& window : windows) smooth_window(result, window);
  for (const SmoothWindow& window : windows) fill_rates_of(result, window);
  return result;
}

}  // namespace ayumi
