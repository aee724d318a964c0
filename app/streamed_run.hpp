#pragma once
// A simulation whose samples are written to the disk while it runs, and the part of them that stays
// in memory.

#include <filesystem>
#include <string>
#include <vector>

#include "ayumi/io/run/written_log.hpp"
#include "commands.hpp"
#include "simulation.hpp"

namespace ayumi::app {

/// What is wanted of a run beside its log.
struct StreamedParts {
  bool postures = false;  ///< for table_of_postures()
  bool torque = false;
  std::vector<SimulationEvent> first_events = {};  ///< come before those of the run
};

struct StreamedRun {
  WrittenLog log;
  ReferenceTrajectory postures;  ///< where asked for
  Eigen::MatrixXd torque;        ///< where asked for: that the motors gave, samples x dof [N m]
  double wall = 0;               ///< that the simulation took, without writing [s]
};

/// Runs the pattern and writes the log to `file`; empty: no file, only its hash.
StreamedRun simulate_streamed(const Context& context, const Task& input,
                              const SimulateOptions& options, const std::filesystem::path& file,
                              const StreamedParts& parts = {});

/// The log with its samples, read from its file.
SimulationLog with_samples(const WrittenLog& log, const std::filesystem::path& file);

/// "with dtad, the robot stands, ...", as for a log with samples.
std::string outcome_text(const WrittenLog& log);

}  // namespace ayumi::app
