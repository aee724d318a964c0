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
  RobotState state;              ///< planned state of base and joints
  Eigen::VectorXd acceleration;  ///< [a_WB; dw_WB; ddtheta], world axes [m/s^2, rad/s^2]
  Eigen::Vector3d cog = Eigen::Vector3d::Zero();    ///< commanded COG p_G in the world [m]
  Eigen::Vector3d dcog = Eigen::Vector3d::Zero();   ///< velocity of the COG [m/s]
  Eigen::Vector3d ddcog = Eigen::Vector3d::Zero();  ///< acceleration of the COG [m/s^2]
  Eigen::Vector3d zmp = Eigen::Vector3d::Zero();    ///< commanded ZMP p_Z in the world [m]
  double fz = 0;                                    ///< commanded vertical force f_z [N]
  Support support = Support::both;
  std::array<Eigen::Isometry3d, 2> feet = {Eigen::Isometry3d::Identity(),
                                           Eigen::Isometry3d::Identity()};  ///< planned sole frames
};

/// A phase in which VIIP controls the robot. The samples hold the posture during it.
struct ViipSpan {
  long begin = 0, end = 0;  ///< ticks from `begin` to before `end`
  ViipGoal goal;
};

/// W = diag(value), valid from this sample on, with one entry per dof.
struct JointWeight {
  long from = 0;
  Eigen::VectorXd value;
  bool operator==(const JointWeight&) const = default;
};

struct CommandSeries {
  double dt = 0.001;  ///< time between samples [s]
  std::vector<CommandSample> samples;
  std::vector<ViipSpan> viip;                 ///< VIIP phases in time order
  std::map<std::string, std::string> origin;  ///< source of each track, in words
  /// Weights in time order; if there are none, the robot's own are used.
  std::vector<JointWeight> joint_weight;
  /// Whether the joints come from a table of servo targets, from which the lead was removed; the
  /// table is replayed unchanged.
  bool servo_commands = false;
  /// Servo targets for open loop instead of the command with its feedforward, as angles of the
  /// joints, dof x samples [rad]; the last column is held after the end. If the matrix is empty,
  /// the command with its feedforward is used.
  Eigen::MatrixXd targets = {};
  /// The rows of an imported sequence, which a robot receives unchanged. Without them, the table is
  /// computed from the samples.
  std::optional<ReferenceTrajectory> kept = {};

  /// First and last sample of a flight, in which no foot is planned on the ground.
  struct Flight {
    long first = 0, last = 0;
  };
  /// All flights, in time order.
  std::vector<Flight> flights() const {
    std::vector<Flight> found;
    for (size_t i = 0; i < samples.size(); ++i) {
      const auto k = static_cast<long>(i);
      if (samples[i].support != Support::none) continue;
      if (found.empty() || found.back().last + 1 < k) found.push_back({k, k});
      found.back().last = k;
    }
    return found;
  }

  /// The W of sample k; null if it is the robot's own.
  const Eigen::VectorXd* joint_weight_at(long k) const {
    const Eigen::VectorXd* weight = nullptr;
    for (const JointWeight& w : joint_weight)
      if (w.from <= k) weight = &w.value;
    return weight;
  }

  double duration() const { return dt * static_cast<double>(samples.size() - 1); }
};

}  // namespace ayumi
