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
/// Where the values come from: docs/theory.md, "DTAD".
struct DtadParams {
  double pole_ratio = 0.25;    ///< [q] second pole of (18)(19): K = 1 + q, D = (1 + q)/omega
  std::optional<double> k;     ///< [k] K given directly, with d; must exceed 1
  std::optional<double> d;     ///< [d] D omega given directly, with k; must be positive
  double long_term = 1;        ///< [long] share of (18)(19); 0: ref ZMP is the commanded one
  double as_printed = 0;       ///< [as_printed] 1: D with the printed sign, a demonstration
  double zmp_gain = 1;         ///< [ka] short-term loop on the measured ZMP; grows towards (14)
  double rocking_damping = 8;  ///< [damp] of the robot's rocking on its soles and servos
  double pull_rate = 1.8;      ///< [ks] pull of the reference COG to the command
  double pull_damping = 1.8;   ///< [kd] damping of that pull
  double zmp_filter = 0.01;    ///< [tau_z] low pass of the measured ZMP
  double margin = 0.01;        ///< [margin] kept inside the support region
  double offset_time = 6.6;  ///< [washout] after which a constant ZMP offset is accepted; 0: never
  double height_stiffness = 1.0;  ///< [kz] K_z of (20), times omega^2
  double height_damping = 2.0;    ///< [dz] D_z of (20), times omega
  double fz_gain = 0.3;           ///< [kaz] short-term loop on the measured f_z
  double ankle_share = 0.5;  ///< [ankle] share of the stance foot's tilt turned back at the ankle
  double compliance = 0.5;   ///< [conform] share of one foot's ground slope against the ground at
                             ///< large that its ankle gives in to
  double momentum_gain = 6;  ///< [momentum] moment that trunk and arms take up, as a multiple of
                             ///< the one that a ZMP wanted outside the support stands for; 0: off
  double step_share = 0;     ///< [step] of the error the supports leave over, answered by
                             ///< footholds; 0: off
  double time_scale_limit = 2.5;  ///< [hurry] fastest clock of a pattern whose footholds move
  bool literal = false;           ///< (14) integrated as printed, D sign corrected: a demonstration
  ControllerKind kind = ControllerKind::dtad;  ///< that chooses the ZMP: DTAD or a baseline
  /// [effort] preview: cost of the jerk's change. Source: Q = 1, R = 1e-6 of Kajita and others
  /// (2003), with their tick of 5 ms and COG height of 0.814 m made dimensionless.
  double preview_effort = 5e-7;
  double preview_horizon = 5.5;  ///< [horizon] preview: of the planned ZMP; theirs, 1.6 s
  double preview_feedback = 1;   ///< [feedback] preview: share of its gains on the measured state
  double least_guide_time = 1;   ///< [soonest] foot-guided: least time that the DCM is given
  StepWeights steps;             ///< [place], [time], [offset], [zmp], [slowest] dcm-step

  /// Whether the plan moves with the robot, in a pattern without VIIP goals.
  bool moves_footholds() const {
    return kind == ControllerKind::dcm_step || (step_share > 0 && !literal);
  }
  FootholdParams footholds() const {
    if (kind == ControllerKind::dcm_step) return {1, time_scale_limit, steps};
    return {step_share, time_scale_limit};
  }
};

/// Whether the gains of the law are in DtadParams: those of DTAD and of the baselines.
inline bool has_dtad_gains(ControllerKind kind) {
  return kind == ControllerKind::dtad || is_baseline(kind);
}

/// Defaults, then the robot's sidecar, then the pattern's gains. Throws Error(usage) naming an
/// unknown gain, K <= 1 or D <= 0, q together with k and d, or a value out of range.
DtadParams dtad_params(const RobotModel& model, const ControllerSpec& spec);

/// Its gains by the names of files; K and D omega as the law uses them are "k" and "d".
std::vector<std::pair<std::string, double>> gains_of(DtadParams params);

/// K and D (times omega) of (18)(19) as the law uses them, share and sign put in.
double long_term_k(const DtadParams& params);
double long_term_d(const DtadParams& params);

/// K and D of (18)(19), and those by which a baseline chooses the ZMP.
struct HorizontalGains {
  double K = 0;  ///< [1]
  double D = 0;  ///< [s]
};

/// DTAD, and the baselines, which choose the ZMP in another way for the same body.
class Dtad {
 public:
  /// Starts at rest in the posture of the command, which the servos hold with `target` [rad].
  /// `torque_lead`: offsets of the servo targets by sample of the pattern [rad], one column:
  /// throughout (control/torque_feedforward).
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
  std::optional<PreviewControl> preview_;  // of the baselines of these names
  CogMotion previewed_;                    // by preview_, in this tick
  std::optional<FootGuided> guide_;
  SupportRegion region_;
  Eigen::VectorXd offsets_;  // of the servo targets: ankles and torque [rad]
  Side anchor_ = Side::left;
  ReactionFilter filter_;                              // measured ZMP and f_z
  Eigen::Vector2d offset_ = Eigen::Vector2d::Zero();   // accepted offset of the ZMP [m]
  Eigen::Vector2d outside_ = Eigen::Vector2d::Zero();  // ZMP wanted less the one asked for [m]
  bool first_ = true;                                  // no tick yet, from rest
  bool ended_ = false;                                 // the plan is at rest behind its last sample
  bool flying_ = false;                                // from the planned lift-off to the landing
};

}  // namespace ayumi
