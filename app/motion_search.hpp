#pragma once
// Search for values of a generated motion that the robot can do, if the default values are too
// large for it.

#include <functional>
#include <string>
#include <vector>

#include "ayumi/motion/pattern.hpp"
#include "commands.hpp"

namespace ayumi::app {

/// One value of a motion that the user did not set, and the values that may replace it.
struct Dial {
  std::string name;  ///< as the option, e.g. "--stride"; with its unit in `unit`
  std::string unit;
  std::vector<double> values;  ///< the default first, then values farther and farther from it
  bool posture = false;        ///< changes postures, hardly speeds and torques
  /// Values in between, for where none of the list is enough; a fixed value has no such range.
  double least = 0, most = 0, step = 0;
  double stands_for = 0;  ///< what a value of 0 means

  double meant(double value) const { return value == 0 ? stands_for : value; }
};

struct SearchResult {
  bool found = false;
  std::vector<double> values;  ///< of the dials
  int tried = 0;
  std::string limit;     ///< what is wrong with the default values; "" where nothing is
  bool refused = false;  ///< the robot cannot do the default values at all
  std::string falls;     ///< how the motion found ends in a simulation; "" where the robot stands
  /// Where nothing was found: what is wrong with the motion that comes nearest to passing, of those
  /// that are checked in full; "" where there is none.
  std::string nearest;
  std::vector<double> nearest_values;  ///< of the dials
};

/// How a motion ends in a simulation with the default controller, "with dtad, the robot fell at 3.2
/// s ..."; "" where the robot stands at its end.
std::string end_in_simulation(const RobotModel& model, const Pattern& pattern);

/// Tries the values of the dials, those nearest to the defaults first, until the check accepts the
/// motion for a profile of the robot. Where none of them is enough, the search goes on from the
/// trial that comes nearest: it moves one value after the other, or two at once, and keeps what
/// comes nearer. `make` returns the pattern for values of the dials; it may throw
/// Error(bad_pattern) or Error(usage) for those that the robot cannot do. The number of trials is
/// bounded, not their time, so that the same input gives the same result. `simulated`: of the
/// motions that the check accepts, the first one in which the robot stands in a simulation is
/// taken; where it falls in all that are simulated, the first one that the check accepts.
SearchResult search_motion(const RobotModel& model, const std::vector<Dial>& dials,
                           const std::function<Pattern(const std::vector<double>&)>& make,
                           const Progress& progress = {}, bool simulated = false);

/// "--stride 0.02 m, --period 0.7 s": the values that are not the defaults.
std::string changed_values(const std::vector<Dial>& dials, const std::vector<double>& values);

/// Whether the motion can be sampled, with every posture inside its limits. False where it cannot
/// be made.
bool postures_pass(const RobotModel& model, const std::function<Pattern()>& make);

}  // namespace ayumi::app
