#pragma once
// The simulation of a task whose samples are not held in memory.

#include <string>

#include "ayumi/sim/simulator.hpp"
#include "ayumi/task/task.hpp"

namespace ayumi {

/// Does the same as simulate() of a task, but each sample goes to `sink`, and the log has no
/// samples.
SimulationLog simulate_streamed(const Task& task, const SimulateOptions& options,
                                const Simulator::SampleSink& sink, const Progress& progress = {},
                                const std::string& command_line = "");

}  // namespace ayumi
