#pragma once
// Presents a pattern as it is planned in the form of a run's log, so that pictures, plots and pages
// show it like a run.

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"
#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

/// The state, COG, ZMP, f_z, foot forces and motor torques that the full model needs for `motion`,
/// and in addition the commanded values of `command` (the same series, or the one before a change).
/// The log has every `stride`-th sample, starting with the first.
SimulationLog plan_log(const RobotModel& model, const ActuatorLimits& actuators,
                       const CommandSeries& motion, const CommandSeries& command, int stride = 1);

}  // namespace ayumi
