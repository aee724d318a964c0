#pragma once
// Simulation of a pattern from the command line: options that replace those of the pattern, and
// verdicts in words.

#include "ayumi/sim/run_caution.hpp"
#include "pattern_input.hpp"

namespace ayumi::app {

/// The choices of the command line for a simulation.
struct SimulationChoice {
  std::string controller;  ///< name of the controller; "" for that of the pattern
  /// Either "" for that of the pattern, or "none", or a pattern file that has the scenario.
  std::string scenario;
  std::vector<std::string> gains;  ///< "name=value" for each gain that is set
  bool noise = false;       ///< whether to use the sensor noise, bias and latency of the sidecar
  bool true_state = false;  ///< whether to use the true state instead of sensors and estimator
  bool unstable = false;    ///< whether to simulate also with gains that make the loop unstable
  int substeps = 1;         ///< number of integrator steps in a servo period
  std::string plant = "ayumi";  ///< "ayumi" or "mujoco"
};
void add_simulation_options(Command& command, SimulationChoice& choice);

/// Adds the option --noise.
void add_noise_flag(Command& command, bool& noise);

/// Adds the option --plant NAME.
void add_plant_option(Command& command, std::string& plant);
/// Throws Error(usage) for a plant without which this program was built.
PlantKind plant_of(const std::string& name);
/// The plants with which this program was built.
std::vector<std::string> built_plants();

/// Adds the option --allow-unstable.
void add_unstable_flag(Command& command, bool& allowed);
/// Throws Error(bad_pattern) with the reason for DTAD gains that `ayumi gains` would refuse.
void refuse_unstable_gains(const Task& input, const ControllerSpec& spec, bool allowed);

/// Prints a note on standard error if `noise` is true and the robot's files state no noise.
void note_missing_noise(const RobotModel& robot, bool noise);

/// The controller of the pattern with the changes of the choice.
ControllerSpec chosen_controller(const Task& input, const SimulationChoice& choice);

/// The options of the task with the changes of the choice. Throws the same errors as
/// refuse_unstable_gains().
SimulateOptions simulation_options(const Context& context, const Task& input,
                                   const SimulationChoice& choice);

/// The caution for the head of the table of a run. It contains the disturbances of the run and of
/// the run from which the pattern's own table comes, and the reason why the run is `unfit` for a
/// robot.
TableCaution table_caution(const Task& input, const SimulationLog& log,
                           const std::vector<std::string>& unfit);

/// Torques of the motors, samples x dof [N m].
Eigen::MatrixXd torques_of(const SimulationLog& log);

/// A share in words, such as "72 % (l_knee at 2.90 s)"; without the place if it is unknown.
std::string share_text(const SimulationLog& log, const JointShare& share);

/// The figures that are worse with control than without, under the same disturbances, such as "the
/// largest trunk tilt is 8.3 deg with control and 5.3 deg in open loop".
std::vector<std::string> worse_than_open_loop(const SimulationLog& open_run,
                                              const SimulationLog& closed_run);
/// What comes before these figures in a message.
inline constexpr const char* kWorseWithControl =
    "some figures are worse with control than in open loop";

/// The outcome in words, such as "with dtad, the robot stands, final COG error 0.20 mm, largest
/// trunk tilt 1.3 deg, ...".
std::string outcome_text(const SimulationLog& log);
/// The same for a log whose `rows` samples are not in memory.
std::string outcome_text(const SimulationLog& about, size_t rows);

}  // namespace ayumi::app
