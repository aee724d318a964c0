#pragma once
// Seeded random numbers that are the same on every platform.

#include <cmath>
#include <cstdint>

#include "ayumi/math/elementary.hpp"

namespace ayumi {

/// SplitMix64 with uniform and normal deviates.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ull);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
  }
  /// A number in [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }
  /// A number with mean 0 and standard deviation 1, by Box-Muller, of which only one number of each
  /// pair is used.
  double normal() {
    const double radius = std::sqrt(-2.0 * elementary::log(1.0 - uniform()));
    return radius * elementary::cos(2.0 * M_PI * uniform());
  }
  /// Gives the same numbers as `count` calls of normal(), in less time.
  void normals(double* out, int count);

 private:
  std::uint64_t state_;
};

}  // namespace ayumi
