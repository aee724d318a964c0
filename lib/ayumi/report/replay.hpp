#pragma once
// The data of a report's replay and of the live page for authoring: the robot with its motions, the
// quantities of a motion as a table, and the data about both that the script needs.

#include <string>
#include <vector>

#include "ayumi/render/robot_surface.hpp"
#include "ayumi/report/report.hpp"

namespace ayumi {

struct ReplayPlan {
  double rate = 50;           ///< rate of the rows [Hz]
  size_t triangles = 60'000;  ///< largest number of triangles of the robot
};

struct ReplayData {
  std::string model;    ///< bytes of a .glb with the run and then its ghosts
  std::string series;   ///< rows of 32-bit floats, little-endian
  std::string scenery;  ///< corners of triangles: place and colour, as 32-bit floats
  std::string config;   ///< configuration as JSON
  std::vector<std::string> ghosts;
  double duration = 0, start = 0;  ///< duration and beginning of the replay [s]
};

ReplayData make_replay(const RobotModel& model, const RobotLook& look, const ReportInput& input,
                       const ReplayPlan& plan);

/// The robot for the live page, which places the bodies itself by rows of a table. Returns the
/// bytes of a .glb of the robot in the first posture of the log, with at most this many triangles.
std::string live_model(const RobotModel& model, const SimulationLog& log, size_t triangles);

/// JSON with the names of the table's columns, the tree of the bodies, and the soles, pushes and
/// world of the log. `surface` is the robot's. The columns are those of the report's replay, then
/// the pose of the base ("base."), and the angle ("q."), rate ("dq.") and torque ("tau.") of every
/// joint.
std::string live_config(const RobotModel& model, const std::vector<BodySurface>& surface,
                        const SimulationLog& log, double rate);

/// The table: one row of 32-bit floats, little-endian, every 1/rate seconds, and one row at the
/// end.
std::string live_series(const SimulationLog& log, double rate);

/// The triangles of the ground in the form of ReplayData::scenery.
std::string live_scenery(const World& world);

}  // namespace ayumi
