#pragma once
// Numbers with few digits, for people.

#include <cmath>
#include <string>

#include "ayumi/base/text.hpp"

namespace ayumi::text {

/// As brief(), but a large number has no exponent, such as "114000" for 114213 with three digits.
inline std::string significant(double value, int digits) {
  // brief() writes an exponent if the rounded value has more than `digits` digits before the point.
  double least = 1, unit = 1;  // the least number with more digits, and the unit of the last digit
  for (int i = 0; i < digits; ++i) least *= 10;
  while (std::isfinite(value) && std::abs(value) >= (least - 0.5) * unit) unit *= 10;
  if (unit == 1) return brief(value, digits);
  return fixed(std::round(value / unit) * unit, 0);
}

}  // namespace ayumi::text
