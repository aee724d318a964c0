#include "ayumi/io/table/recording.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <optional>
#include <string_view>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/degrees.hpp"
#include "ayumi/io/formats/motion_file.hpp"
#include "ayumi/io/table/comma_cells.hpp"
#include "ayumi/io/table/csv_dialect.hpp"
#include "ayumi/io/table/table_columns.hpp"
#include "ayumi/model/encoder_angles.hpp"

namespace ayumi {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// A step between two rows is an error and not a motion if the joint is faster than this multiple of
// its motor's limit. Chosen: commands may have steps, and measured angles then move at most twice
// as fast as the motor's limit.
constexpr double kJumpSpeed = 5;

// The same speed where the robot's files give no limit [rad/s]. Chosen: five times that of quick
// hobby servos.
constexpr double kJumpRate = 50;

// Steps of at most this number of counts are never jumps. Chosen: a coarse encoder has one count
// for two degrees.
constexpr double kJumpCounts = 4;

// If a time step differs from the usual one by more than this share of it, there is a gap. Chosen:
// half a sample.
constexpr double kGap = 0.5;

// If the rows of a table are at least this far apart and the times have no unit, they may be in
// milliseconds [s]. Chosen: recorders take at least two rows per second and at most two per
// millisecond.
constexpr double kSlowestStep = 0.5;

// A device without a joint counts as still if it moves by less than this [counts]. Chosen: 0.05
// degrees.
constexpr double kStillCounts = 10;

[[noreturn]] void complain(const std::string& file, const std::string& what) {
  fail(ErrorCode::bad_file, {file}, what);
}

[[noreturn]] void complain(const std::string& file, size_t line, const std::string& what) {
  fail(ErrorCode::bad_file, {file, "", static_cast<long>(line)}, what);
}

std::optional<double> number_of(std::string_view cell) {
  double value = 0;
  if (!cell.empty() && cell.front() == '+') cell.remove_prefix(1);
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (cell.empty() || error != std::errc() || end != cell.data() + cell.size()) return std::nullopt;
  return value;
}

// A file that was put together from two files has lines of both kinds.
void require_one_line_end(const std::string& bytes, const std::string& file) {
  bool with = false, without = false;
  size_t line = 0;
  for (size_t at = bytes.find('\n'); at != std::string::npos; at = bytes.find('\n', at + 1)) {
    ++line;
    (at > 0 && bytes[at - 1] == '\r' ? with : without) = true;
    if (with && without)
      complain(file, line,
               std::string("this line ends with ") +
                   (bytes[at - 1] == '\r' ? "CR LF, but the lines before it end with LF"
                                          : "LF, but the lines before it end with CR LF") +
                   "; the file may consist of parts of two files. Use one kind of line end");
  }
}

// Rows of numbers without names; `line` is the line of each row.
struct BareRows {
  std::vector<std::vector<double>> rows;
  std::vector<size_t> lines;
  double dt = 0;  // time from row to row [s]; 0 if the file does not state it
};

std::vector<double> numbers_of(const std::vector<std::string_view>& cells, size_t begin, size_t end,
                               const std::string& file, size_t line) {
  std::vector<double> values;
  for (size_t c = begin; c < end; ++c) {
    const auto value = number_of(cells[c]);
    if (!value || !std::isfinite(*value))
      complain(file, line,
               "column " + std::to_string(c + 1) + ": '" + std::string(cells[c].substr(0, 24)) +
                   "' is not a" + (value ? " finite" : "") + " number");
    values.push_back(*value);
  }
  return values;
}

bool is_sequence(const std::vector<std::string_view>& cells) {
  return std::any_of(cells.begin(), cells.end(), [](std::string_view c) { return c == "R"; });
}

// A row of a sequence has the interval, 2, targets, words and requests. Only the devices of the
// robot are read.
BareRows sequence_rows(std::string_view rest, const std::string& file, size_t devices) {
  struct Row {
    int at;
    std::vector<double> counts;
    size_t line;
  };
  std::vector<Row> rows;
  size_t line = 0, columns = 0;
  int now = 0, tick = 0;
  while (!rest.empty()) {
    const std::string_view text = take_line(rest);
    ++line;
    if (text.empty()) continue;
    const std::vector<std::string_view> cells = cells_of(text);
    const auto interval = number_of(cells[0]);
    if (cells.size() < 3 || !interval || *interval < 1 || *interval != std::round(*interval) ||
        (cells[1] != "2" && cells[1] != "3"))
      complain(
          file, line,
          "a row must begin with an interval [ms] and a code. The code is 2 if targets follow, "
          "and 3 if a command to one device follows");
    if (cells[1] == "2") {
      if (columns != 0 && cells.size() != columns)
        complain(file, line,
                 "the row has " + std::to_string(cells.size()) +
                     " columns, but each row before it has " + std::to_string(columns));
      columns = cells.size();
      if (columns < 2 + devices)
        complain(file, line,
                 "the row has " + std::to_string(columns) + " columns, but the " +
                     std::to_string(devices) + " devices of the robot need at least " +
                     std::to_string(2 + devices) + " columns");
      if (!rows.empty()) tick = std::gcd(tick, now - rows.back().at);
      rows.push_back({now, numbers_of(cells, 2, 2 + devices, file, line), line});
    }
    now += static_cast<int>(*interval);
  }
  if (rows.size() < 2)
    complain(file, "the sequence has fewer than two rows with targets; record a motion");
  BareRows result;
  result.dt = 0.001 * tick;
  for (size_t r = 0; r + 1 < rows.size(); ++r)
    for (int t = rows[r].at; t < rows[r + 1].at; t += tick) {
      const double u = static_cast<double>(t - rows[r].at) / (rows[r + 1].at - rows[r].at);
      std::vector<double> counts = rows[r].counts;
      for (size_t c = 0; c < counts.size(); ++c)
        counts[c] += u * (rows[r + 1].counts[c] - counts[c]);
      result.rows.push_back(counts);
      result.lines.push_back(rows[r].line);
    }
  result.rows.push_back(rows.back().counts);
  result.lines.push_back(rows.back().line);
  return result;
}

BareRows bare_rows(const std::string& bytes, const std::string& file, size_t needed,
                   const std::string& what) {
  BareRows result;
  std::string_view rest = bytes;
  size_t line = 0, columns = 0;
  while (!rest.empty()) {
    const std::string_view text = take_line(rest);
    ++line;
    if (text.empty()) continue;
    const std::vector<std::string_view> cells = cells_of(text);
    if (columns == 0) columns = cells.size();
    if (cells.size() != columns)
      complain(file, line,
               "the row has " + std::to_string(cells.size()) +
                   " columns, but each row before it has " + std::to_string(columns));
    if (columns < needed)
      complain(file, line,
               "the row has " + std::to_string(columns) + " columns, but " + what + " needs " +
                   std::to_string(needed) + "; is this a recording of another robot?");
    result.rows.push_back(numbers_of(cells, 0, columns, file, line));
    result.lines.push_back(line);
  }
  if (result.rows.size() < 2)
    complain(file, "the recording has fewer than two rows; record a motion");
  return result;
}

double jump_limit(const RobotModel& model, int dof, double dt, double resolution) {
  const double speed = model.limits().speed[dof];
  const double rate = std::isfinite(speed) && speed > 0 ? kJumpSpeed * speed : kJumpRate;
  return std::max(rate * dt, kJumpCounts * resolution);
}

void require_less_than_a_turn(const AngleTable& table, int j, const RobotModel& model,
                              const std::string& file) {
  const Dof& dof = model.dofs()[static_cast<size_t>(j)];
  const double most = table.theta.col(j).cwiseAbs().maxCoeff();
  if (!dof.prismatic && most > 2 * M_PI)
    complain(file,
             dof.name + " reaches " + text::brief(most, 4) +
                 " rad, which is more than a turn; if the angles are in degrees, give --unit deg");
}

void require_motion(const AngleTable& table, const std::vector<size_t>& lines,
                    const RobotModel& model, const std::string& file) {
  // Angles in degrees that are read as radians also look like jumps, so the unit is checked first.
  // Counts that wrap can also exceed a turn, so their jumps are tested first.
  for (int j = 0; j < model.dof_count(); ++j)
    if (table.resolution[j] <= 0) require_less_than_a_turn(table, j, model, file);
  bool any = false;
  for (int j = 0; j < model.dof_count(); ++j) {
    if (!table.has[static_cast<size_t>(j)]) continue;
    const VectorXd theta = table.theta.col(j);
    any = any || theta.cwiseAbs().maxCoeff() > 0;
    const Dof& dof = model.dofs()[static_cast<size_t>(j)];
    const double limit = jump_limit(model, j, table.dt, table.resolution[j]);
    for (Index k = 1; k < theta.size(); ++k)
      if (std::abs(theta[k] - theta[k - 1]) > limit)
        complain(
            file, lines[static_cast<size_t>(k)],
            dof.name + " jumps by " +
                text::brief(std::abs(theta[k] - theta[k - 1]) / kRadiansPerDegree, 3) +
                " deg from the row before, but a motor moves at most " +
                text::brief(limit / kRadiansPerDegree, 3) +
                " deg in this time. Samples are missing, or the 16-bit counter of the encoder "
                "has overflowed. Record again; after an overflow, you can also add or subtract "
                "65536 counts from this row on");
    require_less_than_a_turn(table, j, model, file);
  }
  if (!any)
    complain(file, "all angles are 0, so the robot or its recorder was not running; record again");
}

AngleTable empty_table(const RobotModel& model, Index rows, double dt) {
  AngleTable table;
  table.dt = dt;
  table.theta = MatrixXd::Zero(rows, model.dof_count());
  table.has.assign(static_cast<size_t>(model.dof_count()), 0);
  table.resolution = VectorXd::Zero(model.dof_count());
  return table;
}

AngleTable angles_of(const BareRows& bare, const RobotModel& model, const std::string& file,
                     size_t first, double dt) {
  AngleTable table = empty_table(model, static_cast<Index>(bare.rows.size()), dt);
  std::vector<char> used(bare.rows.front().size(), 0);
  for (int j = 0; j < model.dof_count(); ++j) {
    const EncoderDescription& encoder = model.dofs()[static_cast<size_t>(j)].encoder;
    if (encoder.device < 1) continue;
    const size_t column = first + static_cast<size_t>(encoder.device) - 1;
    used[column] = 1;
    table.has[static_cast<size_t>(j)] = 1;
    table.resolution[j] = kRadiansPerDegree / std::abs(encoder.counts_per_degree);
    for (size_t k = 0; k < bare.rows.size(); ++k)
      table.theta(static_cast<Index>(k), j) =
          bare.rows[k][column] * kRadiansPerDegree / encoder.counts_per_degree;
  }
  require_motion(table, bare.lines, model, file);
  return table;
}

size_t device_count(const RobotModel& model, const std::string& file) {
  int devices = 0;
  for (const Dof& dof : model.dofs()) devices = std::max(devices, dof.encoder.device);
  if (devices == 0)
    complain(file, "the rows are counts, but the robot '" + model.name() +
                       "' has no encoders; add \"encoders\" to the sidecar of the robot");
  return static_cast<size_t>(devices);
}

// The times of a table with names, from their column and its unit in seconds.
struct TimeColumn {
  int column = -1;
  double unit = 1;
  bool has_unit = false;
};
TimeColumn time_of(const NumberTable& table, const std::string& file) {
  for (size_t c = 0; c < table.columns.size(); ++c) {
    const std::string& column = table.columns[c];
    if (!is_time_column(column)) continue;
    const std::optional<double> seconds = seconds_of_time_column(column);
    if (!seconds)
      complain(file, "the unit of the times in the column '" + column +
                         "' is not known; units are s, ms, us and ns");
    return {static_cast<int>(c), *seconds, !column_name(column).unit.empty()};
  }
  return {};
}

/// The time of the first row [s]; empty if the table has no times.
std::optional<double> clock_start(const NumberTable& table, const std::string& file) {
  const TimeColumn time = time_of(table, file);
  if (time.column < 0) return std::nullopt;
  return time.unit * table.values(0, time.column);
}

// Messages count the rows from the first data row on, because the lines of a plain table are not
// known here.
double interval_of(const NumberTable& table, const RecordingOptions& options,
                   const std::string& file) {
  const Index rows = table.values.rows();
  if (rows < 2) complain(file, "the recording has fewer than two rows; record a motion");
  const TimeColumn time = time_of(table, file);
  if (time.column < 0) return options.rate > 0 ? 1 / options.rate : 0.001;
  const VectorXd t = time.unit * table.values.col(time.column);
  std::vector<double> steps;
  for (Index k = 1; k < rows; ++k) steps.push_back(t[k] - t[k - 1]);
  std::vector<double> sorted = steps;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2),
                   sorted.end());
  const double usual = sorted[sorted.size() / 2];
  if (!(usual > 0)) complain(file, "the times do not increase; correct the time column");
  if (!time.has_unit && usual >= kSlowestStep)
    complain(file, "the times of '" + table.columns[size_t(time.column)] +
                       "' have no unit, and they increase by " + text::brief(usual) +
                       " per row; name the column t[ms] or t[s]");
  for (size_t k = 0; k < steps.size(); ++k) {
    const std::string at = "after t = " + text::exact(t[static_cast<Index>(k)]) + " s (data row " +
                           std::to_string(k + 1) + ") ";
    if (!(steps[k] > 0)) complain(file, at + "the time does not increase; correct the time column");
    const long lost = std::max(1L, std::lround(steps[k] / usual) - 1);
    if (steps[k] > (1 + kGap) * usual)
      complain(file, at + text::counted(lost, "sample") + (lost == 1 ? " is" : " are") +
                         " missing, because the next row comes " + text::brief(1000 * steps[k]) +
                         " ms later, but usually a row comes " + text::brief(1000 * usual) +
                         " ms after the row before; record again");
  }
  return (t[rows - 1] - t[0]) / static_cast<double>(rows - 1);
}

// The joint of a column and the factor to radians; `has_unit` says whether the name has the unit.
struct JointColumn {
  int dof = -1;
  double factor = 1;
  bool counts = false;
};
JointColumn joint_column(const std::string& column, const RobotModel& model, bool degrees,
                         const std::string& file) {
  const ColumnName named = column_name(column);
  const bool whole = find_joint(model, column) >= 0;  // the name itself may end like a unit
  std::string name = whole ? column : named.name, unit = whole ? "" : named.unit;
  if (name.starts_with("theta.")) name = name.substr(6);
  JointColumn result;
  result.dof = find_joint(model, name);
  if (result.dof < 0) return result;
  const Dof& dof = model.dofs()[static_cast<size_t>(result.dof)];
  if (unit.empty()) unit = dof.prismatic ? "m" : degrees ? "deg" : "rad";
  if (unit == "deg" && !dof.prismatic) {
    result.factor = kRadiansPerDegree;
  } else if (unit == "counts" || unit == "pulses") {
    if (dof.encoder.device < 1)
      complain(file, "column '" + column + "': the joint has no encoder in the sidecar");
    result.factor = kRadiansPerDegree / dof.encoder.counts_per_degree;
    result.counts = true;
  } else if (unit != (dof.prismatic ? "m" : "rad")) {
    complain(file, "column '" + column + "': the unit '" + unit + "' is not rad, deg or counts");
  }
  return result;
}

AngleTable named_angles(const std::string& bytes, const std::string& file, const RobotModel& model,
                        const RecordingOptions& options) {
  const NumberTable table = number_table(plain_table_text(bytes, file), file);
  const double dt = interval_of(table, options, file);
  AngleTable result = empty_table(model, table.values.rows(), dt);
  result.clock_start = clock_start(table, file);
  result.timed = result.clock_start.has_value();
  bool any = false;
  for (size_t c = 0; c < table.columns.size(); ++c) {
    const JointColumn column = joint_column(table.columns[c], model, options.degrees, file);
    if (column.dof < 0) continue;
    const auto at = static_cast<size_t>(column.dof);
    if (result.has[at])
      complain(file, "column '" + table.columns[c] +
                         "': the joint already has another column; remove one of the two");
    any = true;
    result.has[at] = 1;
    result.theta.col(column.dof) = column.factor * table.values.col(static_cast<Index>(c));
    if (column.counts) result.resolution[column.dof] = std::abs(column.factor);
  }
  if (!any)
    complain(file, "no column is a joint of '" + model.name() + "'; its joints are " +
                       text::join(model.dof_names(), ", ") +
                       ". Is this a recording of another robot?");
  std::vector<size_t> lines(static_cast<size_t>(table.values.rows()));
  std::iota(lines.begin(), lines.end(), size_t{2} + table.header.size());
  require_motion(result, lines, model, file);
  return result;
}

double polynomial(const std::vector<double>& coefficients, double x) {
  double value = 0;
  for (const double c : coefficients) value = value * x + c;
  return value;
}

MatrixXd axes_of(const BareRows& bare, const AxisReadings& axes) {
  if (axes.columns.empty()) return {};
  MatrixXd values(static_cast<Index>(bare.rows.size()), 3);
  for (size_t k = 0; k < bare.rows.size(); ++k)
    for (Index i = 0; i < 3; ++i)
      values(static_cast<Index>(k), i) =
          axes.scale[i] *
          (bare.rows[k][static_cast<size_t>(axes.columns[static_cast<size_t>(i)] - 1)] -
           axes.zero[i]);
  return values;
}

SensorTable bare_sensors(const std::string& bytes, const std::string& file, const RobotModel& model,
                         const RecordingOptions& options) {
  const SensorDescription& sensors = model.description().sensors;
  const bool cells = sensors.load_cells.contains("left") && sensors.load_cells.contains("right");
  if (!cells && sensors.accelerometer.columns.empty() && sensors.gyro.columns.empty())
    complain(file, "the rows are readings without names, but the sidecar of '" + model.name() +
                       "' does not say which sensors the columns belong to; add \"load_cells\" to "
                       "\"sensors\" in the sidecar");
  int needed = 1;
  for (const AxisReadings* axes : {&sensors.accelerometer, &sensors.gyro})
    for (const int column : axes->columns) needed = std::max(needed, column);
  for (const auto& [side, foot] : sensors.load_cells)
    for (const int column : foot.columns) needed = std::max(needed, column);
  const BareRows bare =
      bare_rows(bytes, file, static_cast<size_t>(needed), "the sidecar's calibration");
  SensorTable table;
  table.dt = options.rate > 0 ? 1 / options.rate : 0.001;
  table.acceleration = axes_of(bare, sensors.accelerometer);
  table.gyro = axes_of(bare, sensors.gyro);
  if (!cells) return table;
  table.foot_load.resize(static_cast<Index>(bare.rows.size()), 2);
  bool any = false;
  for (size_t k = 0; k < bare.rows.size(); ++k)
    for (const int side : {0, 1}) {
      const LoadCells& foot = sensors.load_cells.at(side == 0 ? "left" : "right");
      double sum = 0;
      for (size_t c = 0; c < foot.columns.size(); ++c) {
        const double reading = bare.rows[k][static_cast<size_t>(foot.columns[c] - 1)];
        any = any || reading != 0;
        sum += polynomial(foot.cells[c], reading);
      }
      table.foot_load(static_cast<Index>(k), side) = polynomial(foot.force, sum);
    }
  if (!any)
    complain(file,
             "all readings of the load cells are 0, so the sensors were not running; record again");
  return table;
}

MatrixXd named_axes(const NumberTable& table, const std::string& name, const std::string& unit) {
  MatrixXd values(table.values.rows(), 3);
  Index i = 0;
  for (const char* axis : {"x", "y", "z"}) {
    int column = table.find(name + "." + axis + "[" + unit + "]");
    if (column < 0) column = table.find(name + "_" + axis);
    if (column < 0) return {};
    values.col(i++) = table.values.col(column);
  }
  return values;
}

SensorTable named_sensors(const std::string& bytes, const std::string& file,
                          const RecordingOptions& options) {
  const NumberTable table = number_table(plain_table_text(bytes, file), file);
  SensorTable result;
  result.dt = interval_of(table, options, file);
  result.clock_start = clock_start(table, file);
  result.timed = result.clock_start.has_value();
  std::array<int, 2> foot = {-1, -1};
  for (const int side : {0, 1}) {
    const std::string name = side == 0 ? "left" : "right";
    for (const std::string& each : {"fz." + name + "[N]", name + "[N]", name, "fz_" + name})
      if (foot[static_cast<size_t>(side)] < 0) foot[static_cast<size_t>(side)] = table.find(each);
  }
  if (foot[0] >= 0 && foot[1] >= 0) {
    result.foot_load.resize(table.values.rows(), 2);
    for (const int side : {0, 1})
      result.foot_load.col(side) = table.values.col(foot[static_cast<size_t>(side)]);
    if (result.foot_load.cwiseAbs().maxCoeff() <= 0)
      complain(file, "all loads of the feet are 0, so the sensors were not running; record again");
  }
  result.acceleration = named_axes(table, "acc", "m/s^2");
  result.gyro = named_axes(table, "gyro", "rad/s");
  if (result.foot_load.size() == 0 && result.acceleration.size() == 0 && result.gyro.size() == 0)
    complain(
        file,
        "no column has the name of a joint or a sensor. A column of a joint has the name of the "
        "joint, as in r_knee or r_knee[deg]. The columns of sensors are fz.left[N] and "
        "fz.right[N]; acc.x[m/s^2], acc.y[m/s^2] and acc.z[m/s^2]; gyro.x[rad/s], "
        "gyro.y[rad/s] and gyro.z[rad/s]");
  return result;
}

}  // namespace

bool is_bare_table(const std::string& bytes) {
  std::string_view rest = bytes;
  std::string_view line;
  while (!rest.empty() && line.empty()) line = take_line(rest);
  const std::vector<std::string_view> cells = cells_of(line);
  return cells.size() > 1 && number_of(cells[0]).has_value();
}

namespace {

void require_rate(const RecordingOptions& options) {
  if (options.rate != 0) require_within("the rate of the rows", options.rate, kRecordingRate);
}

void require_rate_of_rows(double dt, const std::string& file) {
  const double rate = rate_of_rows(dt);
  if (!(rate >= kRecordingRate.least && rate <= kRecordingRate.most))
    complain(file, "the file has " + text::brief(rate) +
                       " rows per second, but a recording must have from " +
                       text::exact(kRecordingRate.least) + " to " +
                       text::exact(kRecordingRate.most) + " rows per second; correct the times");
}

AngleTable readings_of(const std::string& bytes, const std::string& file, const RobotModel& model,
                       const RecordingOptions& options) {
  if (trimmed(bytes).empty()) complain(file, "the file is empty");
  require_one_line_end(bytes, file);
  if (!is_bare_table(bytes)) return named_angles(bytes, file, model, options);
  const size_t devices = device_count(model, file);
  std::string_view rest = bytes;
  std::string_view line;
  while (!rest.empty() && line.empty()) line = take_line(rest);
  if (is_sequence(cells_of(line))) {
    const BareRows rows = sequence_rows(bytes, file, devices);
    AngleTable table = angles_of(rows, model, file, 0, rows.dt);
    table.timed = true;
    return table;
  }
  const BareRows rows = bare_rows(bytes, file, devices, "the robot '" + model.name() + "'");
  for (size_t r = 0; r < rows.rows.size(); ++r)
    for (const double value : rows.rows[r])
      if (value != std::round(value))
        complain(file, rows.lines[r],
                 "the columns have no names, so their values must be encoder counts, but " +
                     text::brief(value) +
                     " is not a whole number. If the values are angles, add a first row with the "
                     "names of the columns, such as t[s] and " +
                     model.dof_names().front() + "[rad]");
  for (size_t r = 0; r < rows.rows.size(); ++r)
    for (size_t c = devices; c < rows.rows[r].size(); ++c)
      if (rows.rows[r][c] != 0)
        complain(file, rows.lines[r],
                 "column " + std::to_string(c + 1) + " is " + text::brief(rows.rows[r][c]) +
                     ", but the robot '" + model.name() + "' has " + std::to_string(devices) +
                     " devices; is this a recording of another robot?");
  return angles_of(rows, model, file, 0, options.rate > 0 ? 1 / options.rate : 0.001);
}

}  // namespace

void take_to_joints(const RobotModel& model, MeasuredAt measured_at, AngleTable& table) {
  table.measured_at = measured_at;
  if (measured_at == MeasuredAt::joint) return;
  const Eigen::VectorXd zeros = encoder_zeros(model);
  for (int dof = 0; dof < model.dof_count(); ++dof)
    if (table.has[static_cast<size_t>(dof)] && zeros[dof] != 0)
      table.theta.col(dof).array() += zeros[dof];
}

AngleTable read_angles(const std::string& bytes, const std::string& file, const RobotModel& model,
                       const RecordingOptions& options) {
  require_rate(options);
  AngleTable table = readings_of(bytes, file, model, options);
  require_rate_of_rows(table.dt, file);
  take_to_joints(model, options.measured_at, table);
  return table;
}

bool holds_sensors(const std::string& bytes, const std::string& file, const RobotModel& model) {
  if (!is_bare_table(bytes)) {
    const NumberTable table = number_table(plain_table_text(bytes, file), file);
    for (const std::string& column : table.columns)
      if (joint_column(column, model, false, file).dof >= 0) return false;
    return true;
  }
  std::string_view rest = bytes;
  std::string_view line;
  while (!rest.empty() && line.empty()) line = take_line(rest);
  const std::vector<std::string_view> cells = cells_of(line);
  int devices = 0;
  for (const Dof& dof : model.dofs()) devices = std::max(devices, dof.encoder.device);
  const SensorDescription& sensors = model.description().sensors;
  const bool calibrated = !sensors.load_cells.empty() || !sensors.accelerometer.columns.empty() ||
                          !sensors.gyro.columns.empty();
  return calibrated && !is_sequence(cells) && cells.size() > static_cast<size_t>(devices) + 2;
}

SensorTable read_sensors_table(const std::string& bytes, const std::string& file,
                               const RobotModel& model, const RecordingOptions& options) {
  require_rate(options);
  if (trimmed(bytes).empty()) complain(file, "the file is empty");
  require_one_line_end(bytes, file);
  SensorTable table = is_bare_table(bytes) ? bare_sensors(bytes, file, model, options)
                                           : named_sensors(bytes, file, options);
  require_rate_of_rows(table.dt, file);
  return table;
}

}  // namespace ayumi
