#pragma once
// Contacts of a motion that has joint angles only: the supporting feet over time, their places, and
// from these the place of the robot.

#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// The content of a file of recorded or commanded angles.
struct RawMotion {
  double dt = 0.001;                      ///< [s]
  Eigen::MatrixXd theta;                  ///< rows x dof, the robot's order [rad]
  std::vector<BasePose> base;             ///< empty or one per row
  std::vector<Eigen::Vector3d> cog, zmp;  ///< empty or one per row, world [m]
  std::vector<double> fz;                 ///< empty or one per row [N]
  std::vector<Support> support;           ///< one per row; empty: to be detected
};

/// Support in each row. Feet on the ground do not move relative to each other: both support while
/// their relative pose rests (2 cm/s) at one height (3 mm); else the foot that is lower in the
/// other's frame. At an immediate change of the supporting foot both support as long as they do not
/// move apart along the ground (4 cm/s) or by more than 1 cm in height. In a motion with a base, a
/// sole supports that is at rest within 3 mm of the lowest height of all; a row without such a sole
/// is flight. Intervals shorter than 20 ms belong to their neighbours. A contact lasts from the
/// rest after a swing, if there is one, to the beginning of the next swing.
std::vector<Support> detect_supports(const RobotModel& model, const RawMotion& motion);

/// One foot on the ground.
struct FootContact {
  Side foot = Side::left;
  double begin = 0, end = 0;  ///< [s]
  Foothold place;
};

/// The motion as a pattern with a table named `table`: phases, level footholds, swings, and the
/// base that follows from them (in double support by minimum jerk from one foot to the other),
/// unless the motion has a base. It starts with the feet at the origin and the heading along x.
struct GroundedMotion {
  Pattern pattern;
  std::vector<FootContact> contacts;  ///< in order of begin
};
/// Throws Error(bad_model) without soles, Error(bad_pattern) for fewer than 6 rows.
GroundedMotion grounded(const RobotModel& model, const RawMotion& motion, const std::string& table);

}  // namespace ayumi
