#include "ayumi/sim/simulate.hpp"

#include <limits>
#include <utility>

#include "ayumi/sim/reference_row.hpp"
#include "ayumi/sim/simulator.hpp"

namespace ayumi {

SimulationLog simulate(const RobotModel& model, const CommandSeries& series,
                       const SimulateOptions& options, const Progress& progress) {
  Simulator simulator(model, series, options);
  simulator.advance(std::numeric_limits<long>::max(), progress);
  return simulator.take_log();
}

ReferenceTrajectory extract_reference(const RobotModel& model, const SimulationLog& log) {
  ReferenceTrajectory table;
  table.dt = log.dt;
  table.joints = model.dof_names();
  table.provenance = log.provenance;
  for (const SimulationSample& s : log.samples) {
    ReferenceRow row = reference_row(s);
    row.theta = s.target;
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace ayumi
