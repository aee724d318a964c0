#pragma once
// DTAD: dual-term absorption of disturbance, section 3 of the paper. The law and its derivation:
// docs/theory.md, "DTAD". The effect of each term: docs/measurements/law.md.

#include <memory>
#include <optional>

#include "ayumi/control/feedback.hpp"
#include "ayumi/control/foot_guided.hpp"
#include "ayumi/control/preview_control.hpp"
#include "ayumi/control/support_region.hpp"
#include "ayumi/control/whole_body.hpp"
#include "ayumi/motion/controller_spec.hpp"

namespace ayumi {

/// Dimensionless gains: rates in units of omega = sqrt(g / z), times in units of 1 / omega, lengths
/// in units of the COG height z. The names in files and on the command line are those in brackets.
/// docs/theory.md, "DTAD", explains the origin of the values.
struct DtadParams {
  double pole_ratio = 0.25;    ///< [q] second pole of (18)(19): K = 1 + q, D = (1 + q)/omega
  std::optional<double> k;     ///< [k] K given directly, with d; must exceed 1
  std::optional<double> d;     ///< [d] D omega given directly, with k; must be positive
  double long_term = 1;        ///< [long] share of (18)(19); with 0, ref ZMP is the commanded ZMP
  double as_printed = 0;       ///< [as_printed] with 1, D has the printed sign, as a demonstration
  double zmp_gain = 1;         ///< [ka] short-term loop on the measured ZMP; grows towards (14)
  double rocking_damping = 8;  ///< [damp] damping of the robot's rocking on its soles and servos
  double pull_rate = 1.8;      ///< [ks] pull of the reference COG to the command
  double pull_damping = 1.8;   ///< [kd] damping of that pull
  double zmp_filter = 0.01;    ///< [tau_z] time constant of the low pass of the measured ZMP
  double margin = 0.01;  ///< [margin] distance that is kept from the edge of the support region
  /// [washout] time after which a constant ZMP offset is accepted; 0 if this never happens.
  double offset_time = 6.6;
  double height_stiffness = 1.0;  ///< [kz] K_z of (20), times omega^2
  double height_damping = 2.0;    ///< [dz] D_z of (20), times omega
  double fz_gain = 0.3;           ///< [kaz] short-term loop on the measured f_z
  double ankle_share = 0.5;  ///< [ankle] share of the stance foot's tilt that the ankle compensates
  /// [conform] share of the difference between one foot's ground slope and the general slope to
  /// which its ankle yields.
  double compliance = 0.5;
  /// [momentum] moment that trunk and arms provide, as a multiple of the moment that corresponds to
  /// a wanted ZMP outside the support; 0 switches this off.
  double momentum_gain = 6;
  /// [step] share of the DCM error beyond the supports' reach that the footholds correct; 0
  /// switches this off.
  double step_share = 0;
  double time_scale_limit = 2.5;  ///< [hurry] fastest clock of a pattern with moving footholds
  bool literal = false;  ///< (14) integrated as printed, with D's sign corrected: a demonstration
  /// The method that chooses the ZMP: DTAD or a baseline.
  ControllerKind kind = ControllerKind::dtad;
  /// [effort] preview: cost of the jerk's change. Source: Q = 1 and R = 1e-6 of Kajita and others
  /// (2003), made dimensionless with their tick of 5 ms and their COG height of 0.814 m.
  double preview_effort = 5e-7;
  /// [horizon] preview: horizon of the planned ZMP [1/omega]. Source: the 1.6 s of Kajita and
  /// others (2003).
  double preview_horizon = 5.5;
  double preview_feedback = 1;  ///< [feedback] preview: share of its gains on the measured state
  double least_guide_time = 1;  ///< [soonest] foot-guided: smallest time that the DCM is given
  StepWeights steps;            ///< [place], [time], [offset], [zmp], [slowest] dcm-step

  /// Whether the plan moves with the robot in a pattern without VIIP goals.
  bool moves_footholds() const {
    return kind == ControllerKind::dcm_step || (step_share > 0 && !literal);
  }
  FootholdParams footholds() const {
    if (kind == ControllerKind::dcm_step) return {1, time_scale_limit, steps};
    return {step_share, time_scale_limit};
  }
};

/// Whether DtadParams contains the gains of the law: this is so for DTAD and the baselines.
inline bool has_dtad_gains(ControllerKind kind) {
  return kind == ControllerKind::dtad || is_baseline(kind);
}

/// The defaults, overridden first by the robot's sidecar and then by the pattern's gains. Throws
/// Error(usage) for an unknown gain or a value out of range, and Error(bad_model) if this gain is
/// in the sidecar. Also throws Error(usage) for k without d, for K <= 1 or D <= 0, and for q
/// together with k and d.
DtadParams dtad_params(const RobotModel& model, const ControllerSpec& spec);

/// The gains by their names in files; "k" and "d" are K and D omega as the law uses them.
std::vector<std::pair<std::string, double>> gains_of(DtadParams params);

/// K and D (times omega) of (18)(19) as the law uses them, including share and sign.
double long_term_k(const DtadParams& params);
double long_term_d(const DtadParams& params);

/// K and D of (18)(19), or those by which a baseline chooses the ZMP.
struct HorizontalGains {
  double K = 0;  ///< K of (18)(19) or of the baseline [1]
  double D = 0;  ///< D of (18)(19) or of the baseline [s]
};

/// DTAD, and the baselines, which choose the ZMP in another way for the same body.
class Dtad {
 public:
  /// Starts at rest in the posture of the command, which the servos hold with `target` [rad].
  /// `torque_lead` has the offsets of the servo targets for each sample of the pattern [rad]; a
  /// single column applies to all samples (control/torque_feedforward).
  Dtad(const RobotModel& model, const ActuatorLimits& limits, const DtadParams& params,
       CommandPlan command, std::shared_ptr<const Eigen::MatrixXd> torque_lead,
       const Eigen::VectorXd& target);

  /// Continues after another law.
  void take_over(const Handover& handover);

  /// The command of the coming tick.
  const CommandSample& plan() const { return command_.now(); }

  void update(const Estimate& estimate, ControlOutput& out);

  Handover handover() const {
    return {body_.state(), body_.dcog(), body_.target(), plan(), command_};
  }

 private:
  HorizontalGains horizontal_gains(double omega) const;
  CogReference cog_reference(const Estimate& estimate, LawTerms& terms);
  Eigen::Vector2d zmp_gap(const Eigen::Vector2d& ref_zmp, double omega, double z);
  void turn_upper_body(double omega);
  bool in_flight(const Estimate& estimate);
  void fly(const Estimate& estimate, const CommandSample& next, ControlOutput& out);

  const RobotModel* model_;
  DtadParams params_;
  CommandPlan command_;
  std::shared_ptr<const Eigen::MatrixXd> torque_lead_;
  ReferenceBody body_;
  AngularMomentumTask momentum_;
  std::optional<PreviewControl> preview_;  // for the baseline `preview` only
  CogMotion previewed_;                    // COG motion of the preview control in this tick
  std::optional<FootGuided> guide_;
  SupportRegion region_;
  Eigen::VectorXd offsets_;  // offsets of the servo targets for ankles and torque [rad]
  Side anchor_ = Side::left;
  ReactionFilter filter_;                             // measured ZMP and f_z
  Eigen::Vector2d offset_ = Eigen::Vector2d::Zero();  // accepted offset of the ZMP [m]
  // // Wanted ZMP minus ref ZMP [m].
  Eigen::Vector2d outside_ = Eigen::Vector2d::Zero();
  bool first_ = true;    // no tick has been computed yet; starts from rest
  bool ended_ = false;   // the plan is at rest after its last sample
  bool flying_ = false;  // true from the planned lift-off to the landing
};

}  // namespace ayumi
