#pragma once
// A finding's value and its limit in words: lengths in mm, angles in degrees.

#include <Eigen/Core>

#include "ayumi/base/text.hpp"
#include "ayumi/limits/finding.hpp"

namespace ayumi {

/// "300 deg, limit 1 deg", with as many digits as show that the two differ.
inline std::string amount_text(const Finding& finding) {
  const auto quantity = [&](double value, int more_digits) -> std::string {
    if (finding.unit == "m") return text::fixed(1000 * value, 1 + more_digits) + " mm";
    if (finding.unit == "rad") return text::brief(value * 180 / EIGEN_PI, 4 + more_digits) + " deg";
    if (finding.unit == "1") return text::fixed(value, 2 + more_digits);
    return text::brief(value, 4 + more_digits) + " " + finding.unit;
  };
  // Digits beyond the usual ones. Chosen: a smaller difference is rounding of the computation.
  constexpr int kMostMoreDigits = 6;
  int more = 0;
  while (more < kMostMoreDigits && quantity(finding.worst, more) == quantity(finding.limit, more))
    ++more;
  return quantity(finding.worst, more) + ", limit " + quantity(finding.limit, more);
}

}  // namespace ayumi
