// Real sequence files are not clean tables. They have two kinds of line ends, blanks around cells,
// "-0", requests in the columns in which other files have words for hobby servos, and commands to
// single devices between the rows. Recordings of robots and files of other programs have no
// intervals, and their values are counts or radians.
#include "ayumi/io/formats/hoap_motion.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/formats/hoap.hpp"
#include "ayumi/io/table/csv_dialect.hpp"

namespace ayumi {

namespace {

void refuse_lost_motion(const HoapFile& sequence, int device, const RobotModel& model,
                        const std::string& file, std::vector<std::string>& filled) {
  const auto column = static_cast<size_t>(device - 1);
  const auto [least, most] = std::minmax_element(
      sequence.rows.begin(), sequence.rows.end(),
      [&](const HoapRow& a, const HoapRow& b) { return a.values[column] < b.values[column]; });
  // An axis that moves by less than this holds its place. Chosen: 0.05 degrees, half of what servos
  // do not follow (kOfCounts of motion_import.cpp); the number of counts is that of an encoder with
  // 209 counts per degree.
  constexpr double kTremblingCounts = 10, kTremblingAngle = 0.05 * EIGEN_PI / 180;
  const double low = least->values[column], high = most->values[column];
  const std::string unit = sequence.layout.radians ? " rad" : " counts";
  const std::string name = "device " + std::to_string(device);
  if (high - low > (sequence.layout.radians ? kTremblingAngle : kTremblingCounts))
    fail(ErrorCode::bad_file, {file},
         name + " moves from " + text::brief(low) + " to " + text::brief(high) + unit +
             ", but no joint of '" + model.name() +
             "' has this device; add the device to \"encoders\" in the sidecar");
  filled.push_back(name +
                   " is ignored, because no joint of this robot has this device. Its target is " +
                   text::brief(low) + unit + " in every row");
}

void refuse_zeros(const HoapFile& sequence, const std::string& file) {
  for (const HoapRow& row : sequence.rows)
    for (const double value : row.values)
      if (value != 0) return;
  if (sequence.rows.size() > 1)
    fail(ErrorCode::bad_file, {file},
         "all values of all motors are 0, so nothing was recorded; record again");
}

// A step that no motor board passes on shows that the motion in the file is discontinuous, or that
// rows are missing.
void say_largest_step(const HoapFile& sequence, std::vector<std::string>& filled) {
  if (sequence.layout.radians) return;
  const double limit = SafetyOptions().counts_per_ms;
  double worst = limit;
  size_t row = 0, device = 0;
  for (size_t r = 1; r < sequence.rows.size(); ++r) {
    const HoapRow &from = sequence.rows[r - 1], &to = sequence.rows[r];
    for (size_t m = 0; m < to.values.size(); ++m) {
      const double step = std::abs(to.values[m] - from.values[m]) / (to.at - from.at);
      if (step <= worst) continue;
      worst = step;
      row = r;
      device = m + 1;
    }
  }
  if (device > 0)
    filled.push_back("at row " + std::to_string(row + 1) + ", the target of device " +
                     std::to_string(device) + " changes by " + text::brief(worst) +
                     " counts/ms from the row before, but motor boards allow at most " +
                     text::brief(limit) + " counts/ms. Rows may be missing before this row");
}

/// The joints whose angles leave their position limits in some row.
std::vector<std::string> beyond_limits(const RobotModel& model, const Eigen::MatrixXd& theta) {
  // Tolerance [rad]. Chosen: rounding of decimals; no knee bends by so little.
  constexpr double kSlack = 1e-6;
  std::vector<std::string> names;
  for (int j = 0; j < model.dof_count(); ++j) {
    const Dof& dof = model.dofs()[static_cast<size_t>(j)];
    if (dof.limited && (theta.col(j).minCoeff() < dof.lower - kSlack ||
                        theta.col(j).maxCoeff() > dof.upper + kSlack))
      names.push_back(dof.name);
  }
  return names;
}

// The angles in radians. The notes say which of them were negated, and whether the angles fit
// better with the other signs.
void apply_signs(const RobotModel& model, bool encoder_signs, Eigen::MatrixXd& theta,
                 std::vector<std::string>& notes) {
  std::vector<std::string> negative;
  Eigen::MatrixXd other = theta;
  for (int j = 0; j < model.dof_count(); ++j) {
    const Dof& dof = model.dofs()[static_cast<size_t>(j)];
    if (dof.encoder.device < 1 || dof.encoder.counts_per_degree >= 0) continue;
    negative.push_back(dof.name);
    other.col(j) *= -1;
  }
  if (!encoder_signs) theta.swap(other);
  if (encoder_signs)
    notes.push_back("angles in radians have the signs of the encoders, so the angles of " +
                    (negative.empty() ? std::string("no joint") : text::join(negative, ", ")) +
                    " were negated. With --signs joint, no angle is negated");
  else
    notes.push_back(
        "angles in radians have the signs of the joints, so no angle was negated. With --signs "
        "encoder, the angles get the signs of the encoders");
  const std::vector<std::string> beyond = beyond_limits(model, theta);
  if (beyond.size() > beyond_limits(model, other).size())
    notes.push_back("with these signs, angles of " + text::join(beyond, ", ") +
                    " exceed the position limits. With `--signs " +
                    (encoder_signs ? "joint" : "encoder") + "`, fewer joints exceed their limits");
}

}  // namespace

std::string recognize_hoap_motion(const MotionInput& source) {
  const size_t first = source.bytes.find_first_not_of(" \t\r\n");
  if (first == std::string::npos || source.bytes.find('\0') != std::string::npos) return "";
  const char c = source.bytes[first];
  if (!(c == '-' || c == '+' || c == '.' || (c >= '0' && c <= '9'))) return "";
  const std::string_view line =
      std::string_view(source.bytes).substr(first, source.bytes.find('\n', first) - first);
  if (line.find_first_of(",;\t") == std::string_view::npos) return "";
  return looks_like_hoap(plain_table_text(source.bytes, source.file), source.model)
             ? "the first row looks like a row of a HOAP sequence"
             : "";
}

MotionFile read_hoap_motion(const MotionInput& source) {
  const RobotModel& model = source.model;
  const std::string &file = source.file, bytes = plain_table_text(source.bytes, file);
  const HoapFile sequence = parse_hoap(bytes, file, model);
  refuse_zeros(sequence, file);
  MotionFile motion;
  motion.file_rows = static_cast<int>(sequence.rows.size());
  double dt = sequence.dt();
  if (sequence.layout.has_interval()) {
    motion.sequence = source.bytes;
  } else {
    const double rate = source.options.rate;
    if (rate > 0) dt = 1 / rate;
    motion.notes.push_back(
        std::string("the rows of ") + (sequence.layout.radians ? "angles in radians" : "counts") +
        " do not state their intervals. " +
        (rate > 0 ? "As --rate says, there is one row every " : "Ayumi assumes one row every ") +
        text::brief(1000 * dt) + " ms" + (rate > 0 ? "" : " (--rate HZ changes this)"));
  }
  motion.rate = 1 / dt;
  if (!sequence.even)
    motion.notes.push_back(
        "the intervals between the rows differ, so Ayumi interpolates linearly and makes one row "
        "every " +
        std::to_string(sequence.tick_ms) + " ms");
  if (sequence.general_commands > 0)
    motion.notes.push_back(
        std::to_string(sequence.general_commands) +
        " commands to single devices are ignored, but the intervals of their rows are kept");
  say_largest_step(sequence, motion.notes);
  Eigen::MatrixXd theta = hoap_readings(model, sequence);
  std::vector<char> known(static_cast<size_t>(sequence.layout.motors) + 1, 0);
  std::vector<Eigen::Index> columns;
  for (int j = 0; j < model.dof_count(); ++j) {
    const Dof& dof = model.dofs()[static_cast<size_t>(j)];
    if (dof.encoder.device < 1 || dof.encoder.device > sequence.layout.motors) continue;
    known[static_cast<size_t>(dof.encoder.device)] = 1;
    motion.joints.push_back(dof.name);
    columns.push_back(j);
  }
  for (int device = 1; device <= sequence.layout.motors; ++device)
    if (!known[static_cast<size_t>(device)])
      refuse_lost_motion(sequence, device, model, file, motion.notes);
  if (sequence.layout.radians)
    apply_signs(model, source.options.encoder_signs, theta, motion.notes);
  motion.values = theta(Eigen::all, columns);
  return motion;
}

}  // namespace ayumi
