#pragma once
// Is a command series physically consistent? theta, COG, ZMP and f_z against each other and against
// the robot's limits; findings say what, where, when, how much, and what to do.

#include <map>
#include <string>
#include <vector>

#include "ayumi/limits/finding.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

struct CheckSummary {
  double min_zmp_margin = 0;            ///< distance inside the support polygon [m]
  double max_cog_residual = 0;          ///< [m]
  double max_zmp_residual = 0;          ///< full-model ZMP - cmd ZMP [m]
  double max_fz_residual = 0;           ///< [N]
  double max_point_mass_gap = 0;        ///< ZMP of (14)(15) - cmd ZMP [m]
  double max_joint_position_ratio = 0;  ///< |theta - mid| / half range
  double max_joint_speed_ratio = 0;
  double max_joint_acceleration = 0;  ///< [rad/s^2]
  double max_torque_ratio = 0;
  double max_continuous_torque_ratio = 0;
  double max_friction_ratio = 0;      ///< |f_t| / (mu f_z)
  double max_yaw_ratio = 0;           ///< yaw moment / friction capacity about the ZMP
  double max_foot_slip = 0;           ///< [m]
  double max_foot_penetration = 0;    ///< [m]
  double max_foot_float = 0;          ///< [m]
  double max_landing_speed = 0;       ///< [m/s]
  double max_servo_step = 0;          ///< per tick / speed limit per tick
  double max_ballistic_residual = 0;  ///< COG acceleration + g in flight [m/s^2]
  double max_momentum_rate = 0;       ///< angular momentum rate in flight [N m]
  double min_self_clearance = 0;      ///< [m]
};

struct ConsistencyReport {
  bool consistent = false;        ///< no finding of severity error
  std::vector<Finding> findings;  ///< errors first, then by time
  CheckSummary summary;
  std::string profile;  ///< actuator profile judged against
};

/// Tolerance of every finding kind, in the unit of that kind. Patterns and the command line may
/// override entries.
struct CheckOptions {
  std::string profile;  ///< "" = default of the robot
  double friction = 0.8;
  std::map<std::string, double> tolerances;  ///< overrides by kind
};

/// All kinds with their default tolerance and unit, in the order of docs/cli.md.
struct FindingSpec {
  FindingKind kind = FindingKind::cog_residual;
  std::string unit, meaning;
  double tolerance = 0;
};
const std::vector<FindingSpec>& finding_specs();

/// Throws Error(usage) for an unknown tolerance name.
ConsistencyReport check_consistency(const RobotModel& model, const CommandSeries& series,
                                    const CheckOptions& options = {});

}  // namespace ayumi
