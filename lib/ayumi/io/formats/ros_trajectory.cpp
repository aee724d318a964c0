#include "ayumi/io/formats/ros_trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/yaml/yaml_tree.hpp"

namespace ayumi {

namespace {

constexpr double kNanosecond = 1e-9;

size_t yaml_line(const YamlNode& node) { return static_cast<size_t>(node.line); }

std::vector<std::string> names_in(const MotionInput& source, const YamlNode& node) {
  std::vector<std::string> names;
  if (!node.is_list() || node.items.empty())
    source.refuse(yaml_line(node), "names of joints are needed");
  for (const YamlNode& item : node.items) names.push_back(item.text);
  return names;
}

/// The keys of one group of joints.
struct Trajectory {
  std::vector<std::string> joints;
  std::vector<double> times;
  std::vector<std::vector<double>> rows;
};

double duration_of(const MotionInput& source, const YamlNode& node) {
  if (!node.is_map()) return source.number(node.text, yaml_line(node), "time_from_start");
  const YamlNode *whole = node.find("sec", "secs"), *part = node.find("nanosec", "nsecs");
  if (!whole) source.refuse(yaml_line(node), "time_from_start has no seconds");
  return source.number(whole->text, yaml_line(*whole), "sec") +
         (part ? kNanosecond * source.number(part->text, yaml_line(*part), "nanosec") : 0);
}

void add_key(const MotionInput& source, size_t line, double time, std::vector<double> row,
             Trajectory& result) {
  if (!result.times.empty() && !(time > result.times.back()))
    source.refuse(line, "time " + text::brief(time) + " s does not come after " +
                            text::brief(result.times.back()) + " s; times must increase");
  if (row.size() != result.joints.size())
    source.refuse(line, "the point has " + text::counted(row.size(), "position") +
                            ", but there are " + text::counted(result.joints.size(), "joint") +
                            "; give one position for each joint");
  result.times.push_back(time);
  result.rows.push_back(std::move(row));
}

Trajectory trajectory_of(const MotionInput& source, const YamlNode& names, const YamlNode& points) {
  Trajectory result;
  result.joints = names_in(source, names);
  if (!points.is_list()) source.refuse(yaml_line(points), "`points` is not a list");
  for (const YamlNode& point : points.items) {
    const YamlNode *positions = point.find("positions"), *time = point.find("time_from_start");
    if (!positions || !time)
      source.refuse(yaml_line(point), "a point needs positions and time_from_start");
    if (!positions->items.empty())
      source.refuse(yaml_line(*positions), "the positions are not finite numbers");
    // These values are not used, but if they are wrong, the file is broken.
    for (const char* const key : {"velocities", "accelerations", "effort"}) {
      const YamlNode* const list = point.find(key);
      if (!list) continue;
      if (!list->items.empty())
        source.refuse(yaml_line(*list), "the " + std::string(key) + " are not finite numbers");
      if (!list->numbers.empty() && list->numbers.size() != result.joints.size())
        source.refuse(yaml_line(*list),
                      std::string(key) + " has " + text::counted(list->numbers.size(), "value") +
                          ", but there are " + text::counted(result.joints.size(), "joint") +
                          "; give one value for each joint");
    }
    add_key(source, yaml_line(point), duration_of(source, *time), positions->numbers, result);
  }
  if (result.times.empty())
    source.refuse(yaml_line(points), "the trajectory has no point; write the file again");
  return result;
}

// A motion of play_motion2, with lists of its positions and times.
Trajectory trajectory_of_lists(const MotionInput& source, const YamlNode& motion) {
  const YamlNode *names = motion.find("joints"), *positions = motion.find("positions"),
                 *times = motion.find("times_from_start");
  if (!names || !positions || !times)
    source.refuse(yaml_line(motion), "a motion needs joints, positions and times_from_start");
  Trajectory one;
  one.joints = names_in(source, *names);
  const size_t width = one.joints.size(), rows = times->numbers.size();
  if (!positions->items.empty())
    source.refuse(
        yaml_line(*positions),
        "the positions must be one list of finite numbers, but here they are rows, or some of them "
        "are not finite numbers. Join the rows to one list, or correct the numbers");
  if (!times->items.empty()) source.refuse(yaml_line(*times), "the times are not finite numbers");
  if (positions->numbers.size() != rows * width)
    source.refuse(yaml_line(*positions),
                  "the motion has " + text::counted(positions->numbers.size(), "position") +
                      ", but " + text::counted(width, "joint") + " at " +
                      text::counted(rows, "time") + " need " + std::to_string(rows * width));
  for (size_t k = 0; k < rows; ++k) {
    const auto begin = positions->numbers.begin() + static_cast<long>(k * width);
    add_key(source, yaml_line(*times), times->numbers[k],
            std::vector<double>(begin, begin + static_cast<long>(width)), one);
  }
  return one;
}

void find_trajectories(const MotionInput& source, const YamlNode& node,
                       std::vector<Trajectory>& found) {
  const YamlNode *names = node.find("joint_names"), *points = node.find("points");
  if (names && points) {
    found.push_back(trajectory_of(source, *names, *points));
    return;
  }
  for (const YamlNode& item : node.items) find_trajectories(source, item, found);
}

// The documents of a stream, which are separated by lines of three hyphens. Lines keep their
// numbers.
std::vector<std::string> documents_of(const std::string& text) {
  std::vector<std::string> documents(1);
  size_t lines = 0;
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find('\n', at), text.size() - 1) + 1;
    const std::string line = text.substr(at, end - at);
    if (line.starts_with("---")) {
      documents.emplace_back(lines + 1, '\n');
    } else {
      documents.back() += line;
    }
    ++lines;
    at = end;
  }
  std::erase_if(documents, [](const std::string& document) {
    return document.find_first_not_of(" \t\r\n") == std::string::npos;
  });
  return documents;
}

MotionFile joined(const MotionInput& source, std::vector<Trajectory> all) {
  // Joins the trajectories of the same joints, one after the other.
  std::vector<Trajectory> groups;
  MotionFile motion;
  for (Trajectory& one : all) {
    auto same = std::find_if(groups.begin(), groups.end(),
                             [&](const Trajectory& group) { return group.joints == one.joints; });
    if (same == groups.end()) {
      groups.push_back(std::move(one));
      continue;
    }
    const double end = same->times.back();
    for (size_t k = 0; k < one.times.size(); ++k) {
      if (!(one.times[k] > 0)) continue;  // the previous trajectory has ended before this time
      same->times.push_back(end + one.times[k]);
      same->rows.push_back(std::move(one.rows[k]));
    }
  }
  if (all.size() > 1)
    motion.notes.push_back(text::counted(all.size(), "trajectory", "trajectories") +
                           "; trajectories of the same joints are played one after the other");
  size_t width = 0;
  for (const Trajectory& group : groups) {
    motion.times.insert(motion.times.end(), group.times.begin(), group.times.end());
    for (const std::string& joint : group.joints) {
      if (std::find(motion.joints.begin(), motion.joints.end(), joint) != motion.joints.end())
        source.refuse(0, "two trajectories of different groups move the joint '" + joint + "'");
      motion.joints.push_back(joint);
    }
    width += group.joints.size();
  }
  std::sort(motion.times.begin(), motion.times.end());
  motion.times.erase(std::unique(motion.times.begin(), motion.times.end()), motion.times.end());
  motion.values.setConstant(static_cast<Eigen::Index>(motion.times.size()),
                            static_cast<Eigen::Index>(width),
                            std::numeric_limits<double>::quiet_NaN());
  Eigen::Index first = 0;
  for (const Trajectory& group : groups) {
    for (size_t k = 0; k < group.times.size(); ++k) {
      const auto at = std::lower_bound(motion.times.begin(), motion.times.end(), group.times[k]) -
                      motion.times.begin();
      for (size_t j = 0; j < group.joints.size(); ++j)
        motion.values(at, first + static_cast<Eigen::Index>(j)) = group.rows[k][j];
    }
    first += static_cast<Eigen::Index>(group.joints.size());
  }
  motion.notes.push_back("units: seconds, radians and metres, as the format defines them");
  return motion;
}

template <typename Values>
std::string numbers_text(const Values& values) {
  std::vector<std::string> words;
  for (const double value : values) words.push_back(text::exact(value));
  return "[" + text::join(words, ", ") + "]";
}

const YamlNode* motions_of(const YamlNode& root) {
  if (const YamlNode* motions = root.find("motions")) return motions;
  for (const YamlNode& item : root.items)
    if (const YamlNode* motions = motions_of(item)) return motions;
  return nullptr;
}

}  // namespace

std::string recognize_ros_trajectory(const MotionInput& source) {
  const bool names = source.bytes.find("joint_names:") != std::string::npos ||
                     source.bytes.find("\"joint_names\"") != std::string::npos;  // YAML as JSON
  return names && source.bytes.find("time_from_start") != std::string::npos
             ? "the file has joint_names and points with time_from_start"
             : "";
}

MotionFile read_ros_trajectory(const MotionInput& source) {
  std::vector<Trajectory> found;
  for (const std::string& document : documents_of(source.bytes))
    find_trajectories(source, parse_yaml(document, source.file), found);
  if (found.empty())
    source.refuse(0, "the file has no trajectory with joint_names and points; add one");
  return joined(source, std::move(found));
}

std::vector<WrittenFile> write_ros_trajectory(const RobotModel&, const MotionFile& motion) {
  std::string text = "header:\n  stamp: {sec: 0, nanosec: 0}\n  frame_id: \"\"\njoint_names: [" +
                     text::join(motion.joints, ", ") + "]\npoints:\n";
  const Eigen::Index rows = motion.rows();
  for (Eigen::Index k = 0; k < rows; ++k) {
    const double time = motion.times[static_cast<size_t>(k)];
    const auto whole = static_cast<long>(std::floor(time));
    auto part = std::lround((time - static_cast<double>(whole)) / kNanosecond);
    const bool carry = part == 1'000'000'000;
    text += "  - positions: " + numbers_text(motion.values.row(k)) + "\n";
    // Controllers of ROS want the last speed to be zero.
    const Eigen::Index a = std::max<Eigen::Index>(k - 1, 0), b = std::min(k + 1, rows - 1);
    const Eigen::RowVectorXd speed =
        k + 1 == rows || a == b ? Eigen::RowVectorXd::Zero(motion.values.cols())
                                : Eigen::RowVectorXd((motion.values.row(b) - motion.values.row(a)) *
                                                     motion.rate / static_cast<double>(b - a));
    text += "    velocities: " + numbers_text(speed) + "\n";
    text += "    time_from_start: {sec: " + std::to_string(whole + (carry ? 1 : 0)) +
            ", nanosec: " + std::to_string(carry ? 0 : part) + "}\n";
  }
  return {{"", text}};
}

std::string recognize_play_motion(const MotionInput& source) {
  const auto has = [&](const char* word) { return source.bytes.find(word) != std::string::npos; };
  if (!has("motions:")) return "";
  if (has("times_from_start")) return "the file has motions with times_from_start";
  return has("joints:") && has("time_from_start") ? "the file has motions with points" : "";
}

MotionFile read_play_motion(const MotionInput& source) {
  const YamlNode root = parse_yaml(source.bytes, source.file);
  const YamlNode* motions = motions_of(root);
  if (!motions || !motions->is_map() || motions->items.empty())
    source.refuse(yaml_line(root), "the list of motions is empty; add a motion");
  MotionFile about;
  const YamlNode& first = motions->items[source.chosen_motion(motions->keys, {}, about)];
  // In ROS 1, a motion is a list of points.
  const YamlNode *names = first.find("joints"), *points = first.find("points");
  if (points && !names) source.refuse(yaml_line(first), "a motion with points needs joints");
  Trajectory one =
      points ? trajectory_of(source, *names, *points) : trajectory_of_lists(source, first);
  if (one.times.empty())
    source.refuse(yaml_line(first), "the motion has no posture; write the file again");
  MotionFile motion = joined(source, {std::move(one)});
  motion.name = about.name;
  motion.chosen = about.chosen;
  motion.notes.insert(motion.notes.end(), about.notes.begin(), about.notes.end());
  return motion;
}

std::vector<WrittenFile> write_play_motion(const RobotModel&, const MotionFile& motion) {
  std::string name = motion.name.empty() ? "motion" : motion.name;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return !std::isalnum(c) && c != '_'; }, '_');
  std::string text = "/play_motion2:\n  ros__parameters:\n    motions:\n      " + name +
                     ":\n        joints: [" + text::join(motion.joints, ", ") +
                     "]\n        positions: [";
  for (Eigen::Index k = 0; k < motion.rows(); ++k) {
    std::string row = numbers_text(motion.values.row(k));
    text += (k > 0 ? ",\n          " : "\n          ") + row.substr(1, row.size() - 2);
  }
  text += "]\n        times_from_start: " + numbers_text(motion.times) + "\n";
  text += "        meta:\n          name: " + name +
          "\n          usage: demo\n          description: 'written by ayumi export'\n";
  return {{"", text}};
}

}  // namespace ayumi
