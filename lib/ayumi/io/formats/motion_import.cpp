// This file makes evenly spaced postures of a robot from the content of a motion file.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/base/utf8.hpp"
#include "ayumi/io/degrees.hpp"
#include "ayumi/io/formats/motion_formats.hpp"
#include "ayumi/math/smoothing.hpp"
#include "ayumi/model/encoder_angles.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/motion/servo_feedforward.hpp"

namespace ayumi {

namespace {

/// Largest number of rows of a file and of a motion. Chosen: a motion of this length with 60
/// columns takes 200 MB.
constexpr size_t kMostRows = 400'000;

/// The rows of a motion: every quantity is a column, so that all are treated alike.
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

std::string shortened(const std::vector<std::string>& names) {
  constexpr size_t kMost = 40;  // largest number of names. Chosen: a line that a person still reads
  return text::join_first(names, kMost);
}

// The text as the readers take it: it has no byte order mark, and its lines end with a line feed.
std::string plain_text(const std::string& bytes) {
  std::string text = bytes.starts_with("\xEF\xBB\xBF") ? bytes.substr(3) : bytes;
  if (text.find('\n') == std::string::npos) std::replace(text.begin(), text.end(), '\r', '\n');
  return text;
}

size_t line_at(const std::string& bytes, size_t at) {
  const auto end = bytes.begin() + static_cast<std::ptrdiff_t>(std::min(at, bytes.size()));
  const auto line_feeds = std::count(bytes.begin(), end, '\n');
  return static_cast<size_t>(line_feeds > 0 ? line_feeds : std::count(bytes.begin(), end, '\r')) +
         1;
}

void refuse_other_encodings(const MotionInput& source) {
  const std::string& text = source.bytes;
  const size_t at = text::not_utf8_at(text);
  if (at == std::string::npos) return;
  char byte[8];
  std::snprintf(byte, sizeof byte, "0x%02x", static_cast<unsigned char>(text[at]));
  source.refuse(
      line_at(text, at),
      "the byte " + std::string(byte) +
          " is not UTF-8 text. The file may have another encoding, such as Latin-1 or Shift-JIS; "
          "save the file as UTF-8");
}

// ---- checks of the size, before a reader takes memory for it

/// Largest number of values in one row, and of characters in one value. Chosen: no robot comes near
/// to them. In tables whose rows are joints, a row may have as many values as there may be rows.
constexpr size_t kMostInRow = kMostRows, kLongestValue = 100'000;
/// Largest number of lists of numbers, and of elements, in a text that does not have one row in
/// each line. Chosen: 500 s of 20 joints at 50 rows per second in the format with the most lists
/// (one for each joint). A parser takes about 0.4 kB and 1 us for each.
constexpr size_t kMostLists = 500'000;
/// Largest depth of elements inside each other. Chosen: motions need five; parsers descend by
/// recursion.
constexpr int kDeepestElement = 200;

void refuse_too_many(const MotionInput& source, const std::string& text) {
  const size_t lines = static_cast<size_t>(std::count(text.begin(), text.end(), '\n'));
  if (lines > kMostRows)
    source.refuse(0, "the file has " + std::to_string(lines) + " lines, but import reads at most " +
                         std::to_string(kMostRows) +
                         " rows; cut the file into parts, or leave out rows");
  const bool xml = text.find_first_not_of(" \t\r\n") == text.find('<');
  size_t values = 0, lists = 0, begin = 0;
  int depth = 0;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n' || c == '[' || c == '{' || c == '<') values = 0;
    if (c == '[' || c == '{' || c == '<') ++lists;
    if (xml && c == '<' && i + 1 < text.size())
      depth += text[i + 1] == '/' ? -1 : text[i + 1] == '?' || text[i + 1] == '!' ? 0 : 1;
    if (xml && c == '>' && i > 0 && text[i - 1] == '/') --depth;
    if (std::isspace(static_cast<unsigned char>(c)) || std::strchr(",;[]{}<>%\"", c)) {
      values += c == ',' || c == ';' || c == '\t' || c == ' ' || c == '%';
      begin = i;
    }
    const auto refuse = [&](const std::string& what, size_t most) {
      source.refuse(line_at(text, i), "there are more than " + std::to_string(most) + " " + what +
                                          "; cut the file into parts, or leave out rows");
    };
    if (lists > kMostLists)
      refuse("lists or elements, which are too many for a motion", kMostLists);
    if (values > kMostInRow) refuse("values in one row", kMostInRow);
    if (depth > kDeepestElement) refuse("elements inside each other", kDeepestElement);
    if (i - begin > kLongestValue) refuse("characters in one value", kLongestValue);
  }
}

// Whether the numbers of a text have decimal commas, whatever else the text contains.
bool has_decimal_commas(const std::string& text) {
  size_t points = 0, commas = 0;
  for (size_t i = 1; i + 1 < text.size(); ++i) {
    if (text[i] != '.' && text[i] != ',') continue;
    const bool inside = std::isdigit(static_cast<unsigned char>(text[i - 1])) &&
                        std::isdigit(static_cast<unsigned char>(text[i + 1]));
    (text[i] == '.' ? points : commas) += inside;
  }
  // For each fifty commas, one point between digits may belong to a version or a name. Chosen.
  return commas > 2 && points * 50 < commas;
}

// The end of every message about a motion's content. It names the remedy that the content suggests,
// unless the message has named one, and says how the format was recognized; `format` is null if it
// was not.
std::string remedy(const MotionFormat* format, const ImportedMotion& motion,
                   const std::string& bytes, bool named) {
  std::string words;
  const bool text = !format || !format->binary;
  const bool open = !bytes.empty() && std::strchr("\r\n}])>", bytes.back()) == nullptr;
  const bool counts = format && format->name == "hoap";  // whole numbers between commas
  if (format && text && !named && open) words += "; the file may be truncated";
  if (text && !named && !counts && has_decimal_commas(bytes))
    words += "; if the commas are decimal commas, write decimal points";
  if (!format) return words;
  words += ". Ayumi read the file in the format '" + format->name + "' (" + format->words + ")";
  if (!motion.reason.empty()) words += ", because " + motion.reason;
  return words;
}

// A text that was cut off may end within a number, and only this end can show it.
bool may_be_cut(const std::string& text) {
  const auto last = static_cast<unsigned char>(text.back());
  return std::isdigit(last) || last == '.' || last == '-';
}

// Recognizes the format of the file. Afterwards, `source` has the content in the form that readers
// take, and `result` has the name of the format and the reason.
const MotionFormat& format_of(const std::string& bytes, MotionInput& source,
                              ImportedMotion& result) {
  const ImportOptions& options = source.options;
  if (options.rate != 0) require_within("the rate of the rows", options.rate, ImportOptions::kRate);
  if (options.smooth)
    require_within("the largest change by smoothing", *options.smooth, ImportOptions::kSmooth);
  if (const std::string refusal = text::wide_encoding_refusal(bytes); !refusal.empty())
    source.refuse(1, refusal);
  const MotionFormat* format = nullptr;
  const bool text = bytes.find('\0') == std::string::npos;
  if (text) refuse_too_many(source, bytes);
  source.bytes = text ? plain_text(bytes) : bytes;
  if (options.format.empty()) {
    const Recognized recognized = recognize(source);
    format = recognized.format;
    result.reason = recognized.reason;
  } else {
    format = find_motion_format(options.format);
    if (!format || !(format->read || format->read_keys))
      fail(ErrorCode::usage, "--format " + options.format + " cannot be read; import reads " +
                                 text::join(read_format_names(), ", "));
  }
  result.format = format->name;
  if (!format->binary && !text) {
    const size_t at = bytes.find('\0');
    source.refuse(line_at(bytes, at), "this is a binary file, but text is needed");
  }
  if (!format->binary) refuse_other_encodings(source);
  return *format;
}

MotionFile read_file_of(const std::string& bytes, const std::string& file, const RobotModel& model,
                        const ImportOptions& options, ImportedMotion& result) {
  MotionInput source{{}, file, model, options};
  const MotionFormat* const format = &format_of(bytes, source, result);
  if (!format->read)
    source.refuse(0,
                  "this file contains key poses, not rows of joint angles; `ayumi import` makes a "
                  "pattern from it");
  MotionFile motion = format->read(source);
  if (format->name == "hoap" && !motion.sequence.empty()) motion.sequence = bytes;
  if (static_cast<size_t>(motion.rows()) > kMostRows)
    source.refuse(0, "the file has " + std::to_string(motion.rows()) +
                         " rows, but import reads at most " + std::to_string(kMostRows) +
                         "; cut the file into parts, or leave out rows");
  if (!options.motion.empty() && !motion.chosen)
    motion.notes.push_back("--motion is not used, because the file has one motion");
  if (!format->binary && may_be_cut(source.bytes))
    motion.notes.push_back(
        "the last line of the file has no line end. If the file is truncated, the last value may "
        "be "
        "wrong");
  return motion;
}

// ---- joints

std::vector<std::string> column_names(const MotionFile& motion, const RobotModel& model,
                                      const ImportOptions& options, const std::string& file,
                                      std::vector<std::string>& notes) {
  const auto columns = static_cast<size_t>(motion.values.cols());
  const std::string count = text::counted(columns, "joint column");
  if (!options.joints.empty()) {
    if (options.joints.size() != columns)
      fail(ErrorCode::bad_file, {file},
           "the file has " + count + ", but --joints has " +
               text::counted(options.joints.size(), "name") + "; give one name for each column");
    return options.joints;
  }
  const std::vector<std::string> own = model.dof_names();
  if (options.by_order) {
    if (own.size() != columns)
      fail(ErrorCode::bad_file, {file},
           "the file has " + count + ", but '" + model.name() + "' has " +
               text::counted(own.size(), "joint") + "; name the columns with --joints A,B,...");
    notes.push_back("the columns are the joints in the order of the robot, as --order says: " +
                    shortened(own));
    return own;
  }
  if (motion.joints.empty())
    fail(ErrorCode::bad_file, {file},
         "the file has " + count + " without names" +
             (own.size() == columns
                  ? "; give --order if the columns are the " + text::counted(own.size(), "joint") +
                        " of '" + model.name() + "' in the order of the robot (" + own.front() +
                        ", ..., " + own.back() + "), or name the columns with --joints A,B,..."
                  : ", but '" + model.name() + "' has " + text::counted(own.size(), "joint") +
                        ", so this may be a motion of another robot. If it is a motion of this "
                        "robot, name the columns with --joints A,B,..."));
  return motion.joints;
}

/// A column is in degrees if a joint with limits has an angle of at least this [rad]. Chosen: more
/// than one and a half turns, which no joint with limits makes.
constexpr double kNoAngle = 10;

void refuse_degrees(const MotionFile& motion, Eigen::Index column, const std::string& name,
                    const Dof& dof, bool degrees, const std::string& file) {
  if (dof.prismatic || !dof.limited || degrees) return;
  double most = 0;
  for (const double value : motion.values.col(column))
    if (std::abs(value) > most) most = std::abs(value);
  if (most > kNoAngle)
    fail(ErrorCode::bad_file, {file},
         "column '" + name + "' reaches " + text::brief(most) +
             " rad, but no joint with limits can turn so far; " +
             (motion.unit != MotionFile::Unit::of_format
                  ? "give --unit deg if the angles are in degrees"
                  : "the angles of this format are in radians, so correct the file"));
}

/// Largest distance of a motion from the origin of its world [m], and largest ground force as a
/// multiple of the robot's weight. Chosen: far beyond any recording; a number with a digit too many
/// or a damaged number exceeds them.
constexpr double kFarthest = 10000, kMostWeights = 1000;

void refuse_absurd(const MotionFile& motion, const RobotModel& model, const std::string& file) {
  const auto refuse = [&](size_t row, const std::string& what) {
    fail(ErrorCode::bad_file, {file},
         "row " + std::to_string(row + 1) + ": " + what + "; correct the file");
  };
  const auto check = [&](size_t row, const char* name, const Eigen::Vector3d& place) {
    double most = 0;  // NaN: not set in this row
    for (const double x : place)
      if (std::abs(x) > most) most = std::abs(x);
    if (most > kFarthest)
      refuse(row, std::string("a coordinate of the ") + name + " is " + text::brief(most) +
                      " m, but at most " + text::brief(kFarthest / 1000) + " km are possible");
  };
  for (size_t k = 0; k < motion.base.size(); ++k) check(k, "root", motion.base[k].position);
  for (size_t k = 0; k < motion.cog.size(); ++k) check(k, "COG", motion.cog[k]);
  for (size_t k = 0; k < motion.zmp.size(); ++k) check(k, "ZMP", motion.zmp[k]);
  const double most = kMostWeights * model.mass() * kGravity;
  for (size_t k = 0; k < motion.fz.size(); ++k)
    if (most > 0 && std::abs(motion.fz[k]) > most)
      refuse(k, "the vertical force is " + text::brief(motion.fz[k]) + " N, but at most " +
                    text::brief(kMostWeights) + " times the weight are possible");
}

bool is_joint_of(const RobotModel& model, const std::string& name) {
  const auto& joints = model.description().joints;
  return std::any_of(joints.begin(), joints.end(),
                     [&](const JointDescription& joint) { return joint.name == name; });
}

// The columns of the robot's joints in its order; -1 for those that the file does not have.
std::vector<int> map_joints(const MotionFile& motion, const RobotModel& model,
                            const ImportOptions& options, const std::string& file,
                            std::vector<std::string>& notes) {
  const std::vector<std::string> names = column_names(motion, model, options, file, notes);
  std::vector<int> columns(static_cast<size_t>(model.dof_count()), -1);
  std::vector<std::string> matched, unknown, extra, missing;
  for (size_t i = 0; i < names.size(); ++i) {
    const int dof = find_joint(model, names[i]);
    if (dof < 0) {
      (is_joint_of(model, names[i]) ? extra : unknown).push_back(names[i]);
      continue;
    }
    int& column = columns[static_cast<size_t>(dof)];
    if (column >= 0)
      fail(ErrorCode::bad_file, {file},
           "the columns '" + names[static_cast<size_t>(column)] + "' and '" + names[i] +
               "' are the same joint; remove one of them");
    const auto at = static_cast<Eigen::Index>(i);
    if (motion.values.col(at).array().isNaN().all()) continue;  // the joint is never set
    column = static_cast<int>(i);
    matched.push_back(names[i]);
    refuse_degrees(motion, at, names[i], model.dofs()[static_cast<size_t>(dof)],
                   options.degrees && motion.unit == MotionFile::Unit::assumed, file);
  }
  const std::string robot = "'" + model.name() + "'";
  if (unknown.size() > matched.size())
    fail(ErrorCode::bad_file, {file},
         "this is a motion of another robot: " +
             (matched.empty() ? "its joints " + shortened(unknown) + " are not joints of " + robot
                              : "of its " + text::counted(names.size(), "joint") + " only " +
                                    shortened(matched) + " are joints of " + robot + ", and " +
                                    shortened(unknown) + " are not") +
             ". The joints of " + robot + " are " + shortened(model.dof_names()) +
             ". If this is a motion of " + robot +
             ", add the names of the file to \"aliases\" in the sidecar, or name the columns with "
             "--joints A,B,...");
  for (int dof = 0; dof < model.dof_count(); ++dof)
    if (columns[static_cast<size_t>(dof)] < 0)
      missing.push_back(model.dofs()[static_cast<size_t>(dof)].name);
  if (!unknown.empty())
    notes.push_back("unknown joints are left out: " + shortened(unknown) +
                    (unknown.size() == 1 ? text::suggestion(unknown[0], missing) : ""));
  if (!extra.empty())
    notes.push_back(
        "these joints are left out, because they do not move independently on this robot: " +
        shortened(extra));
  if (!missing.empty())
    notes.push_back(
        "these joints are missing in the file and keep the angles of the home posture: " +
        shortened(missing));
  return columns;
}

// ---- rows

// The columns: theta of the robot, and then the other quantities of the motion. NaN means that a
// value is not set. `zeros` are added to the columns of the file, by dof.
Rows rows_of(const MotionFile& motion, const std::vector<int>& columns, const RobotModel& model,
             bool degrees, const Eigen::VectorXd& zeros) {
  const Eigen::Index rows = motion.rows(), dofs = model.dof_count();
  Rows all(rows, dofs + (motion.base.empty() ? 0 : 7) + (motion.cog.empty() ? 0 : 3) +
                     (motion.zmp.empty() ? 0 : 3) + (motion.fz.empty() ? 0 : 1));
  const Eigen::VectorXd home = model.posture();
  for (Eigen::Index dof = 0; dof < dofs; ++dof) {
    const int column = columns[static_cast<size_t>(dof)];
    if (column < 0)
      all.col(dof).setConstant(home[dof]);
    else
      all.col(dof) = motion.values.col(column);
    if (degrees && column >= 0 && !model.dofs()[static_cast<size_t>(dof)].prismatic)
      all.col(dof) *= kRadiansPerDegree;
    if (column >= 0 && zeros[dof] != 0) all.col(dof).array() += zeros[dof];
  }
  for (Eigen::Index k = 0; k < rows; ++k) {
    const auto at = static_cast<size_t>(k);
    Eigen::Index c = dofs;
    if (!motion.base.empty()) {
      Eigen::Quaterniond q = motion.base[at].attitude;
      // Where rows are interpolated, the quaternion must not change its sign from row to row.
      if (k > 0 &&
          all.row(k - 1).segment<4>(c + 3).dot(Eigen::RowVector4d(q.w(), q.x(), q.y(), q.z())) < 0)
        q.coeffs() *= -1;
      all.row(k).segment<3>(c) = motion.base[at].position.transpose();
      all.row(k).segment<4>(c + 3) << q.w(), q.x(), q.y(), q.z();
      c += 7;
    }
    if (!motion.cog.empty()) all.row(k).segment<3>(c) = motion.cog[at].transpose(), c += 3;
    if (!motion.zmp.empty()) all.row(k).segment<3>(c) = motion.zmp[at].transpose(), c += 3;
    if (!motion.fz.empty()) all(k, c) = motion.fz[at];
  }
  return all;
}

/// Fills one column between the rows in which it is set.
class SetColumn {
 public:
  SetColumn(const std::vector<double>& times, const Eigen::VectorXd& values, bool smooth) {
    for (Eigen::Index k = 0; k < values.size(); ++k)
      if (!std::isnan(values[k])) {
        t_.push_back(times[static_cast<size_t>(k)]);
        x_.push_back(values[k]);
      }
    slope_.assign(t_.size(), 0);
    // Monotone cubics (Fritsch and Carlson 1980, with the harmonic mean of Fritsch and Butland
    // 1984). They do not overshoot the keys, and are at rest at the first and the last key.
    for (size_t i = 1; smooth && i + 1 < t_.size(); ++i) {
      const double h0 = t_[i] - t_[i - 1], h1 = t_[i + 1] - t_[i];
      const double d0 = (x_[i] - x_[i - 1]) / h0, d1 = (x_[i + 1] - x_[i]) / h1;
      if (d0 * d1 > 0) slope_[i] = 3 * (h0 + h1) / ((2 * h1 + h0) / d0 + (h1 + 2 * h0) / d1);
    }
    smooth_ = smooth;
  }

  double at(double t) {
    while (i_ + 2 < t_.size() && t_[i_ + 1] <= t) ++i_;
    if (t_.size() < 2 || t <= t_.front()) return x_.front();
    if (t >= t_.back()) return x_.back();
    const double h = t_[i_ + 1] - t_[i_], u = (t - t_[i_]) / h;
    if (!smooth_ || u == 0) return (1 - u) * x_[i_] + u * x_[i_ + 1];
    const double v = 1 - u;
    return v * v * (1 + 2 * u) * x_[i_] + u * u * (3 - 2 * u) * x_[i_ + 1] +
           h * u * v * (v * slope_[i_] - u * slope_[i_ + 1]);
  }

 private:
  std::vector<double> t_, x_, slope_;
  size_t i_ = 0;
  bool smooth_ = false;
};

Rows interpolated(const std::vector<double>& times, const Rows& rows, double dt, Eigen::Index count,
                  bool smooth) {
  Rows result(count, rows.cols());
  for (Eigen::Index c = 0; c < rows.cols(); ++c) {
    SetColumn column(times, rows.col(c), smooth);
    for (Eigen::Index k = 0; k < count; ++k) result(k, c) = column.at(static_cast<double>(k) * dt);
  }
  return result;
}

double near_whole_rate(double dt) {
  const double rate = std::round(1 / dt);
  return rate > 0 && std::abs(1 / dt - rate) < 1e-3 * rate ? 1 / rate : dt;
}

struct Spacing {
  double dt = 0;
  bool even = false;
};

// The median step, or the mean step if the format rounds its times.
Spacing spacing_of(const std::vector<double>& times, double time_step) {
  std::vector<double> steps;
  for (size_t k = 1; k < times.size(); ++k) steps.push_back(times[k] - times[k - 1]);
  std::nth_element(steps.begin(), steps.begin() + static_cast<long>(steps.size() / 2), steps.end());
  const double median = near_whole_rate(steps[steps.size() / 2]);
  const double mean = near_whole_rate(times.back() / static_cast<double>(times.size() - 1));
  for (const double dt : {median, mean}) {
    const double tolerance = std::max(1e-3 * dt, time_step > 0 ? 0.51 * time_step : 0);
    bool even = true;
    for (size_t k = 0; even && k < times.size(); ++k)
      even = std::abs(times[k] - static_cast<double>(k) * dt) < tolerance;
    if (even) return {dt, true};
  }
  return {median, false};
}

/// If the step is at least this long, the rows are key postures [s]. Chosen: recordings have at
/// least 20 rows per second, and players do not hold a posture for longer.
constexpr double kKeyStep = 0.06;
/// Step of the rows between key postures [s]. Chosen: half of the interval of hobby servos (20 ms);
/// for action files it is the unit of their times, so that their keys are rows.
constexpr double kKeyTick = 0.01, kActionTick = 0.008;
/// Shortest usual step between rows [s], and the longest between key postures and between other
/// rows. Chosen: no servo has a shorter tick, a robot that holds a posture for a minute has ended
/// its motion, and a recording with a longer gap shows nothing of what the robot did in it. A slip,
/// such as milliseconds that are taken for seconds or a clock that was set, exceeds them.
constexpr double kShortestStep = 1 / ImportOptions::kRate.most, kLongestKeyStep = 60,
                 kLongestGap = 10;

[[noreturn]] void refuse_step(const std::string& what, double longest, const std::string& remedy,
                              const std::string& file) {
  fail(ErrorCode::bad_file, {file},
       what + ", but the time between two rows must be from " + text::brief(1000 * kShortestStep) +
           " ms to " + text::brief(longest) + " s; " + remedy);
}

void require_rate(double rate, const std::string& file) {
  const double step = 1 / rate;
  if (!(step >= kShortestStep && step <= kLongestKeyStep))
    refuse_step("the file states " + text::brief(rate) + " rows per second", kLongestKeyStep,
                "correct the rate in the file", file);
}

/// `usual` is the step between most rows. Two rows may be nearer to each other.
void require_steps(const std::vector<double>& times, double usual, double longest,
                   const std::string& format, const std::string& file) {
  // Tolerance of the shortest step, as a share of it. Derived: times of a few hours in seconds with
  // seven decimals.
  constexpr double kRounding = 0.01;
  if (usual < kShortestStep * (1 - kRounding))
    refuse_step("the rows are " + text::brief(1000 * usual) + " ms apart", longest,
                "correct the times", file);
  for (size_t k = 1; k < times.size(); ++k)
    if (const double step = times[k] - times[k - 1]; !(step <= longest))
      refuse_step(
          "data row " + std::to_string(k + 1) + " comes " + text::brief(step) +
              " s after the row before",
          longest,
          std::string("correct the times, or cut the file where rows are missing") +
              (format == "csv" ? ". If the times are in milliseconds, name their column t[ms]"
                               : ""),
          file);
}

std::vector<double> times_of(const MotionFile& motion, const ImportOptions& options,
                             const std::string& file, std::vector<std::string>& notes) {
  std::vector<double> times = motion.times;
  const auto rows = static_cast<size_t>(motion.rows());
  if (rows < 2)
    fail(ErrorCode::bad_file, {file}, "the table has only one row; a motion needs more");
  if (times.empty()) {
    if (motion.rate > 0 && options.rate > 0 && motion.file_rows == 0)
      notes.push_back("--rate is not used, because the file states its rate, " +
                      text::brief(motion.rate) + " rows per second");
    if (motion.rate != 0) require_rate(motion.rate, file);
    const double rate = motion.rate > 0 ? motion.rate : options.rate;
    if (!(rate > 0))
      fail(ErrorCode::bad_file, {file},
           "this format does not state the number of rows per second. Give --rate HZ, for example "
           "30 for the LAFAN1 motions of the Unitree G1. With twice the true rate, all speeds "
           "would be twice as large as the true ones, and all accelerations four times as large");
    for (size_t k = 0; k < rows; ++k) times.push_back(static_cast<double>(k) / rate);
    return times;
  }
  if (options.rate > 0)
    notes.push_back("--rate is not used, because the file states the times of its rows");
  if (times[0] != 0)
    notes.push_back("the pattern begins at the first row. The file gives this row the time " +
                    text::brief(times[0]) + " s");
  for (size_t k = 1; k < rows; ++k)
    if (!(times[k] > times[k - 1]))
      fail(ErrorCode::bad_file, {file},
           "data row " + std::to_string(k + 1) + ": time " + text::brief(times[k]) +
               " s does not come after " + text::brief(times[k - 1]) +
               " s of the row before; times must increase");
  const double first = times[0];
  for (double& time : times) time -= first;
  return times;
}

Rows even_rows(const MotionFile& motion, const Rows& rows, const ImportOptions& options,
               const std::string& file, const std::string& format, double& dt,
               std::vector<std::string>& notes) {
  const double tick = format == "op3-action" ? kActionTick : kKeyTick;
  const std::vector<double> times = times_of(motion, options, file, notes);
  const Spacing spacing = spacing_of(times, motion.time_step);
  const bool keys = (motion.keys && !spacing.even) || spacing.dt > kKeyStep;
  const bool unset = rows.array().isNaN().any();
  dt = keys ? tick : spacing.dt;
  require_steps(times, spacing.dt, keys ? kLongestKeyStep : kLongestGap, format, file);
  const double last = times.back() / dt;
  if (last > static_cast<double>(kMostRows))
    fail(
        ErrorCode::bad_file, {file},
        "the motion lasts " + text::brief(times.back()) + " s. With one row every " +
            text::brief(1000 * dt) + " ms it has more than " + std::to_string(kMostRows) +
            " rows, which is the limit of import; cut the file into parts" +
            (format == "csv" ? ". If the times are in milliseconds, name their column t[ms]" : ""));
  const Eigen::Index count =
      spacing.even && !keys ? rows.rows() : static_cast<Eigen::Index>(std::floor(last + 1e-3)) + 1;
  if (keys)
    notes.push_back(text::counted(rows.rows(), "key posture") +
                    ". Between these postures, Ayumi interpolates the angles with monotone cubic "
                    "curves and makes one row every " +
                    text::brief(1000 * dt) + " ms");
  else if (!spacing.even)
    notes.push_back(
        "the rows are not evenly spaced in time, so Ayumi interpolates linearly and makes one row "
        "every " +
        text::brief(dt) + " s");
  if (unset && !keys)
    notes.push_back(
        "some rows do not have all values; the missing values are interpolated linearly");
  if (spacing.even && !keys && !unset) return rows;
  std::vector<double> on_ticks = times;
  if (spacing.even && !keys)
    for (size_t k = 0; k < times.size(); ++k) on_ticks[k] = static_cast<double>(k) * dt;
  return interpolated(on_ticks, rows, dt, count, keys);
}

void set_motion(const Rows& rows, const MotionFile& file, Eigen::Index dofs, RawMotion& motion) {
  motion.theta = rows.leftCols(dofs);
  for (Eigen::Index k = 0; k < rows.rows(); ++k) {
    Eigen::Index c = dofs;
    const auto vector = [&] {
      c += 3;
      return Eigen::Vector3d(rows.row(k).segment<3>(c - 3).transpose());
    };
    if (!file.base.empty()) {
      BasePose base;
      base.position = vector();
      const auto q = rows.row(k).segment<4>(c);
      base.attitude = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
      // Definition: the tolerance of Ayumi's own tables for a unit quaternion; the bits of such a
      // quaternion are kept.
      constexpr double kUnit = 1e-6;
      if (!(std::abs(base.attitude.norm() - 1) < kUnit)) base.attitude.normalize();
      motion.base.push_back(base);
      c += 4;
    }
    if (!file.cog.empty()) motion.cog.push_back(vector());
    if (!file.zmp.empty()) motion.zmp.push_back(vector());
    if (!file.fz.empty()) motion.fz.push_back(rows(k, c));
  }
}

// Each row gets the contacts of the row that is nearest to it.
std::vector<Support> supports_on_ticks(const MotionFile& motion, size_t count, double dt) {
  if (motion.support.empty() || motion.support.size() == count) return motion.support;
  std::vector<Support> result;
  size_t r = 0;
  for (size_t k = 0; k < count; ++k) {
    const double t = motion.times.front() + static_cast<double>(k) * dt;
    while (r + 1 < motion.times.size() && motion.times[r + 1] <= t + 0.5 * dt) ++r;
    result.push_back(motion.support[r]);
  }
  return result;
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
      "the angles are servo targets, which are ahead of the joint angles by the lag of the servos "
      "(delay + kd/kp). Ayumi removed this lag to get the joint angles");
}

// Whether the values are angles of the encoders of this robot unit. If the user does not state it,
// they are if the programs of a robot play or record this format, or if the values are the targets
// of servos. If a table of Ayumi states offsets in its head, its reader has already added them.
bool of_encoders(const MotionFile& read, const ImportOptions& options, const std::string& format) {
  if (options.sent) return true;
  if (read.of_joints) return false;
  if (options.measured_at) return *options.measured_at == MeasuredAt::encoder;
  if (options.commands) return true;
  // A table with a head row or in JSON may come from anywhere.
  const MotionFormat* const known = find_motion_format(format);
  return known && known->played && format != "csv" && format != "json";
}

// The robot keeps the last target of a sequence, so a short one can be made longer.
void hold_last_row(Eigen::Index least, ImportedMotion& imported) {
  Eigen::MatrixXd& theta = imported.motion.theta;
  const Eigen::Index rows = theta.rows();
  if (rows >= least) return;
  theta.conservativeResize(least, Eigen::NoChange);
  theta.bottomRows(least - rows) = theta.row(rows - 1).replicate(least - rows, 1);
  imported.filled.push_back("the last posture is held until there are " + std::to_string(least) +
                            " rows, because a check needs this number of rows");
}

// A motion begins and ends at rest. So its rows are continued beyond both ends as if it returned
// along its own path.
Eigen::VectorXd smoothed_from_rest(const Eigen::VectorXd& raw, double band, double cutoff) {
  const Eigen::Index n = raw.size();
  const auto more = std::min<Eigen::Index>(n - 1, static_cast<Eigen::Index>(2 / cutoff));
  Eigen::VectorXd mirrored(n + 2 * more);
  mirrored << raw.segment(1, more).reverse(), raw, raw.segment(n - 1 - more, more).reverse();
  return smoothed_within(mirrored, band, cutoff).segment(more, n);
}

// Values that were rounded or measured with noise have accelerations from row to row that no motion
// has. The difference of a row's acceleration from those of its neighbours is then larger than the
// accelerations themselves. In smooth motions it is smaller. Returns the root mean square of these
// accelerations, or 0 for a smooth motion.
double noise_of(const Eigen::VectorXd& values, double dt) {
  // Ratio of third to second differences above which a motion is noisy. Derived: between white
  // noise, which has a ratio of sqrt(20/6) = 1.8, and a motion of 2 Hz at 30 rows per second, which
  // has 0.4.
  constexpr double kNoise = 1.2;
  const Eigen::Index rows = values.size();
  const Eigen::VectorXd rate = values.tail(rows - 1) - values.head(rows - 1);
  const Eigen::VectorXd second = rate.tail(rows - 2) - rate.head(rows - 2);
  const Eigen::VectorXd third = second.tail(rows - 3) - second.head(rows - 3);
  if (third.norm() < kNoise * second.norm()) return 0;
  return second.norm() / std::sqrt(static_cast<double>(rows - 2)) / (dt * dt);
}

void say_rough_angles(const RobotModel& model, ImportedMotion& imported) {
  // Acceleration of the noise above which a note is written [rad/s^2, m/s^2]. Chosen: the
  // acceleration of joints in quick motions.
  constexpr double kSaid = 20;
  const Eigen::MatrixXd& theta = imported.motion.theta;
  double worst = 0;
  Eigen::Index joint = 0;
  for (Eigen::Index j = 0; j < theta.cols(); ++j) {
    const double noise = noise_of(theta.col(j), imported.motion.dt);
    if (noise < worst) continue;
    worst = noise;
    joint = j;
  }
  if (worst < kSaid) return;
  imported.filled.push_back(
      "the angles are rough, as if they were rounded or measured with noise. The root mean square "
      "of the acceleration of " +
      model.dof_names()[static_cast<size_t>(joint)] + " is " + text::brief(worst, 2) +
      (model.dofs()[static_cast<size_t>(joint)].prismatic ? " m/s2" : " rad/s2") +
      ". Ayumi computes the forces from the accelerations, so the forces are rough too. --smooth "
      "DEG smooths the angles and changes each angle by at most DEG degrees (try 0.1)");
}

// Noise of the root moves the whole robot, so it moves the ZMP at once.
void say_rough_root(ImportedMotion& imported) {
  // Acceleration of the noise above which a note is written [m/s^2]. Derived: 0.1 g moves the ZMP
  // by 0.1 of the COG height, about half the width of a sole.
  constexpr double kSaid = 0.1 * kGravity;
  const std::vector<BasePose>& base = imported.motion.base;
  if (base.empty()) return;
  double worst = 0;
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::VectorXd place(static_cast<Eigen::Index>(base.size()));
    for (size_t k = 0; k < base.size(); ++k)
      place[static_cast<Eigen::Index>(k)] = base[k].position[axis];
    worst = std::max(worst, noise_of(place, imported.motion.dt));
  }
  if (worst < kSaid) return;
  imported.filled.push_back(
      "the track of the root is rough, as if it was rounded or measured with noise. The root mean "
      "square of its acceleration is " +
      text::brief(worst, 2) +
      " m/s2, which moves the ZMP. --smooth does not smooth the root, so smooth the track in the "
      "program that recorded it");
}

// Counts are rounded, and they are interpolated linearly between the times for which they were
// made, so that their differences are no accelerations of the motion. Servos do not follow a change
// of a tenth of a degree.
void smooth_angles(const RobotModel& model, const ImportOptions& options,
                   ImportedMotion& imported) {
  // Largest change of an angle [deg]. Chosen: 21 counts, which servos do not follow.
  constexpr double kOfCounts = 0.1;
  // Frequency up to which a motion is kept [1/s]. Chosen: ten times the frequency of the steps of a
  // walk (0.55 s each).
  constexpr double kCutoff = 20;
  const double degrees = options.smooth.value_or(imported.format == "hoap" ? kOfCounts : 0);
  say_rough_root(imported);
  if (degrees <= 0) {
    say_rough_angles(model, imported);
    return;
  }
  Eigen::MatrixXd& theta = imported.motion.theta;
  for (int i = 0; i < model.dof_count(); ++i) {
    const Dof& dof = model.dofs()[i];
    if (dof.prismatic) continue;
    const Eigen::VectorXd raw = theta.col(i);
    theta.col(i) =
        smoothed_from_rest(raw, degrees * kRadiansPerDegree, kCutoff * imported.motion.dt);
    if (!dof.limited) continue;
    // Smoothing overshoots beside a jump, but it must not violate a limit.
    const double margin = model.description().soft_limit_margin;
    theta.col(i) = theta.col(i)
                       .cwiseMax(std::min(dof.lower + margin, raw.minCoeff()))
                       .cwiseMin(std::max(dof.upper - margin, raw.maxCoeff()));
  }
  imported.filled.push_back("the angles were smoothed, and each changed by at most " +
                            text::brief(degrees) + " deg");
}

// Joints that leave their position limits, or are faster than their servos, and would do neither if
// the angles were in degrees. Joints of `stated` are left out, because the file states their unit.
// The default profile of the robot is taken.
std::string hint_of_degrees(const RobotModel& model, const RawMotion& motion,
                            const std::vector<bool>& stated) {
  std::vector<std::string> suspicious;
  for (int i = 0; i < model.dof_count(); ++i) {
    const Dof& dof = model.dofs()[static_cast<size_t>(i)];
    if (dof.prismatic || stated[static_cast<size_t>(i)]) continue;
    const Eigen::VectorXd angle = motion.theta.col(i);
    const Eigen::Index rows = angle.size();
    const double fastest =
        rows < 2 ? 0
                 : (angle.tail(rows - 1) - angle.head(rows - 1)).cwiseAbs().maxCoeff() / motion.dt;
    const auto possible = [&](double unit) {
      return unit * angle.minCoeff() >= dof.lower - kRadiansPerDegree &&
             unit * angle.maxCoeff() <= dof.upper + kRadiansPerDegree &&
             unit * fastest <= model.limits().speed[i];
    };
    if (!possible(1) && possible(kRadiansPerDegree)) suspicious.push_back(dof.name);
  }
  if (suspicious.empty()) return "";
  constexpr size_t kNamed = 3;  // largest number of names. Chosen: a line that a person still reads
  const bool one = suspicious.size() == 1;
  return ". In radians, " + text::counted(suspicious.size(), "joint") + " (" +
         text::join_first(suspicious, kNamed) + ") " + (one ? "exceeds" : "exceed") +
         " position or speed limits. In degrees, " +
         (one ? "this joint stays inside its limits" : "these joints stay inside their limits") +
         ". If the angles are in degrees, give --unit deg";
}

// What is assumed about the unit of the angles for which the file states none; empty if it states
// all units.
std::string assumed_unit(const MotionFile& read, const RobotModel& model, bool degrees,
                         const RawMotion& motion) {
  const bool all = read.unit == MotionFile::Unit::assumed;
  if (!all && read.without_unit.empty()) return "";
  std::vector<bool> stated(static_cast<size_t>(model.dof_count()), !all);
  for (const std::string& joint : read.without_unit)
    if (const int dof = find_joint(model, joint); dof >= 0)
      stated[static_cast<size_t>(dof)] = false;
  const std::string words = std::string("units: ") + (degrees ? "degrees" : "radians") +
                            (all ? "" : " for " + shortened(read.without_unit));
  if (degrees) return words + ", as --unit says";
  const std::string hint = hint_of_degrees(model, motion, stated);
  return words + (hint.empty() ? " (assumed; --unit deg changes this)" : " (assumed)" + hint);
}

void read_rows(const std::string& bytes, const std::string& file, const RobotModel& model,
               const ImportOptions& options, ImportedMotion& result) {
  const MotionFile read = read_file_of(bytes, file, model, options, result);
  const std::vector<int> columns = map_joints(read, model, options, file, result.filled);
  refuse_absurd(read, model, file);
  result.filled.insert(result.filled.end(), read.notes.begin(), read.notes.end());
  const bool assumed = read.unit == MotionFile::Unit::assumed;
  const auto unit_note = static_cast<std::ptrdiff_t>(result.filled.size());
  Eigen::VectorXd zeros = Eigen::VectorXd::Zero(model.dof_count());
  if (of_encoders(read, options, result.format)) zeros = encoder_zeros(model);
  const Rows rows = rows_of(read, columns, model, options.degrees && assumed, zeros);
  set_motion(even_rows(read, rows, options, file, result.format, result.motion.dt, result.filled),
             read, model.dof_count(), result.motion);
  if (const std::string unit = assumed_unit(read, model, options.degrees, result.motion);
      !unit.empty())
    result.filled.insert(result.filled.begin() + unit_note, unit);
  result.motion.support =
      supports_on_ticks(read, static_cast<size_t>(result.motion.theta.rows()), result.motion.dt);
  result.rows = read.file_rows > 0 ? read.file_rows : static_cast<int>(read.rows());
  result.name = read.name;
  result.commands = read.commands;
  result.caution = read.caution;
  result.sequence = read.sequence;
  // Smallest number of rows. Derived: accelerations take five (motion/differentiate.hpp).
  constexpr int kLeastRows = 6;
  if (!result.sequence.empty()) hold_last_row(kLeastRows, result);
  if (result.motion.theta.rows() < kLeastRows)
    fail(ErrorCode::bad_file, {file},
         "the motion has " + std::to_string(result.motion.theta.rows()) + " rows, but at least " +
             std::to_string(kLeastRows) + " are needed");
}

// Calls `read`. An Error about the file gets an addition that says which format was assumed.
template <typename Read>
void with_remedy(const std::string& bytes, ImportedMotion& result, const Read& read) {
  try {
    read();
  } catch (const Error& error) {
    if (error.code() != ErrorCode::bad_file) throw;
    throw_with_more(error, remedy(find_motion_format(result.format), result, bytes,
                                  error.place().names_remedy));
  }
}

}  // namespace

ImportedMotion read_motion_rows(const std::string& bytes, const std::string& file,
                                const RobotModel& model, const ImportOptions& options) {
  ImportedMotion result;
  with_remedy(bytes, result, [&] { read_rows(bytes, file, model, options, result); });
  return result;
}

std::optional<ImportedKeys> read_key_poses(const std::string& bytes, const std::string& file,
                                           const RobotModel& model, const ImportOptions& options) {
  ImportedMotion about;
  std::optional<ImportedKeys> keys;
  with_remedy(bytes, about, [&] {
    MotionInput source{{}, file, model, options};
    const MotionFormat& format = format_of(bytes, source, about);
    if (!format.read_keys) return;
    keys.emplace();
    keys->pattern = format.read_keys(source, keys->filled);
    keys->format = format.name;
    keys->reason = about.reason;
  });
  return keys;
}

ImportedMotion read_motion(const std::string& bytes, const std::string& file,
                           const RobotModel& model, const ImportOptions& options) {
  ImportedMotion result = read_motion_rows(bytes, file, model, options);
  if (options.commands || result.commands) take_out_lead(model, result);
  smooth_angles(model, options, result);
  if (result.motion.support.empty()) result.filled.push_back("contacts: detected from the motion");
  if (result.motion.base.empty())
    result.filled.push_back(
        "base: computed from the supporting feet, whose soles are taken as level");
  return result;
}

}  // namespace ayumi
