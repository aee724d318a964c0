#pragma once
// Simulation of a pattern from the command line: options that replace those of the pattern, and
// verdicts in words.

#include "ayumi/sim/run_caution.hpp"
#include "pattern_input.hpp"

namespace ayumi::app {

/// What the command line may change of a simulation.
struct SimulationChoice {
  std::string controller;          ///< "" = the pattern's
  std::string scenario;            ///< "" = the pattern's, "none", or a pattern file whose it is
  std::vector<std::string> gains;  ///< "name=value"
  bool noise = false;              ///< sensor noise, bias and latency of the sidecar
  bool true_state = false;         ///< instead of sensors and estimator
  bool unstable = false;           ///< simulate also with gains that make the loop unstable
  int substeps = 1;                ///< of the integrator per servo period
  std::string plant = "ayumi";     ///< "ayumi" or "mujoco"
};
void add_simulation_options(Command& command, SimulationChoice& choice);

/// --plant NAME.
void add_plant_option(Command& command, std::string& plant);
/// Throws Error(usage) for a plant this program was built without.
PlantKind plant_of(const std::string& name);
/// The plants of this program.
std::vector<std::string> built_plants();

/// --allow-unstable.
void add_unstable_flag(Command& command, bool& allowed);
/// Throws Error(bad_pattern) with the reason for DTAD gains that `ayumi gains` refuses.
void refuse_unstable_gains(const Task& input, const ControllerSpec& spec, bool allowed);

/// Says on standard error where `noise` was asked for and the robot's files state none.
void note_missing_noise(const RobotModel& robot, bool noise);

/// The pattern's controller under the choice.
ControllerSpec chosen_controller(const Task& input, const SimulationChoice& choice);

/// The task's options under the choice. Throws as refuse_unstable_gains().
SimulateOptions simulation_options(const Context& context, const Task& input,
                                   const SimulationChoice& choice);

/// The caution in the head of the table of a run: its disturbances and those that the pattern's own
/// table is from, and why the run is `unfit` for a robot.
TableCaution table_caution(const Task& input, const SimulationLog& log,
                           const std::vector<std::string>& unfit);

/// Torques that the motors gave, samples x dof [N m].
Eigen::MatrixXd torques_of(const SimulationLog& log);

/// "72 % (l_knee at 2.90 s)"; without the place where it is unknown.
std::string share_text(const SimulationLog& log, const JointShare& share);

/// "with dtad, the robot stands, final COG error 0.20 mm, largest trunk tilt 1.3 deg, ..."
std::string outcome_text(const SimulationLog& log);
/// The same for a log whose `rows` samples are not in memory.
std::string outcome_text(const SimulationLog& about, size_t rows);

}  // namespace ayumi::app
