#pragma once
// Command series for tests, made without the library's own sampler: standing, and a walk. The COG
// of the walk solves (14)(15) for its ZMP at every sample (one tridiagonal system) with three
// corrections by the full model; legs follow by Newton's method, and velocities and accelerations
// by central differences.

#include <Eigen/Geometry>
#include <array>

#include "ayumi/dynamics/robot_data.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi::test {

struct WalkShape {
  int steps = 8;
  double stride = 0.03, period = 0.55, double_support = 0.10, lift = 0.015, lead = 0.8;
  double dt = 0.001;
};

/// From 0 at s = 0 to 1 at s = 1, with speed and acceleration 0 at both ends.
double minimum_jerk(double s);

/// Places the legs of a robot with a level torso at `base` so that both soles are at `feet`; the
/// arms stay.
void place_legs(const RobotModel& model, const std::array<Eigen::Isometry3d, 2>& feet,
                RobotState& state, RobotData& data);

/// Fills velocities, accelerations and the command quantities of the full model from the poses.
void complete_series(const RobotModel& model, CommandSeries& series, double ground = 0);

/// The robot stands in the home posture, with its soles level at z = 0.
CommandSeries standing(const RobotModel& model, double duration, double dt = 0.001);

/// A straight walk with a level torso and arms as at home.
CommandSeries walk(const RobotModel& model, const WalkShape& w = {});

}  // namespace ayumi::test
