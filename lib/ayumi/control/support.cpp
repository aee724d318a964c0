#include "ayumi/control/support.hpp"

namespace ayumi {

ConvexPolygon support_polygon(const RobotModel& model, const std::array<Eigen::Isometry3d, 2>& feet,
                              Support support) {
  std::vector<Eigen::Vector2d> points;
  for (Side side : {Side::left, Side::right}) {
    if (!supports(support, side)) continue;
    for (const Eigen::Vector2d& p : model.sole(side).polygon)
      points.push_back((feet[static_cast<int>(side)] * Eigen::Vector3d(p.x(), p.y(), 0)).head<2>());
  }
  return ConvexPolygon(std::move(points));
}

}  // namespace ayumi
