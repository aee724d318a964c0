// Delta = cmd - measured. For a body that obeys (14), (18) gives
//   s^2 + omega^2 D s + omega^2 (K - 1) = 0,
// so that K > 1 and D > 0 bring the COG back. For the poles -omega and -q omega,
//   K = 1 + q,  D = (1 + q)/omega:  cmdZ - K Dx - D Ddx = cmdZ + (1 + q)(dcm - cmd dcm).
// The error grows with the printed sign, which is + D Ddx.
// In (26) and (27), a spring kappa = K_Pz/m with gravity compensated keeps dz^2/2 + kappa z^2/2
// constant, so the speed at its middle is z_d sqrt(kappa). It has to be sqrt(2 g z_H) for a push,
// and the falling speed for a landing.
#include "ayumi/control/feedback.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/math/elementary.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

namespace {

// f_min of the projection of ref f_z, as a share of the weight. Chosen: twice the 5 % below which
// there is no ZMP (control/estimator), so that omega^2 of (17) keeps a meaning. No measured case
// changes between half and twice the value (constants.md).
constexpr double kAdmissibleForceShare = 0.1;

// Largest shift of the ZMP by which the rocking of the robot on its soles is damped, as a multiple
// of z: 22 mm on HOAP-1. Chosen: enough to end the rocking that a push of 0.3 N s leaves with
// sensors that are 14 ms late (with 0.06 the rocking continues), and small compared with the soles.
// After a hard push, this damping works against the long-term absorption: without a bound, the walk
// survives 0.78 B instead of 1.08 B.
constexpr double kRockingLimit = 0.09;

// Distance of the wanted ZMP from the support at which the damping of the rocking no longer moves
// the ZMP back from the edge, as a multiple of K z (of z if K is below 1): 22 mm on HOAP-1. Chosen:
// about the shift that kRockingLimit allows (docs/theory.md, "Late sensors"). Measured: with half
// of the value, HOAP-1 with hoap1-strong survives pushes in its double support of 1.08 B and more;
// with twice, 1.14 B; with the value, 1.20 B.
constexpr double kUndampedDistance = 0.08;

}  // namespace

CogError cog_error(const CommandSample& command, const Estimate& estimate) {
  return {command.cog - estimate.cog, command.dcog - estimate.dcog};
}

Eigen::Vector2d long_term_zmp(const Eigen::Vector2d& command_zmp, double K, double D,
                              const CogError& error) {
  return command_zmp - K * error.position.head<2>() - D * error.velocity.head<2>();
}

double long_term_force(double command_fz, double mass, double K_z, double D_z,
                       const CogError& error) {
  return command_fz + mass * (K_z * error.position.z() + D_z * error.velocity.z());
}

double admissible_force(double fz, double mass) {
  return std::max(kAdmissibleForceShare * mass * kGravity, fz);
}

Eigen::Vector2d rocking_acceleration(double gain, double omega, double z,
                                     const Eigen::Vector3d& reference_dcog,
                                     const Estimate& estimate) {
  const Eigen::Vector2d asked = gain * omega * (estimate.dcog - reference_dcog).head<2>();
  const double size = asked.norm(), most = kRockingLimit * z * omega * omega;
  return size > most ? Eigen::Vector2d(most / size * asked) : asked;
}

Eigen::Vector2d without_part_against(const Eigen::Vector2d& missing, const Eigen::Vector2d& rocking,
                                     double K, double omega, double z) {
  const double distance = missing.norm();
  if (distance == 0) return rocking;
  const Eigen::Vector2d outward = missing / distance;
  const double share = std::max(0.0, 1 - distance / (kUndampedDistance * std::max(1.0, K) * z));
  const double most = share * kRockingLimit * z * omega * omega, along = outward.dot(rocking);
  return along > most ? Eigen::Vector2d(rocking + (most - along) * outward) : rocking;
}

double push_stiffness(double z_H, double z_d) { return 2 * kGravity * z_H / (z_d * z_d); }

double landing_stiffness(double speed, double z_d) { return speed * speed / (z_d * z_d); }

double low_pass_share(double dt, double omega, double tau) {
  return 1.0 - elementary::exp(-dt * omega / tau);
}

}  // namespace ayumi
