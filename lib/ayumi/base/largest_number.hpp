#pragma once
// The bound of all numbers that people write.

namespace ayumi {

/// Largest size of a number in a pattern, of a gain, and of what a plant receives, in SI units.
/// Chosen: no robot or world needs a larger number, and its square is finite.
inline constexpr double kLargestNumber = 1e6;

}  // namespace ayumi
