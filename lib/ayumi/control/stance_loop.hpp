#pragma once
// A robot that stands, as a linear system: what the control loop works on. Feet flat, the ZMP away
// from the edge, small deviations from the home posture. docs/theory_gains.md, "Gain design".

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"

namespace ayumi {

/// Deviations along one horizontal axis, from tick to tick. The state of the body is whatever the
/// model has; ref COG and its velocity hold for a tick.
struct LoopModel {
  std::string name = {};            ///< such as "both feet, sideways"
  double height = 0;                ///< of the COG above the ground [m]
  double tick = 0.001;              ///< of the controller [s]
  double delay = 0;                 ///< of the sensors and of the servos' targets [s]
  double tolerated_growth = 0;      ///< of an error, with which the loop counts as stable [1/s]
  Eigen::MatrixXd body = {};        ///< state per state of the tick before
  Eigen::MatrixX2d reference = {};  ///< state per ref COG [m] and its velocity [m/s]
  Eigen::RowVectorXd cog = {}, dcog = {}, zmp = {};  ///< measured, per state [m, m/s, m]
  Eigen::RowVector2d zmp_reference{0, 0};            ///< measured ZMP per ref COG and its velocity
};

/// A point mass on an ankle of finite stiffness [N m/rad] and damping [N m s/rad]: the closed form.
LoopModel pendulum_on_ankle(double mass, double height, double stiffness, double damping,
                            double tick, double delay);

/// The whole robot on both feet and on the left one, forward and sideways: masses, rotors, servos
/// and soles as in the plant. `height` of the COG [m]. The delay is that of the sidecar's sensors
/// and the longest of the legs' servos. Throws Error(bad_model) for a leg without servos.
std::vector<LoopModel> stance_loops(const RobotModel& model, const ActuatorLimits& actuators,
                                    double height, double tick);

}  // namespace ayumi
