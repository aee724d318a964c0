#include "ayumi/sim/servo.hpp"

#include <algorithm>
#include <cmath>

namespace ayumi {

double available_torque(const ActuatorLimits& limits, int dof, double rate, double direction) {
  const double peak = limits.peak_torque[dof];
  const double speed = limits.speed[dof];
  if (rate * direction <= speed || !std::isfinite(speed)) return peak;
  // 1 at the speed limit, 0 at 1.1 times the speed limit.
  return peak * std::clamp(11.0 - 10.0 * rate * direction / speed, 0.0, 1.0);
}

}  // namespace ayumi
