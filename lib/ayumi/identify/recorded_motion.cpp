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
/// Before the first and after the last row, that row is used.
MatrixXd at_rows(const MatrixXd& values, double dt, double after, Index rows, double wanted_dt) {
  MatrixXd result(rows, values.cols());
  const Index last = values.rows() - 1;
  for (Index k = 0; k < rows; ++k) {
    const double at = std::clamp((wanted_dt * static_cast<double>(k) - after) / dt, 0.0,
                                 static_cast<double>(last));
    const Index row = std::min(last, static_cast<Index>(at)), next = std::min(last, row + 1);
    const double u = at - static_cast<double>(row);
    result.row(k) = (1 - u) * values.row(row) + u * values.row(next);
  }
  return result;
}

}  // namespace

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
