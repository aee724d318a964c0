#pragma once
// A value and its limit in words and in units for people: lengths in mm, angles in degrees.

#include <cmath>
#include <numbers>
#include <string>

#include "ayumi/base/significant.hpp"
#include "ayumi/base/text.hpp"

namespace ayumi {

/// A unit for people: a value multiplied by `scale` is a value in the unit `name`.
struct ShownUnit {
  double scale = 1;
  std::string name;
};

/// Shows "rad/s" as "deg/s" if angles are in degrees; other units are not changed.
inline ShownUnit shown_unit(const std::string& unit, bool degrees) {
  if (degrees && unit.starts_with("rad")) return {180 / std::numbers::pi, "deg" + unit.substr(3)};
  return {1, unit};
}

/// The value and the limit, such as "300 deg, limit 1 deg", with as many digits as are needed to
/// see the difference. Both numbers are in `unit`; angles are shown in degrees if `in_degrees`.
inline std::string amount_text(double worst, double limit, const std::string& unit,
                               bool in_degrees) {
  const ShownUnit shown = shown_unit(unit, in_degrees);
  // From this value on, three digits are enough. Chosen: only accelerations are so large.
  constexpr double kLarge = 9999.5;
  const auto quantity = [&](double value, int more_digits) -> std::string {
    if (unit == "m") return text::fixed(1000 * value, 1 + more_digits) + " mm";
    if (unit == "1") return text::fixed(100 * value, more_digits) + " %";
    const double number = value * shown.scale;
    const int digits = std::abs(number) < kLarge ? 4 : 3;
    return text::significant(number, digits + more_digits) + " " + shown.name;
  };
  // Largest number of additional digits. Chosen: a smaller difference is rounding of the
  // computation.
  constexpr int kMostMoreDigits = 6;
  int more = 0;
  while (more < kMostMoreDigits && quantity(worst, more) == quantity(limit, more)) ++more;
  return quantity(worst, more) + ", limit " + quantity(limit, more);
}

}  // namespace ayumi
