#include "ayumi/demand/clearance_points.hpp"

#include <algorithm>
#include <limits>

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/geometry/box_corner.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;

namespace {

// A shape at the place of its body.
struct PlacedCore {
  const Collider* collider;
  Isometry3d shape, core;

  const ConvexCore& set() const { return collider->core(); }
  double rounding() const { return collider->rounding(); }
};

const CollisionModel::PlacedCollider& shape_of(const CollisionModel& collisions, int body,
                                               int shape) {
  return collisions.shapes(body)[static_cast<size_t>(shape)];
}

const CollisionModel::Pair& bodies_of(const CollisionModel& collisions, const ShapePair& shapes) {
  return collisions.pairs()[static_cast<size_t>(shapes.pair)];
}

PlacedCore placed(const CollisionModel& collisions, int body, int shape, const RobotData& data) {
  const CollisionModel::PlacedCollider& p = shape_of(collisions, body, shape);
  const Isometry3d pose = data.pose(body) * p.pose;
  return {&p.collider, pose, p.collider.core_pose(pose)};
}

// The ends of a shape in the frame of its core: points, or discs with a cylinder's radius.
std::vector<Vector3d> ends(const ConvexCore& core) {
  std::vector<Vector3d> result;
  if (!core.points.empty()) return result;
  for (int i = 0; i < 8; ++i) {
    bool twin = false;  // true: equal to an earlier corner, because an axis has no length
    for (int axis = 0; axis < 3; ++axis)
      twin = twin || (core.half[axis] == 0 && (i >> axis & 1) != 0);
    if (!twin) result.push_back(box_corner(core.half, i));
  }
  if (result.size() == 1 && core.disc == 0) result.clear();  // a sphere
  return result;
}

bool is_box(const ConvexCore& core) {
  return core.points.empty() && core.disc == 0 && core.half.minCoeff() > 0;
}

// The distance of an end of one shape from the other shape; `on_a` is on the other shape.
Closest end_from(const PlacedCore& other, const PlacedCore& own, const Vector3d& end) {
  Closest c;
  if (own.set().disc == 0 && is_box(other.set())) {
    c = point_from_box(own.core * end, other.core, other.set().half);
  } else {
    ConvexCore core;
    core.disc = own.set().disc;
    const ConvexPair near =
        convex_pair(other.set(), other.core, core, own.core * Eigen::Translation3d(end));
    c = {near.distance, near.on_a, near.on_b, near.normal};
  }
  c.clearance -= other.rounding() + own.rounding();
  c.on_a += other.rounding() * c.normal;
  c.on_b -= own.rounding() * c.normal;
  return c;
}

// The rate of normal . point for a point that is fixed in the body.
Eigen::RowVectorXd rate_along(const MatrixXd& jacobian, const Vector3d& origin,
                              const Vector3d& point, const Vector3d& normal) {
  return normal.transpose() * jacobian.topRows<3>() +
         (point - origin).cross(normal).transpose() * jacobian.bottomRows<3>();
}

}  // namespace

std::vector<ShapePair> shape_pairs(const CollisionModel& collisions, int pair) {
  const CollisionModel::Pair& p = collisions.pairs()[static_cast<size_t>(pair)];
  std::vector<ShapePair> result;
  for (int a = 0; a < static_cast<int>(collisions.shapes(p.a).size()); ++a)
    for (int b = 0; b < static_cast<int>(collisions.shapes(p.b).size()); ++b)
      result.push_back({pair, a, b});
  return result;
}

int clearance_point_count(const CollisionModel& collisions, const ShapePair& shapes) {
  const CollisionModel::Pair& p = bodies_of(collisions, shapes);
  const auto count = ends(shape_of(collisions, p.a, shapes.a).collider.core()).size() +
                     ends(shape_of(collisions, p.b, shapes.b).collider.core()).size();
  return static_cast<int>(count) + (shapes.edges || count == 0 ? 1 : 0);
}

bool edges_meet(const CollisionModel& collisions, const ShapePair& shapes, const RobotData& data,
                double same_distance) {
  ShapePair with = shapes;
  with.edges = true;
  const std::vector<Closest> points = clearance_points(collisions, with, data);
  double nearest_end = std::numeric_limits<double>::infinity();
  for (size_t i = 1; i < points.size(); ++i)
    nearest_end = std::min(nearest_end, points[i].clearance);
  return nearest_end > 0 && points[0].clearance < nearest_end - same_distance;
}

double shape_clearance(const CollisionModel& collisions, const ShapePair& shapes,
                       const RobotData& data, double skip) {
  const CollisionModel::Pair& p = bodies_of(collisions, shapes);
  const PlacedCore a = placed(collisions, p.a, shapes.a, data);
  const PlacedCore b = placed(collisions, p.b, shapes.b, data);
  const double bound = clearance_bound(*a.collider, a.shape, *b.collider, b.shape);
  return bound > skip ? bound : clearance(*a.collider, a.shape, *b.collider, b.shape);
}

Closest point_from_box(const Vector3d& point, const Isometry3d& pose, const Vector3d& half) {
  const Vector3d p = pose.inverse() * point;
  Vector3d on_box = p.cwiseMax(-half).cwiseMin(half), normal = p - on_box;
  double distance = normal.norm();
  if (distance > 0) {
    normal /= distance;
  } else {  // inside: the point leaves through the nearest face
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

std::vector<Closest> clearance_points(const CollisionModel& collisions, const ShapePair& shapes,
                                      const RobotData& data) {
  const CollisionModel::Pair& p = bodies_of(collisions, shapes);
  const PlacedCore a = placed(collisions, p.a, shapes.a, data);
  const PlacedCore b = placed(collisions, p.b, shapes.b, data);
  std::vector<Closest> points;
  const bool first = shapes.edges || (ends(a.set()).empty() && ends(b.set()).empty());
  if (first) points.push_back(closest(*a.collider, a.shape, *b.collider, b.shape));
  for (const Vector3d& end : ends(b.set())) points.push_back(end_from(a, b, end));
  for (const Vector3d& end : ends(a.set())) {
    Closest c = end_from(b, a, end);
    std::swap(c.on_a, c.on_b);
    c.normal = -c.normal;
    points.push_back(c);
  }
  return points;
}

MatrixXd clearance_gradient(const RobotModel& model, const CollisionModel& collisions,
                            const ShapePair& shapes, const RobotData& data) {
  const CollisionModel::Pair& p = bodies_of(collisions, shapes);
  const Vector3d A = data.pose(p.a).translation(), B = data.pose(p.b).translation();
  const MatrixXd by_a = body_jacobian(model, data, p.a, A);
  const MatrixXd by_b = body_jacobian(model, data, p.b, B);
  const std::vector<Closest> points = clearance_points(collisions, shapes, data);
  MatrixXd by(static_cast<Eigen::Index>(points.size()), model.velocity_count());
  for (size_t i = 0; i < points.size(); ++i) {
    const Closest& c = points[i];
    by.row(static_cast<Eigen::Index>(i)) =
        rate_along(by_b, B, c.on_b, c.normal) - rate_along(by_a, A, c.on_a, c.normal);
  }
  return by;
}

}  // namespace ayumi
