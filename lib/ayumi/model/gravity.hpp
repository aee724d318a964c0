#pragma once

namespace ayumi {

/// Standard gravity [m/s^2], written into every file that Ayumi produces.
/// Source: ISO 80000-3, the value fixed by the third CGPM in 1901.
inline constexpr double kGravity = 9.80665;

}  // namespace ayumi
