#pragma once
// What a report's replay is made of: the robot with its motions, the run's quantities as a table,
// and what the script has to know of them.

#include <string>

#include "ayumi/report/report.hpp"

namespace ayumi {

struct ReplayPlan {
  double rate = 50;           ///< [Hz]
  size_t triangles = 60'000;  ///< at most, of the robot
};

struct ReplayData {
  std::string model;    ///< bytes of a .glb: the run, then its ghosts
  std::string series;   ///< rows of 32-bit floats, little-endian
  std::string scenery;  ///< corners of triangles: place and colour, 32-bit floats
  std::string config;   ///< JSON
  std::vector<std::string> ghosts;
  double duration = 0, start = 0;  ///< [s]
};

ReplayData make_replay(const RobotModel& model, const ReportInput& input, const ReplayPlan& plan);

}  // namespace ayumi
