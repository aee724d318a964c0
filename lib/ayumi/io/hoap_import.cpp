// Real sequence files are no clean tables: line ends of two kinds, blanks around cells, "-0",
// requests where others have hobby servo words, commands to single devices between the rows.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <optional>
#include <string_view>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/comma_cells.hpp"
#include "ayumi/io/motion_import.hpp"

namespace ayumi {

namespace {

constexpr double kRadiansPerDegree = EIGEN_PI / 180;
constexpr double kSmoothing = 0.050;  // to either side of a sample [s]
constexpr double kBandDegrees = 0.1;  // of change by it; servos follow no better

std::optional<int> whole_number(std::string_view cell) {
  int value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size()) return std::nullopt;
  return value;
}

int motors_of(size_t columns) {
  return columns == 25 ? 20 : columns == 27 || columns == 29 ? 21 : 0;
}

struct Row {
  int at = 0;               // [ms]
  std::vector<int> counts;  // by device from 1
};

class Reader {
 public:
  Reader(const std::string& bytes, const std::string& file) : rest_(bytes), file_(file) {}

  std::vector<Row> rows() {
    while (!rest_.empty()) {
      const std::string_view line = take_line(rest_);
      ++line_;
      if (!line.empty()) read(line);
    }
    if (rows_.empty()) fail(ErrorCode::bad_file, file_ + ": no row with targets for the motors");
    return std::move(rows_);
  }
  int general_commands() const { return general_; }
  size_t columns() const { return columns_; }

 private:
  [[noreturn]] void stop(const std::string& reason) const {
    fail(ErrorCode::bad_file, file_ + ":" + std::to_string(line_) + ": " + reason);
  }

  void read(std::string_view line) {
    const std::vector<std::string_view> cells = cells_of(line);
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
           (columns_ != 0 ? ", the rows before have " + std::to_string(columns_)
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
  int now_ = 0, general_ = 0;
  size_t columns_ = 0, line_ = 0;
};

// Counts of one device at every tick, straight between rows.
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
  const int low = least->counts[device], high = most->counts[device];
  const std::string name = "device " + std::to_string(device + 1);
  if (low != high)
    fail(ErrorCode::bad_file, file + ": " + name + " moves from " + std::to_string(low) + " to " +
                                  std::to_string(high) + " counts, but no joint of '" +
                                  model.name() + "' has it (encoders in its sidecar)");
  filled.push_back(name + " is not on this robot: left out, it rests at " + std::to_string(low) +
                   " counts");
}

}  // namespace

Eigen::VectorXd smoothed_within(const Eigen::VectorXd& x, double band, int reach) {
  const Eigen::Index n = x.size();
  constexpr int kDegree = 4;
  if (reach < 3 || n <= reach) return x;
  // Least squares over -reach .. reach: the value at 0 is linear in the samples.
  Eigen::MatrixXd powers(2 * reach + 1, kDegree + 1);
  for (int i = -reach; i <= reach; ++i)
    for (int p = 0; p <= kDegree; ++p)
      powers(i + reach, p) = std::pow(static_cast<double>(i) / reach, p);
  const Eigen::MatrixXd normal = powers.transpose() * powers;
  const Eigen::VectorXd weights =
      powers * normal.ldlt().solve(Eigen::VectorXd::Unit(kDegree + 1, 0));
  Eigen::VectorXd padded(n + 2 * reach), y(n);
  padded.segment(reach, n) = x;
  for (int i = 1; i <= reach; ++i) {  // point-symmetric about both ends
    padded[reach - i] = 2 * x[0] - x[i];
    padded[reach + n - 1 + i] = 2 * x[n - 1] - x[n - 1 - i];
  }
  for (Eigen::Index k = 0; k < n; ++k)
    y[k] = x[k] + band * std::tanh((weights.dot(padded.segment(k, 2 * reach + 1)) - x[k]) / band);
  return y;
}

ImportedMotion read_hoap_motion(const std::string& bytes, const std::string& file,
                                const RobotModel& model) {
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
  if (!even)
    result.filled.push_back("intervals change: straight between rows, every " +
                            std::to_string(tick) + " ms");
  if (reader.general_commands() > 0)
    result.filled.push_back(std::to_string(reader.general_commands()) +
                            " commands to single devices left out; their time passes");
  const Eigen::VectorXd home = model.posture();
  const size_t motors = rows.front().counts.size();
  std::vector<int> dof_of_device(motors, -1);
  for (int dof = 0; dof < model.dof_count(); ++dof) {
    const auto device = static_cast<size_t>(model.dofs()[dof].encoder.device);
    if (device >= 1 && device <= motors) dof_of_device[device - 1] = dof;
  }
  const Eigen::Index count = (rows.back().at - rows.front().at) / tick + 1;
  result.motion.theta = home.transpose().replicate(count, 1);
  std::vector<char> told(static_cast<size_t>(model.dof_count()), 0);
  for (size_t device = 0; device < motors; ++device) {
    const int dof = dof_of_device[device];
    if (dof < 0) {
      refuse_lost_motion(rows, device, model, file, result.filled);
      continue;
    }
    told[static_cast<size_t>(dof)] = 1;
    const double per_degree = model.dofs()[dof].encoder.counts_per_degree;
    const int reach = static_cast<int>(std::lround(kSmoothing / result.motion.dt));
    result.motion.theta.col(dof) =
        smoothed_within(on_ticks(rows, device, tick), kBandDegrees * std::abs(per_degree), reach) *
        (kRadiansPerDegree / per_degree);
  }
  result.filled.push_back("angles smoothed by at most " + text::brief(kBandDegrees) + " deg");
  for (int dof = 0; dof < model.dof_count(); ++dof)
    if (!told[static_cast<size_t>(dof)])
      result.filled.push_back(model.dofs()[dof].name + ": not in the file, rests at home");
  return result;
}

}  // namespace ayumi
