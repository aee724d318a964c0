#pragma once
// DTAD: dual-term absorption of disturbance, section 3 of the paper. The law, its derivation and
// what each term is worth: docs/theory.md.

#include <optional>
#include <string>
#include <vector>

#include "ayumi/control/estimator.hpp"
#include "ayumi/control/resolver.hpp"
#include "ayumi/pattern/command_series.hpp"

namespace ayumi {

/// Dimensionless gains: rates in units of omega = sqrt(g / z), lengths in units of the COG height
/// z.
struct DtadParams {
  double q = 0.25;          ///< second pole of (18)(19): K = 1 + q, D = (1 + q)/omega
  std::optional<double> k;  ///< K given directly, with d; must exceed 1
  std::optional<double> d;  ///< D omega given directly, with k; must be positive
  double ka = 1.5;          ///< short-term loop on the measured ZMP; grows towards (14)
  double ks = 1.5;          ///< pull of the reference COG to the command
  double kd = 1.5;          ///< damping of that pull
  double tau_z = 0.066;     ///< low-pass of the measured ZMP, times 1/omega
  double margin = 0.01;     ///< kept inside the support polygon, times z
  double washout = 6.6;     ///< forgetting of a constant ZMP offset, times 1/omega; 0: off
  double kz = 1.0;          ///< K_z of (20), times omega^2
  double dz = 2.0;          ///< D_z of (20), times omega
  double kaz = 0.3;         ///< short-term loop on the measured f_z
  double ankle = 0.5;       ///< share of the stance foot's measured tilt taken back at the ankle
  bool literal = false;     ///< (14) integrated as printed, D sign corrected: a demonstration
};

/// Defaults, then the robot's sidecar, then the pattern's gains. Throws Error(usage) naming an
/// unknown gain, K <= 1 or D <= 0, q together with k and d, or a value out of range.
DtadParams dtad_params(const RobotModel& model, const ControllerSpec& spec);

/// What either controller asks of the body: the reference of (14)-(21) and (24).
struct CogReference {
  Eigen::Vector3d zmp = Eigen::Vector3d::Zero();    ///< ref p_Z, plan frame [m]
  double fz = 0;                                    ///< ref f_z [N]
  Eigen::Vector3d ddcog = Eigen::Vector3d::Zero();  ///< ref acceleration [m/s^2]
  Eigen::Vector3d dcog = Eigen::Vector3d::Zero();   ///< its integral [m/s]
};

struct ControlOutput {
  Eigen::VectorXd target;  ///< what the servos receive [rad]
  RobotState reference;    ///< reference posture, plan frame
  CogReference cog_reference;
  Eigen::Vector3d cog = Eigen::Vector3d::Zero();  ///< of the reference posture [m]
  std::vector<std::string> notes;                 ///< what gave way: saturated joints, held limits
};

class Dtad {
 public:
  /// Starts at rest in the posture of `first`.
  Dtad(const RobotModel& model, const ActuatorLimits& limits, const DtadParams& params, double dt,
       const CommandSample& first);

  /// One tick: command now and one tick later, and what is measured.
  ControlOutput update(const CommandSample& command, const CommandSample& next,
                       const Estimate& estimate);

 private:
  CogReference cog_reference(const CommandSample& command, const Estimate& estimate);
  Eigen::VectorXd ankle_offsets(const Estimate& estimate, double omega);

  const RobotModel* model_;
  ActuatorLimits limits_;
  DtadParams params_;
  double dt_;
  RobotData data_;
  Eigen::VectorXd weight_, lead_, previous_target_;
  RobotState reference_;
  Side anchor_ = Side::left;
  Eigen::Vector3d dcog_ = Eigen::Vector3d::Zero();          // ref COG velocity [m/s]
  Eigen::Vector2d zmp_filtered_ = Eigen::Vector2d::Zero();  // z-hat [m]
  Eigen::Vector2d offset_ = Eigen::Vector2d::Zero();        // washed-out offset z-hat_d [m]
  double fz_filtered_ = 0;                                  // [N]
  Eigen::Vector3d slope_ = Eigen::Vector3d::Zero();         // lasting tilt of the stance foot [rad]
};

/// Time by which a servo target must lead so that the joint does not lag: kd / kp of each joint
/// [s].
Eigen::VectorXd servo_lead(const RobotModel& model);

}  // namespace ayumi
