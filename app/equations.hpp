#pragma once
// The paper's equations in words, and with the numbers of one instant of a run.

#include <optional>
#include <string>
#include <vector>

#include "ayumi/sim/simulation_log.hpp"

namespace ayumi::app {

/// One instant of a run, as the equations need it.
struct RunInstant {
  const SimulationLog& log;
  double mass = 0;  ///< of the robot [kg]
  size_t k = 0;     ///< sample

  const SimulationSample& now() const { return log.samples[k]; }
  /// A gain that the run used, by its name in files; 0 where the controller has none.
  double gain(const std::string& name) const;
};

/// A number of the log and, if the equation computes it from other numbers of the log, this result.
struct LoggedValue {
  std::string name;  ///< of the log's column, as "ref.zmp.x[m]"
  double value = 0;
  std::optional<double> computed = {};
};

/// An equation at one instant of a run.
struct EquationNumbers {
  std::vector<std::string> lines;   ///< in words
  std::vector<LoggedValue> values;  ///< behind the words, unrounded
};

struct Equation {
  int number;
  std::string formula;  ///< in one line, corrected where the printed form cannot be followed
  std::string words;    ///< its meaning and its purpose
  /// The numbers of a run; null where a log does not contain them.
  EquationNumbers (*numbers)(const RunInstant&);
};

/// The equations of the paper that this program uses, by number.
const std::vector<Equation>& equations();

}  // namespace ayumi::app
