#pragma once
// Checks of the input that every plant makes. Values that are not finite or too large are refused
// with their names and, within a run, with the time.

#include "ayumi/model/robot_model.hpp"
#include "ayumi/sim/step.hpp"

namespace ayumi {

constexpr double kLargestNumber =
    1e6;  ///< values below this are accepted, SI units. Chosen: no robot
          ///< or world has a larger one, and its square is finite

/// Throws Error(bad_pattern) that names the part of the world that is not a number or not possible.
void check_world(const RobotModel& model, const World& world);

/// Throws Error(usage) that names the part of the state that is not a number or has the wrong size.
void check_state(const RobotModel& model, const RobotState& state);

/// Throws Error(usage) that names the part of the input of one step of `dt` [s] that is not valid,
/// `time` [s] after the plant's start.
void check_step(const RobotModel& model, const Eigen::VectorXd& targets, const StepInput& input,
                double dt, double time);

}  // namespace ayumi
