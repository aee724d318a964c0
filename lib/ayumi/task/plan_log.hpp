#pragma once
// A pattern as it is planned, in the shape of a run's log, so that pictures, plots and pages show
// it like a run.

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"
#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

/// State, COG, ZMP, f_z, foot forces and motor torques that the full model needs for `motion`;
/// beside it what `command` commands (the same series, or the one before a change). Every
/// `stride`-th sample, from the first on.
SimulationLog plan_log(const RobotModel& model, const ActuatorLimits& actuators,
                       const CommandSeries& motion, const CommandSeries& command, int stride = 1);

}  // namespace ayumi
