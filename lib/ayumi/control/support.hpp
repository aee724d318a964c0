#pragma once
// The support region of planned feet, and the nearest admissible ZMP and vertical force.

#include <array>

#include "ayumi/math/polygon.hpp"
#include "ayumi/pattern/command_series.hpp"

namespace ayumi {

/// Convex hull of the soles that support, seen from above, world axes [m].
ConvexPolygon support_polygon(const RobotModel& model, const std::array<Eigen::Isometry3d, 2>& feet,
                              Support support);

}  // namespace ayumi
