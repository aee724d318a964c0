#pragma once
// A picture of the influences in a study of many runs. For every uncertain value it shows the rank
// correlation with the severity of the run, and the failure rates in the two halves of its range.

#include <string>
#include <vector>

#include "ayumi/plot/drawing.hpp"
#include "ayumi/study/certify.hpp"

namespace ayumi {

/// Draws the values in the order of their correlation, the strongest first. Throws Error(usage) if
/// there is no value.
Drawing draw_influences(const std::string& title, const std::vector<ValueInfluence>& influences);

}  // namespace ayumi
