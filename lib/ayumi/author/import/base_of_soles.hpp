#pragma once
// The track of the base in a motion that has joint angles only, from soles that are not exactly
// level: each foot on the ground gives the base a pose, and where both stand, these poses differ.

#include <vector>

#include "ayumi/math/polygon.hpp"
#include "ayumi/model/robot_model.hpp"

namespace ayumi {

/// Largest difference between the poses that the two feet give the base while both stand.
struct SoleDisagreement {
  Eigen::Array3d position = Eigen::Array3d::Zero();  ///< in the axes of the world [m]

  void add(const Eigen::Isometry3d& by_left, const Eigen::Isometry3d& by_right);
  double length() const { return position.matrix().norm(); }  ///< of the position [m]
};

/// Where the feet that carry the robot stand, row by row.
struct SupportRegions {
  std::vector<ConvexPolygon> regions;  ///< in the world [m]
  std::vector<size_t> of_row;          ///< index of the region, for each row
};

/// The track `base`, moved along the ground by at most the disagreement of the soles (and at most
/// by half of what the check allows a sole that stands), so that the ZMP leaves the support as
/// little as possible: in this range, the soles do not say where the base is, but the ZMP of a
/// robot that stands is inside its support. Rows with a ZMP well inside keep it. `theta` has a row
/// of angles for each base [rad], `dt` is the time between rows [s].
std::vector<BasePose> base_with_zmp_inside(const RobotModel& model, const Eigen::MatrixXd& theta,
                                           double dt, std::vector<BasePose> base,
                                           const SupportRegions& support,
                                           const SoleDisagreement& soles);

}  // namespace ayumi
