#pragma once
// How near a run was to its limits over time, for the same picture as that of the planned motion
// (check/stability_series).

#include "ayumi/check/stability_series.hpp"
#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

/// The margins are those of the true state of a run. A sole carries load if more than 5 % of the
/// weight rests on it. ZMP and DCM are judged by the hull of the soles that carry load, at their
/// true places, seen from above; for the DCM, the hull also contains the soles that the plan puts
/// down next, at the places where they are in the run at that later time. Torques are those that
/// the servos applied.
StabilitySeries run_stability(const RobotModel& model, const ActuatorLimits& actuators,
                              const SimulationLog& log, double dt = 0.01);

}  // namespace ayumi
