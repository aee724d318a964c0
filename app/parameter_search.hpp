#pragma once
// For a pattern with declared parameters that cannot be repaired: which values would pass.

#include <string>
#include <vector>

#include "pattern_input.hpp"

namespace ayumi::app {

struct PassingValue {
  std::string parameter;
  double given = 0, passing = 0;
};

/// One parameter at a time, the others as given: the value nearest to the given one, at most half
/// of it away, with which the pattern passes the check. Parameters without such a value are left
/// out. Values that do not even sample (a foot out of reach) do not pass.
std::vector<PassingValue> passing_parameters(const Context& context, const std::string& pattern,
                                             const PatternOptions& options,
                                             const std::vector<std::string>& tolerances);

}  // namespace ayumi::app
