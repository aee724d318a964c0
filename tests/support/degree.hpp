#pragma once

#include <cmath>

namespace ayumi::test {

inline constexpr double kDegree = M_PI / 180;  ///< a degree [rad]

}  // namespace ayumi::test
