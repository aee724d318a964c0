// Real sequence files are no clean tables: line ends of two kinds, blanks around cells, "-0",
// requests where others have hobby servo words, commands to single devices between the rows; and
// what robots answer, or other programs write for them, is bare: no intervals, counts or radians.
#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/formats/hoap.hpp"
#include "ayumi/io/table/motion_import.hpp"

namespace ayumi {

namespace {

void refuse_lost_motion(const HoapFile& sequence, int device, const RobotModel& model,
                        const std::string& file, std::vector<std::string>& filled) {
  const auto column = static_cast<size_t>(device - 1);
  const auto [least, most] = std::minmax_element(
      sequence.rows.begin(), sequence.rows.end(),
      [&](const HoapRow& a, const HoapRow& b) { return a.values[column] < b.values[column]; });
  // Movement of an axis that holds its place. Chosen: 0.05 degrees, half of what servos do not
  // follow (kOfCounts of table_import.cpp); as counts those of an encoder of 209 counts per degree.
  constexpr double kTremblingCounts = 10, kTremblingAngle = 0.05 * EIGEN_PI / 180;
  const double low = least->values[column], high = most->values[column];
  const std::string unit = sequence.layout.radians ? " rad" : " counts";
  const std::string name = "device " + std::to_string(device);
  if (high - low > (sequence.layout.radians ? kTremblingAngle : kTremblingCounts))
    fail(ErrorCode::bad_file, file + ": " + name + " moves from " + text::brief(low) + " to " +
                                  text::brief(high) + unit + ", but no joint of '" + model.name() +
                                  "' has this device; add it to \"encoders\" in the sidecar");
  filled.push_back(name + " is not on this robot and is ignored; its target is always " +
                   text::brief(low) + unit);
}

void refuse_zeros(const HoapFile& sequence, const std::string& file) {
  for (const HoapRow& row : sequence.rows)
    for (const double value : row.values)
      if (value != 0) return;
  if (sequence.rows.size() > 1)
    fail(ErrorCode::bad_file,
         file + ": every value of every motor is 0; nothing was recorded here");
}

// A step that no motor board passes on: the file has a jump, or rows are missing.
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
    filled.push_back("device " + std::to_string(device) + " jumps by " + text::brief(worst) +
                     " counts/ms before row " + std::to_string(row + 1) +
                     ", but motor boards allow at most " + text::brief(limit) +
                     " counts/ms; rows may be missing there");
}

/// Joints whose angles leave their position limits somewhere.
std::vector<std::string> beyond_limits(const RobotModel& model, const Eigen::MatrixXd& theta) {
  constexpr double kSlack = 1e-6;  // Chosen: rounding of decimals [rad]; no knee bends by it
  std::vector<std::string> names;
  for (int j = 0; j < model.dof_count(); ++j) {
    const Dof& dof = model.dofs()[static_cast<size_t>(j)];
    if (dof.limited && (theta.col(j).minCoeff() < dof.lower - kSlack ||
                        theta.col(j).maxCoeff() > dof.upper + kSlack))
      names.push_back(dof.name);
  }
  return names;
}

// Angles in radians: says which of them were negated, and whether the other reading fits better.
void apply_signs(const RobotModel& model, bool encoder_signs, ImportedMotion& result) {
  std::vector<std::string> negative;
  Eigen::MatrixXd other = result.motion.theta;
  for (int j = 0; j < model.dof_count(); ++j) {
    const Dof& dof = model.dofs()[static_cast<size_t>(j)];
    if (dof.encoder.device < 1 || dof.encoder.counts_per_degree >= 0) continue;
    negative.push_back(dof.name);
    other.col(j) *= -1;
  }
  if (!encoder_signs) result.motion.theta.swap(other);
  if (encoder_signs)
    result.filled.push_back(
        "angles in radians have the signs of the encoders: those of " +
        (negative.empty() ? std::string("no joint") : text::join(negative, ", ")) +
        " were negated (--signs joint takes all angles as they are)");
  else
    result.filled.push_back(
        "angles in radians have the signs of the joints: none was negated (--signs encoder applies "
        "the signs of the encoders)");
  const std::vector<std::string> beyond = beyond_limits(model, result.motion.theta);
  if (beyond.size() > beyond_limits(model, other).size())
    result.filled.push_back("with these signs, angles of " + text::join(beyond, ", ") +
                            " exceed the position limits; with --signs " +
                            (encoder_signs ? "joint" : "encoder") + " fewer joints do");
}

void say_bare_rate(const HoapFile& sequence, double rate, ImportedMotion& result) {
  if (rate > 0) result.motion.dt = 1 / rate;
  result.filled.push_back(std::string(sequence.layout.radians ? "angles in radians" : "counts") +
                          " without intervals: " + text::brief(1000 * result.motion.dt) +
                          " ms from row to row" + (rate > 0 ? "" : " (--rate HZ changes this)"));
}

}  // namespace

ImportedMotion read_hoap_motion(const std::string& bytes, const std::string& file,
                                const RobotModel& model, double rate, bool encoder_signs) {
  const HoapFile sequence = parse_hoap(bytes, file, model);
  refuse_zeros(sequence, file);
  const ReferenceTrajectory targets = hoap_targets(model, sequence);
  ImportedMotion result;
  result.format = "hoap";
  result.rows = static_cast<int>(sequence.rows.size());
  result.motion.dt = sequence.dt();
  if (sequence.layout.has_interval())
    result.sequence = bytes;
  else
    say_bare_rate(sequence, rate, result);
  if (!sequence.even)
    result.filled.push_back(
        "the intervals change, so the rows are interpolated linearly, one every " +
        std::to_string(sequence.tick_ms) + " ms");
  if (sequence.general_commands > 0)
    result.filled.push_back(
        std::to_string(sequence.general_commands) +
        " commands to single devices are ignored, but the time of their rows counts");
  say_largest_step(sequence, result.filled);
  std::vector<char> known(static_cast<size_t>(sequence.layout.motors) + 1, 0);
  result.motion.theta.resize(static_cast<Eigen::Index>(targets.rows.size()), model.dof_count());
  for (size_t k = 0; k < targets.rows.size(); ++k)
    result.motion.theta.row(static_cast<Eigen::Index>(k)) = targets.rows[k].theta.transpose();
  for (const Dof& dof : model.dofs())
    if (dof.encoder.device >= 1 && dof.encoder.device <= sequence.layout.motors)
      known[static_cast<size_t>(dof.encoder.device)] = 1;
  for (int device = 1; device <= sequence.layout.motors; ++device)
    if (!known[static_cast<size_t>(device)])
      refuse_lost_motion(sequence, device, model, file, result.filled);
  for (const Dof& dof : model.dofs())
    if (dof.encoder.device < 1 || dof.encoder.device > sequence.layout.motors)
      result.filled.push_back(
          dof.name +
          ": the file has no angles of this joint; the joint keeps its angle of the home posture");
  if (sequence.layout.radians) apply_signs(model, encoder_signs, result);
  return result;
}

}  // namespace ayumi
