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
  std::string name;  ///< name of the option, e.g. "--stride"; its unit is in `unit`
  std::string unit;
  std::vector<double> values;  ///< the default first, then values with increasing distance from it
  bool posture = false;        ///< whether it changes postures, but hardly speeds and torques
  /// The range and the step of values in between, which are tried if none of the list passes. A
  /// fixed value has no such range.
  double least = 0, most = 0, step = 0;
  double stands_for = 0;  ///< the value that is meant by 0

  double meant(double value) const { return value == 0 ? stands_for : value; }
};

struct SearchResult {
  bool found = false;
  std::vector<double> values;  ///< values of the dials
  int tried = 0;
  std::string limit;     ///< the error with the default values; "" if there is none
  bool refused = false;  ///< whether the robot cannot do the default values at all
  std::string falls;     ///< the end of the found motion in a simulation; "" if the robot stands
  /// If nothing was found: the error of the motion that is nearest to passing, among those that
  /// are checked in full; "" if there is no such motion.
  std::string nearest;
  std::vector<double> nearest_values;  ///< values of the dials of this motion
};

/// The values that a motion really has, if it does not take all values of the dials as they are.
using UsedValues = std::function<std::vector<double>(std::vector<double>)>;

/// Tries the values of the dials, those nearest to the defaults first, until the check accepts the
/// motion for a profile of the robot. If none of them passes, the search continues from the trial
/// that is nearest to passing: it moves one value after the other, then all together, and keeps
/// changes that come nearer. `make` returns the pattern for values of the dials; it may throw
/// Error(bad_pattern) or Error(usage) for values that the robot cannot do. The number of trials is
/// bounded, not their time, so that the same input gives the same result. With `simulated`, the
/// result is the first accepted motion after which the robot stands in a simulation. If it falls in
/// all simulated motions, the result is the first accepted motion. `used` gives the values that the
/// motion for values of the dials really has.
SearchResult search_motion(const RobotModel& model, const std::vector<Dial>& dials,
                           const std::function<Pattern(const std::vector<double>&)>& make,
                           const Progress& progress = {}, bool simulated = false,
                           const UsedValues& used = std::identity());

/// The values that are not the defaults, such as "--stride 0.02 m, --period 0.7 s".
std::string changed_values(const std::vector<Dial>& dials, const std::vector<double>& values);

/// Whether the motion can be sampled with every posture inside its limits. Returns false if the
/// motion cannot be made.
bool postures_pass(const RobotModel& model, const std::function<Pattern()>& make);

}  // namespace ayumi::app
