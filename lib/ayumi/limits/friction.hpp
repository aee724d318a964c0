#pragma once
// The rule of the friction cone, which torsional friction also needs.

#include "ayumi/demand/ground_demand.hpp"

namespace ayumi {

/// The share of the friction cone that a motion uses while it presses on the ground.
inline double friction_ratio(const GroundDemand& demand, double coefficient) {
  return demand.tangential_force / (coefficient * demand.normal_force);
}

}  // namespace ayumi
