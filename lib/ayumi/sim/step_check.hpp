#pragma once
// Checks of the input that every plant makes. Values that are not finite or too large are refused
// with their names and, within a run, with the time.

#include "ayumi/base/largest_number.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/sim/step.hpp"

namespace ayumi {

/// Throws Error(bad_pattern) that names the part of the world that is not a number or not possible.
void check_world(const RobotModel& model, const World& world);

/// Throws Error(usage) that names the part of the state that is not a number or has the wrong size.
void check_state(const RobotModel& model, const RobotState& state);

/// Throws Error(usage) that names the part of a plant's report that is not a number or has the
/// wrong size.
void check_report(const RobotModel& model, const StepReport& report);

/// Throws Error(usage) that names the part of the input of one step of `dt` [s] that is not valid,
/// `time` [s] after the plant's start.
void check_step(const RobotModel& model, const Eigen::VectorXd& targets, const StepInput& input,
                double dt, double time);

}  // namespace ayumi
