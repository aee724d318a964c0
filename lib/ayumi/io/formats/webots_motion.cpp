#include "ayumi/io/formats/webots_motion.hpp"

#include <cmath>
#include <limits>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/table/comma_cells.hpp"

namespace ayumi {

namespace {

constexpr std::string_view kWebotsMagic = "#WEBOTS_MOTION";
constexpr double kMillisecond = 1e-3;

std::vector<std::string_view> split(std::string_view line, char separator) {
  std::vector<std::string_view> cells;
  while (true) {
    const size_t end = line.find(separator);
    cells.push_back(trimmed(line.substr(0, end)));
    if (end == std::string_view::npos) return cells;
    line.remove_prefix(end + 1);
  }
}

// Reads a time of the form [[MM:]SS:]mmm.
double time_of(const MotionInput& source, std::string_view cell, size_t line) {
  const std::vector<std::string_view> parts = split(cell, ':');
  if (parts.size() > 3)
    source.refuse(line,
                  "'" + std::string(cell.substr(0, 24)) + "' is not a time of the form MM:SS:mmm");
  constexpr double units[] = {kMillisecond, 1, 60};
  double time = 0;
  for (size_t i = 0; i < parts.size(); ++i)
    time += units[parts.size() - 1 - i] * source.number(parts[i], line, "time");
  return std::round(time / kMillisecond) * kMillisecond;
}

// Removes the empty cell behind a separator at the end of a line; returns whether there was one.
bool remove_open_end(std::vector<std::string_view>& cells) {
  const bool open = !cells.empty() && cells.back().empty();
  if (open) cells.pop_back();
  return open;
}

}  // namespace

std::string recognize_webots_motion(const MotionInput& source) {
  return source.bytes.starts_with(kWebotsMagic) && recognize_webots_durations(source).empty()
             ? "the first line begins with #WEBOTS_MOTION"
             : "";
}

std::string recognize_webots_durations(const MotionInput& source) {
  std::string_view rest = source.bytes;
  std::vector<std::string_view> head = split(take_line(rest), ',');
  remove_open_end(head);
  return head.size() == 2 && head[0] == kWebotsMagic &&
                 take_line(rest).find('%') != std::string::npos
             ? "the first line is #WEBOTS_MOTION with a version, and the second line has names "
               "that contain %"
             : "";
}

MotionFile read_webots_motion(const MotionInput& source) {
  std::string_view rest = source.bytes;
  size_t line = 1;
  std::vector<std::string_view> head = split(take_line(rest), ',');
  const std::string version(head.size() > 1 ? head[1] : "");
  if (version != "V1.0" && version != "V1.1")
    source.refuse(1,
                  "version '" + version.substr(0, 24) + "' is unknown; Ayumi reads V1.0 and V1.1");
  MotionFile motion;
  motion.time_step = kMillisecond;
  head.erase(head.begin(), head.begin() + 2);
  bool open = remove_open_end(head);  // a separator ends every row
  char separator = ',';
  if (head.empty()) {  // the names are in the second line
    const std::string_view names = take_line(rest);
    ++line;
    if (names.find('%') != std::string_view::npos) separator = '%';
    head = split(names, separator);
    open = remove_open_end(head) || open;
  }
  for (const std::string_view name : head) {
    if (name.empty()) source.refuse(line, "a column has no name");
    motion.joints.emplace_back(name);
  }
  const bool durations = separator == '%';
  // With %, a row with an empty name begins with this character, and a name may begin with #.
  const auto is_remark = [&](std::string_view text) {
    return is_comment(text) && !(durations && text.find('%') != std::string_view::npos);
  };
  const size_t before = durations ? 1 : 2, after = durations ? 1 : 0;
  std::vector<double> cells;
  double now = 0;
  int without_time = 0;
  while (!rest.empty()) {
    const std::string_view text = take_line(rest);
    ++line;
    if (text.empty() || is_remark(text)) continue;
    std::vector<std::string_view> row = split(text, separator);
    if (open && row.back().empty()) row.pop_back();
    if (row.size() != before + head.size() + after)
      source.refuse(line, "the row has " + text::counted(row.size(), "cell") +
                              ", but the head row needs " +
                              std::to_string(before + head.size() + after) + " (" +
                              text::counted(head.size(), "joint") + ")");
    if (durations) {
      const double duration = source.number(row.back(), line, "duration");
      if (duration < 0) source.refuse(line, "the duration is below 0 s");
      if (duration == 0) {
        ++without_time;
        continue;
      }
      if (!motion.times.empty()) now += duration;
    } else {
      now = time_of(source, row.front(), line);
    }
    if (!motion.times.empty() && !(now > motion.times.back()))
      source.refuse(line, "time " + text::brief(now) + " s does not come after " +
                              text::brief(motion.times.back()) + " s; times must increase");
    motion.times.push_back(now);
    for (size_t i = 0; i < head.size(); ++i)
      cells.push_back(row[before + i] == "*"
                          ? std::numeric_limits<double>::quiet_NaN()
                          : source.number(row[before + i], line, "column " + motion.joints[i]));
  }
  if (without_time > 0)
    motion.notes.push_back(text::counted(without_time, "row") +
                           " with a duration of 0 s are left out");
  if (motion.times.empty())
    source.refuse(line,
                  "the file has no pose, so there is no motion to read; write the file again");
  motion.values = Eigen::Map<Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(
      cells.data(), static_cast<Eigen::Index>(motion.times.size()),
      static_cast<Eigen::Index>(head.size()));
  motion.notes.push_back("units: radians and metres, as the format defines them");
  if (durations) {
    motion.keys = true;
    motion.notes.push_back(
        "the last cell of a row is the time from the pose before to the pose of this row; the "
        "motion begins at the first pose");
  }
  return motion;
}

std::vector<WrittenFile> write_webots_durations(const RobotModel&, const MotionFile& motion) {
  std::string text = std::string(kWebotsMagic) + ",V1.1\n" + text::join(motion.joints, "%") + "\n";
  for (Eigen::Index k = 0; k < motion.rows(); ++k) {
    text += "play";
    for (const double value : motion.values.row(k)) text += "%" + text::exact(value);
    // The first pose is also reached in the time of one row.
    const auto at = static_cast<size_t>(k);
    const double time = k > 0 ? motion.times[at] - motion.times[at - 1] : 1 / motion.rate;
    text += "%" + text::exact(time) + "\n";
  }
  return {{"", text}};
}

std::vector<WrittenFile> write_webots_motion(const RobotModel&, const MotionFile& motion) {
  std::string text = std::string(kWebotsMagic) + ",V1.0," + text::join(motion.joints, ",") + "\n";
  for (Eigen::Index k = 0; k < motion.rows(); ++k) {
    const long ms = std::lround(motion.times[static_cast<size_t>(k)] / kMillisecond);
    char time[32];
    std::snprintf(time, sizeof time, "%02ld:%02ld:%03ld", ms / 60000, ms / 1000 % 60, ms % 1000);
    text += std::string(time) + ",Pose" + std::to_string(k + 1);
    for (const double value : motion.values.row(k)) text += "," + text::exact(value);
    text += "\n";
  }
  return {{"", text}};
}

}  // namespace ayumi
