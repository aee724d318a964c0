#pragma once
// Generators of patterns a person then edits: `ayumi new walk`, `step`, `stand`, `sway`, `squat`,
// `jump`.

#include "ayumi/motion/pattern.hpp"

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
  double rise = 0;               ///< of a stair [m]; every stride then leads onto the next one,
                                 ///< where the other foot joins, and the world has the stairs
  Side first_swing = Side::right;
};

/// The walk of HOAP-1 scaled to a robot: lengths with its home COG height, times with the root of
/// it.
WalkParameters walk_defaults(const RobotModel& model);

/// The same for a staircase whose stairs rise by `rise` [m]: stairs a little longer than the sole,
/// lower COG, slower and higher steps.
WalkParameters stair_defaults(const RobotModel& model, double rise);

/// Phases, ZMP keys and swing targets of a straight or turning walk that starts and ends at rest.
/// Throws Error(usage) naming the parameter out of range.
Pattern walk_pattern(const RobotModel& model, const WalkParameters& parameters);

/// Both feet on the ground, home posture, for `duration` [s].
Pattern stand_pattern(const RobotModel& model, double duration);

/// The COG goes to and fro over both feet; every stretch starts and ends at rest.
struct SwayParameters {
  double side = 0.02;   ///< to either side of the middle [m]
  double forward = 0;   ///< ahead of and behind it [m]
  double period = 2.0;  ///< of one to and fro [s]
  int cycles = 2;
};
SwayParameters sway_defaults(const RobotModel& model);

/// COG keys: the middle, left (front), right (back), the middle. Throws as walk_pattern.
Pattern sway_pattern(const RobotModel& model, const SwayParameters& parameters);

/// The COG goes down and up over both feet.
struct SquatParameters {
  double depth = 0.03;  ///< below the home posture's COG [m]
  double period = 2.0;  ///< of one down and up, without the stay below [s]
  double hold = 0.3;    ///< stay below [s]
  int cycles = 2;
};
SquatParameters squat_defaults(const RobotModel& model);

/// COG height keys; where the COG is over the ground is solved. Throws as walk_pattern.
Pattern squat_pattern(const RobotModel& model, const SquatParameters& parameters);

/// Stoop, lift-off, flight, touchdown, settle, as often as asked without a rest between.
struct JumpParameters {
  double height = 0.03;      ///< of the COG above ref z_G, where it leaves the ground and lands [m]
  double stoop = 0.03;       ///< below ref z_G, before and after [m]
  double cog_height = 0.22;  ///< ref z_G above the soles [m]
  double forward = 0;        ///< way of each jump [m]
  int times = 1;
};
JumpParameters jump_defaults(const RobotModel& model);

/// COG height keys at the lowest points, at lift-off and at touchdown, foot keys where it travels;
/// the way between is the parabola. Throws as walk_pattern, and when no push within the stoop
/// reaches the height.
Pattern jump_pattern(const RobotModel& model, const JumpParameters& parameters);

}  // namespace ayumi
