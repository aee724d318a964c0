#include "ayumi/io/formats/json_motion.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/degrees.hpp"
#include "ayumi/io/json/json_reader.hpp"
#include "ayumi/math/elementary.hpp"

namespace ayumi {

namespace {

bool is_object(const MotionInput& source) {
  const size_t first = source.bytes.find_first_not_of(" \t\r\n");
  return first != std::string::npos && source.bytes[first] == '{';
}

bool has_key(const MotionInput& source, const std::string& key) {
  return source.bytes.find("\"" + key + "\"") != std::string::npos;
}

// An angle in degrees as text, with as many digits as a number in radians has.
std::string degrees_text(double radians) { return text::brief(radians / kRadiansPerDegree, 12); }

// Reads rows, each with the same number of finite numbers.
std::vector<std::vector<double>> frames_of(const MotionInput& source, const JsonNode& root,
                                           size_t least) {
  std::vector<std::vector<double>> rows;
  for (const JsonNode& frame : root.at("Frames").items()) {
    rows.push_back(frame.numbers());
    if (rows.back().size() < least || rows.back().size() != rows.front().size())
      frame.complain("the frame has " + text::counted(rows.back().size(), "value") + ", but " +
                     (rows.size() > 1 ? std::to_string(rows.front().size())
                                      : "at least " + std::to_string(least)) +
                     " are needed");
  }
  if (rows.empty())
    source.refuse(0, "the file has no frame, so there is no motion to read; write the file again");
  return rows;
}

BasePose frame_root(const MotionInput& source, const std::vector<double>& row, size_t k,
                    size_t place, size_t turn, bool scalar_first) {
  const double* q = &row[turn];
  BasePose base;
  base.position = {row[place], row[place + 1], row[place + 2]};
  base.attitude = scalar_first ? Eigen::Quaterniond(q[0], q[1], q[2], q[3])
                               : Eigen::Quaterniond(q[3], q[0], q[1], q[2]);
  if (!(std::abs(base.attitude.norm() - 1) < kUnitQuaternion))
    source.refuse(0, "Frames: frame " + std::to_string(k + 1) +
                         ": the quaternion of the root has length " +
                         text::brief(base.attitude.norm()) + ", but 1 is needed");
  return base;
}

void set_values(const std::vector<std::vector<double>>& rows, size_t first, size_t count,
                MotionFile& motion) {
  motion.values.resize(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(count));
  for (size_t k = 0; k < rows.size(); ++k)
    for (size_t j = 0; j < count; ++j)
      motion.values(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(j)) =
          rows[k][first + j];
}

// Turns a rotation from y up to z up: x stays, and y becomes z.
const Eigen::Quaterniond& upright() {
  static const Eigen::Quaterniond turn(
      elementary::turn_quaternion(EIGEN_PI / 2, Eigen::Vector3d::UnitX()));
  return turn;
}

template <typename Values>
std::string comma_list(const Values& values) {
  std::vector<std::string> words;
  for (const double value : values)
    words.push_back(value == 0 && std::signbit(value) ? "-0.0" : text::exact(value));
  return text::join(words, ", ");
}

std::string quoted_list(const std::vector<std::string>& names) {
  std::vector<std::string> words;
  for (const std::string& name : names) words.push_back("\"" + name + "\"");
  return text::join(words, ", ");
}

}  // namespace

std::string recognize_poppy_move(const MotionInput& source) {
  return is_object(source) && has_key(source, "framerate") && has_key(source, "positions")
             ? "the file is JSON with \"framerate\" and \"positions\""
             : "";
}

MotionFile read_poppy_move(const MotionInput& source) {
  const Json document = parse_json(source.bytes, source.file, ErrorCode::bad_file);
  const JsonNode root = root_of(document, source.file, ErrorCode::bad_file);
  std::map<double, std::map<std::string, double>> rows;
  std::vector<std::string> names;
  for (const auto& [key, motors] : root.at("positions").members()) {
    const double time = source.number(key, 0, "positions");
    for (const auto& [motor, value] : motors.members()) {
      const std::vector<JsonNode> parts =
          value.value().is_array() ? value.items() : std::vector<JsonNode>{value};
      if (parts.empty() || parts.size() > 2)
        value.complain("expected an angle, or [angle, speed], found " +
                           std::to_string(parts.size()) +
                           " numbers; write decimal points, not decimal commas",
                       true);
      rows[time][motor] = parts.front().number();
      if (!parts.back().value().is_null()) parts.back().number();  // the speed, which is not used
      if (std::find(names.begin(), names.end(), motor) == names.end()) names.push_back(motor);
    }
  }
  if (rows.empty())
    source.refuse(0,
                  "the file has no position, so there is no motion to read; write the file again");
  MotionFile motion;
  motion.joints = names;
  motion.values.setConstant(static_cast<Eigen::Index>(rows.size()),
                            static_cast<Eigen::Index>(names.size()),
                            std::numeric_limits<double>::quiet_NaN());
  Eigen::Index k = 0;
  for (const auto& [time, row] : rows) {
    motion.times.push_back(time);
    for (size_t j = 0; j < names.size(); ++j)
      if (const auto found = row.find(names[j]); found != row.end())
        motion.values(k, static_cast<Eigen::Index>(j)) = kRadiansPerDegree * found->second;
    ++k;
  }
  motion.notes.push_back("units: seconds and degrees, as the format defines them");
  return motion;
}

std::vector<WrittenFile> write_poppy_move(const RobotModel&, const MotionFile& motion) {
  std::string text = "{\n  \"framerate\": " + text::exact(motion.rate) + ",\n  \"positions\": {";
  const Eigen::Index rows = motion.rows();
  // The speeds are those of the angles as they are written, so that they are the same if the file
  // is read and written again.
  const Eigen::MatrixXd written = motion.values.unaryExpr([](double angle) {
    const std::string text = degrees_text(angle);
    double degrees = 0;
    std::from_chars(text.data(), text.data() + text.size(), degrees);
    return kRadiansPerDegree * degrees;
  });
  for (Eigen::Index k = 0; k < rows; ++k) {
    text += (k > 0 ? ",\n    \"" : "\n    \"") + text::exact(motion.times[static_cast<size_t>(k)]) +
            "\": {";
    const Eigen::Index a = std::max<Eigen::Index>(k - 1, 0), b = std::min(k + 1, rows - 1);
    for (size_t j = 0; j < motion.joints.size(); ++j) {
      const auto c = static_cast<Eigen::Index>(j);
      const double speed =
          a == b ? 0 : (written(b, c) - written(a, c)) * motion.rate / static_cast<double>(b - a);
      text += (j > 0 ? ", \"" : "\"") + motion.joints[j] + "\": [" +
              degrees_text(motion.values(k, c)) + ", " + degrees_text(speed) + "]";
    }
    text += "}";
  }
  return {{"", text + "\n  }\n}\n"}};
}

std::string recognize_deep_mimic(const MotionInput& source) {
  return is_object(source) && has_key(source, "Frames") && !has_key(source, "Frame_offset")
             ? "the file is JSON with \"Frames\""
             : "";
}

MotionFile read_deep_mimic(const MotionInput& source) {
  const Json document = parse_json(source.bytes, source.file, ErrorCode::bad_file);
  const JsonNode root = root_of(document, source.file, ErrorCode::bad_file);
  MotionFile motion;
  if (const auto duration = root.find("FrameDuration")) {
    const std::vector<std::vector<double>> rows = frames_of(source, root, 8);
    const double step = duration->number();
    if (!(step > 0))
      duration->complain("the duration of a frame must be above 0 s, but it is " +
                         text::exact(step) + " s");
    motion.rate = 1 / step;
    for (size_t k = 0; k < rows.size(); ++k)
      motion.base.push_back(frame_root(source, rows[k], k, 0, 3, false));
    set_values(rows, 7, rows.front().size() - 7, motion);
    motion.notes.push_back(
        "units: metres and radians, with the axis z upwards. The file does not state the order of "
        "the "
        "quaternion; Ayumi assumes x y z w, the order of files that have a single FrameDuration");
  } else {
    const std::vector<std::vector<double>> rows = frames_of(source, root, 9);
    double now = 0;
    for (size_t k = 0; k < rows.size(); ++k) {
      motion.times.push_back(now);
      now += rows[k][0];
      if (!(rows[k][0] > 0) && k + 1 < rows.size())
        source.refuse(0, "Frames: frame " + std::to_string(k + 1) +
                             ": the duration must be above 0 s, but it is " +
                             text::exact(rows[k][0]) + " s");
      BasePose base = frame_root(source, rows[k], k, 1, 4, true);
      base.position = {base.position.x(), -base.position.z(), base.position.y()};
      base.attitude = upright() * base.attitude * upright().conjugate();
      motion.base.push_back(base);
    }
    set_values(rows, 8, rows.front().size() - 8, motion);
    motion.notes.push_back(
        "units: metres and radians; quaternion order: w x y z, as the format defines it. In the "
        "file, "
        "the axis y points upwards; Ayumi turns the motion so that z points upwards. Each joint "
        "has "
        "one number");
  }
  if (const auto names = root.find("Joints")) motion.joints = names->strings();
  if (!motion.joints.empty() &&
      static_cast<Eigen::Index>(motion.joints.size()) != motion.values.cols())
    source.refuse(0, "\"Joints\" has " + text::counted(motion.joints.size(), "name") +
                         ", but the frames have " +
                         text::counted(motion.values.cols(), "joint column") +
                         "; give one name for each column");
  return motion;
}

std::vector<WrittenFile> write_deep_mimic(const RobotModel&, const MotionFile& motion) {
  std::string text =
      "{\n\"LoopMode\": \"Clamp\",\n\"FrameDuration\": " + text::exact(1 / motion.rate) +
      ",\n\"Joints\": [" + quoted_list(motion.joints) + "],\n\"Frames\": [";
  for (Eigen::Index k = 0; k < motion.rows(); ++k) {
    const BasePose& base = motion.base[static_cast<size_t>(k)];
    text += (k > 0 ? ",\n[" : "\n[") + comma_list(base.position) + ", " +
            comma_list(base.attitude.coeffs()) + ", " + comma_list(motion.values.row(k)) + "]";
  }
  return {{"", text + "\n]\n}\n"}};
}

std::string recognize_open_duck(const MotionInput& source) {
  return is_object(source) && has_key(source, "Frames") && has_key(source, "Frame_offset")
             ? "the file is JSON with \"Frames\" and \"Frame_offset\""
             : "";
}

MotionFile read_open_duck(const MotionInput& source) {
  const Json document = parse_json(source.bytes, source.file, ErrorCode::bad_file);
  const JsonNode root = root_of(document, source.file, ErrorCode::bad_file);
  MotionFile motion;
  motion.joints = root.at("Joints").strings();
  const std::vector<JsonNode> offsets = root.at("Frame_offset").items();
  if (offsets.empty())
    root.at("Frame_offset")
        .complain("the list of offsets is empty; give root_pos, root_quat and joints_pos");
  const auto offset = [&](const char* key) {
    const int at = offsets[0].at(key).integer();
    if (at < 0) offsets[0].at(key).complain("an offset must not be below 0");
    return static_cast<size_t>(at);
  };
  const size_t place = offset("root_pos"), turn = offset("root_quat"), first = offset("joints_pos");
  const std::vector<std::vector<double>> rows =
      frames_of(source, root, std::max({place + 3, turn + 4, first + motion.joints.size()}));
  motion.rate = root.has("FPS") ? root.at("FPS").number() : 1 / root.at("FrameDuration").number();
  for (size_t k = 0; k < rows.size(); ++k)
    motion.base.push_back(frame_root(source, rows[k], k, place, turn, false));
  set_values(rows, first, motion.joints.size(), motion);
  motion.notes.push_back(
      "units: metres and radians; quaternion order: x y z w, as the format defines it");
  return motion;
}

std::vector<WrittenFile> write_open_duck(const RobotModel&, const MotionFile& motion) {
  const std::string joints = std::to_string(motion.joints.size());
  std::string text =
      "{\n\"LoopMode\": \"Clamp\",\n\"FPS\": " + text::exact(motion.rate) +
      ",\n\"FrameDuration\": " + text::exact(1 / motion.rate) + ",\n\"Joints\": [" +
      quoted_list(motion.joints) +
      "],\n\"Frame_offset\": [{\"root_pos\": 0, \"root_quat\": 3, \"joints_pos\": 7}],\n"
      "\"Frame_size\": [{\"root_pos\": 3, \"root_quat\": 4, \"joints_pos\": " +
      joints + "}],\n\"Frames\": [";
  for (Eigen::Index k = 0; k < motion.rows(); ++k) {
    const BasePose& base = motion.base[static_cast<size_t>(k)];
    text += (k > 0 ? ",\n[" : "\n[") + comma_list(base.position) + ", " +
            comma_list(base.attitude.coeffs()) + ", " + comma_list(motion.values.row(k)) + "]";
  }
  return {{"", text + "\n]\n}\n"}};
}

}  // namespace ayumi
