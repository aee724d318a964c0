#pragma once
// The paper's equations in words, and with the numbers of one instant of a run.

#include <string>
#include <vector>

#include "ayumi/control/laws/dtad.hpp"
#include "ayumi/sim/simulation_log.hpp"

namespace ayumi::app {

/// One instant of a run, as the equations need it.
struct RunInstant {
  const SimulationLog& log;
  const RobotModel& model;
  DtadParams gains;
  size_t k = 0;  ///< sample

  const SimulationSample& now() const { return log.samples[k]; }
  /// Rate of a logged point by differences over 4 ms [1/s].
  Eigen::Vector3d rate(Eigen::Vector3d SimulationSample::*point) const;
  double omega_squared() const;  ///< (17) with the reference force
};

struct Equation {
  int number;
  std::string formula;  ///< in one line, corrected where the printed form cannot be followed
  std::string words;    ///< its meaning and its purpose
  /// Lines with the numbers of a run; null where a log does not contain them.
  std::vector<std::string> (*numbers)(const RunInstant&);
};

/// The equations of the paper that this program uses, by number.
const std::vector<Equation>& equations();

}  // namespace ayumi::app
