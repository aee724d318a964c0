#pragma once
// The data of a report's replay and of the live page for authoring: the robot with its motions, the
// quantities of a motion as a table, and the data about both that the script needs.

#include <string>

#include "ayumi/report/report.hpp"

namespace ayumi {

struct ReplayPlan {
  double rate = 50;           ///< [Hz]
  size_t triangles = 60'000;  ///< largest number of triangles of the robot
};

struct ReplayData {
  std::string model;    ///< bytes of a .glb: the run, then its ghosts
  std::string series;   ///< rows of 32-bit floats, little-endian
  std::string scenery;  ///< corners of triangles: place and colour, 32-bit floats
  std::string config;   ///< JSON
  std::vector<std::string> ghosts;
  double duration = 0, start = 0;  ///< [s]
};

ReplayData make_replay(const RobotModel& model, const RobotLook& look, const ReportInput& input,
                       const ReplayPlan& plan);

/// The live page places the bodies itself, by rows of a table: bytes of a .glb of the robot in the
/// first posture of the log, with at most that many triangles.
std::string live_model(const RobotModel& model, const SimulationLog& log, size_t triangles);

/// JSON: names of the table's columns, how the bodies hang together, soles, pushes and world of the
/// log. The columns are those of the report's replay, then the pose of the base, and angle, rate
/// and torque of every joint; "base." and "q.", "dq.", "tau." begin their names.
std::string live_config(const RobotModel& model, const SimulationLog& log, double rate);

/// The table: one row of 32-bit floats, little-endian, for each 1/rate seconds, and one at the end.
std::string live_series(const SimulationLog& log, double rate);

/// As ReplayData::scenery.
std::string live_scenery(const World& world);

}  // namespace ayumi
