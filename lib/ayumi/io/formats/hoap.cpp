#include "ayumi/io/formats/hoap.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/degrees.hpp"
#include "ayumi/io/table/comma_cells.hpp"
#include "ayumi/model/encoder_angles.hpp"

namespace ayumi {

namespace {

constexpr int kLongestInterval = 60000;  // Definition: the longest interval is a minute [ms]

std::optional<double> any_number(std::string_view cell) {
  double value = 0;
  if (!cell.empty() && cell.front() == '+') cell.remove_prefix(1);
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

bool is_whole(std::string_view cell) {
  int value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return error == std::errc() && end == cell.data() + cell.size();
}

bool all_numbers(const std::vector<std::string_view>& cells) {
  return std::all_of(cells.begin(), cells.end(),
                     [](std::string_view cell) { return any_number(cell).has_value(); });
}

bool is_row_of_commands(const std::vector<std::string_view>& cells) {
  return cells.size() > 2 && is_whole(cells[0]) && (cells[1] == "2" || cells[1] == "3");
}

int devices_of(const RobotModel& model) {
  int most = 0;
  for (const Dof& dof : model.dofs()) most = std::max(most, dof.encoder.device);
  return most;
}

// The numbers of devices as text, such as "25 (HOAP-1), 27 (HOAP-2)".
std::string list_of(const std::vector<SequenceLayout>& layouts, bool with_interval) {
  std::vector<std::string> words;
  for (const SequenceLayout& layout : layouts)
    if (layout.has_interval() == with_interval)
      words.push_back(std::to_string(layout.columns()) + " (" + layout.name + ")");
  return text::join(words, ", ");
}

class Reader {
 public:
  Reader(const std::string& bytes, const std::string& file, const RobotModel& model,
         int interval_ms)
      : rest_(bytes), file_(file), layouts_(sequence_layouts(model)), given_(interval_ms) {
    const size_t end = bytes.find('\n');
    if (end != std::string::npos && end > 0 && bytes[end - 1] == '\r') result_.line_end = "\r\n";
  }

  HoapFile whole() {
    while (!rest_.empty()) {
      const std::string_view line = take_line(rest_);
      ++line_;
      if (!line.empty()) read(line);
    }
    if (result_.rows.empty())
      fail(ErrorCode::bad_file, {file_}, "the file has no row with targets for the motors");
    const std::string &first = result_.first_words, &last = result_.last_words;
    if (!last.empty() && last.size() < first.size() && first.starts_with(last))
      stop("the row ends with '" + last + "', but the first row ends with '" + first +
               "'. The file may be truncated; copy it again",
           true);
    if (bare_) set_bare_times();
    set_tick();
    return std::move(result_);
  }

 private:
  [[noreturn]] void stop(const std::string& reason, bool names_remedy = false) const {
    SourcePlace place{file_, "", static_cast<long>(line_)};
    place.names_remedy = names_remedy;
    fail(ErrorCode::bad_file, place, reason);
  }

  void read(std::string_view line) {
    const std::vector<std::string_view> cells = cells_of(line);
    if (result_.rows.empty() && result_.general_commands == 0)
      bare_ = all_numbers(cells) && (is_bare(cells.size()) || !is_row_of_commands(cells));
    if (bare_) return read_bare(cells);
    int interval = 0;
    const auto [end, error] =
        std::from_chars(cells[0].data(), cells[0].data() + cells[0].size(), interval);
    if (error != std::errc() || end != cells[0].data() + cells[0].size() || interval < 1 ||
        interval > kLongestInterval)
      stop("'" + std::string(cells[0].substr(0, 24)) + "' is not an interval in milliseconds");
    if (cells.size() < 3 || (cells[1] != "2" && cells[1] != "3"))
      stop(
          "a row must begin with an interval [ms] and a code. The code is 2 if targets follow, and "
          "3 if a command to one device follows");
    if (cells[1] == "3")
      ++result_.general_commands;
    else
      read_targets(cells, line);
    now_ += interval;
    if (now_ > std::numeric_limits<int>::max() / 2) stop("the sequence lasts longer than 12 days");
  }

  bool is_bare(size_t columns) const {
    return std::any_of(layouts_.begin(), layouts_.end(), [&](const SequenceLayout& layout) {
      return !layout.has_interval() && layout.columns() == columns;
    });
  }

  void find_layout(size_t columns, bool with_interval) {
    if (!result_.rows.empty()) {
      if (columns != result_.layout.columns())
        stop("the row has " + std::to_string(columns) + " columns, but each row before it has " +
             std::to_string(result_.layout.columns()));
      return;
    }
    for (const SequenceLayout& layout : layouts_)
      if (layout.columns() == columns && layout.has_interval() == with_interval) {
        result_.layout = layout;
        return;
      }
    if (std::all_of(layouts_.begin(), layouts_.end(),
                    [](const SequenceLayout& layout) { return layout.motors == 0; }))
      stop(
          "the rows are encoder counts of motors, but this robot has no encoders. With --robot, "
          "name "
          "the robot that the file was made for, or add \"encoders\" to the sidecar of this robot",
          true);
    stop("the row has " + std::to_string(columns) + " columns, but " +
         (with_interval ? "sequences" : "rows without an interval") + " of this robot have " +
         list_of(layouts_, with_interval) +
         ". Add the layout of this file to \"layouts\" in the sidecar, or name the robot that the "
         "file was made for");
  }

  void read_targets(const std::vector<std::string_view>& cells, std::string_view line) {
    find_layout(cells.size(), true);
    HoapRow row{now_, {}};
    const size_t begin = result_.layout.before.size();
    const auto motors = static_cast<size_t>(result_.layout.motors);
    for (size_t m = 0; m < motors; ++m) {
      const std::string_view cell = cells[begin + m];
      const auto count = any_number(cell);
      if (!count || !is_whole(cell) || *count < -32768 || *count > 32767)
        stop("column " + std::to_string(begin + m + 1) + ": '" + std::string(cell.substr(0, 24)) +
             "' is not a whole number from -32768 to 32767");
      row.values.push_back(*count);
    }
    size_t at = 0;  // the place after the comma that follows the last motor
    for (size_t comma = 0; comma < begin + motors && at != std::string_view::npos; ++comma)
      at = line.find(',', at == 0 ? 0 : at + 1);
    result_.last_words = at == std::string_view::npos ? "" : std::string(line.substr(at));
    if (result_.rows.empty()) result_.first_words = result_.last_words;
    result_.rows.push_back(std::move(row));
  }

  void read_bare(const std::vector<std::string_view>& cells) {
    find_layout(cells.size(), false);
    HoapRow row{0, {}};
    const size_t begin = result_.layout.before.size();
    for (size_t m = 0; m < static_cast<size_t>(result_.layout.motors); ++m) {
      const std::string_view cell = cells[begin + m];
      const auto value = any_number(cell);
      if (!value || std::abs(*value) > 32768)
        stop("column " + std::to_string(begin + m + 1) + ": '" + std::string(cell.substr(0, 24)) +
             "' is neither a count from -32768 to 32767 nor an angle");
      fraction_ = fraction_ || *value != std::round(*value);
      row.values.push_back(*value);
    }
    result_.rows.push_back(std::move(row));
  }

  // If any value has a fraction, the values are angles, and the layout is the one of angles.
  void set_bare_times() {
    const size_t columns = result_.layout.columns();
    const SequenceLayout* found = nullptr;
    for (const SequenceLayout& layout : layouts_)
      if (!found && !layout.has_interval() && layout.columns() == columns &&
          layout.radians == fraction_)
        found = &layout;
    if (!found)
      fail(ErrorCode::bad_file, {file_},
           "the file has " + std::to_string(columns) + " columns in " +
               (fraction_ ? "radians" : "counts") +
               ", and none of them is an interval. This robot has no layout with such columns; "
               "add the layout to \"layouts\" in the sidecar");
    result_.layout = *found;
    const int interval = given_ > 0                    ? given_
                         : found->intervals_ms.empty() ? 1
                                                       : found->intervals_ms.front();
    for (size_t r = 0; r < result_.rows.size(); ++r)
      result_.rows[r].at = static_cast<int>(r) * interval;
  }

  void set_tick() {
    int tick = 0;
    for (size_t r = 1; r < result_.rows.size(); ++r) {
      const int step = result_.rows[r].at - result_.rows[r - 1].at;
      result_.even = result_.even && (tick == 0 || step == tick);
      tick = std::gcd(tick, step);
    }
    result_.tick_ms = std::max(tick, 1);
  }

  std::string_view rest_;
  const std::string& file_;
  const std::vector<SequenceLayout> layouts_;
  const int given_;
  HoapFile result_;
  bool bare_ = false, fraction_ = false;
  int now_ = 0;
  size_t line_ = 0;
};

// The degree of freedom of each device of a layout, in device order.
std::vector<int> dofs_by_device(const RobotModel& model, const SequenceLayout& layout) {
  const std::string need =
      layout.motors == 0
          ? std::string(
                "; in \"encoders\" of the sidecar, give the device and the counts per "
                "degree of every joint")
          : ". For the layout '" + layout.name +
                "', \"encoders\" of the sidecar must give each of the devices 1 to " +
                std::to_string(layout.motors) + " to exactly one joint, with its counts per degree";
  std::vector<int> dofs(static_cast<size_t>(layout.motors), -1);
  for (int dof = 0; dof < model.dof_count(); ++dof) {
    const Dof& joint = model.dofs()[static_cast<size_t>(dof)];
    const int device = joint.encoder.device;
    if (device < 1 || device > layout.motors || dofs[static_cast<size_t>(device - 1)] >= 0 ||
        joint.encoder.counts_per_degree == 0)
      fail(ErrorCode::bad_model,
           "robot '" + model.name() + "': joint '" + joint.name + "' has " +
               (device < 1 ? "no encoder" : "encoder device " + std::to_string(device)) + need);
    dofs[static_cast<size_t>(device - 1)] = dof;
  }
  for (size_t m = 0; m < dofs.size(); ++m)
    if (dofs[m] < 0)
      fail(ErrorCode::bad_model, "robot '" + model.name() + "': no joint has encoder device " +
                                     std::to_string(m + 1) + need);
  return dofs;
}

// Appends the rows [begin, end) of counts in device order, with the cells before and after the
// motors.
void append_rows(std::string& text, const Eigen::MatrixXi& counts, const std::vector<int>& dofs,
                 Eigen::Index begin, Eigen::Index end, const std::string& before,
                 const std::string& behind) {
  for (Eigen::Index k = begin; k < end; ++k) {
    text += before;
    for (const int dof : dofs) text += "," + std::to_string(counts(k, dof));
    text += behind;
  }
}

int interval_of(const RobotModel& model, const SequenceLayout& layout, double dt) {
  const std::string refusal = refusal_of_interval(model, layout, dt);
  if (!refusal.empty()) fail(ErrorCode::bad_pattern, refusal);
  return static_cast<int>(std::round(1000 * dt));
}

Eigen::MatrixXi counts_of(const RobotModel& model, const ReferenceTrajectory& table,
                          const SafetyOptions& options) {
  const Eigen::MatrixXi counts = encoder_counts(model, table, options);
  if (counts.cwiseAbs().maxCoeff() > 32767)
    fail(ErrorCode::bad_pattern,
         "a joint angle needs more than 32767 encoder counts, the largest number of the format; "
         "keep the joint nearer to its zero");
  return counts;
}

}  // namespace

std::vector<SequenceLayout> sequence_layouts(const RobotModel& model) {
  if (!model.description().layouts.empty()) return model.description().layouts;
  const int motors = devices_of(model);
  return {{"motors and three requests", {"interval", "2"}, {"R", "R", "R"}, motors, false, {}},
          {"answers", {}, {"*", "*"}, motors, false, {1}},
          {"angles", {}, {"*", "*"}, motors, true, {2}}};
}

SequenceLayout written_layout(const RobotModel& model, const std::string& name) {
  std::vector<std::string> names;
  for (const SequenceLayout& layout : sequence_layouts(model)) {
    if (!layout.has_interval()) continue;
    names.push_back(layout.name);
    if (!name.empty() && layout.name != name) continue;
    dofs_by_device(model, layout);
    return layout;
  }
  if (!name.empty() && !names.empty())
    fail(ErrorCode::bad_model, "robot '" + model.name() + "' has no layout '" + name +
                                   "'; it has " + text::join(names, ", ") +
                                   text::suggestion(name, names));
  fail(ErrorCode::bad_model, "robot '" + model.name() +
                                 "' has no layout with an interval, so no sequence can be written "
                                 "for this robot; add such a layout to \"layouts\" in the sidecar");
}

HoapFile parse_hoap(const std::string& bytes, const std::string& file, const RobotModel& model,
                    int interval_ms) {
  return Reader(bytes, file, model, interval_ms).whole();
}

bool looks_like_hoap(const std::string& bytes, const RobotModel& model) {
  std::string_view rest = bytes;
  std::string_view line = take_line(rest);
  while (line.empty() && !rest.empty()) line = take_line(rest);
  const std::vector<std::string_view> cells = cells_of(line);
  if (is_row_of_commands(cells)) return true;  // no head row can begin in this way
  if (!all_numbers(cells)) return false;
  for (const SequenceLayout& layout : sequence_layouts(model))
    if (!layout.has_interval() && layout.columns() == cells.size()) return true;
  return false;
}

Eigen::VectorXd values_on_ticks(const HoapFile& sequence, int device) {
  const std::vector<HoapRow>& rows = sequence.rows;
  const auto column = static_cast<size_t>(device - 1);
  const int begin = rows.front().at;
  const Eigen::Index count = (rows.back().at - begin) / sequence.tick_ms + 1;
  Eigen::VectorXd values(count);
  size_t r = 0;
  for (Eigen::Index k = 0; k < count; ++k) {
    const int t = begin + static_cast<int>(k) * sequence.tick_ms;
    while (r + 1 < rows.size() && rows[r + 1].at <= t) ++r;
    values[k] = rows[r].values[column];
    if (rows[r].at == t) continue;
    const double u = static_cast<double>(t - rows[r].at) / (rows[r + 1].at - rows[r].at);
    values[k] = (1 - u) * rows[r].values[column] + u * rows[r + 1].values[column];
  }
  return values;
}

double angle_of_unit(const HoapFile& sequence, const Dof& dof) {
  const double per_degree = dof.encoder.counts_per_degree;
  if (sequence.layout.radians) return per_degree < 0 ? -1 : 1;
  return kRadiansPerDegree / per_degree;
}

Eigen::MatrixXd hoap_readings(const RobotModel& model, const HoapFile& sequence) {
  const Eigen::Index count =
      (sequence.rows.back().at - sequence.rows.front().at) / sequence.tick_ms + 1;
  Eigen::MatrixXd readings =
      encoder_angles(model.posture(), encoder_zeros(model)).transpose().replicate(count, 1);
  for (int j = 0; j < model.dof_count(); ++j) {
    const Dof& dof = model.dofs()[static_cast<size_t>(j)];
    if (dof.encoder.device < 1 || dof.encoder.device > sequence.layout.motors) continue;
    readings.col(j) = values_on_ticks(sequence, dof.encoder.device) * angle_of_unit(sequence, dof);
  }
  return readings;
}

ReferenceTrajectory hoap_targets(const RobotModel& model, const HoapFile& sequence) {
  ReferenceTrajectory table;
  table.dt = sequence.dt();
  table.joints = model.dof_names();
  table.provenance.robot = model.name();
  table.servo.zeros = encoder_zeros(model);
  const Eigen::MatrixXd theta = joint_rows(hoap_readings(model, sequence), table.servo.zeros);
  table.rows.resize(static_cast<size_t>(theta.rows()));
  for (Eigen::Index k = 0; k < theta.rows(); ++k)
    table.rows[static_cast<size_t>(k)].theta = theta.row(k).transpose();
  return table;
}

std::string refusal_of_interval(const RobotModel& model, const SequenceLayout& layout, double dt) {
  const double ms = 1000 * dt;
  const int interval = static_cast<int>(std::round(ms));
  if (interval < 1 || std::abs(ms - interval) > 1e-6)
    return "in a HOAP sequence, the time between two rows is a whole number of milliseconds, but "
           "in "
           "the table it is " +
           text::brief(ms) + " ms";
  const std::vector<int>& allowed = layout.intervals_ms;
  if (allowed.empty() || std::find(allowed.begin(), allowed.end(), interval) != allowed.end())
    return "";
  std::vector<std::string> known;
  for (const int each : allowed) known.push_back(std::to_string(each));
  return "the table has a row every " + text::brief(ms) + " ms, but the layout '" + layout.name +
         "' of '" + model.name() + "' allows only " + text::join(known, ", ") + " ms";
}

std::string hoap_csv(const RobotModel& model, const ReferenceTrajectory& table,
                     const SafetyOptions& options, const SequenceLayout& layout) {
  const std::vector<int> dofs = dofs_by_device(model, layout);
  const int interval = interval_of(model, layout, table.dt);
  std::string behind;
  for (const std::string& word : layout.after) behind += "," + word;
  std::string text;
  const Eigen::MatrixXi counts = counts_of(model, table, options);
  append_rows(text, counts, dofs, 0, counts.rows(), std::to_string(interval) + ",2", behind + "\n");
  return text;
}

std::string hoap_csv(const RobotModel& model, const ReferenceTrajectory& table,
                     const SafetyOptions& options) {
  return hoap_csv(model, table, options, written_layout(model));
}

std::string hoap_csv_around(const RobotModel& model, const ReferenceTrajectory& table, size_t first,
                            size_t count, const SafetyOptions& options, const HoapFile& sequence,
                            const std::string& bytes) {
  const auto begin = static_cast<Eigen::Index>(first);
  const auto end = static_cast<Eigen::Index>(first + count);
  const auto rows = static_cast<Eigen::Index>(table.rows.size());
  if (begin == 0 && end == rows) return bytes;
  const std::vector<int> dofs = dofs_by_device(model, sequence.layout);
  // The rows around the file have its own interval, which its layout need not allow.
  const std::string before = std::to_string(interval_of(model, {}, table.dt)) + ",2";
  const Eigen::MatrixXi counts = counts_of(model, table, options);
  std::string text;
  append_rows(text, counts, dofs, 0, begin, before, sequence.first_words + sequence.line_end);
  text += bytes;
  if (!bytes.ends_with('\n')) text += sequence.line_end;
  append_rows(text, counts, dofs, end, rows, before, sequence.last_words + sequence.line_end);
  return text;
}

}  // namespace ayumi
