#include "ayumi/io/kept_rows.hpp"

#include <cmath>

#include "ayumi/io/pattern/pattern_table.hpp"
#include "ayumi/io/table/csv_dialect.hpp"
#include "ayumi/io/table/table.hpp"

namespace ayumi {

namespace {

// Whether the pattern still moves as its table does.
bool moves_as_table(const Task& task) {
  constexpr double kSame = 1e-6;  // tolerance [rad]. Chosen: a hundredth of a count
  const DenseTable& table = *task.pattern.table;
  const CommandSeries& series = task.series;
  const double rows = series.duration() / table.dt + 1;
  if (std::abs(rows - static_cast<double>(table.theta.rows())) > 0.5) return false;
  for (size_t k = 0; k < series.samples.size(); ++k) {
    const double row = static_cast<double>(k) * series.dt / table.dt;
    if (std::abs(row - std::round(row)) > 1e-6 || std::lround(row) >= table.theta.rows()) continue;
    for (size_t i = 0; i < table.joints.size(); ++i) {
      const int dof = task.robot.find_dof(table.joints[i]);
      const double angle = table.theta(std::lround(row), static_cast<Eigen::Index>(i));
      if (dof < 0 || std::abs(series.samples[k].state.theta[dof] - angle) > kSame) return false;
    }
  }
  return true;
}

}  // namespace

std::optional<KeptRows> kept_rows(const Task& task) {
  if (!task.pattern.table) return {};
  const DenseTable& table = *task.pattern.table;
  // A copy in another format (io/import_pattern.hpp) has no rows of targets.
  if (!table.sequence || !table.sequence->file.ends_with(sequence_beside("").string()) ||
      theta_sha256(table) != table.sequence->theta_sha256 ||
      !read_with_encoders_of(task.robot, table) || !moves_as_table(task))
    return {};
  std::string bytes = kept_sequence(table);
  HoapFile file =
      parse_hoap(plain_table_text(bytes, table.sequence->file), table.sequence->file, task.robot);
  ReferenceTrajectory targets = hoap_targets(task.robot, file);
  return KeptRows{std::move(file), std::move(bytes), std::move(targets)};
}

std::optional<ReferenceTrajectory> rows_of_table(const Task& task,
                                                 const ReferenceTrajectory& planned) {
  if (!task.pattern.table) return {};
  const DenseTable& table = *task.pattern.table;
  if (table.commands || task.pattern.correction || !moves_as_table(task)) return {};
  ReferenceTrajectory rows = resampled(planned, table.dt);
  rows.rows.resize(static_cast<size_t>(table.theta.rows()), rows.rows.back());
  for (size_t k = 0; k < rows.rows.size(); ++k) {
    ReferenceRow& row = rows.rows[k];
    for (size_t i = 0; i < table.joints.size(); ++i)
      row.theta[task.robot.find_dof(table.joints[i])] =
          table.theta(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i));
    if (!table.base.empty()) row.base = table.base[k];
    if (!table.cog.empty()) row.cog = table.cog[k];
    if (!table.zmp.empty()) row.zmp = table.zmp[k];
    if (!table.fz.empty()) row.fz = table.fz[k];
  }
  return rows;
}

}  // namespace ayumi
