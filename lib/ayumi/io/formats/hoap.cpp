#include "ayumi/io/formats/hoap.hpp"

#include <charconv>
#include <cmath>
#include <string_view>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/io/table/comma_cells.hpp"

namespace ayumi {

namespace {

class SequenceParser {
 public:
  SequenceParser(const std::string& bytes, const std::string& file, const HoapLayout& layout)
      : rest_(bytes), file_(file), layout_(layout) {}

  HoapSequence whole() {
    while (!rest_.empty()) {
      const std::string_view line = take_line(rest_);
      ++line_;
      if (!line.empty()) row(line);
    }
    if (counts_.empty()) fail(ErrorCode::bad_file, file_ + ": the file has no row of a sequence");
    HoapSequence sequence;
    sequence.interval_ms = interval_;
    sequence.counts =
        Eigen::Map<const Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
            counts_.data(), static_cast<Eigen::Index>(counts_.size()) / layout_.motors,
            layout_.motors);
    return sequence;
  }

 private:
  [[noreturn]] void stop(const std::string& reason) const {
    fail(ErrorCode::bad_file, file_ + ":" + std::to_string(line_) + ": " + reason);
  }

  void row(std::string_view line) {
    const std::vector<std::string_view> cells = cells_of(line);
    if (cells.size() > 1 && cells[1] != "2")
      stop("command '" + std::string(cells[1].substr(0, 16)) +
           "': only fixed commands (2) are allowed here; `ayumi import` also reads general "
           "commands (3)");
    if (cells.size() != static_cast<size_t>(layout_.columns()))
      stop(std::to_string(cells.size()) + " columns, but sequences of this robot have " +
           std::to_string(layout_.columns()) + " (interval, 2, " + std::to_string(layout_.motors) +
           " motors, " + std::to_string(layout_.rc_words + layout_.requests) + " more)");
    const int interval = whole_number(cells[0], 1);
    if (interval < 1) stop("an interval of " + std::to_string(interval) + " ms");
    if (!counts_.empty() && interval != interval_)
      stop("the interval changes from " + std::to_string(interval_) + " to " +
           std::to_string(interval) + " ms; a fixed rate is needed");
    interval_ = interval;
    for (int m = 0; m < layout_.motors; ++m)
      counts_.push_back(whole_number(cells[static_cast<size_t>(2 + m)], 3 + m));
  }

  int whole_number(std::string_view cell, int column) const {
    int value = 0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error != std::errc() || end != cell.data() + cell.size())
      stop("column " + std::to_string(column) + ": '" + std::string(cell.substr(0, 24)) +
           "' is not a whole number");
    if (value < -32768 || value > 32767)
      stop("column " + std::to_string(column) + ": " + std::to_string(value) +
           " does not fit into 16 bits");
    return value;
  }

  std::string_view rest_;
  const std::string& file_;
  const HoapLayout& layout_;
  std::vector<int> counts_;
  int interval_ = 1;
  size_t line_ = 0;
};

// Dof of each device, in device order.
std::vector<int> dofs_by_device(const RobotModel& model) {
  std::vector<int> dofs(static_cast<size_t>(model.dof_count()), -1);
  for (int dof = 0; dof < model.dof_count(); ++dof) {
    const Dof& joint = model.dofs()[static_cast<size_t>(dof)];
    const int device = joint.encoder.device;
    if (device < 1 || device > model.dof_count() || dofs[static_cast<size_t>(device - 1)] >= 0 ||
        joint.encoder.counts_per_degree == 0)
      fail(ErrorCode::bad_model,
           "robot '" + model.name() + "': joint '" + joint.name + "' has encoder device " +
               std::to_string(device) + "; a HOAP sequence needs each of 1 to " +
               std::to_string(model.dof_count()) + " once, with counts per degree");
    dofs[static_cast<size_t>(device - 1)] = dof;
  }
  return dofs;
}

}  // namespace

HoapSequence parse_hoap(const std::string& bytes, const std::string& file,
                        const HoapLayout& layout) {
  return SequenceParser(bytes, file, layout).whole();
}

std::string hoap_text(const HoapSequence& sequence, const HoapLayout& layout) {
  std::string text;
  for (Eigen::Index k = 0; k < sequence.counts.rows(); ++k) {
    text += std::to_string(sequence.interval_ms) + ",2";
    for (const int count : sequence.counts.row(k)) text += "," + std::to_string(count);
    for (int i = 0; i < layout.rc_words; ++i) text += ",60";  // head centre
    for (int i = 0; i < layout.requests; ++i) text += ",R";
    text += '\n';
  }
  return text;
}

HoapLayout hoap_layout(const RobotModel& model) {
  return {.motors = static_cast<int>(dofs_by_device(model).size())};
}

std::string hoap_csv(const RobotModel& model, const ReferenceTrajectory& table,
                     const SafetyOptions& options) {
  const std::vector<int> dofs = dofs_by_device(model);
  const double ms = table.dt * 1000;
  HoapSequence sequence;
  sequence.interval_ms = static_cast<int>(std::round(ms));
  if (sequence.interval_ms < 1 || std::abs(ms - sequence.interval_ms) > 1e-6)
    fail(ErrorCode::bad_pattern,
         "a HOAP sequence needs a whole number of milliseconds between rows, the table has " +
             std::to_string(ms) + " ms");
  const Eigen::MatrixXi counts =
      encoder_counts(model, table, count_step_limits(model, table.dt, options));
  sequence.counts.resize(counts.rows(), counts.cols());
  for (size_t m = 0; m < dofs.size(); ++m)
    sequence.counts.col(static_cast<Eigen::Index>(m)) = counts.col(dofs[m]);
  if (sequence.counts.cwiseAbs().maxCoeff() > 32767)
    fail(ErrorCode::bad_pattern, "a joint angle needs more counts than 16 bits hold");
  return hoap_text(sequence, hoap_layout(model));
}

ReferenceTrajectory read_hoap(const std::filesystem::path& path, const RobotModel& model) {
  const std::vector<int> dofs = dofs_by_device(model);
  const HoapSequence sequence = parse_hoap(read_file(path), path.string(), hoap_layout(model));
  ReferenceTrajectory table;
  table.dt = sequence.interval_ms * 0.001;
  table.joints = model.dof_names();
  table.provenance.robot = model.name();
  for (Eigen::Index k = 0; k < sequence.counts.rows(); ++k) {
    ReferenceRow row;
    row.theta.resize(model.dof_count());
    for (size_t m = 0; m < dofs.size(); ++m) {
      const double per_degree =
          model.dofs()[static_cast<size_t>(dofs[m])].encoder.counts_per_degree;
      row.theta[dofs[m]] =
          sequence.counts(k, static_cast<Eigen::Index>(m)) / per_degree * (EIGEN_PI / 180);
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace ayumi
