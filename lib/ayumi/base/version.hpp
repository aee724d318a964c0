#pragma once

namespace ayumi {

/// Version of the library and the command, "major.minor.patch".
const char* version();

/// Standard gravity [m/s^2], written into every file Ayumi produces.
inline constexpr double kGravity = 9.80665;

}  // namespace ayumi
