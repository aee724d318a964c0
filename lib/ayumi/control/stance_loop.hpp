#pragma once
// A standing robot as a linear system, on which the control loop works. The feet are flat, the ZMP
// is away from the edge, and deviations from the home posture are small. docs/theory_gains.md,
// "Gain design".

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"

namespace ayumi {

/// Deviations along one horizontal axis from tick to tick. The state of the body depends on the
/// model; ref COG and its velocity are constant during a tick.
struct LoopModel {
  bool both_feet = false;  ///< whether both feet are on the ground; otherwise one foot
  bool sideways = false;   ///< whether it describes the motion sideways; otherwise forwards
  double height = 0;       ///< height of the COG above the ground [m]
  double tick = 0.001;     ///< tick of the controller [s]
  double delay = 0;        ///< delay of the sensors and of the servos' targets [s]
  /// Growth of an error with which the loop still counts as stable [1/s].
  double tolerated_growth = 0;
  Eigen::MatrixXd body = {};  ///< state for each unit of the previous state
  /// State for each unit of ref COG [m] and of its velocity [m/s].
  Eigen::MatrixX2d reference = {};
  /// Measured values for each unit of the state [m, m/s, m].
  Eigen::RowVectorXd cog = {}, dcog = {}, zmp = {};
  /// Measured ZMP for each unit of ref COG and of its velocity.
  Eigen::RowVector2d zmp_reference{0, 0};
};

/// Support and direction of a loop, such as "both feet, sideways".
std::string name_of(const LoopModel& loop);

/// The whole robot on both feet and on the left foot, forward and sideways; masses, rotors, servos
/// and soles are those of the plant. `height` is that of the COG [m]. The delay is that of the
/// sidecar's sensors plus the longest delay of the legs' servos. Throws Error(bad_model) for a leg
/// without servos.
std::vector<LoopModel> stance_loops(const RobotModel& model, const ActuatorLimits& actuators,
                                    double height, double tick);

}  // namespace ayumi
