#pragma once
// The rule of the friction cone. Torsional friction needs it too.

#include "ayumi/demand/ground_demand.hpp"

namespace ayumi {

/// Share of the friction cone that a motion uses, where it presses on the ground.
inline double friction_ratio(const GroundDemand& demand, double coefficient) {
  return demand.tangential_force / (coefficient * demand.normal_force);
}

}  // namespace ayumi
