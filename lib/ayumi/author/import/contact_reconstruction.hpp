#pragma once
// A motion that only tells joints over time, put on the ground: which foot carries when, where it
// stands, and so where the robot is.

#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// What a file of recorded or commanded angles holds.
struct RawMotion {
  double dt = 0.001;                      ///< [s]
  Eigen::MatrixXd theta;                  ///< rows x dof, the robot's order [rad]
  std::vector<BasePose> base;             ///< empty or one per row
  std::vector<Eigen::Vector3d> cog, zmp;  ///< empty or one per row, world [m]
  std::vector<double> fz;                 ///< empty or one per row [N]
  std::vector<Support> support;           ///< one per row; empty: to be detected
};

/// Who carries the robot in each row. Feet on the ground do not move against each other: both carry
/// while their relative pose rests (2 cm/s) at one height (3 mm); else the one that is lower in the
/// other's frame; where one takes over from the other at once, both carry as long as they do not
/// part along the ground (4 cm/s) or by more than 1 cm in height. With a base, a sole carries that
/// is within 3 mm of the lowest height of all and rests; flight is when none does. Stretches
/// shorter than 20 ms belong to their neighbours. A contact lasts from where a swing has come to
/// rest, if it does, to where the next one begins.
std::vector<Support> detect_supports(const RobotModel& model, const RawMotion& motion);

/// One foot on the ground.
struct FootContact {
  Side foot = Side::left;
  double begin = 0, end = 0;  ///< [s]
  Foothold place;
};

/// The motion as a pattern with a table named `table`: phases, level footholds, swings, and the
/// base that goes with them (in double support from one foot's to the other's, minimum jerk),
/// unless the motion has its own. Starts with the feet at the origin, heading along x.
struct GroundedMotion {
  Pattern pattern;
  std::vector<FootContact> contacts;  ///< in order of begin
};
/// Throws Error(bad_model) without soles, Error(bad_pattern) for fewer than 6 rows.
GroundedMotion grounded(const RobotModel& model, const RawMotion& motion, const std::string& table);

}  // namespace ayumi
