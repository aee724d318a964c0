#pragma once
// A log as MCAP with JSON messages, which Foxglove opens. The numbers of every tick are in one
// topic for each group of quantities ("/state", "/measured", "/left", ...) and in /joint_states.
// /tf has the frames of all links, /robot has their surface (once), /scene has the marks of COG,
// ZMP, DCM and forces, and /events has the events. The schemas named foxglove.* are those of
// Foxglove, with only the fields that are written.

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "ayumi/io/run/log_table.hpp"

namespace ayumi {

/// A surface with a colour for each vertex, in the frame of a body.
struct ColoredMesh {
  std::vector<Eigen::Vector3f> points;   ///< vertices [m]
  std::vector<Eigen::Vector4f> colors;   ///< colour of each vertex: sRGB and alpha, from 0 to 1
  std::vector<std::uint32_t> indices{};  ///< three vertices for each triangle
};

struct McapTopic {
  std::string topic, schema;
  std::uint64_t messages = 0;
};

struct McapLog {
  std::string bytes;
  std::vector<McapTopic> topics;
};

/// `surface` has one mesh for each body, or is empty. `table` is the table of the log.
McapLog log_mcap(const RobotModel& model, const std::vector<ColoredMesh>& surface,
                 const SimulationLog& log, const LogTable& table);

}  // namespace ayumi
