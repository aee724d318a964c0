#include "ayumi/identify/recorded_motion.hpp"

#include "ayumi/base/error.hpp"

namespace ayumi {

using Eigen::Index;
using Eigen::MatrixXd;

namespace {

// Share of the shorter of two recordings for which the times of both must overlap if one clock
// measured them. Chosen: recorders that are started by hand miss less than half of a motion, and
// times of different clocks, such as seconds of the day and seconds of the motion, do not overlap.
constexpr double kOneClock = 0.5;

double difference_of_clocks(std::optional<double> first, double first_lasts,
                            std::optional<double> second, double second_lasts) {
  if (!first || !second) return 0;
  const double overlap =
      std::min(*first + first_lasts, *second + second_lasts) - std::max(*first, *second);
  return overlap >= kOneClock * std::min(first_lasts, second_lasts) ? *second - *first : 0;
}

/// The rows of `values`, which are `dt` [s] apart and begin `after` [s] after the wanted rows.
MatrixXd at_rows(const MatrixXd& values, double dt, double after, Index rows, double wanted_dt) {
  MatrixXd result(rows, values.cols());
  for (Index column = 0; column < values.cols(); ++column)
    for (Index k = 0; k < rows; ++k)
      result(k, column) =
          interpolated(values.col(column), dt, wanted_dt * static_cast<double>(k) - after);
  return result;
}

}  // namespace

double interpolated(const Eigen::Ref<const Eigen::VectorXd>& values, double dt, double t) {
  const double at = t / dt;
  const Index last = values.size() - 1;
  if (at <= 0) return values[0];
  const auto k = static_cast<Index>(at);
  if (k >= last) return values[last];
  const double u = at - static_cast<double>(k);
  return (1 - u) * values[k] + u * values[k + 1];
}

double first_row_after(const AngleTable& angles, const SensorTable& sensors) {
  return difference_of_clocks(angles.clock_start, angles.duration(), sensors.clock_start,
                              sensors.duration());
}

void add_sensors(const SensorTable& more, SensorTable& all, const std::string& file) {
  if (all.rows() == 0) {
    all = more;
    return;
  }
  const double after =
      difference_of_clocks(all.clock_start, all.duration(), more.clock_start, more.duration());
  const Index rows = all.rows();
  const auto add = [&](const MatrixXd& from, MatrixXd& to, const char* name) {
    if (from.size() == 0) return;
    if (to.size() > 0)
      fail(ErrorCode::usage, {file},
           std::string("another file already holds ") + name + "; give only one such file");
    to = at_rows(from, more.dt, after, rows, all.dt);
  };
  add(more.foot_load, all.foot_load, "the loads of the feet");
  add(more.acceleration, all.acceleration, "accelerations");
  add(more.gyro, all.gyro, "angular velocities");
}

}  // namespace ayumi
