#pragma once
// A motion in which every joint and the root move, and files of it in every format.

#include <cmath>

#include "ayumi/base/text.hpp"
#include "ayumi/io/formats/hoap.hpp"
#include "ayumi/io/formats/motion_formats.hpp"
#include "ayumi/io/table/table.hpp"

namespace ayumi::test {

/// A motion whose numbers have all their digits.
inline MotionFile moving(const RobotModel& model, int rows = 40, double rate = 50) {
  MotionFile motion;
  motion.rate = rate;
  motion.joints = model.dof_names();
  motion.values.resize(rows, model.dof_count());
  for (int k = 0; k < rows; ++k) {
    motion.times.push_back(k / rate);
    for (int j = 0; j < model.dof_count(); ++j) motion.values(k, j) = 0.1 * std::sin(0.1 * k + j);
    const double yaw = 0.3 * std::sin(0.05 * k);
    BasePose base;
    base.position = {0.01 * k, -0.002 * k, 0.25 + 0.001 * std::cos(0.2 * k)};
    base.attitude = Eigen::Quaterniond(std::cos(yaw / 2), 0, 0, std::sin(yaw / 2));
    motion.base.push_back(base);
    motion.zmp.emplace_back(0.01 * k, 0.001 * k, 0);
  }
  return motion;
}

/// The same motion as a joint table.
inline ReferenceTrajectory table_of(const RobotModel& model, const MotionFile& motion) {
  ReferenceTrajectory table;
  table.dt = 1 / motion.rate;
  table.joints = motion.joints;
  for (Eigen::Index k = 0; k < motion.rows(); ++k) {
    ReferenceRow row;
    row.theta = motion.values.row(k).transpose();
    row.base = motion.base[static_cast<size_t>(k)];
    row.cog = row.base.position;
    row.zmp = motion.zmp[static_cast<size_t>(k)];
    row.fz = 9.81 * model.mass();
    table.rows.push_back(row);
  }
  return table;
}

/// The key poses of Choreonoid with every row as one key, and all joints by their numbers.
inline std::string key_poses_of(const RobotModel& model, const MotionFile& motion) {
  std::string text = "type: PoseSeq\nname: moving\ntargetBody: r\nrefs:\n";
  for (Eigen::Index k = 0; k < motion.rows(); ++k) {
    std::string ids, angles;
    for (size_t j = 0; j < motion.joints.size(); ++j) {
      ids += (j > 0 ? ", " : "") + std::to_string(model.find_dof(motion.joints[j]));
      angles += (j > 0 ? ", " : "") + text::exact(motion.values(k, static_cast<Eigen::Index>(j)));
    }
    text += "  -\n    time: " + text::exact(motion.times[static_cast<size_t>(k)]) +
            "\n    refer:\n      type: Pose\n      joints: [" + ids + "]\n      q: [" + angles +
            "]\n";
  }
  return text;
}

/// The main file of the motion in a format that can be read; "" if it cannot be written here.
inline std::string file_of(const MotionFormat& format, const RobotModel& model,
                           const MotionFile& motion) {
  if (format.write) return format.write(model, motion)[0].bytes;
  if (format.name == "choreonoid-poses") return key_poses_of(model, motion);
  if (format.name == "csv") return reference_csv(table_of(model, motion), {});
  if (format.name == "json") return reference_json(table_of(model, motion), {});
  if (format.name == "hoap")
    return hoap_csv(model, table_of(model, motion), {}, written_layout(model));
  return "";
}

}  // namespace ayumi::test
