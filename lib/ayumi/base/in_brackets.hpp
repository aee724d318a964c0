#pragma once
// The place and the time of a figure, in words.

#include <string>

#include "ayumi/base/text.hpp"

namespace ayumi {

/// " (l_knee at 1.20 s)", which follows the largest value of a figure. Without a place:
/// " (at 1.20 s)".
inline std::string in_brackets(const std::string& place, double at) {
  return " (" + place + (place.empty() ? "" : " ") + "at " + text::fixed(at, 2) + " s)";
}

}  // namespace ayumi
