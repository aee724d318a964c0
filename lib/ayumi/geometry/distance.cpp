#include "ayumi/geometry/distance.hpp"

#include <fcl/fcl.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "ayumi/geometry/penetration.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// A sphere swept along z by +-half_length, or a shape of the collision library.
struct Collider::Impl {
  bool swept = false;
  double sweep_radius = 0, half_length = 0;
  Isometry3d offset = Isometry3d::Identity();  // library shape in the shape frame
  std::unique_ptr<fcl::CollisionGeometryd> geometry;
  Solid solid;  // the same for depths
};

namespace {

struct Bounds {
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity());
  Vector3d high = -low;
};

Bounds mesh_bounds(const MeshShape& mesh) {
  Bounds b;
  for (const MeshPart& part : mesh.mesh.parts) {
    for (const Eigen::Vector3f& v : part.vertices) {
      b.low = b.low.cwiseMin(v.cast<double>());
      b.high = b.high.cwiseMax(v.cast<double>());
    }
  }
  if (!(b.low.x() <= b.high.x())) b.low = b.high = Vector3d::Zero();
  return b;
}

// Zero or less where the bodies meet: the library's own depth is not asked for, since its polytope
// expansion ends the program on some of them.
double library_distance(const fcl::CollisionGeometryd& a, const Isometry3d& pose_a,
                        const fcl::CollisionGeometryd& b, const Isometry3d& pose_b) {
  try {
    fcl::DistanceRequestd request(false, false, 0, 0, 1e-7, fcl::GST_LIBCCD);
    fcl::DistanceResultd result;
    return fcl::distance(&a, pose_a, &b, pose_b, request, result);
  } catch (const std::exception&) {
    return 0;
  }
}

}  // namespace

Collider::Collider(const Shape& shape) : impl_(std::make_unique<Impl>()) {
  Impl& impl = *impl_;
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    impl.swept = true;
    impl.sweep_radius = radius_ = sphere->radius;
    impl.geometry = std::make_unique<fcl::Sphered>(sphere->radius);
    impl.solid = {Solid::Kind::capsule, Vector3d::Zero(), sphere->radius, 0};
  } else if (const auto* capsule = std::get_if<Capsule>(&shape)) {
    impl.swept = true;
    impl.sweep_radius = capsule->radius;
    impl.half_length = 0.5 * capsule->length;
    radius_ = impl.half_length + capsule->radius;
    impl.geometry = std::make_unique<fcl::Capsuled>(capsule->radius, capsule->length);
    impl.solid = {Solid::Kind::capsule, Vector3d::Zero(), capsule->radius, impl.half_length};
  } else if (const auto* box = std::get_if<Box>(&shape)) {
    radius_ = 0.5 * box->size.norm();
    impl.geometry = std::make_unique<fcl::Boxd>(box->size);
    impl.solid = {Solid::Kind::box, 0.5 * box->size, 0, 0};
  } else if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    radius_ = std::hypot(cylinder->radius, 0.5 * cylinder->length);
    impl.geometry = std::make_unique<fcl::Cylinderd>(cylinder->radius, cylinder->length);
    impl.solid = {Solid::Kind::cylinder, Vector3d::Zero(), cylinder->radius,
                  0.5 * cylinder->length};
  } else {
    const Bounds bounds = mesh_bounds(std::get<MeshShape>(shape));
    const Vector3d size = bounds.high - bounds.low;
    center_ = 0.5 * (bounds.low + bounds.high);
    radius_ = 0.5 * size.norm();
    impl.offset.translation() = center_;
    impl.geometry = std::make_unique<fcl::Boxd>(size);
    impl.solid = {Solid::Kind::box, 0.5 * size, 0, 0};
  }
}

Collider::Collider(Collider&&) noexcept = default;
Collider& Collider::operator=(Collider&&) noexcept = default;
Collider::~Collider() = default;

double clearance(const Collider& a, const Isometry3d& pose_a, const Collider& b,
                 const Isometry3d& pose_b) {
  const Collider::Impl &ia = *a.impl_, &ib = *b.impl_;
  if (ia.swept && ib.swept) {
    const Vector3d za = ia.half_length * pose_a.linear().col(2);
    const Vector3d zb = ib.half_length * pose_b.linear().col(2);
    const Vector3d &ca = pose_a.translation(), &cb = pose_b.translation();
    return segment_distance(ca - za, ca + za, cb - zb, cb + zb) - ia.sweep_radius - ib.sweep_radius;
  }
  const Isometry3d place_a = pose_a * ia.offset, place_b = pose_b * ib.offset;
  const double apart = library_distance(*ia.geometry, place_a, *ib.geometry, place_b);
  if (apart > 0) return apart;
  return std::min(0.0, -overlap(ia.solid, place_a, ib.solid, place_b));
}

double clearance_bound(const Collider& a, const Isometry3d& pose_a, const Collider& b,
                       const Isometry3d& pose_b) {
  return (pose_a * a.center() - pose_b * b.center()).norm() - a.radius() - b.radius();
}

// The minimum of a convex quadratic over the unit square: the free optimum, then clamped in turn.
double segment_distance(const Vector3d& a0, const Vector3d& a1, const Vector3d& b0,
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
  return (w + s * u - t * v).norm();
}

}  // namespace ayumi
