#pragma once
// The jump of VIIP, section 4.1 of the paper: stoop, (24)(25); push, (26); flight; absorb, (27);
// settle, (24)(25). docs/theory_flight.md has the law and the closed forms.

#include "ayumi/control/laws/viip.hpp"

namespace ayumi {

/// The effect of a jump by (26) on a point mass [m], [m/s], [s]; heights are above ref z_G.
struct JumpFigures {
  /// z_H if released at ref z_G; z_H + z_d^2/(4 z_H) if the push lasts until f_z = 0.
  double apex = 0;
  /// Height at lift-off: 0 with a release at ref z_G, otherwise z_d^2/(2 z_H).
  double lift_off = 0;
  double lift_off_speed = 0;    ///< speed at lift-off, upwards
  double touchdown_speed = 0;   ///< speed at touchdown, downwards, at ref z_G
  double push = 0, flight = 0;  ///< durations of push and flight
};
JumpFigures jump_figures(const JumpGoal& goal);

class ViipJump {
 public:
  /// Continues from `start`. `held` has the posture that the pattern holds during the phase. The
  /// height of its COG is ref z_G. Throws Error(bad_pattern) for a jump that is not possible.
  ViipJump(const RobotModel& model, const ActuatorLimits& limits, const ViipParams& params,
           double dt, const Handover& start, const CommandSample& held, const JumpGoal& goal);

  /// Feet, support, COG and ZMP of the coming tick.
  const CommandSample& plan() const { return plan_; }

  void update(const Estimate& estimate, ControlOutput& out);

  /// Sets the weights W = diag(weight) of (29) from now on [dof].
  void weigh(const Eigen::VectorXd& weight) { weight_ = weight; }

  Handover handover() const { return {reference_, dcog_, target_, plan_, command_}; }

 private:
  enum class Stage { stoop, push, flight, landing, settle };

  // The values of one flight, from its release on.
  struct Flight {
    Eigen::Vector3d cog = Eigen::Vector3d::Zero(), velocity = Eigen::Vector3d::Zero();
    Eigen::Vector3d momentum = Eigen::Vector3d::Zero();  // angular momentum about the COG [N m s]
    std::array<Eigen::Vector3d, 2> feet, landing;        // place relative to the COG [m]
    double duration = 0;                                 // time to the expected touchdown [s]
    double touchdown_speed = 0;  // expected touchdown speed, downwards [m/s]
    double rise = 0,
           hold = 0;        // rise and hold of the rate of retraction before the touchdown [s]
    double retraction = 0;  // retraction of the legs before the touchdown [m]
  };

  void enter(Stage stage);
  LawStage law_stage() const;
  CogReference cog_reference(const Estimate& estimate, LawTerms& terms);
  double vertical_force(LawTerms& terms) const;
  double progress() const;
  bool leaves_now();
  double lean() const;
  void stand(const Estimate& estimate, ControlOutput& out);
  Resolution resolve_standing(const Eigen::Vector3d& trunk_rate, double level) const;
  Resolution resolve_with_momentum(double share);
  void release();
  void fly(const Estimate& estimate, ControlOutput& out);
  double retraction(double t) const;
  Eigen::Vector3d foot_position(int side, double t) const;
  void measure_speed(const Estimate& estimate);
  void touch_down(const Estimate& estimate);
  Eigen::VectorXd torque(const Eigen::VectorXd& velocity);
  void move_joints(const Eigen::VectorXd& velocity, ControlOutput& out);
  void finish_plan();

  const RobotModel* model_;
  ActuatorLimits limits_;
  ViipParams params_;
  double dt_;
  JumpGoal goal_;
  double height_, omega_;  // ref z_G above the ground, sqrt(g / z)
  CommandPlan command_;    // command of the pattern, for the next law
  CommandSample held_, plan_;
  Eigen::Vector2d offset_;  // held COG relative to the middle of the feet [m]
  mutable RobotData data_;
  Eigen::VectorXd weight_, lead_, target_;
  RobotState reference_;
  Side anchor_ = Side::left;
  Eigen::Vector3d dcog_ = Eigen::Vector3d::Zero();
  ReactionFilter filter_;  // measured ZMP
  Eigen::Vector2d zmp_;    // ref ZMP [m]
  Stage stage_ = Stage::stoop;
  double elapsed_ = 0;        // time in this stage [s]
  double unloaded_ = 0;       // time without ground force at the end of a spring push [s]
  double loaded_ = 0;         // time with ground force at the end of a flight [s]
  double speed_ = 0;          // measured vertical velocity of the COG [m/s]
  double speed_before_ = 0;   // this velocity when the feet carried no load for the last time [m/s]
  double forward_ = 0;        // share of the torque that is fed forward, 0 to 1
  Eigen::VectorXd velocity_;  // generalised velocity of the last tick; empty after an impact
  int left_ = 1;              // number of remaining jumps, including this one
  double from_ = 0;           // COG height at which the stage began [m]
  double stiffness_ = 0;      // K_Pz / m of (26) or (27) [1/s^2]
  double depth_ = 0;          // depth of the push or of the landing [m]
  Eigen::Vector3d momentum_ = Eigen::Vector3d::Zero();  // angular momentum of the reference [N m s]
  Eigen::Vector3d momentum_rate_ =
      Eigen::Vector3d::Zero();  // rate of momentum_ on the ground [N m]
  Flight flight_;
};

}  // namespace ayumi
