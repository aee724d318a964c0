#pragma once
// Bounds of what a caller may choose. They are declared beside the option that they limit, so that
// the command line, Python and C++ use the same bounds.

#include <string>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"

namespace ayumi {

/// The values that a quantity may have, both ends included.
struct Bounds {
  double least = 0, most = 0;
  const char* unit = "";  ///< unit in messages; "" for a number without one
};

/// Throws Error(usage) such as "the ramp is nan s; it must be from 0 to 60 s" unless `value` is
/// within the bounds. NaN is outside.
inline void require_within(const std::string& quantity, double value, const Bounds& bounds) {
  if (value >= bounds.least && value <= bounds.most) return;
  const std::string unit = *bounds.unit ? std::string(" ") + bounds.unit : "";
  fail(ErrorCode::usage, quantity + " is " + text::exact(value) + unit + "; it must be from " +
                             text::exact(bounds.least) + " to " + text::exact(bounds.most) + unit);
}

}  // namespace ayumi
