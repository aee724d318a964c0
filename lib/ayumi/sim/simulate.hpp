#pragma once
// SimulationLog = simulate(model, command series, controller, scenario): Ayumi's own integrator (or
// another plant) with servos, sensors and scripted disturbances, the loop closed around `control`.

#include <functional>

#include "ayumi/base/progress.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"
#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

class AnyPlant;

/// Which integrator moves the robot.
struct PlantKind {
  std::string name = "ayumi";
  /// Empty: Ayumi's own. The model outlives the plant.
  std::function<AnyPlant(const RobotModel&, const ActuatorLimits&, const World&)> make = {};
};

struct SimulateOptions {
  ControllerSpec controller;
  std::string profile;  ///< actuator profile; "" = default
  World world;
  std::vector<Disturbance> scenario;
  double settle = 1.0;        ///< hold the last command this long after the pattern [s]
  int substeps = 1;           ///< integrator steps per 1 ms control tick
  bool true_state = false;    ///< controllers see ground truth instead of sensors
  bool sensor_noise = false;  ///< the sidecar's noise, bias, latency
  std::uint64_t seed = 1;
  PlantKind plant;
};

/// Throws Error(bad_model) when the robot has no soles or servos, Error(bad_pattern) for a
/// disturbance on an unknown link, Error(usage) for an unknown controller or gain.
SimulationLog simulate(const RobotModel& model, const CommandSeries& series,
                       const SimulateOptions& options, const Progress& progress = {});

/// The table the robot is to replay: servo targets and reference quantities of a run.
ReferenceTrajectory extract_reference(const RobotModel& model, const SimulationLog& log);

}  // namespace ayumi
