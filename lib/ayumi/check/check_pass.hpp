#pragma once
// One run of the check over a command series: what all its parts read and what they find.

#include "ayumi/check/finding_windows.hpp"
#include "ayumi/demand/motion_demand.hpp"
#include "ayumi/dynamics/self_collision.hpp"

namespace ayumi {

inline constexpr double kWindowGap = 0.020;  ///< violations nearer than this are one finding [s]
inline constexpr double kRounding = 1e-7;    ///< of lengths that are met exactly [m]

struct CheckPass {
  CheckPass(const RobotModel& model, const CommandSeries& series, const CheckOptions& options);
  CheckPass(const CheckPass&) = delete;
  CheckPass& operator=(const CheckPass&) = delete;

  int count() const { return static_cast<int>(series.samples.size()); }
  double tolerance(FindingKind kind) const { return tolerance_of[kind]; }

  /// Notes a violation; `excess` orders the samples of a finding, `detail` is carried along.
  void add(FindingKind kind, int item, int sample, double value, double limit, double excess,
           int detail = 0, Severity severity = Severity::error) {
    windows.add({kind, item, sample, severity, value, limit, excess, detail});
  }

  /// That of contacts.hpp.
  bool at_flight_edge(int k) const;

  const RobotModel& model;
  const CommandSeries& series;
  const Tolerances tolerance_of;
  const double friction;
  const ActuatorLimits& limits;
  const ContactPlan plan;
  const CollisionModel collisions;
  MotionDynamics dynamics;
  const double weight;  ///< [N]

  FindingWindows windows;
  FindingWindows targets;  ///< steps of what servos receive: told, no cause of anything
  CheckSummary summary;
  Eigen::MatrixXd square_sum;                   ///< of torques before a sample, dof x (samples + 1)
  std::vector<Eigen::Vector3d> flight_moment;   ///< about the COG, by sample; 0 on the ground [N m]
  std::vector<Eigen::Vector3d> cog;             ///< of the posture, by sample [m]
  std::vector<double> cog_deviation;            ///< of the posture from the command, by sample [m]
  std::array<std::vector<SoleError>, 2> soles;  ///< by Side and sample; of a swing the depth only
  std::vector<char> rough;  ///< a joint accelerates beyond the tolerance, by sample
};

/// Everything that one sample tells by itself.
void check_samples(CheckPass& pass);

/// The soles, by what check_samples() noted of them.
void check_feet(CheckPass& pass);
/// The COG where flights begin and end, of which differences tell nothing else.
void check_leaps(CheckPass& pass);
/// Steps between samples that the planned speed does not tell.
void check_servo_steps(CheckPass& pass);
/// Mean moment over a few samples of a flight: momentum must not change, while the rate of a single
/// sample holds the rounding of differences.
void check_angular_momentum(CheckPass& pass);
/// Steps of what servos receive: the posture led by kd/kp times its rate. Warnings.
void check_servo_targets(CheckPass& pass);
/// RMS torque in the thermal window.
void check_continuous_torque(CheckPass& pass);
/// Bodies against each other: every 20 ms, then every sample around the places where they are near.
void check_self_collision(CheckPass& pass);

inline void raise_to(double& maximum, double value) {
  if (value > maximum) maximum = value;
}

}  // namespace ayumi
