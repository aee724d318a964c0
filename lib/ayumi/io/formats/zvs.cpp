#include "ayumi/io/formats/zvs.hpp"

#include <filesystem>
#include <optional>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/robot/ztk.hpp"
#include "ayumi/io/table/comma_cells.hpp"
#include "ayumi/math/rotation.hpp"

namespace ayumi {

namespace {

constexpr size_t kRootValues = 6;

std::vector<std::string_view> tokens_of(std::string_view line) {
  std::vector<std::string_view> tokens;
  constexpr std::string_view between = " \t(),{}[]";
  while (true) {
    const size_t begin = line.find_first_not_of(between);
    if (begin == std::string_view::npos) return tokens;
    line.remove_prefix(begin);
    const size_t end = std::min(line.find_first_of(between), line.size());
    tokens.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
}

// The moving joints of the robot whose file is beside the motion, in the order of their values. If
// there is such a robot but it cannot be read or its joints do not fit, `notes` says why.
std::vector<std::string> joints_beside(const MotionInput& source, size_t width,
                                       std::vector<std::string>& notes) {
  const std::optional<std::string> bytes = source.beside(".ztk");
  if (!bytes) return {};
  const std::filesystem::path file = std::filesystem::path(source.file).replace_extension(".ztk");
  try {
    std::vector<std::string> joints = parse_ztk(*bytes, file).joint_order;
    if (width == joints.size() || width == joints.size() + kRootValues) {
      notes.push_back("the names of the joints come from the robot file " +
                      file.filename().string() + " in the folder of the motion");
      return joints;
    }
    notes.push_back("the robot file " + file.filename().string() +
                    " in the folder of the motion is not used, because it has " +
                    text::counted(joints.size(), "joint") + ", but a row has " +
                    text::counted(width, "value"));
  } catch (const Error& error) {
    notes.push_back(
        "the robot file in the folder of the motion is not used, because of an error: " +
        std::string(error.what()));
  }
  return {};
}

}  // namespace

std::string recognize_zvs(const MotionInput& source) {
  std::string_view rest = source.bytes;
  std::string_view line;
  while ((line.empty() || is_comment(line)) && !rest.empty()) line = take_line(rest);
  const size_t open = line.find('(');
  if (open == std::string_view::npos ||
      line.find_first_not_of("0123456789.eE+-/ \t(), \r") != std::string_view::npos)
    return "";
  return tokens_of(line.substr(0, open)).size() == 2 ? "the rows have the form `dt n ( values )`"
                                                     : "";
}

MotionFile read_zvs(const MotionInput& source) {
  std::string_view rest = source.bytes;
  std::vector<double> cells;
  MotionFile motion;
  size_t width = 0;
  double now = 0;
  for (size_t next = 1; !rest.empty();) {
    const size_t line = next++;
    std::string_view text = take_line(rest);
    if (text.empty() || is_comment(text)) continue;
    std::vector<std::string_view> tokens = tokens_of(text);
    // The values may go over several lines, up to the closing bracket.
    for (bool open = text.find('(') != std::string_view::npos;
         open && text.find(')') == std::string_view::npos;) {
      const bool end = rest.empty();
      ++next;
      text = take_line(rest);
      if (end || text.find('(') != std::string_view::npos)
        source.refuse(line, "the bracket ( is not closed, so the row was cut; copy the file again");
      if (is_comment(text)) continue;
      const std::vector<std::string_view> more = tokens_of(text);
      tokens.insert(tokens.end(), more.begin(), more.end());
    }
    if (tokens.size() < 3) source.refuse(line, "the row must have the form `dt n ( values )`");
    const double dt = source.number(tokens[0], line, "dt");
    const double count =
        source.number(tokens[1].substr(0, tokens[1].find('/')), line, "number of values");
    if (count != static_cast<double>(tokens.size() - 2))
      source.refuse(line, "the row has " + text::counted(tokens.size() - 2, "value") +
                              " between the brackets, but its number of values, n, is " +
                              text::brief(count));
    if (width > 0 && tokens.size() - 2 != width)
      source.refuse(line, "the row has " + text::counted(tokens.size() - 2, "value") +
                              ", but the first row has " + std::to_string(width));
    width = tokens.size() - 2;
    if (!(dt > 0))
      source.refuse(line,
                    "dt " + text::brief(dt) + " s is not possible; the step must be above 0 s");
    motion.times.push_back(now);
    now += dt;
    for (size_t i = 2; i < tokens.size(); ++i)
      cells.push_back(source.number(tokens[i], line, "value " + std::to_string(i - 1)));
  }
  if (motion.times.empty())
    source.refuse(0, "the file has no row, so there is no motion to read; write the file again");
  Eigen::MatrixXd all = Eigen::Map<Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(
      cells.data(), static_cast<Eigen::Index>(motion.times.size()),
      static_cast<Eigen::Index>(width));
  motion.notes.push_back("units: seconds, radians and metres, as the format defines them");
  motion.joints = joints_beside(source, width, motion.notes);
  const size_t joints =
      motion.joints.empty() ? static_cast<size_t>(source.model.dof_count()) : motion.joints.size();
  if (width == joints + kRootValues) {
    for (Eigen::Index k = 0; k < all.rows(); ++k)
      motion.base.push_back(
          {all.row(k).head<3>().transpose(), exp_rotation(all.row(k).segment<3>(3).transpose())});
    all = all.rightCols(static_cast<Eigen::Index>(joints)).eval();
    motion.notes.push_back(
        "the first 6 values of a row are read as the position and the rotation vector of the root, "
        "because the robot has " +
        text::counted(joints, "joint"));
  }
  motion.values = std::move(all);
  return motion;
}

std::vector<WrittenFile> write_zvs(const RobotModel& model, const MotionFile& motion) {
  std::string text;
  const size_t rows = motion.times.size();
  const auto width = static_cast<size_t>(motion.values.cols()) + kRootValues;
  for (size_t k = 0; k < rows; ++k) {
    const double dt = 1 / motion.rate;
    text += text::exact(dt) + " " + std::to_string(width) + " (";
    const BasePose& base = motion.base[k];
    const Eigen::Vector3d turn = log_rotation(base.attitude).unaryExpr(&repeatable);
    for (const double value : base.position) text += " " + text::exact(value);
    for (const double value : turn) text += " " + text::exact(value);
    for (const double value : motion.values.row(static_cast<Eigen::Index>(k)))
      text += " " + text::exact(value);
    text += " )\n";
  }
  // RoKi applies the motion to the robot beside it, whose links have the same order.
  return {{"", text}, {".ztk", ztk_text(model.description(), model.dof_names())}};
}

}  // namespace ayumi
