#pragma once
// A log as MCAP with JSON messages, which Foxglove opens. Numbers of every tick are in one topic
// per group of quantities ("/state", "/measured", "/left", ...) and in /joint_states. /tf has the
// frames of all links, /robot their surface (once), /scene the marks of COG, ZMP, DCM and forces,
// and /events what happened. The schemas named foxglove.* are those of Foxglove, as far as their
// fields are written.

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "ayumi/io/run/log_table.hpp"

namespace ayumi {

/// A surface with a colour per vertex, in the frame of a body.
struct ColoredMesh {
  std::vector<Eigen::Vector3f> points;   ///< [m]
  std::vector<Eigen::Vector4f> colors;   ///< sRGB and alpha, 0 to 1
  std::vector<std::uint32_t> indices{};  ///< three per triangle
};

struct McapTopic {
  std::string topic, schema;
  std::uint64_t messages = 0;
};

struct McapLog {
  std::string bytes;
  std::vector<McapTopic> topics;
};

/// `surface` has one mesh per body, or is empty. `table` is that of the log.
McapLog log_mcap(const RobotModel& model, const std::vector<ColoredMesh>& surface,
                 const SimulationLog& log, const LogTable& table);

}  // namespace ayumi
