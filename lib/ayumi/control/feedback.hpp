#pragma once
// The feedback law of DTAD and VIIP, (18)-(21) and (24)-(27) of the paper, one function per
// equation. The laws put these functions together (control/laws); (14)-(17) are in dynamics/zmp.
// Derivations: docs/theory.md, "DTAD" and "VIIP".

#include "ayumi/control/estimator.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

/// The error of the COG (21): the command minus the measurement.
struct CogError {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< error of the position [m]
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< error of the velocity [m/s]
};
CogError cog_error(const CommandSample& command, const Estimate& estimate);

/// (18)(19), long-term absorption: the ref ZMP before it is projected into the support region [m].
/// The sign of D is corrected (docs/notation.md). K is greater than 1 and has no unit; D is greater
/// than 0 [s].
Eigen::Vector2d long_term_zmp(const Eigen::Vector2d& command_zmp, double K, double D,
                              const CogError& error);

/// (18)(19) with the poles -omega and -q omega, K = 1 + q and D = (1 + q)/omega, about a goal at
/// rest: only the divergent component `dcm` is fed back [m].
inline Eigen::Vector2d regulating_zmp(const Eigen::Vector2d& goal, double q,
                                      const Eigen::Vector2d& dcm) {
  return goal + (1 + q) * (dcm - goal);
}

/// (20), long-term absorption: the ref f_z before it is bounded [N]. The unit of K_z is 1/s^2, that
/// of D_z is 1/s.
double long_term_force(double command_fz, double mass, double K_z, double D_z,
                       const CogError& error);

/// The admissible vertical force that is nearest to `fz` [N]. It is at least 10 % of the weight, so
/// that the feet stay on the ground.
double admissible_force(double fz, double mass);

/// Short-term absorption: (14)(15) closed by the measured ZMP. `gap` is the measured ZMP minus ref
/// ZMP [m]. The ground gives the acceleration omega^2 (x - measured), while ref ZMP requires
/// omega^2 (x - ref). The difference is the acceleration that the reference lacks. The result is
/// `gain` times this difference [m/s^2]. With a gain of 0, the reference is played unchanged; with
/// a large gain, the motion approaches (14).
inline Eigen::Vector2d short_term_acceleration(double gain, double omega2,
                                               const Eigen::Vector2d& gap) {
  return gain * omega2 * gap;
}

/// Damping of the rocking of the robot on its soft soles and servos [m/s^2]. The reference follows
/// the measured velocity of the COG with the rate gain * omega and a bounded acceleration.
/// `estimate.dcog - reference_dcog` is its distance from this velocity [m/s]. z is the height of
/// the COG [m]. docs/theory.md, "Late sensors".
Eigen::Vector2d rocking_acceleration(double gain, double omega, double z,
                                     const Eigen::Vector3d& reference_dcog,
                                     const Estimate& estimate);

/// The rocking_acceleration() that remains if the wanted ZMP is outside the support by the vector
/// `missing` [m]. The part along this vector moves the ZMP back from the edge, so its bound falls
/// to zero with the distance. K is that of (18), and z the height of the COG [m].
Eigen::Vector2d without_part_against(const Eigen::Vector2d& missing, const Eigen::Vector2d& rocking,
                                     double K, double omega, double z);

/// Stiffness and damping of the vertical force. They are forces per metre, or per metre and unit of
/// mass if the caller multiplies by the mass.
struct HeightGains {
  double stiffness = 0;  ///< K_Pz [N/m]
  double damping = 0;    ///< K_Dz [N s/m]
};

/// (24): the ref f_z [N] for a COG at height z [m] with speed dz [m/s] that should come to rest at
/// the height `goal` [m]. `weight` is that of the robot [N].
inline double height_force(const HeightGains& gains, double weight, double goal, double z,
                           double dz) {
  return gains.stiffness * (goal - z) - gains.damping * dz + weight;
}

/// (26): K_Pz / m [1/s^2] of a push that starts from rest at depth z_d [m] and leads to an apex z_H
/// [m].
double push_stiffness(double z_H, double z_d);

/// (27): K_Pz / m [1/s^2] of a landing at `speed` [m/s] that sinks by z_d [m].
double landing_stiffness(double speed, double z_d);

/// The share of a new value that a first-order low pass with time constant tau / omega takes over
/// in one tick of dt [s].
double low_pass_share(double dt, double omega, double tau);

/// The measured ZMP [m] and vertical force [N] after a first-order low pass. They keep their values
/// while there is no contact.
class ReactionFilter {
 public:
  ReactionFilter() = default;
  ReactionFilter(const Eigen::Vector2d& zmp, double fz) : zmp_(zmp), fz_(fz) {}

  void update(const Estimate& estimate, double share) {
    if (!estimate.contact) return;
    zmp_ += share * (estimate.zmp.head<2>() - zmp_);
    fz_ += share * (estimate.fz - fz_);
  }
  const Eigen::Vector2d& zmp() const { return zmp_; }
  double fz() const { return fz_; }

 private:
  Eigen::Vector2d zmp_ = Eigen::Vector2d::Zero();
  double fz_ = 0;
};

}  // namespace ayumi
