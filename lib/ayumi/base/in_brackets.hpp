#pragma once
// Puts the place and the time of a figure into words.

#include <string>

#include "ayumi/base/text.hpp"

namespace ayumi {

/// A text such as " (l_knee at 1.20 s)", which follows the largest value of a figure. Without a
/// place, it is " (at 1.20 s)".
inline std::string in_brackets(const std::string& place, double at) {
  return " (" + place + (place.empty() ? "" : " ") + "at " + text::fixed(at, 2) + " s)";
}

}  // namespace ayumi
