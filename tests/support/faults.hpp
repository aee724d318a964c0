#pragma once
// Patterns as dense tables (theta, base, COG, ZMP, f_z), and faults planted in them one by one.

#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/plan/sample.hpp"
#include "tests/support/walk.hpp"

namespace ayumi::test {

/// A smooth bump that is 1 at `center`, and 0 from `width` / 2 away on.
inline double bump(double t, double center, double width) {
  const double s = (t - center) / width;
  return std::abs(s) < 0.5 ? std::pow(std::cos(M_PI * s), 4) : 0;
}

/// The pattern with every quantity as a column of a table, which replaces the keyframes.
inline Pattern baked(const RobotModel& model, const Pattern& pattern) {
  const CommandSeries series = sample(model, pattern);
  Pattern result = pattern;
  result.keyframes.clear();
  result.correction.reset();
  DenseTable table;
  table.file = "baked.csv";
  table.dt = series.dt;
  table.joints = model.dof_names();
  table.theta.resize(static_cast<Eigen::Index>(series.samples.size()), model.dof_count());
  for (size_t k = 0; k < series.samples.size(); ++k) {
    const CommandSample& s = series.samples[k];
    table.theta.row(static_cast<Eigen::Index>(k)) = s.state.theta.transpose();
    table.base.push_back(s.state.base);
    table.cog.push_back(s.cog);
    table.zmp.push_back(s.zmp);
    table.fz.push_back(s.fz);
  }
  result.table = table;
  return result;
}

/// Calls `change(t, row, table)` for each row.
inline void for_rows(DenseTable& table, const std::function<void(double t, size_t k)>& change) {
  for (size_t k = 0; k < static_cast<size_t>(table.theta.rows()); ++k)
    change(table.dt * static_cast<double>(k), k);
}

inline void move_joint(const RobotModel& model, DenseTable& table, const std::string& joint,
                       double size, double center, double width) {
  const int column = model.find_dof(joint);
  for_rows(table, [&](double t, size_t k) {
    table.theta(static_cast<Eigen::Index>(k), column) += size * bump(t, center, width);
  });
}

/// Calls `change(t, base, feet)` for every row; the legs follow by inverse kinematics.
inline void move_body(const RobotModel& model, DenseTable& table,
                      const std::function<void(double t, BasePose& base,
                                               std::array<Eigen::Isometry3d, 2>& feet)>& change) {
  RobotData data(model);
  for_rows(table, [&](double t, size_t k) {
    RobotState state = model.rest_state();
    state.base = table.base[k];
    state.theta = table.theta.row(static_cast<Eigen::Index>(k)).transpose();
    update_positions(model, state, data);
    std::array<Eigen::Isometry3d, 2> feet = {sole_pose(model, data, Side::left),
                                             sole_pose(model, data, Side::right)};
    change(t, state.base, feet);
    place_legs(model, feet, state, data);
    table.base[k] = state.base;
    table.theta.row(static_cast<Eigen::Index>(k)) = state.theta.transpose();
  });
}

/// The foot moves by `way` and back; base and arms stay.
inline void slip_foot(const RobotModel& model, DenseTable& table, Side side,
                      const Eigen::Vector3d& way, double center, double width) {
  move_body(model, table, [&](double t, BasePose&, auto& feet) {
    feet[static_cast<int>(side)].translation() += bump(t, center, width) * way;
  });
}

/// The trunk moves by `way` and back over its feet.
inline void sway_base(const RobotModel& model, DenseTable& table, const Eigen::Vector3d& way,
                      double center, double width) {
  move_body(model, table, [&](double t, BasePose& base, auto&) {
    base.position += bump(t, center, width) * way;
  });
}

/// Plays the whole motion, including its phases, in `share` of its time.
inline void squeeze(Pattern& pattern, double share) {
  pattern.table->dt *= share;
  for (Phase& phase : pattern.phases) phase.until *= share;
}

/// Removes the commands of the table beside the motion; they are then those of the full model.
inline void motion_alone(DenseTable& table) {
  table.cog.clear();
  table.zmp.clear();
  table.fz.clear();
}

}  // namespace ayumi::test
