#pragma once
// Numbers with few digits, for people.

#include <cmath>
#include <string>

#include "ayumi/base/text.hpp"

namespace ayumi::text {

/// As brief(), but a large number has no exponent, such as "114000" for 114213 with three digits.
inline std::string significant(double value, int digits) {
  // brief() writes an exponent if the rounded value has more than `digits` digits before the point.
  if (!(std::abs(value) >= std::pow(10, digits) - 0.5)) return brief(value, digits);
  if (!std::isfinite(value)) return brief(value, digits);
  const double unit = std::pow(10, std::floor(std::log10(std::abs(value))) + 1 - digits);
  return fixed(std::round(value / unit) * unit, 0);
}

}  // namespace ayumi::text
