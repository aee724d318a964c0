#pragma once
// Times that an edit computes, in the form in which an author would write them.

#include <cmath>

namespace ayumi {

/// A time without rounding noise: 1.95 and not 1.9500000000000002. Chosen: 1 ns is far below every
/// time step.
inline double round_time(double t) { return std::round(1e9 * t) / 1e9; }

}  // namespace ayumi
