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

/// Every value has been tried as it is told. First one parameter at a time: the nearest value, from
/// nothing to four times the given one; whole numbers stay whole where one passes. Where no
/// parameter does alone, several together, each step the one that leaves least wrong. Empty: none
/// found. Values that do not even sample (a foot out of reach) do not pass. Parameters that are 0
/// are left alone.
std::vector<PassingValues> passing_parameters(const Context& context, const std::string& pattern,
                                              const PatternOptions& options,
                                              const std::vector<std::string>& tolerances);

struct PassingPace {
  std::vector<std::pair<double, double>> windows;  ///< of the pattern as it is [s]
  double factor = 0;  ///< these taking so much longer, it passes; 0: not found
  double whole = 0;   ///< all of it taking so much longer; 0: not found
  double tried = 0;   ///< up to this factor; 0: what is wrong is no matter of time
};
/// Where what is wrong is a matter of time: the segments of the pattern around it, and all of it,
/// taking longer, until the pattern passes as it is.
PassingPace passing_pace(const Context& context, const Task& input, const ConsistencyReport& check,
                         const std::vector<std::string>& tolerances);

}  // namespace ayumi::app
