#pragma once
// The equations of the paper, in words and with the numbers of one instant of a run.

#include <optional>
#include <string>
#include <vector>

#include "ayumi/sim/simulation_log.hpp"

namespace ayumi::app {

/// One instant of a run, as the equations need it.
struct RunInstant {
  const SimulationLog& log;
  double mass = 0;  ///< mass of the robot [kg]
  size_t k = 0;     ///< index of the sample

  const SimulationSample& now() const { return log.samples[k]; }
  /// A gain that the run used, by its name in files; 0 where the controller has none.
  double gain(const std::string& name) const;
};

/// A number of the log and, if the equation computes it from other numbers of the log, the result
/// of this computation.
struct LoggedValue {
  std::string name;  ///< name of the log's column, such as "ref.zmp.x[m]"
  double value = 0;
  std::optional<double> computed = {};
};

/// An equation at one instant of a run.
struct EquationNumbers {
  std::vector<std::string> lines;   ///< text lines
  std::vector<LoggedValue> values;  ///< the values in the lines, unrounded
};

struct Equation {
  int number;
  /// The formula in one line, corrected if the printed form cannot be followed.
  std::string formula;
  std::string words;  ///< its meaning and its purpose
  /// Computes the numbers for an instant of a run; null if a log does not contain them.
  EquationNumbers (*numbers)(const RunInstant&);
};

/// The equations of the paper that this program uses, by number.
const std::vector<Equation>& equations();

}  // namespace ayumi::app
