#pragma once
// Whether there is a ZMP: the one rule of all pictures and curves.

#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

/// Vertical force below which pictures and curves show no ZMP [N]. Definition: it is shown as
/// 0.0 N. In flight, the force of a planned motion differs from 0 by rounding.
inline constexpr double kLeastZmpForce = 0.05;

/// Whether there is a ZMP. In flight there is none, although the sample still has the last one.
inline bool has_zmp(const SimulationSample& sample) { return sample.fz >= kLeastZmpForce; }

}  // namespace ayumi
