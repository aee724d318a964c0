#pragma once
// DTAD: dual-term absorption of disturbance, section 3 of the paper. The law, its derivation and
// what each term is worth: docs/theory.md.

#include <optional>
#include <string>
#include <vector>

#include "ayumi/control/reference_body.hpp"
#include "ayumi/control/support.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

/// Dimensionless gains: rates in units of omega = sqrt(g / z), lengths in units of the COG height
/// z.
struct DtadParams {
  double q = 0.25;          ///< second pole of (18)(19): K = 1 + q, D = (1 + q)/omega
  std::optional<double> k;  ///< K given directly, with d; must exceed 1
  std::optional<double> d;  ///< D omega given directly, with k; must be positive
  double long_term = 1;     ///< share of the long-term term; 0: ref ZMP is the commanded one
  double as_printed = 0;    ///< 1: D of (18)(19) with the printed sign, a demonstration
  double ka = 2.5;          ///< short-term loop on the measured ZMP; grows towards (14)
  double ks = 2;            ///< pull of the reference COG to the command
  double kd = 2;            ///< damping of that pull
  double tau_z = 0.066;     ///< low-pass of the measured ZMP, times 1/omega
  double margin = 0.01;     ///< kept inside the support polygon, times z
  double washout = 6.6;     ///< forgetting of a constant ZMP offset, times 1/omega; 0: off
  double kz = 1.0;          ///< K_z of (20), times omega^2
  double dz = 2.0;          ///< D_z of (20), times omega
  double kaz = 0.3;         ///< short-term loop on the measured f_z
  double ankle = 0.5;       ///< share of the stance foot's measured tilt taken back at the ankle
  double conform = 0.5;     ///< share of one foot's slope against the ground's that its ankle takes
  double trunk = 1;      ///< turn of the trunk where the ZMP wanted is outside the support; 0: off
  double step = 0;       ///< share of what the supports leave over that footholds take; 0: off
  double hurry = 2.5;    ///< fastest clock of a pattern whose footholds move
  bool literal = false;  ///< (14) integrated as printed, D sign corrected: a demonstration
};

/// Defaults, then the robot's sidecar, then the pattern's gains. Throws Error(usage) naming an
/// unknown gain, K <= 1 or D <= 0, q together with k and d, or a value out of range.
DtadParams dtad_params(const RobotModel& model, const ControllerSpec& spec);

/// K and D (times omega) of (18)(19) as the law uses them, share and sign put in.
double long_term_k(const DtadParams& params);
double long_term_d(const DtadParams& params);

class Dtad {
 public:
  /// Starts at rest in the posture of `first`, which the servos hold with `target` [rad].
  Dtad(const RobotModel& model, const ActuatorLimits& limits, const DtadParams& params, double dt,
       const CommandSample& first, const Eigen::VectorXd& target);

  /// Goes on from what another law left; `plan` is the first command.
  void take_over(const Handover& handover, const CommandSample& plan);

  /// One tick: command now and one tick later, what is measured, and by how much the servos would
  /// sag under the command (servo_sag()).
  void update(const CommandSample& command, const CommandSample& next, const Estimate& estimate,
              const Eigen::Ref<const Eigen::VectorXd>& sag, ControlOutput& out);

  const ReferenceBody& body() const { return body_; }

 private:
  CogReference cog_reference(const CommandSample& command, const Estimate& estimate);
  void lean_trunk(double omega, double z);

  const RobotModel* model_;
  DtadParams params_;
  double dt_;
  ReferenceBody body_;
  SupportRegion region_;
  Eigen::VectorXd offsets_;  // of the servo targets: ankles and sag [rad]
  Side anchor_ = Side::left;
  Eigen::Vector2d zmp_filtered_ = Eigen::Vector2d::Zero();  // z-hat [m]
  Eigen::Vector2d offset_ = Eigen::Vector2d::Zero();        // washed-out offset z-hat_d [m]
  double fz_filtered_ = 0;                                  // [N]
  Eigen::Vector2d outside_ = Eigen::Vector2d::Zero();       // ZMP wanted less the one asked for [m]
  Eigen::Vector3d lean_ = Eigen::Vector3d::Zero();          // of the trunk [rad]
  Eigen::Vector3d lean_rate_ = Eigen::Vector3d::Zero();     // [rad/s]
  bool first_ = true;                                       // no tick yet, from rest
};

}  // namespace ayumi
