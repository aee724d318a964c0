// Real sequence files are no clean tables: line ends of two kinds, blanks around cells, "-0",
// requests where others have hobby servo words, commands to single devices between the rows; and
// what robots answer, or other programs write for them, is bare: no intervals, counts or radians.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numeric>
#include <optional>
#include <string_view>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/table/comma_cells.hpp"
#include "ayumi/io/table/motion_import.hpp"

namespace ayumi {

namespace {

constexpr double kRadiansPerDegree = EIGEN_PI / 180;

std::optional<int> whole_number(std::string_view cell) {
  int value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size()) return std::nullopt;
  return value;
}

int motors_of(size_t columns) {
  return columns == 25 ? 20 : columns == 27 || columns == 29 ? 21 : 0;
}

constexpr size_t kBareColumns = 23;  // Definition: 21 motors, then two that say nothing of them
constexpr int kBareMotors = 21;

// Counts per degree of the motors, in the makers' own angles. Source: the encoders in
// robots/hoap1/robot.json.
constexpr double kCounts = 209;
constexpr std::array<int, kBareMotors> kSigns = {1, 1, -1, 1,  1,  -1, 1, 1,  -1, -1, 1,
                                                 1, 1, -1, -1, -1, -1, 1, -1, 1,  1};

struct Row {
  int at = 0;                  // [ms]
  std::vector<double> counts;  // by device from 1
};

std::optional<double> any_number(std::string_view cell) {
  double value = 0;
  if (!cell.empty() && cell.front() == '+') cell.remove_prefix(1);
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

class Reader {
 public:
  Reader(const std::string& bytes, const std::string& file) : rest_(bytes), file_(file) {
    std::string_view rest = rest_;
    bare_ = is_bare_hoap_row(take_line(rest));
  }

  std::vector<Row> rows() {
    while (!rest_.empty()) {
      const std::string_view line = take_line(rest_);
      ++line_;
      if (!line.empty()) read(line);
    }
    if (rows_.empty()) fail(ErrorCode::bad_file, file_ + ": no row with targets for the motors");
    if (radians_) {
      for (Row& row : rows_)
        for (int m = 0; m < kBareMotors; ++m)
          row.counts[static_cast<size_t>(m)] *=
              kSigns[static_cast<size_t>(m)] * kCounts / kRadiansPerDegree;
    }
    return std::move(rows_);
  }
  bool bare() const { return bare_; }
  bool radians() const { return radians_; }
  int general_commands() const { return general_; }
  size_t columns() const { return columns_; }

 private:
  [[noreturn]] void stop(const std::string& reason) const {
    fail(ErrorCode::bad_file, file_ + ":" + std::to_string(line_) + ": " + reason);
  }

  // One row per tick of 1 ms until the rate is known.
  void read_bare(const std::vector<std::string_view>& cells) {
    if (cells.size() != kBareColumns)
      stop(std::to_string(cells.size()) + " columns, but the rows before have 23");
    Row row{now_++, {}};
    for (int m = 0; m < kBareMotors; ++m) {
      const std::string_view cell = cells[static_cast<size_t>(m)];
      const auto value = any_number(cell);
      if (!value || std::abs(*value) > 32768)
        stop("column " + std::to_string(1 + m) + ": '" + std::string(cell.substr(0, 24)) +
             "' is neither a count of 16 bits nor an angle");
      radians_ = radians_ || *value != std::round(*value);
      row.counts.push_back(*value);
    }
    rows_.push_back(std::move(row));
  }

  void read(std::string_view line) {
    const std::vector<std::string_view> cells = cells_of(line);
    if (bare_) return read_bare(cells);
    const auto interval = whole_number(cells[0]);
    if (!interval || *interval < 1 || *interval > 60000)
      stop("'" + std::string(cells[0].substr(0, 24)) + "' is not an interval in milliseconds");
    if (cells.size() < 3 || (cells[1] != "2" && cells[1] != "3"))
      stop("expected an interval, then 2 (targets) or 3 (a command to one device)");
    if (cells[1] == "3")
      ++general_;
    else
      read_targets(cells);
    now_ += *interval;
  }

  void read_targets(const std::vector<std::string_view>& cells) {
    const int motors = motors_of(cells.size());
    if (motors == 0 || (columns_ != 0 && cells.size() != columns_))
      stop(std::to_string(cells.size()) + " columns" +
           (columns_ != 0 ? ", but the rows before have " + std::to_string(columns_)
                          : "; sequences have 25 (HOAP-1), 27 (HOAP-2) or 29 (HOAP-3)"));
    columns_ = cells.size();
    Row row{now_, {}};
    for (int m = 0; m < motors; ++m) {
      const std::string_view cell = cells[static_cast<size_t>(2 + m)];
      const auto count = whole_number(cell);
      if (!count || *count < -32768 || *count > 32767)
        stop("column " + std::to_string(3 + m) + ": '" + std::string(cell.substr(0, 24)) +
             "' is not a count of 16 bits");
      row.counts.push_back(*count);
    }
    rows_.push_back(std::move(row));
  }

  std::string_view rest_;
  const std::string& file_;
  std::vector<Row> rows_;
  bool bare_ = false, radians_ = false;
  int now_ = 0, general_ = 0;
  size_t columns_ = 0, line_ = 0;
};

// Counts of one device at every tick, interpolated linearly between rows.
Eigen::VectorXd on_ticks(const std::vector<Row>& rows, size_t device, int tick) {
  const int begin = rows.front().at;
  const Eigen::Index count = (rows.back().at - begin) / tick + 1;
  Eigen::VectorXd values(count);
  size_t r = 0;
  for (Eigen::Index k = 0; k < count; ++k) {
    const int t = begin + static_cast<int>(k) * tick;
    while (r + 2 < rows.size() && rows[r + 1].at <= t) ++r;
    if (rows.size() == 1) {
      values[k] = rows[0].counts[device];
      continue;
    }
    const double u = static_cast<double>(t - rows[r].at) / (rows[r + 1].at - rows[r].at);
    values[k] = (1 - u) * rows[r].counts[device] + u * rows[r + 1].counts[device];
  }
  return values;
}

void refuse_lost_motion(const std::vector<Row>& rows, size_t device, const RobotModel& model,
                        const std::string& file, std::vector<std::string>& filled) {
  const auto [least, most] = std::minmax_element(
      rows.begin(), rows.end(),
      [&](const Row& a, const Row& b) { return a.counts[device] < b.counts[device]; });
  // Movement of an axis that holds its place [counts]. Chosen: 0.05 degrees, half of what servos do
  // not follow (kOfCounts of table_import.cpp).
  constexpr double kTrembling = 10;
  const double low = least->counts[device], high = most->counts[device];
  const std::string name = "device " + std::to_string(device + 1);
  if (high - low > kTrembling)
    fail(ErrorCode::bad_file, file + ": " + name + " moves from " + text::brief(low) + " to " +
                                  text::brief(high) + " counts, but no joint of '" + model.name() +
                                  "' has this device; add it to \"encoders\" in the sidecar");
  filled.push_back(name + " is not on this robot and is ignored; its target is always " +
                   text::brief(low) + " counts");
}

// Rows without intervals: one per millisecond as robots answer, one per 2 ms as files in radians
// are meant, or as is said.
void set_bare_rate(const Reader& reader, double rate, ImportedMotion& result) {
  result.motion.dt = rate > 0 ? 1 / rate : reader.radians() ? 0.002 : 0.001;
  result.filled.push_back(std::string(reader.radians() ? "angles in radians" : "counts") +
                          " without intervals: " + text::brief(1000 * result.motion.dt) +
                          " ms from row to row" + (rate > 0 ? "" : " (--rate HZ for another)"));
}

}  // namespace

bool is_bare_hoap_row(std::string_view line) {
  const std::vector<std::string_view> cells = cells_of(line);
  return cells.size() == kBareColumns &&
         std::all_of(cells.begin(), cells.end(),
                     [](std::string_view cell) { return any_number(cell).has_value(); });
}

ImportedMotion read_hoap_motion(const std::string& bytes, const std::string& file,
                                const RobotModel& model, double rate) {
  Reader reader(bytes, file);
  const std::vector<Row> rows = reader.rows();
  int tick = 0;
  bool even = true;
  for (size_t r = 1; r < rows.size(); ++r) {
    const int step = rows[r].at - rows[r - 1].at;
    even = even && (tick == 0 || step == tick);
    tick = std::gcd(tick, step);
  }
  tick = std::max(tick, 1);
  ImportedMotion result;
  result.format = "hoap";
  result.rows = static_cast<int>(rows.size());
  result.motion.dt = 0.001 * tick;
  if (reader.bare()) set_bare_rate(reader, rate, result);
  if (!even)
    result.filled.push_back("the intervals change: rows are interpolated linearly, every " +
                            std::to_string(tick) + " ms");
  if (reader.general_commands() > 0)
    result.filled.push_back(
        std::to_string(reader.general_commands()) +
        " commands to single devices are ignored, but the time of their rows counts");
  const Eigen::VectorXd home = model.posture();
  const size_t motors = rows.front().counts.size();
  std::vector<int> dof_of_device(motors, -1);
  for (int dof = 0; dof < model.dof_count(); ++dof) {
    const auto device = static_cast<size_t>(model.dofs()[dof].encoder.device);
    if (device >= 1 && device <= motors) dof_of_device[device - 1] = dof;
  }
  const Eigen::Index count = (rows.back().at - rows.front().at) / tick + 1;
  result.motion.theta = home.transpose().replicate(count, 1);
  std::vector<char> in_file(static_cast<size_t>(model.dof_count()), 0);
  for (size_t device = 0; device < motors; ++device) {
    const int dof = dof_of_device[device];
    if (dof < 0) {
      refuse_lost_motion(rows, device, model, file, result.filled);
      continue;
    }
    in_file[static_cast<size_t>(dof)] = 1;
    const double per_degree = model.dofs()[dof].encoder.counts_per_degree;
    result.motion.theta.col(dof) = on_ticks(rows, device, tick) * (kRadiansPerDegree / per_degree);
  }
  for (int dof = 0; dof < model.dof_count(); ++dof)
    if (!in_file[static_cast<size_t>(dof)])
      result.filled.push_back(
          model.dofs()[dof].name +
          ": the file does not have this joint; it keeps its angle of the home posture");
  return result;
}

}  // namespace ayumi
