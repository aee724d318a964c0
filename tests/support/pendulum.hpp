#pragma once
// A point mass above its ZMP, integrated in small steps: the simple model of (14)-(17).

#include <cmath>
#include <functional>

#include "ayumi/dynamics/zmp.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi::test {

/// A scalar state with its rate.
struct Motion {
  double x = 0, v = 0;
};

/// One Runge-Kutta step of x'' = f(x, x').
inline Motion step(const Motion& s, double dt, const std::function<double(const Motion&)>& f) {
  const Motion k1 = {s.v, f(s)};
  const Motion s2 = {s.x + 0.5 * dt * k1.x, s.v + 0.5 * dt * k1.v};
  const Motion k2 = {s2.v, f(s2)};
  const Motion s3 = {s.x + 0.5 * dt * k2.x, s.v + 0.5 * dt * k2.v};
  const Motion k3 = {s3.v, f(s3)};
  const Motion s4 = {s.x + dt * k3.x, s.v + dt * k3.v};
  const Motion k4 = {s4.v, f(s4)};
  return {s.x + dt / 6 * (k1.x + 2 * k2.x + 2 * k3.x + k4.x),
          s.v + dt / 6 * (k1.v + 2 * k2.v + 2 * k3.v + k4.v)};
}

/// (14) for a robot of the size of HOAP-1 that keeps its height: x'' for the given ZMP.
struct LevelPendulum {
  double mass = 6.5;      ///< mass of the robot [kg]
  double height = 0.225;  ///< height of the COG [m]

  double fz() const { return mass * kGravity; }
  double omega() const { return std::sqrt(omega_squared(fz(), mass, height)); }
  double acceleration(double x, double zmp) const {
    return horizontal_acceleration(omega_squared(fz(), mass, height), {x, 0}, {zmp, 0}).x();
  }
};

}  // namespace ayumi::test
