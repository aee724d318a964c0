#pragma once
// VIIP: variable impedant inverted pendulum manipulation, section 4 of the paper. The commanded
// motion is the pendulum's own: a regulator chooses ref ZMP, (24) the vertical force, the feet are
// placed where the pendulum will need them. Law and derivation: docs/theory.md.

#include "ayumi/control/footsteps.hpp"
#include "ayumi/control/reference_body.hpp"
#include "ayumi/motion/viip_goal.hpp"

namespace ayumi {

/// Dimensionless: rates in units of omega = sqrt(g / z), lengths in units of the COG height z.
struct ViipParams {
  double q = 0.75;        ///< second pole of the standing regulator
  double goal = 0.3;      ///< time constant of each of two lags of a displacement, times 1/omega
  double ka = 2;          ///< short-term loop on the measured ZMP
  double av = 3;          ///< leak of the reference velocity to the measured one
  double ax = 1;          ///< leak of the reference COG to the measured one
  double tau_z = 0.066;   ///< low-pass of the measured ZMP, times 1/omega
  double margin = 0.01;   ///< kept inside the support polygon, times z
  double kz = 1.5;        ///< sqrt(K_Pz / m) of (24), times omega
  double dz = 1;          ///< K_Dz / (2 sqrt(m K_Pz)): (25) asks for at least 1
  double ankle = 0.5;     ///< share of the stance foot's tilt taken back at the ankle
  double single = 1.7;    ///< length of a single support, times 1/omega
  double both = 0.4;      ///< of a double support, times 1/omega
  double lift = 0.09;     ///< of the swing sole, times z
  double reach = 0.5;     ///< largest departure from a nominal foothold, times z
  double hurry = 0.1;     ///< a foothold moved farther than this comes sooner, times z
  double soonest = 0.75;  ///< least time left to a step that comes sooner, times 1/omega
  double inside = 0.05;   ///< nominal ZMP, from the sole's centre to the other foot, times z
  double hold = 0.5;      ///< share of a foot's error of place taken back by the next step
  bool feedback = true;   ///< false: the reference pendulum alone, a demonstration
  bool landings = true;   ///< false: a foot lands when its time is up, whatever its cells say
};

/// Defaults, then the robot's sidecar, then the pattern's gains. Throws Error(usage) naming an
/// unknown gain or a value out of range, for dz with (25).
ViipParams viip_params(const RobotModel& model, const ControllerSpec& spec);

/// What `steps` counted steps take from standing to standing [s].
double stepping_time(const ViipParams& params, double omega, int steps);

/// Ref f_z of (24) [N] for a COG at height z moving at dz that is to be at `goal`.
double viip_force(const ViipParams& params, double mass, double omega, double goal, double z,
                  double dz);

class Viip {
 public:
  /// Goes on from `start`. `held`: the posture and COG that the pattern holds meanwhile; the COG
  /// over the middle of its feet is what displacements start from.
  Viip(const RobotModel& model, const ActuatorLimits& limits, const ViipParams& params, double dt,
       const Handover& start, const CommandSample& held);

  /// CogGoal or StepGoal from the coming tick on, for `ticks` (steps without a count end in time).
  void set_goal(const ViipGoal& goal, long ticks);

  double omega() const { return omega_; }  ///< sqrt(g / z) of the held posture [1/s]

  /// Feet, support, COG and ZMP of the coming tick.
  const CommandSample& plan() const { return plan_; }

  ControlOutput update(const Estimate& estimate);

  const ReferenceBody& body() const { return body_; }

 private:
  enum class Stage { stand, shift, single, both };

  Eigen::Vector3d standing_goal(const Eigen::Vector3d& displacement) const;
  Eigen::Vector2d regulate(const Eigen::Vector2d& xi, int state) const;
  Eigen::Vector2d clipped(const Eigen::Vector2d& zmp) const;
  CogReference cog_reference(const Estimate& estimate);
  void go_on(const Estimate& estimate);
  void start_steps();
  void start_single();
  double to_landing() const;
  void hurry(const PlannedStep& step, const Eigen::Vector2d& xi);
  void swing(const Eigen::Vector2d& xi);
  void learn(const Eigen::Vector2d& miss);
  Eigen::Vector2d missed(const Estimate& estimate, Side foot);
  void finish_plan();

  const RobotModel* model_;
  ViipParams params_;
  double dt_, omega_, height_;
  ReferenceBody body_;
  RobotData data_;
  CommandSample held_, plan_, next_;
  Eigen::Vector3d offset_;  // held COG from the middle of the feet, axes of the feet [m]
  // Asked, and on the way there through two lags.
  std::array<Eigen::Vector3d, 3> displacement_ = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
                                                  Eigen::Vector3d::Zero()};
  StepGoal steps_;
  int steps_left_ = 0;
  long ticks_left_ = 0;
  Stage stage_ = Stage::stand;
  double elapsed_ = 0;        // in this stage [s]
  double rate_ = 1;           // of its clock: a step that comes sooner runs faster
  Side anchor_ = Side::left;  // foot the reference stands on
  Footsteps footsteps_;
  // What each foot always misses of its plan when it lands, axes of the foot [m].
  std::array<Eigen::Vector2d, 2> habit_ = {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
  Eigen::Vector2d zmp_filtered_;
  Eigen::Vector3d swing_rate_, swing_acceleration_;  // of x, y, yaw of the foot in the air
  // Clipped ref ZMP by the measured and by the reference state: now, and at the end of the last
  // single support.
  std::array<Eigen::Vector2d, 2> zmp_, zmp_before_;
};

}  // namespace ayumi
