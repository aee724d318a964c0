#pragma once
// The foot in the air, for every law that places feet. Its foothold may move until the landing.
// This file has its path and its height, the detection of its landing, and its smallest distance
// from the other foot.

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "ayumi/control/estimator.hpp"
#include "ayumi/math/elementary.hpp"

namespace ayumi {

/// Smallest distance between the inner sides of two soles beside each other [m]. Chosen: a few
/// times the error with which a foot lands, 1.5 mm on HOAP-1. Its effect is in constants.md.
inline constexpr double kSoleClearance = 0.008;

/// Half the distance between a sole's sides [m].
double sole_half_width(const RobotModel& model);

/// Whether the load cells of the foot measure 10 % of the weight or more. Then the foot stands on
/// the ground.
bool bears(const RobotModel& model, const Estimate& estimate, Side side);

/// The height of a swing foot as a share of the lift: 64 (s (1 - s))^3, with zero rate and
/// acceleration at both ends. s is `share`, the share of the swing that has passed since lift-off
/// (0 to 1).
inline double swing_height(double share) { return elementary::power<3>(4 * share * (1 - share)); }

/// The path of smallest jerk from the present place, with its rate and acceleration, to rest at a
/// target in a given time. It is planned again in every tick, so the target may move.
template <int N>
class SwingReplan {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;

  /// The path is at rest from now on.
  void stop() {
    rate_.setZero();
    acceleration_.setZero();
  }

  /// Advances by one tick of dt [s]. Returns the distance that is covered if `remaining` is left
  /// for the remaining `time` [s].
  Vector step(const Vector& remaining, double time, double dt) {
    const double t = std::max(time, kLeastTime);
    const Vector jerk = 60 / (t * t * t) * remaining - 36 / (t * t) * rate_ - 9 / t * acceleration_;
    acceleration_ += dt * jerk;
    rate_ += dt * acceleration_;
    return dt * rate_;
  }

 private:
  // A path is never planned for a shorter time than this [s], because jerks grow with 1 / t^3.
  // Chosen: 30 ticks of 1 ms; with half of it, a target that moves in the last ticks requires eight
  // times the jerk. Its effect is in constants.md.
  static constexpr double kLeastTime = 0.03;

  Vector rate_ = Vector::Zero(), acceleration_ = Vector::Zero();
};

}  // namespace ayumi
