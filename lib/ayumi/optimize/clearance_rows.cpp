#include "ayumi/optimize/clearance_rows.hpp"

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/geometry/box_corner.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;

namespace {

constexpr int kCorners = 8;

bool is_one_box(const CollisionModel& collisions, int body) {
  const auto& shapes = collisions.shapes(body);
  if (shapes.size() != 1) return false;
  const Collider& c = shapes.front().collider;
  return c.core().points.empty() && c.core().disc == 0 && c.rounding() == 0 &&
         c.core().half.minCoeff() > 0;
}

struct PlacedBox {
  Isometry3d pose;
  Vector3d half;

  Vector3d corner(int i) const { return pose * box_corner(half, i); }
};

PlacedBox placed_box(const CollisionModel& collisions, int body, const RobotData& data) {
  const CollisionModel::PlacedCollider& shape = collisions.shapes(body).front();
  return {shape.collider.core_pose(data.pose(body) * shape.pose), shape.collider.core().half};
}

// Rate of normal . point, the point fixed in the body.
Eigen::RowVectorXd rate_along(const MatrixXd& jacobian, const Vector3d& origin,
                              const Vector3d& point, const Vector3d& normal) {
  return normal.transpose() * jacobian.topRows<3>() +
         (point - origin).cross(normal).transpose() * jacobian.bottomRows<3>();
}

}  // namespace

int clearance_rows(const CollisionModel& collisions, int pair) {
  const CollisionModel::Pair& p = collisions.pairs()[pair];
  const bool boxes = is_one_box(collisions, p.a) && is_one_box(collisions, p.b);
  return boxes ? 1 + 2 * kCorners : 1;
}

Closest point_from_box(const Vector3d& point, const Isometry3d& pose, const Vector3d& half) {
  const Vector3d p = pose.inverse() * point;
  Vector3d on_box = p.cwiseMax(-half).cwiseMin(half), normal = p - on_box;
  double distance = normal.norm();
  if (distance > 0) {
    normal /= distance;
  } else {  // inside: the way out through the nearest face
    int axis = 0;
    distance = -(half - p.cwiseAbs()).minCoeff(&axis);
    normal = (p[axis] < 0 ? -1 : 1) * Vector3d::Unit(axis);
    on_box -= distance * normal;
  }
  Closest result;
  result.clearance = distance;
  result.on_a = pose * on_box;
  result.on_b = point;
  result.normal = pose.linear() * normal;
  return result;
}

std::vector<Closest> clearance_points(const CollisionModel& collisions, int pair,
                                      const RobotData& data) {
  const CollisionModel::Pair& p = collisions.pairs()[pair];
  std::vector<Closest> points = {collisions.closest(p, data)};
  if (clearance_rows(collisions, pair) == 1) return points;
  const PlacedBox a = placed_box(collisions, p.a, data), b = placed_box(collisions, p.b, data);
  for (int i = 0; i < kCorners; ++i) points.push_back(point_from_box(b.corner(i), a.pose, a.half));
  for (int i = 0; i < kCorners; ++i) {
    Closest c = point_from_box(a.corner(i), b.pose, b.half);
    std::swap(c.on_a, c.on_b);
    c.normal = -c.normal;
    points.push_back(c);
  }
  return points;
}

MatrixXd clearance_gradient(const RobotModel& model, const CollisionModel& collisions, int pair,
                            const RobotData& data) {
  const CollisionModel::Pair& p = collisions.pairs()[pair];
  const Vector3d A = data.pose(p.a).translation(), B = data.pose(p.b).translation();
  const MatrixXd by_a = body_jacobian(model, data, p.a, A);
  const MatrixXd by_b = body_jacobian(model, data, p.b, B);
  const std::vector<Closest> points = clearance_points(collisions, pair, data);
  MatrixXd by(static_cast<Eigen::Index>(points.size()), model.velocity_count());
  for (size_t i = 0; i < points.size(); ++i) {
    const Closest& c = points[i];
    by.row(static_cast<Eigen::Index>(i)) =
        rate_along(by_b, B, c.on_b, c.normal) - rate_along(by_a, A, c.on_a, c.normal);
  }
  return by;
}

}  // namespace ayumi
