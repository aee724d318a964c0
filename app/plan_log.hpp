#pragma once
// A pattern as it is planned, in the shape of a run's log: preview and plots show it like one.

#include <string>

#include "ayumi/sim/simulation_log.hpp"
#include "pattern_input.hpp"

namespace ayumi::app {

/// State, COG, ZMP, f_z, foot forces and motor torques that the full model needs for `motion`;
/// beside it what `command` commands (the same series, or the one before a change).
SimulationLog plan_log(const RobotModel& model, const ActuatorLimits& actuators,
                       const CommandSeries& motion, const CommandSeries& command);

/// Whether a name is that of a pattern rather than of a RUN: a file that ends in .json or .jsonc.
bool names_pattern(const std::string& file);

/// The log of a RUN (`log`: which of them), or the plan of a pattern. Throws as read_run_log() and
/// load_pattern().
SimulationLog log_of(const Context& context, const std::string& run_or_pattern,
                     const std::string& log);

}  // namespace ayumi::app
