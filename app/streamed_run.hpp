#pragma once
// Runs a simulation whose samples are written to the disk while it runs, and keeps a part of them
// in memory.

#include <filesystem>
#include <string>
#include <vector>

#include "ayumi/io/run/written_log.hpp"
#include "commands.hpp"
#include "simulation.hpp"

namespace ayumi::app {

/// The parts of a run that are kept in addition to its log.
struct StreamedParts {
  bool postures = false;  ///< whether to keep the postures, for table_of_postures()
  bool torque = false;
  std::vector<SimulationEvent> first_events = {};  ///< events before those of the run
};

struct StreamedRun {
  WrittenLog log;
  ReferenceTrajectory postures;  ///< the postures, if they were requested
  Eigen::MatrixXd torque;  ///< torques of the motors, if they were requested, samples x dof [N m]
  double wall = 0;         ///< time that the simulation took, without writing [s]
};

/// Runs the pattern and writes the log to `file`; if `file` is empty, only computes the hash of the
/// log.
StreamedRun simulate_streamed(const Context& context, const Task& input,
                              const SimulateOptions& options, const std::filesystem::path& file,
                              const StreamedParts& parts = {});

/// The log with its samples, read from its file.
SimulationLog with_samples(const WrittenLog& log, const std::filesystem::path& file);

/// The outcome in words ("with dtad, the robot stands, ..."), as for a log with samples.
std::string outcome_text(const WrittenLog& log);

}  // namespace ayumi::app
