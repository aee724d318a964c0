#include "ayumi/task/streamed_simulation.hpp"

#include <limits>

namespace ayumi {

SimulationLog simulate_streamed(const Task& task, const SimulateOptions& options,
                                const Simulator::SampleSink& sink, const Progress& progress,
                                const std::string& command_line) {
  Simulator simulator(task.robot, task.series, options);
  simulator.send_samples(sink);
  simulator.advance(std::numeric_limits<long>::max(), progress);
  SimulationLog log = simulator.take_log();
  log.provenance = provenance(task, name_of(options.controller.type), command_line);
  return log;
}

}  // namespace ayumi
