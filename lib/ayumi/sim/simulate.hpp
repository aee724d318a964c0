#pragma once
// simulate(): the closed loop of a plant with servos, sensors, scripted disturbances and a
// controller, from a command series to a SimulationLog.

#include <functional>

#include "ayumi/base/bounds.hpp"
#include "ayumi/base/progress.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"
#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

class Controller;
class PlantInterface;
struct Estimate;

/// The plant that moves the robot.
struct PlantKind {
  std::string name = "ayumi";
  /// The function that makes the plant; empty for Ayumi's own plant. The model must outlive the
  /// plant.
  std::function<PlantInterface(const RobotModel&, const ActuatorLimits&, const World&)> make = {};
};

/// Servo targets that replace those of the control law in each tick. The arguments are the targets
/// that the law would send at `t` [s], the estimate that it had, and its plan. The result must have
/// the size of `targets` [rad, m]. All angles are those of the joints; the simulator makes targets
/// of encoders of them (model/encoder_angles). Copies of a simulator share the state of the
/// function.
using TargetFunction = std::function<Eigen::VectorXd(
    double t, const Estimate& estimate, const CommandSample& plan, const Eigen::VectorXd& targets)>;

/// One individual robot. It differs from the model that its controller uses: in masses, soles and
/// sensors (model), and in its servos (actuators). Links, joints and their order are the same.
struct RobotUnit {
  RobotModel model;
  ActuatorLimits actuators;
};

struct SimulateOptions {
  /// Bounds of substeps. Chosen: with 100, a run takes about a hundred times as long.
  static constexpr Bounds kSubsteps = {1, 100};

  ControllerSpec controller;
  std::string profile;  ///< actuator profile; "" for the default
  World world;
  std::vector<Disturbance> scenario;
  double settle = 1.0;  ///< time for which the last command is held after the pattern [s]
  int substeps = 1;     ///< integrator steps in a control tick
  /// Whether the controller gets the true state instead of sensor readings.
  bool true_state = false;
  bool sensor_noise = false;  ///< whether to use the sidecar's noise, bias and latency
  std::uint64_t seed = 1;
  PlantKind plant;
  /// Targets of the servos; if empty, they receive those of the control law.
  TargetFunction targets = {};
  /// The robot that is simulated, including its sensors; it must outlive the run. If it is null,
  /// the robot is equal to its model.
  const RobotUnit* unit = nullptr;
  /// A controller before its first tick, made with the same model, series and law. The run copies
  /// its own controller from it, because this takes less time than making one. If it is null, the
  /// run makes its own.
  const Controller* prepared = nullptr;
};

/// Throws Error(bad_model) if the robot has no soles or servos, Error(bad_pattern) for a
/// disturbance on an unknown link, and Error(usage) for an unknown controller or gain.
SimulationLog simulate(const RobotModel& model, const CommandSeries& series,
                       const SimulateOptions& options, const Progress& progress = {});

/// The table that the robot replays: servo targets and reference quantities of a run.
ReferenceTrajectory extract_reference(const RobotModel& model, const SimulationLog& log);

}  // namespace ayumi
