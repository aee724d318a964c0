#include <algorithm>
#include <cctype>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/formats/hoap.hpp"
#include "ayumi/io/table/comma_cells.hpp"
#include "ayumi/io/table/csv_dialect.hpp"
#include "ayumi/io/table/motion_import.hpp"
#include "ayumi/io/table/table_columns.hpp"
#include "ayumi/math/smoothing.hpp"
#include "ayumi/motion/servo_feedforward.hpp"

namespace ayumi {

namespace {

constexpr double kRadiansPerDegree = EIGEN_PI / 180;

[[noreturn]] void refuse_table(const std::string& file, const std::string& reason) {
  fail(ErrorCode::bad_file, file + ": " + reason);
}

// "r_knee[deg]" and "r_knee (deg)" are a name and its unit; so are "time_s" and "time_ms".
struct ColumnName {
  std::string name, unit;
};

ColumnName column_name(const std::string& column) {
  for (const auto& [open, close] : {std::pair{'[', ']'}, std::pair{'(', ')'}}) {
    const size_t at = column.find(open);
    if (at == std::string::npos || column.back() != close) continue;
    return {std::string(trimmed(std::string_view(column).substr(0, at))),
            std::string(trimmed(std::string_view(column).substr(at + 1, column.size() - at - 2)))};
  }
  for (const std::string unit : {"s", "ms"})
    if (column.ends_with("_" + unit))
      return {column.substr(0, column.size() - unit.size() - 1), unit};
  return {column, ""};
}

bool is_time(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return name == "t" || name == "time";
}

// Angle of a joint with limits from which on a column is in degrees [rad]. Chosen: more than one
// and a half turns, which no joint with limits makes.
constexpr double kNoAngle = 10;

// Joint columns by bare name or with a unit become theta columns, and a time column of any name
// t[s].
void rename_column(NumberTable& table, Eigen::Index i, const RobotModel& model,
                   const ImportOptions& options, const std::string& file) {
  std::string& column = table.columns[static_cast<size_t>(i)];
  const ColumnName named = column_name(column);
  if (is_time(named.name) && (named.unit.empty() || named.unit == "s" || named.unit == "ms")) {
    if (named.unit == "ms") table.values.col(i) *= 1e-3;
    column = "t[s]";
    return;
  }
  const bool whole = model.find_dof(column) >= 0;  // a name may end like a unit
  std::string joint = whole ? column : named.name;
  if (joint.starts_with("theta.") && !named.unit.empty()) joint = joint.substr(6);
  const int dof = model.find_dof(joint);
  const std::string unit = whole ? "" : named.unit;
  if (dof < 0 || !(unit.empty() || unit == "deg" || unit == "rad")) return;
  const bool degrees = unit.empty() ? options.degrees : unit == "deg";
  const Dof& made = model.dofs()[static_cast<size_t>(dof)];
  const double most = table.values.col(i).cwiseAbs().maxCoeff();
  if (degrees && !made.prismatic) table.values.col(i) *= kRadiansPerDegree;
  if (!degrees && !made.prismatic && made.limited && most > kNoAngle)
    refuse_table(file,
                 "column '" + column + "' reaches " + text::brief(most) +
                     " rad, which no joint reaches; give --unit deg if the angles are in degrees");
  column = theta_column(joint);
}

void rename_columns(NumberTable& table, const RobotModel& model, const ImportOptions& options,
                    const std::string& file) {
  for (Eigen::Index i = 0; i < table.values.cols(); ++i)
    rename_column(table, i, model, options, file);
  for (size_t i = 0; i < table.columns.size(); ++i)
    if (std::find(table.columns.begin() + static_cast<std::ptrdiff_t>(i) + 1, table.columns.end(),
                  table.columns[i]) != table.columns.end())
      refuse_table(file, "the column '" + table.columns[i] + "' is given twice");
}

void add_time(NumberTable& table, const ImportOptions& options, const std::string& file) {
  if (table.find("t[s]") >= 0) return;
  if (!(options.rate > 0))
    refuse_table(file,
                 "no time column (t[s], t, time); give --rate HZ when the rows are evenly spaced");
  table.columns.insert(table.columns.begin(), "t[s]");
  const auto old = table.values;
  table.values.resize(old.rows(), old.cols() + 1);
  table.values.rightCols(old.cols()) = old;
  for (Eigen::Index k = 0; k < old.rows(); ++k)
    table.values(k, 0) = static_cast<double>(k) / options.rate;
}

// Rows from time 0 at one rate, the median one, straight between those of the file.
void even_out(NumberTable& table, std::vector<std::string>& filled, const std::string& file) {
  const int at = table.find("t[s]");
  const Eigen::Index rows = table.values.rows();
  Eigen::VectorXd t = table.values.col(at);
  if (t[0] != 0)
    filled.push_back("the pattern begins at the first row; its time in the file is " +
                     text::brief(t[0]) + " s");
  t.array() -= t[0];
  std::vector<double> steps;
  for (Eigen::Index k = 1; k < rows; ++k) {
    steps.push_back(t[k] - t[k - 1]);
    if (!(steps.back() > 0))
      refuse_table(file, "data row " + std::to_string(k + 1) + ": time " + text::brief(t[k]) +
                             " s does not come after " + text::brief(t[k - 1]) +
                             " s of the row before; times must increase");
  }
  if (steps.empty()) refuse_table(file, "the table has only one row; a motion needs more");
  std::nth_element(steps.begin(), steps.begin() + static_cast<long>(steps.size() / 2), steps.end());
  double dt = steps[steps.size() / 2];
  const double rate = std::round(1 / dt);
  if (std::abs(1 / dt - rate) < 1e-3 * rate) dt = 1 / rate;
  const auto count = static_cast<Eigen::Index>(std::floor(t[rows - 1] / dt + 1e-3)) + 1;
  bool even = count == rows;
  for (Eigen::Index k = 0; even && k < rows; ++k)
    even = std::abs(t[k] - static_cast<double>(k) * dt) < 1e-3 * dt;
  auto values = table.values;
  if (!even) {
    filled.push_back(
        "the rows are not evenly spaced, so they are interpolated linearly, one every " +
        text::brief(dt) + " s");
    values.resize(count, table.values.cols());
    Eigen::Index r = 0;
    for (Eigen::Index k = 0; k < count; ++k) {
      const double now = static_cast<double>(k) * dt;
      while (r + 2 < rows && t[r + 1] <= now) ++r;
      const double u = std::min(1.0, (now - t[r]) / (t[r + 1] - t[r]));
      values.row(k) = (1 - u) * table.values.row(r) + u * table.values.row(r + 1);
    }
  }
  for (Eigen::Index k = 0; k < count; ++k) values(k, at) = static_cast<double>(k) * dt;
  table.values = values;
  table.header["dt"] = text::exact(dt);
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
      refuse_table(file, "data row " + std::to_string(k + 1) + ": base.qw...qz has length " +
                             text::brief(q.norm()) + ", a unit quaternion (w, x, y, z) is needed");
    BasePose base;
    base.position = {table.values(k, layout.base[0]), table.values(k, layout.base[1]),
                     table.values(k, layout.base[2])};
    base.attitude = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
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

void fill_theta(const NumberTable& table, const TableLayout& layout, const RobotModel& model,
                const std::string& file, ImportedMotion& result) {
  if (layout.joints.empty()) refuse_table(file, "no column is a joint of '" + model.name() + "'");
  result.motion.theta = model.posture().transpose().replicate(table.values.rows(), 1);
  std::vector<char> in_file(static_cast<size_t>(model.dof_count()), 0);
  for (size_t j = 0; j < layout.joints.size(); ++j) {
    const int dof = model.find_dof(layout.joints[j]);
    if (dof < 0)
      refuse_table(file, "'" + model.name() + "' has no joint '" + layout.joints[j] + "'" +
                             text::suggestion(layout.joints[j], model.dof_names()));
    result.motion.theta.col(dof) = table.values.col(layout.theta[j]);
    in_file[static_cast<size_t>(dof)] = 1;
  }
  for (int dof = 0; dof < model.dof_count(); ++dof)
    if (!in_file[static_cast<size_t>(dof)])
      result.filled.push_back(
          model.dofs()[dof].name +
          ": the file has no angles of this joint; the joint keeps its angle of the home posture");
}

void take_out_lead(const RobotModel& model, ImportedMotion& imported) {
  DenseTable table;
  table.dt = imported.motion.dt;
  table.joints = model.dof_names();
  table.theta = imported.motion.theta;
  table.commands = true;
  imported.motion.theta = postures_of(model, model.limits(), table).theta;
  imported.commands = false;
  imported.filled.push_back(
      "angles are servo targets: the velocity lead, delay + kd/kp, was subtracted");
}

// The robot keeps the last target of a sequence, so a short one can be made longer.
void hold_last_row(Eigen::Index least, ImportedMotion& imported) {
  Eigen::MatrixXd& theta = imported.motion.theta;
  const Eigen::Index rows = theta.rows();
  if (rows >= least) return;
  theta.conservativeResize(least, Eigen::NoChange);
  theta.bottomRows(least - rows) = theta.row(rows - 1).replicate(least - rows, 1);
  imported.filled.push_back("the last posture is held until there are " + std::to_string(least) +
                            " rows, which the check of a motion needs");
}

// A motion begins and ends at rest: as if it returned along its own path.
Eigen::VectorXd smoothed_from_rest(const Eigen::VectorXd& raw, double band, double cutoff) {
  const Eigen::Index n = raw.size();
  const auto more = std::min<Eigen::Index>(n - 1, static_cast<Eigen::Index>(2 / cutoff));
  Eigen::VectorXd mirrored(n + 2 * more);
  mirrored << raw.segment(1, more).reverse(), raw, raw.segment(n - 1 - more, more).reverse();
  return smoothed_within(mirrored, band, cutoff).segment(more, n);
}

// Counts are rounded, and straight between the times for which they were made: differences of that
// are no accelerations of anything. Servos do not follow a tenth of a degree.
void smooth_angles(const RobotModel& model, const ImportOptions& options,
                   ImportedMotion& imported) {
  // Largest change of an angle [deg]. Chosen: 21 counts; what servos do not follow.
  constexpr double kOfCounts = 0.1;
  // Frequency up to which a motion is kept [1/s]. Chosen: ten times that of the steps of a walk
  // (0.55 s each).
  constexpr double kCutoff = 20;
  const double degrees = options.smooth.value_or(imported.format == "hoap" ? kOfCounts : 0);
  if (degrees <= 0) return;
  Eigen::MatrixXd& theta = imported.motion.theta;
  for (int i = 0; i < model.dof_count(); ++i) {
    const Dof& dof = model.dofs()[i];
    if (dof.prismatic) continue;
    const Eigen::VectorXd raw = theta.col(i);
    theta.col(i) =
        smoothed_from_rest(raw, degrees * kRadiansPerDegree, kCutoff * imported.motion.dt);
    if (!dof.limited) continue;
    // Beside a jump it swings over: no limit is to be broken by that.
    const double margin = model.description().soft_limit_margin;
    theta.col(i) = theta.col(i)
                       .cwiseMax(std::min(dof.lower + margin, raw.minCoeff()))
                       .cwiseMin(std::max(dof.upper - margin, raw.maxCoeff()));
  }
  imported.filled.push_back("angles smoothed by at most " + text::brief(degrees) + " deg");
}

}  // namespace

ImportedMotion read_table_motion(const std::string& bytes, const std::string& file,
                                 const RobotModel& model, const ImportOptions& options) {
  NumberTable table = number_table(bytes, file);
  ImportedMotion result;
  result.format = bytes.find_first_not_of(" \t\r\n") != std::string::npos &&
                          bytes[bytes.find_first_not_of(" \t\r\n")] == '{'
                      ? "json"
                      : "csv";
  result.rows = static_cast<int>(table.values.rows());
  result.commands = holds_commands(table);
  result.caution = caution_of(table);
  rename_columns(table, model, options, file);
  add_time(table, options, file);
  const TableLayout layout = layout_of(table, file);
  even_out(table, result.filled, file);
  result.motion.dt = tick_of(table, layout, file);
  fill_theta(table, layout, model, file, result);
  result.motion.base = bases_of(table, layout, file);
  result.motion.cog = vectors_of(table, layout.cog);
  result.motion.zmp = vectors_of(table, layout.zmp);
  result.motion.support = supports_of(table, layout);
  if (layout.fz >= 0)
    for (Eigen::Index k = 0; k < table.values.rows(); ++k)
      result.motion.fz.push_back(table.values(k, layout.fz));
  return result;
}

ImportedMotion read_motion(const std::string& given, const std::string& file,
                           const RobotModel& model, const ImportOptions& options) {
  const std::string bytes = plain_table_text(given, file);
  const bool hoap =
      options.format == "hoap" || (options.format.empty() && looks_like_hoap(bytes, model));
  ImportedMotion result =
      hoap ? read_hoap_motion(bytes, file, model, options.rate, options.encoder_signs)
           : read_table_motion(bytes, file, model, options);
  if (!result.sequence.empty()) result.sequence = given;
  constexpr int kLeastRows = 6;  // Derived: accelerations take five (motion/differentiate.hpp)
  if (!result.sequence.empty()) hold_last_row(kLeastRows, result);
  if (result.motion.theta.rows() < kLeastRows)
    fail(ErrorCode::bad_file, file + ": " + std::to_string(result.motion.theta.rows()) +
                                  " rows of motion; at least " + std::to_string(kLeastRows) +
                                  " are needed");
  if (options.commands || result.commands) take_out_lead(model, result);
  smooth_angles(model, options, result);
  if (result.motion.support.empty()) result.filled.push_back("contacts: detected from the motion");
  if (result.motion.base.empty())
    result.filled.push_back(
        "base: computed from the supporting feet, which stand level on the ground");
  return result;
}

}  // namespace ayumi
