#pragma once
// Ground on which a block is tested in every plant.

#include <algorithm>
#include <cmath>
#include <vector>

#include "ayumi/model/gravity.hpp"
#include "ayumi/sim/schedule.hpp"

namespace ayumi::test {

/// A height field that is an inclined plane [rad], descending forwards through the origin, above
/// and below the plane around it.
inline World inclined_field(double angle, double friction) {
  World world{.friction = friction};
  HeightField field{.origin = {-1, -1}, .spacing = 0.07, .heights = Eigen::MatrixXd(60, 30)};
  for (Eigen::Index i = 0; i < 60; ++i)
    field.heights.row(i).setConstant(-std::tan(angle) * (-1 + 0.07 * static_cast<double>(i)));
  world.fields.push_back(field);
  return world;
}

/// The distance that a block slides down such a slope in `time` by Coulomb's law [m].
inline double sliding_distance(double angle, double friction, double v0, double time) {
  const double a = kGravity * (std::sin(angle) - friction * std::cos(angle));
  return v0 * time + 0.5 * a * time * time;
}

/// The floor at step k of a motion, as the simulator gives it.
inline StepInput floor_input(const std::vector<FloorMotion>& motions, long k, double step) {
  StepInput input;
  input.floor = moving_floor({}, motions, static_cast<double>(k) * step, step);
  return input;
}

/// A floor that is shaken along x at 2 Hz.
inline std::vector<FloorMotion> shaking(double amplitude) {
  return {{0.2, 10, {MotionShape::sine, 2, {0, 0}, {amplitude, 0, 0}}}};
}

/// The largest distance that a block moves relative to that floor [m]. It is measured only when the
/// block has caught up with the floor, because the sine begins at full speed.
template <typename Block>
double moved_on_floor(Block& block, const std::vector<FloorMotion>& motions, double step) {
  double apart = 0, offset = 0;
  for (long k = 0; k < 1700; ++k) {
    block.plant.step(Eigen::VectorXd(0), floor_input(motions, k, step), step);
    const double floor =
        floor_pose({}, motions, static_cast<double>(k + 1) * step).translation().x();
    if (k == 700) offset = block.position().x() - floor;
    if (k >= 700) apart = std::max(apart, std::abs(block.position().x() - floor - offset));
  }
  return apart;
}

}  // namespace ayumi::test
