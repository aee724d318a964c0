#pragma once
// For a pattern that cannot be repaired, or not even be sampled: which values of its declared
// parameters would pass, and how much slower it would.

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
/// Values that pass together, the other parameters as given.
using PassingValues = std::vector<PassingValue>;

/// Every value has been tried as it is returned. First one parameter at a time: the nearest value,
/// from nothing to four times the given one; whole numbers stay whole where one passes. Where no
/// parameter does alone, several together, each step the one that leaves least wrong. Empty: none
/// found. Values that do not even sample (a foot out of reach) do not pass. Parameters that are 0
/// are left alone.
std::vector<PassingValues> passing_parameters(const Context& context, const std::string& pattern,
                                              const PatternOptions& options,
                                              const std::vector<std::string>& tolerances);

struct PassingPace {
  std::vector<std::pair<double, double>> windows;  ///< of the pattern before [s]
  double factor = 0;  ///< on the time of the windows, with which the pattern passes; 0: not found
  double whole = 0;   ///< on the time of the whole pattern; 0: not found
  double tried = 0;   ///< largest factor tried; 0: more time does not help
};
/// How much slower the pattern passes without a repair, where its findings are a matter of time:
/// the segments around the findings alone, and the whole pattern.
PassingPace passing_pace(const Context& context, const Task& input, const ConsistencyReport& check,
                         const std::vector<std::string>& tolerances);

}  // namespace ayumi::app
