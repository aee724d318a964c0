#pragma once
// The largest push that the planned supports allow: the capture bound of the linear pendulum. The
// DCM x + dx/omega can be brought back to the plan if and only if it lies in the Minkowski integral
// of the coming supports, int omega exp(-omega s) S(t + s) ds. The bound holds for a point mass. A
// body has inertia about the edge of its sole and can exceed the bound a little
// (docs/theory_pushes.md).

#include "ayumi/motion/command_series.hpp"

namespace ayumi {

/// The set of capturable DCMs at one moment, by its support function in evenly spread directions.
struct CaptureRegion {
  std::vector<Eigen::Vector2d> normals;  ///< unit vectors; the first one points along +x
  std::vector<double> support;           ///< maximum of n.dcm over the set, for each normal n [m]
  Eigen::Vector2d dcm = Eigen::Vector2d::Zero();  ///< commanded DCM in the world [m]
  double impulse_per_length = 0;  ///< m omega: impulse for each metre of DCM displacement [N s/m]
};

/// The set at tick k of the series. It is assumed that the last support lasts for ever. A tick
/// without support contributes the point of the commanded ZMP.
CaptureRegion capture_region(const RobotModel& model, const CommandSeries& series, long k,
                             int directions = 72);

/// Largest impulse through the COG along the unit vector u after which the pendulum can still
/// return to the plan [N s]: m omega min over n.u > 0 of (h(n) - n.dcm) / (n.u). It is negative if
/// the plan itself leaves the region.
double capture_bound(const CaptureRegion& region, const Eigen::Vector2d& u);

/// m omega times the distance along the unit vector u from the commanded ZMP to the edge of the
/// present support [N s]; 0 without a support.
double edge_bound(const RobotModel& model, const CommandSeries& series, long k,
                  const Eigen::Vector2d& u);

}  // namespace ayumi
