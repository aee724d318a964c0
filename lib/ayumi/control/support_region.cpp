#include "ayumi/control/support_region.hpp"

namespace ayumi {

namespace {

void sole_points(const RobotModel& model, const std::array<Eigen::Isometry3d, 2>& feet,
                 Support support, std::vector<Eigen::Vector2d>& points) {
  points.clear();
  for (Side side : {Side::left, Side::right}) {
    if (!supports(support, side)) continue;
    for (const Eigen::Vector2d& p : model.sole(side).polygon)
      points.push_back((feet[static_cast<int>(side)] * Eigen::Vector3d(p.x(), p.y(), 0)).head<2>());
  }
}

}  // namespace

ConvexPolygon support_polygon(const RobotModel& model, const std::array<Eigen::Isometry3d, 2>& feet,
                              Support support) {
  std::vector<Eigen::Vector2d> points;
  sole_points(model, feet, support, points);
  return ConvexPolygon(std::move(points));
}

const ConvexPolygon& SupportRegion::update(const RobotModel& model,
                                           const std::array<Eigen::Isometry3d, 2>& feet,
                                           Support support, double margin) {
  bool same = known_ && support == support_ && margin == margin_;
  for (Side side : {Side::left, Side::right}) {
    const int i = static_cast<int>(side);
    if (same && supports(support, side)) same = feet[i].matrix() == feet_[i].matrix();
  }
  if (same) return region_;
  known_ = true;
  feet_ = feet;
  support_ = support;
  margin_ = margin;
  sole_points(model, feet, support, points_);
  whole_.assign(points_);
  whole_.shrink_into(margin, points_, scratch_, region_);
  return region_;
}

}  // namespace ayumi
