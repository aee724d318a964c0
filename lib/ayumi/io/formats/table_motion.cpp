#include "ayumi/io/formats/table_motion.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/degrees.hpp"
#include "ayumi/io/table/comma_cells.hpp"
#include "ayumi/io/table/csv_dialect.hpp"
#include "ayumi/io/table/root_columns.hpp"
#include "ayumi/io/table/table_columns.hpp"
#include "ayumi/model/encoder_angles.hpp"

namespace ayumi {

namespace {

[[noreturn]] void refuse_table(const std::string& file, const std::string& reason) {
  fail(ErrorCode::bad_file, {file}, reason);
}

bool is_group_column(const std::string& column) {
  for (const auto* group : {&kCogColumns, &kZmpColumns, &kBaseColumns, &kContactColumns})
    if (std::find(group->begin(), group->end(), column) != group->end()) return true;
  return column == "fz[N]";
}

// Whether a column states the unit of an angle.
enum class AngleUnit { no_angle, stated, missing };

// Joint columns with a name only, or with a unit, become theta columns. A time column of any name
// becomes t[s].
AngleUnit rename_column(NumberTable& table, Eigen::Index i, const RobotModel& model) {
  std::string& column = table.columns[static_cast<size_t>(i)];
  const ColumnName named = column_name(column);
  if (const std::optional<double> seconds = seconds_of_time_column(column)) {
    if (column == "t[s]") return AngleUnit::no_angle;
    if (table.find("t[s]") >= 0) {    // t[s] counts, otherwise the first column of times
      column = theta_column(column);  // it is left out like an unknown joint
      return AngleUnit::no_angle;
    }
    if (*seconds != 1) table.values.col(i) *= *seconds;
    column = "t[s]";
    return AngleUnit::no_angle;
  }
  if (is_group_column(column)) return AngleUnit::no_angle;
  const bool whole = find_joint(model, column) >= 0;  // the name itself may end like a unit
  std::string joint = whole ? column : named.name;
  if (joint.starts_with("theta.") && !named.unit.empty()) joint = joint.substr(6);
  const std::string unit = whole ? "" : named.unit;
  if (!(unit.empty() || unit == "deg" || unit == "rad")) return AngleUnit::no_angle;
  const int dof = find_joint(model, joint);
  const bool prismatic = dof >= 0 && model.dofs()[static_cast<size_t>(dof)].prismatic;
  if (unit == "deg" && !prismatic) table.values.col(i) *= kRadiansPerDegree;
  column = theta_column(joint);
  if (prismatic) return AngleUnit::no_angle;
  return unit.empty() ? AngleUnit::missing : AngleUnit::stated;
}

// Sets the origin of the unit. If no column states one, the importer assumes one; if only some
// columns state none, these are named.
void rename_columns(NumberTable& table, const RobotModel& model, const ImportOptions& options,
                    const std::string& file, MotionFile& motion) {
  std::vector<Eigen::Index> without_unit;
  bool stated = false;
  for (Eigen::Index i = 0; i < table.values.cols(); ++i) {
    const AngleUnit unit = rename_column(table, i, model);
    if (unit == AngleUnit::missing) without_unit.push_back(i);
    stated |= unit == AngleUnit::stated;
  }
  const bool assumed = !stated && !without_unit.empty();
  if (!assumed && options.degrees)
    for (const Eigen::Index i : without_unit) table.values.col(i) *= kRadiansPerDegree;
  for (size_t i = 0; i < table.columns.size(); ++i)
    if (std::find(table.columns.begin() + static_cast<std::ptrdiff_t>(i) + 1, table.columns.end(),
                  table.columns[i]) != table.columns.end())
      refuse_table(file, "the column '" + table.columns[i] + "' is given twice");
  motion.unit = assumed ? MotionFile::Unit::assumed : MotionFile::Unit::of_columns;
  if (!assumed)
    for (const Eigen::Index i : without_unit)
      motion.without_unit.push_back(
          column_name(table.columns[static_cast<size_t>(i)]).name.substr(6));  // without "theta."
}

std::vector<Eigen::Vector3d> vectors_of(const NumberTable& table, const std::vector<int>& at) {
  std::vector<Eigen::Vector3d> result;
  if (at.empty()) return result;
  for (Eigen::Index k = 0; k < table.values.rows(); ++k)
    result.emplace_back(table.values(k, at[0]), table.values(k, at[1]), table.values(k, at[2]));
  return result;
}

std::vector<BasePose> bases_of(const NumberTable& table, const TableLayout& layout,
                               const std::string& file) {
  std::vector<BasePose> result;
  if (layout.base.empty()) return result;
  for (Eigen::Index k = 0; k < table.values.rows(); ++k) {
    Eigen::Vector4d q;
    for (int i = 0; i < 4; ++i) q[i] = table.values(k, layout.base[3 + i]);
    if (std::abs(q.norm() - 1) > 0.01)
      refuse_table(file, "data row " + std::to_string(k + 1) +
                             ": the quaternion of the root has length " + text::brief(q.norm()) +
                             ", but a unit quaternion (w, x, y, z) is needed");
    BasePose base;
    base.position = {table.values(k, layout.base[0]), table.values(k, layout.base[1]),
                     table.values(k, layout.base[2])};
    base.attitude = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
    result.push_back(base);
  }
  return result;
}

std::vector<Support> supports_of(const NumberTable& table, const TableLayout& layout) {
  std::vector<Support> result;
  if (layout.contact.empty()) return result;
  for (Eigen::Index k = 0; k < table.values.rows(); ++k) {
    const bool left = table.values(k, layout.contact[0]) > 0.5;
    const bool right = table.values(k, layout.contact[1]) > 0.5;
    result.push_back(left && right ? Support::both
                     : left        ? Support::left
                     : right       ? Support::right
                                   : Support::none);
  }
  return result;
}

void require_known_version(const NumberTable& table, const std::string& file) {
  const auto format = table.header.find("format");
  if (format == table.header.end() || !format->second.starts_with("ayumi.")) return;
  if (format->second != kReferenceFormat && format->second != kMotionFormat)
    refuse_table(file, "format '" + format->second +
                           "' cannot be read; this version of Ayumi reads " + kReferenceFormat +
                           " and " + kMotionFormat);
}

MotionFile read_number_motion(const MotionInput& source, NumberTable table) {
  const std::string& file = source.file;
  require_known_version(table, file);
  MotionFile motion;
  motion.commands = holds_commands(table);
  const auto format = table.header.find("format");
  motion.of_joints = format != table.header.end() && format->second.starts_with("ayumi.");
  motion.caution = caution_of(table);
  name_root_columns(
      table, file, [&](const std::string& column) { return find_joint(source.model, column) >= 0; },
      motion.notes);
  rename_columns(table, source.model, source.options, file, motion);
  const bool timed = table.find("t[s]") >= 0;
  if (!timed && !(source.options.rate > 0))
    refuse_table(file,
                 "the table has no time column (t[s], t or time); give --rate HZ if the rows are "
                 "evenly spaced");
  if (!timed) {  // layout_of needs the column
    table.columns.emplace_back("t[s]");
    table.values.conservativeResize(Eigen::NoChange, table.values.cols() + 1);
    table.values.rightCols(1).setZero();
  }
  const TableLayout layout = layout_of(table, file);
  if (timed)
    for (Eigen::Index k = 0; k < table.values.rows(); ++k)
      motion.times.push_back(table.values(k, layout.time));
  motion.joints = layout.joints;
  motion.values.resize(table.values.rows(), static_cast<Eigen::Index>(layout.theta.size()));
  for (size_t j = 0; j < layout.theta.size(); ++j)
    motion.values.col(static_cast<Eigen::Index>(j)) = table.values.col(layout.theta[j]);
  if (!source.options.sent)
    motion.values = joint_rows(std::move(motion.values), zeros_of(table, layout, file));
  motion.base = bases_of(table, layout, file);
  motion.cog = vectors_of(table, layout.cog);
  motion.zmp = vectors_of(table, layout.zmp);
  motion.support = supports_of(table, layout);
  if (layout.fz >= 0)
    for (Eigen::Index k = 0; k < table.values.rows(); ++k)
      motion.fz.push_back(table.values(k, layout.fz));
  return motion;
}

}  // namespace

std::string recognize_csv_table(const MotionInput& source) {
  std::string_view rest = source.bytes;
  while (!rest.empty()) {
    const std::string_view line = take_line(rest);
    if (line.empty() || line.front() == '#') continue;
    // The first column, the index of a row, may have no name.
    const bool unnamed = line.find_first_of(",;") == 0;
    const char first = line[unnamed && line.size() > 1 ? 1 : 0];
    const bool letter =
        std::isalpha(static_cast<unsigned char>(first)) || first == '"' || first == '_';
    const bool cells = line.find_first_of(",;\t ") != std::string_view::npos ||
                       line.find_first_not_of(
                           "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                           "0123456789_.-[]()") == std::string_view::npos;
    return letter && cells && line.find(": ") == std::string_view::npos && line.back() != ':'
               ? "the first row names columns"
               : "";
  }
  return "";
}

MotionFile read_csv_table(const MotionInput& source) {
  std::vector<std::string> notes;
  const std::string plain = plain_table_text(source.bytes, source.file, &notes);
  MotionFile motion = read_number_motion(source, number_table(plain, source.file));
  motion.notes.insert(motion.notes.end(), notes.begin(), notes.end());
  return motion;
}

std::string recognize_json_table(const MotionInput& source) {
  const size_t first = source.bytes.find_first_not_of(" \t\r\n");
  const bool object = first != std::string::npos && source.bytes[first] == '{';
  return object && source.bytes.find("\"columns\"") != std::string::npos
             ? "the file is JSON with \"columns\""
             : "";
}

MotionFile read_json_table(const MotionInput& source) {
  return read_number_motion(source, number_table(source.bytes, source.file));
}

MotionFile motion_of_table(const ReferenceTrajectory& table) {
  MotionFile motion;
  motion.rate = 1 / table.dt;
  motion.joints = table.joints;
  motion.name = std::filesystem::path(table.provenance.pattern).stem().string();
  const auto rows = static_cast<Eigen::Index>(table.rows.size());
  motion.values.resize(rows, static_cast<Eigen::Index>(table.joints.size()));
  for (Eigen::Index k = 0; k < rows; ++k) {
    const ReferenceRow& row = table.rows[static_cast<size_t>(k)];
    motion.times.push_back(static_cast<double>(k) * table.dt);
    motion.values.row(k) = row.theta.transpose();
    motion.base.push_back(row.base);
    motion.cog.push_back(row.cog);
    motion.zmp.push_back(row.zmp);
    motion.fz.push_back(row.fz);
    motion.support.push_back(row.contact[0] && row.contact[1] ? Support::both
                             : row.contact[0]                 ? Support::left
                             : row.contact[1]                 ? Support::right
                                                              : Support::none);
  }
  return motion;
}

}  // namespace ayumi
