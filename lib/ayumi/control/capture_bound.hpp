#pragma once
// How hard a push the planned supports allow at best: the capture bound of the linear pendulum. Its
// DCM x + dx/omega can be brought back to the plan exactly when it lies in the Minkowski integral
// of the supports to come, int omega exp(-omega s) S(t + s) ds. It is a figure of a point mass: a
// body with inertia about its edge can pass it by a little. docs/theory.md.

#include "ayumi/motion/command_series.hpp"

namespace ayumi {

/// The set of capturable DCMs at one moment, by its support function in evenly spread directions.
struct CaptureRegion {
  std::vector<Eigen::Vector2d> normals;           ///< unit vectors, the first along +x
  std::vector<double> support;                    ///< max of n.dcm over the set [m]
  Eigen::Vector2d dcm = Eigen::Vector2d::Zero();  ///< commanded, world [m]
  double impulse_per_length = 0;                  ///< m omega [N s/m]
};

/// At tick k of the series; the last supports are taken to last for ever. Ticks without support add
/// the point of the commanded ZMP.
CaptureRegion capture_region(const RobotModel& model, const CommandSeries& series, long k,
                             int directions = 72);

/// Largest impulse through the COG along the unit vector u after which the plan can still be
/// returned to [N s]: m omega min over n.u > 0 of (h(n) - n.dcm) / (n.u); negative when the plan
/// itself leaves the region.
double capture_bound(const CaptureRegion& region, const Eigen::Vector2d& u);

/// m omega times the distance from the commanded ZMP along u to the edge of the present support [N
/// s].
double edge_bound(const RobotModel& model, const CommandSeries& series, long k,
                  const Eigen::Vector2d& u);

}  // namespace ayumi
