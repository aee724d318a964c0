#pragma once
// Cautions that a person must read before a robot receives the table of a run.

#include "ayumi/motion/table_caution.hpp"
#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

/// The disturbances in words, such as "1.1 N s on cog at 2.35 s; latency of 0.004 s at 0 s". Empty
/// if there are none.
std::string words_of(const std::vector<Disturbance>& scenario);

/// The reason why the table of this run is not for a robot, such as "the robot fell at 2.31 s
/// (trunk tilt)" or "the robot did not settle". Empty if the robot stands at the end.
std::string unfit_words(const SimulationLog& log);

/// The words of words_of() and of unfit_words() for a run.
TableCaution caution_of(const SimulationLog& log);

}  // namespace ayumi
