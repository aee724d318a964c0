#pragma once
// What no plant takes: numbers that are none or too large for anything that is there. Each is
// refused by name, and within a run with the time.

#include "ayumi/model/robot_model.hpp"
#include "ayumi/sim/step.hpp"

namespace ayumi {

constexpr double kLargestNumber = 1e6;  ///< smaller ones are taken, in SI units

/// Throws Error(bad_pattern) naming what of the world is not a number or not possible.
void check_world(const RobotModel& model, const World& world);

/// Throws Error(usage) naming what is not a number or has the wrong count.
void check_state(const RobotModel& model, const RobotState& state);

/// The same for one step of `dt` [s], `time` [s] after the plant's start.
void check_step(const RobotModel& model, const Eigen::VectorXd& targets, const StepInput& input,
                double dt, double time);

}  // namespace ayumi
