#pragma once
// Generators of patterns a person then edits: `ayumi new walk`, `ayumi new stand`.

#include "ayumi/pattern/pattern.hpp"

namespace ayumi {

struct WalkParameters {
  int steps = 8;                 ///< steps that move; one closing step brings the feet together
  double stride = 0.03;          ///< forward distance between successive footholds [m]
  double period = 0.55;          ///< of one step: single + double support [s]
  double double_support = 0.18;  ///< share of the period
  double lift = 0.015;           ///< of the swing sole [m]
  double cog_height = 0;         ///< 0: of the home posture, lower if its legs are straight [m]
  double turn = 0;               ///< yaw change per step, left positive [rad]
  double side = 0;               ///< sideways distance per pair of steps, left positive [m]
  Side first_swing = Side::right;
};

/// Phases, ZMP keys and swing targets of a straight or turning walk that starts and ends at rest.
/// Throws Error(usage) naming the parameter out of range.
Pattern walk_pattern(const RobotModel& model, const WalkParameters& parameters);

/// Both feet on the ground, home posture, for `duration` [s].
Pattern stand_pattern(const RobotModel& model, double duration);

}  // namespace ayumi
