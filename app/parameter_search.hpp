#pragma once
// Suggestions for a pattern that cannot be repaired or not even be sampled: values of its declared
// parameters that would pass, and a slower pace that would pass.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pattern_input.hpp"

namespace ayumi::app {

struct PassingValue {
  std::string parameter;
  double given = 0, passing = 0;
};
/// Values that pass together while the other parameters keep their given values.
using PassingValues = std::vector<PassingValue>;

/// Every returned value has been tried. First, single parameters are changed to the nearest value
/// that passes, from zero to four times the given value; whole numbers stay whole if a whole number
/// passes. If no single parameter is enough, several are changed together, at each step the one
/// that leaves the smallest violation. The result is empty if nothing was found. Values with which
/// the motion cannot be sampled (a foot out of reach) do not pass. Parameters that are 0 are not
/// changed.
std::vector<PassingValues> passing_parameters(const Context& context, const std::string& pattern,
                                              const PatternOptions& options,
                                              const std::vector<std::string>& tolerances);

struct PassingPace {
  std::vector<std::pair<double, double>> windows;  ///< windows of the given pattern [s]
  /// Factor on the time of the windows with which it passes; 0 if none was found.
  double factor = 0;
  double whole = 0;  ///< factor on the time of the whole pattern; 0 if none was found
  double tried = 0;  ///< largest factor that was tried; 0 if more time does not help
};
/// How much slower the pattern must be to pass without a repair, if its findings depend on time:
/// only the segments around the findings, and the whole pattern.
PassingPace passing_pace(const Context& context, const Task& input, const ConsistencyReport& check,
                         const std::vector<std::string>& tolerances);

}  // namespace ayumi::app
