#pragma once
// VIIP: variable impedant inverted pendulum manipulation, section 4 of the paper. The commanded
// motion is that of the pendulum: a regulator chooses ref ZMP, (24) gives the vertical force, and
// the feet are placed where the pendulum will need them. docs/theory.md derives the law.

#include "ayumi/control/feedback.hpp"
#include "ayumi/control/footsteps.hpp"
#include "ayumi/control/reference_dynamics.hpp"
#include "ayumi/control/swing_foot.hpp"
#include "ayumi/control/whole_body.hpp"
#include "ayumi/motion/controller_spec.hpp"
#include "ayumi/motion/viip_goal.hpp"

namespace ayumi {

/// Dimensionless gains: rates in units of omega = sqrt(g / z), times in units of 1 / omega, lengths
/// in units of the COG height z. The names in files and on the command line are those in brackets.
/// docs/theory.md, "VIIP", explains the origin of the values.
struct ViipParams {
  double pole_ratio = 0.75;  ///< [q] second pole of the standing regulator
  /// [goal] time constant of each of the two low passes of a displacement goal.
  double goal_lag = 0.3;
  double zmp_gain = 1;         ///< [ka] short-term loop on the measured ZMP
  double velocity_leak = 3;    ///< [av] pull of the reference velocity to the measured one
  double position_leak = 1;    ///< [ax] pull of the reference COG to the measured one
  double rocking_damping = 8;  ///< [damp] damping of the robot's rocking on its soles and servos
  double zmp_filter = 0.01;    ///< [tau_z] time constant of the low pass of the measured ZMP
  double margin = 0.01;      ///< [margin] distance that is kept from the edge of the support region
  double height_rate = 1.5;  ///< [kz] sqrt(K_Pz / m) of (24) while both feet carry load
  double one_foot_rate = 1.06;  ///< [kz_one] `height_rate` while one foot carries load
  double height_damping = 1;    ///< [dz] K_Dz / (2 sqrt(m K_Pz)); (25) requires at least 1
  double momentum_share = 0.3;  ///< [moment] share of a swing's moment that the COG compensates
  double yielding = 1;       ///< [yield] share of a vertical push to which a standing robot yields
  double ankle_share = 0.5;  ///< [ankle] share of the stance foot's tilt that the ankle compensates
  double single_support = 1.7;  ///< [single] duration of a single support
  double double_support = 0.4;  ///< [both] duration of a double support
  double lift = 0.09;           ///< [lift] height to which the swing sole is lifted
  double reach = 0.5;           ///< [reach] largest distance of a foothold from the nominal one
  /// [hurry] if a foothold moves farther than this, the step is made earlier.
  double early_step_bound = 0.1;
  double least_step_time = 0.75;  ///< [soonest] smallest time that is left to such an earlier step
  /// [inside] distance of the nominal ZMP from the sole's centre towards the other foot.
  double zmp_inset = 0.05;
  double recovery = 0.5;  ///< [hold] share of a foot's error that the next step corrects
  bool feedback = true;   ///< if false, only the reference pendulum moves, as a demonstration
  bool landings = true;   ///< if false, a foot lands when its time is over, as a demonstration
};

/// The defaults, overridden first by the robot's sidecar and then by the pattern's gains. Throws
/// Error(usage) for an unknown gain or a value out of range, and Error(bad_model) if this gain is
/// in the sidecar. dz must obey (25).
ViipParams viip_params(const RobotModel& model, const ControllerSpec& spec);

/// The gains by the names that files use, in alphabetical order.
std::vector<std::pair<std::string, double>> gains_of(ViipParams params);

/// The pendulum that VIIP regulates: its state and the ZMP that its regulator requires [m], [m/s].
struct ReferencePendulum {
  Eigen::Vector2d cog, dcog, zmp;
};

/// Horizontal acceleration of the reference [m/s^2]: (14)(15) of the reference pendulum, the
/// short-term absorption of DTAD, and pulls to the measured COG and its velocity. `measured_zmp` is
/// the ZMP that the regulator requires for the measured state. `filter` receives the estimate, and
/// `terms` receives the horizontal summands.
Eigen::Vector2d viip_acceleration(const ViipParams& params, double omega, double omega2, double dt,
                                  const ReferencePendulum& reference,
                                  const Eigen::Vector2d& measured_zmp, const Estimate& estimate,
                                  ReactionFilter& filter, LawTerms& terms);

/// The acceleration that a COG at the height z [m] needs in addition to (14)(15), so that a body
/// whose angular momentum changes at the rate `momentum_rate` [N m] keeps its ZMP [m/s^2].
Eigen::Vector2d turning_acceleration(const Eigen::Vector3d& momentum_rate, double mass, double z);

/// Duration of `steps` steps, from standing to standing [s].
double stepping_time(const ViipParams& params, double omega, int steps);

/// K_Pz and K_Dz of (24) while `feet` feet carry load; a robot in the air keeps those of both feet.
HeightGains viip_height_gains(const ViipParams& params, double mass, double omega, int feet = 2);

/// The ref f_z of (24) with `gains` [N], for a COG at height z moving at dz whose goal is `goal`.
double viip_force(const HeightGains& gains, double mass, double goal, double z, double dz);

class Viip {
 public:
  /// Continues from `start`. `held` has the posture and COG that the pattern holds during the
  /// phase. Displacements start from its COG relative to the middle of its feet.
  Viip(const RobotModel& model, const ActuatorLimits& limits, const ViipParams& params, double dt,
       const Handover& start, const CommandSample& held);

  /// Sets the goal for `ticks` ticks, from the coming tick on. A step goal without a number of
  /// steps makes as many steps as fit into this time. A velocity ends after this time.
  void set_goal(const ViipGoal& goal, long ticks);

  double omega() const { return omega_; }  ///< sqrt(g / z) of the held posture [1/s]

  /// Feet, support, COG and ZMP of the coming tick.
  const CommandSample& plan() const { return plan_; }

  void update(const Estimate& estimate, ControlOutput& out);

  /// Sets the weights W = diag(weight) of (29) from now on [dof].
  void weigh(const Eigen::VectorXd& weight) { body_.weigh(weight); }

  Handover handover() const {
    return {body_.state(), body_.dcog(), body_.target(), plan_, command_};
  }

 private:
  enum class Stage { stand, weight_shift, single_support, double_support };

  Eigen::Vector3d standing_goal(const Eigen::Vector3d& displacement) const;
  Eigen::Vector3d standing_velocity(const Eigen::Vector3d& velocity) const;
  LawStage law_stage() const;
  /// The ZMP before its projection to the support [m], and its derivative with respect to the DCM
  /// [1].
  struct WantedZmp {
    Eigen::Vector2d zmp;
    double gain = 0;
  };
  WantedZmp regulate(const Eigen::Vector2d& dcm, int state) const;
  Eigen::Vector2d inside_support(const Eigen::Vector2d& zmp) const;
  void follow_velocity(const Estimate& estimate);
  CogReference cog_reference(const Estimate& estimate, LawTerms& terms);
  PlannedStep planned_step(Side stance) const;
  Footsteps new_path(const std::array<Eigen::Isometry3d, 2>& feet) const;
  void step_state_machine(const Estimate& estimate);
  void start_steps();
  void start_single_support();
  double time_to_landing() const;
  void choose_time_scale(const PlannedStep& step, const Eigen::Vector2d& dcm);
  Eigen::Vector2d landing_point(const PlannedStep& step, const Eigen::Vector2d& dcm) const;
  void move_swing_foot(const Eigen::Vector2d& dcm);
  Eigen::Vector2d landing_error(const Estimate& estimate, Side foot);
  void update_landing_bias(const Eigen::Vector2d& error);
  void finish_plan();

  const RobotModel* model_;
  ViipParams params_;
  double dt_, omega_, height_;
  double push_filter_;   // time constant of push_ [s]
  CommandPlan command_;  // command of the pattern, for the next law
  ReferenceBody body_;
  ReferenceDynamics dynamics_;
  RobotData data_;
  CommandSample held_, plan_, next_;
  // Held COG relative to the middle of the feet, in the axes of the feet [m].
  Eigen::Vector3d offset_;
  // COG displacement: the requested one, after one lag, and after two lags, which the reference
  // follows [m].
  std::array<Eigen::Vector3d, 3> displacement_ = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
                                                  Eigen::Vector3d::Zero()};
  // The goal velocity and ref v_G, with the same lags [m/s]; the displacement follows it.
  std::array<Eigen::Vector3d, 3> goal_velocity_ = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
                                                   Eigen::Vector3d::Zero()};
  StepGoal steps_;
  int steps_left_ = 0;
  long ticks_left_ = 0;
  Stage stage_ = Stage::stand;
  double elapsed_ = 0;        // time in this stage, by the clock of the stage [s]
  double time_scale_ = 1;     // rate of this clock; above 1 for a step that is made earlier
  Side anchor_ = Side::left;  // foot on which the reference stands
  double early_ = 0;  // height that the plan still has for a foot that has met the ground [m]
  Footsteps footsteps_;
  // Systematic landing error of each foot, in the axes of the foot [m].
  std::array<Eigen::Vector2d, 2> landing_bias_ = {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
  ReactionFilter filter_;  // measured ZMP
  // Measured velocity of the COG after a low pass [m/s].
  Eigen::Vector2d velocity_ = Eigen::Vector2d::Zero();
  double sag_ = 0;        // measured COG below the reference, after a low pass of 1/omega [m]
  double push_ = 0;       // vertical force of the load cells minus the reference's f_z [N]
  double lift_ = 0;       // vertical acceleration of the reference in the last tick [m/s^2]
  SwingReplan<3> swing_;  // path of the foot in the air: x, y, yaw
  // The ref ZMP inside the support, for the measured state and for the reference state: now, and at
  // the end of the last single support.
  std::array<Eigen::Vector2d, 2> zmp_, zmp_before_;
};

}  // namespace ayumi
