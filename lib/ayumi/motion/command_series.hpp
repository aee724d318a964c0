#pragma once
// The command set of the paper at a fixed rate: cmd(theta, dtheta, p_G, p_Z, f_z) and the planned
// contacts. Sample k is at time k dt.

#include <Eigen/Geometry>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ayumi/motion/pattern.hpp"
#include "ayumi/motion/reference_trajectory.hpp"

namespace ayumi {

struct CommandSample {
  RobotState state;                                 ///< planned base and joints
  Eigen::VectorXd acceleration;                     ///< [a_WB; dw_WB; ddtheta], world
  Eigen::Vector3d cog = Eigen::Vector3d::Zero();    ///< cmd p_G, world [m]
  Eigen::Vector3d dcog = Eigen::Vector3d::Zero();   ///< [m/s]
  Eigen::Vector3d ddcog = Eigen::Vector3d::Zero();  ///< [m/s^2]
  Eigen::Vector3d zmp = Eigen::Vector3d::Zero();    ///< cmd p_Z, world [m]
  double fz = 0;                                    ///< cmd f_z [N]
  Support support = Support::both;
  std::array<Eigen::Isometry3d, 2> feet = {Eigen::Isometry3d::Identity(),
                                           Eigen::Isometry3d::Identity()};  ///< planned sole frames
};

/// A phase in which VIIP controls the robot; the samples hold the posture in it.
struct ViipSpan {
  long begin = 0, end = 0;  ///< ticks, the end not included
  ViipGoal goal;
};

/// W = diag(value), valid from this sample on [dof].
struct JointWeight {
  long from = 0;
  Eigen::VectorXd value;
  bool operator==(const JointWeight&) const = default;
};

struct CommandSeries {
  double dt = 0.001;  ///< [s]
  std::vector<CommandSample> samples;
  std::vector<ViipSpan> viip;                 ///< in time order
  std::map<std::string, std::string> origin;  ///< source of each track, in words
  std::vector<JointWeight> joint_weight;      ///< in time order; none: the robot's own
  /// The joints come from a table of servo targets without their lead; it is replayed unchanged.
  bool servo_commands = false;
  /// Servo targets in open loop, in place of the command with its feedforward, dof x samples [rad];
  /// the last column is held after the end. Empty: the command with its feedforward is used.
  Eigen::MatrixXd targets = {};
  /// The rows of an imported sequence, which a robot receives unchanged; none: the table is
  /// computed from the samples.
  std::optional<ReferenceTrajectory> kept = {};

  /// W of sample k; null: the robot's own.
  const Eigen::VectorXd* joint_weight_at(long k) const {
    const Eigen::VectorXd* weight = nullptr;
    for (const JointWeight& w : joint_weight)
      if (w.from <= k) weight = &w.value;
    return weight;
  }

  double duration() const { return dt * static_cast<double>(samples.size() - 1); }
};

}  // namespace ayumi
