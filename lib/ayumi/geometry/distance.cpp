#include "ayumi/geometry/distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ayumi/math/elementary.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

struct SegmentPoints {
  Vector3d on_a, on_b;
};

// The minimum of a convex quadratic over the unit square: first the free optimum, and then each
// variable clamped.
SegmentPoints nearest_on_segments(const Vector3d& a0, const Vector3d& a1, const Vector3d& b0,
                                  const Vector3d& b1) {
  const Vector3d u = a1 - a0, v = b1 - b0, w = a0 - b0;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v);
  const double uw = u.dot(w), vw = v.dot(w);
  const double det = uu * vv - uv * uv;
  double s = 0, t = 0;
  if (det > 1e-12 * uu * vv) s = std::clamp((uv * vw - vv * uw) / det, 0.0, 1.0);
  if (vv > 0) t = std::clamp((uv * s + vw) / vv, 0.0, 1.0);
  if (uu > 0) s = std::clamp((uv * t - uw) / uu, 0.0, 1.0);
  if (vv > 0) t = std::clamp((uv * s + vw) / vv, 0.0, 1.0);
  return {a0 + s * u, b0 + t * v};
}

ConvexPair swept_pair(const Vector3d& ca, const Vector3d& za, const Vector3d& cb,
                      const Vector3d& zb) {
  const SegmentPoints p = nearest_on_segments(ca - za, ca + za, cb - zb, cb + zb);
  const Vector3d between = p.on_b - p.on_a;
  ConvexPair pair{between.norm(), p.on_a, p.on_b, Vector3d::UnitZ()};
  if (pair.distance > 1e-12) pair.normal = between / pair.distance;
  return pair;
}

/// The extent of a core from its centre along a direction [m].
double core_extent(const ConvexCore& core, const Isometry3d& pose, const Vector3d& direction) {
  const Vector3d d = pose.linear().transpose() * direction;
  double far = -std::numeric_limits<double>::infinity();
  for (const Vector3d& p : core.points) far = std::max(far, p.dot(d));
  if (!core.points.empty()) return far;
  const double round = core.disc > 0 ? core.disc * d.head<2>().norm() : 0;
  return core.half.dot(d.cwiseAbs()) + round;
}

}  // namespace

Collider::Collider(const Shape& shape) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    swept_ = true;
    rounding_ = radius_ = sphere->radius;
  } else if (const auto* capsule = std::get_if<Capsule>(&shape)) {
    swept_ = true;
    rounding_ = capsule->radius;
    core_.half.z() = 0.5 * capsule->length;
    radius_ = core_.half.z() + capsule->radius;
  } else if (const auto* box = std::get_if<Box>(&shape)) {
    core_.half = 0.5 * box->size;
    radius_ = core_.half.norm();
  } else if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    core_.half.z() = 0.5 * cylinder->length;
    core_.disc = cylinder->radius;
    radius_ = elementary::hypot(cylinder->radius, 0.5 * cylinder->length);
  } else {
    const Eigen::AlignedBox3d box_around = bounding_box(std::get<MeshShape>(shape).mesh);
    core_.half = 0.5 * box_around.sizes();
    center_ = box_around.center();
    radius_ = core_.half.norm();
  }
}

Collider::Collider(const Shape& shape, const MeshHull& hull) : Collider(shape) {
  if (!std::holds_alternative<MeshShape>(shape) || hull.faces.empty()) return;
  faces_ = hull.faces;
  core_.points = hull.points;
  radius_ = 0;
  for (const Vector3d& p : core_.points) radius_ = std::max(radius_, p.norm());
}

Closest closest(const Collider& a, const Isometry3d& pose_a, const Collider& b,
                const Isometry3d& pose_b) {
  const Isometry3d A = a.core_pose(pose_a), B = b.core_pose(pose_b);
  const ConvexPair pair = a.swept() && b.swept()
                              ? swept_pair(A.translation(), a.core().half.z() * A.linear().col(2),
                                           B.translation(), b.core().half.z() * B.linear().col(2))
                              : convex_pair(a.core(), A, b.core(), B);
  return {pair.distance - a.rounding() - b.rounding(), pair.on_a + a.rounding() * pair.normal,
          pair.on_b - b.rounding() * pair.normal, pair.normal};
}

double clearance(const Collider& a, const Isometry3d& pose_a, const Collider& b,
                 const Isometry3d& pose_b) {
  return closest(a, pose_a, b, pose_b).clearance;
}

double clearance_bound(const Collider& a, const Isometry3d& pose_a, const Collider& b,
                       const Isometry3d& pose_b) {
  return (pose_a * a.center() - pose_b * b.center()).norm() - a.radius() - b.radius();
}

double clearance_along(const Vector3d& direction, const Collider& a, const Isometry3d& pose_a,
                       const Collider& b, const Isometry3d& pose_b) {
  return direction.dot(pose_b * b.center() - pose_a * a.center()) -
         core_extent(a.core(), pose_a, direction) - core_extent(b.core(), pose_b, -direction) -
         a.rounding() - b.rounding();
}

}  // namespace ayumi
