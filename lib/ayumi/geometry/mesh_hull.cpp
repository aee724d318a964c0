#include "ayumi/geometry/mesh_hull.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "ayumi/math/elementary.hpp"

namespace ayumi {

using Eigen::Vector3d;

namespace {

/// A mesh with at most this many vertices uses all of them. Chosen: the time of hull_faces() grows
/// with the cube of the number of points.
constexpr size_t kMeshPoints = 32;
/// If a mesh has more vertices than this, duplicates are not removed first. Chosen: sorting more of
/// them takes more time than it saves; the hull is the same.
constexpr size_t kManyVertices = 4096;
/// Number of directions in which the vertices of a larger mesh are chosen. Chosen: they are about
/// 21 deg apart, so that the hull is at most 4 % of its radius inside a sphere (1 - cos 16 deg).
constexpr int kDirections = 90;
/// Distance from a plane below which points count as being in it, relative to the points' extent.
/// Chosen: above the rounding of single precision, in which mesh files store vertices.
constexpr double kCoplanar = 1e-6;
/// Factor on the square of this distance above which rounding cannot bring a point back into the
/// plane. Chosen: far above the rounding of doubles.
constexpr double kSurely = 1.01;
/// Largest number of corners of a face. Definition: the number that contact_patch() can handle.
constexpr size_t kFaceCorners = 16;

/// The corners of the convex polygon of points in a plane, anticlockwise about the normal.
std::vector<Vector3d> outline(const std::vector<Vector3d>& points, const Vector3d& normal) {
  const Vector3d x = normal.unitOrthogonal(), y = normal.cross(x);
  std::vector<Eigen::Vector2d> flat;
  for (const Vector3d& p : points) flat.emplace_back(x.dot(p), y.dot(p));
  std::vector<size_t> order(points.size()), corners;
  for (size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return std::pair(flat[a].x(), flat[a].y()) < std::pair(flat[b].x(), flat[b].y());
  });
  const auto chain = [&](size_t keep, size_t p) {  // Andrew's monotone chain algorithm
    while (corners.size() >= keep + 2) {
      const Eigen::Vector2d &a = flat[corners[corners.size() - 2]], &b = flat[corners.back()];
      const Eigen::Vector2d u = b - a, v = flat[p] - b;
      if (u.x() * v.y() - u.y() * v.x() > 1e-9 * u.norm() * v.norm()) break;
      corners.pop_back();
    }
    corners.push_back(p);
  };
  for (const size_t p : order) chain(0, p);
  const size_t upper = corners.size() - 1;
  for (size_t i = order.size() - 1; i-- > 0;) chain(upper, order[i]);
  corners.pop_back();
  std::vector<Vector3d> result;
  const size_t n = corners.size(), kept = std::min(n, kFaceCorners);
  for (size_t i = 0; i < kept; ++i) result.push_back(points[corners[i * n / kept]]);
  return result;
}

}  // namespace

std::vector<Vector3d> outer_vertices(const TriangleMesh& mesh) {
  std::vector<Vector3d> all, result;
  for (const MeshPart& part : mesh.parts)
    for (const Eigen::Vector3f& v : part.vertices) all.push_back(v.cast<double>());
  const auto before = [](const Vector3d& a, const Vector3d& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  };
  const auto sort_out = [&](std::vector<Vector3d>& points) {
    std::sort(points.begin(), points.end(), before);
    points.erase(std::unique(points.begin(), points.end()), points.end());
  };
  if (all.size() <= kManyVertices) sort_out(all);
  if (all.size() <= kMeshPoints) return all;
  for (int i = 0; i < kDirections; ++i) {  // a spiral from pole to pole
    const double z = 1 - (2 * i + 1.0) / kDirections, turn = M_PI * (3 - std::sqrt(5.0)) * i;
    const double r = std::sqrt(1 - z * z);
    const Vector3d out(r * elementary::cos(turn), r * elementary::sin(turn), z);
    size_t farthest = 0;
    double most = all[0].dot(out);
    for (size_t k = 1; k < all.size(); ++k) {
      const double distance = all[k].dot(out);
      if (!(most < distance)) continue;
      most = distance;
      farthest = k;
    }
    result.push_back(all[farthest]);
  }
  sort_out(result);
  return result;
}

std::vector<HullFace> hull_faces(const std::vector<Vector3d>& points) {
  std::vector<HullFace> faces;
  double extent = 0;
  for (const Vector3d& p : points) extent = std::max(extent, (p - points[0]).norm());
  const double flat = kCoplanar * extent;
  // The plane of three points contains a face if no point is on its outer side. The point that was
  // on the outer side of the previous plane is often on that of the next one too, so it is tried
  // first, by side of the plane.
  std::array<size_t, 2> outer = {0, 0};
  std::vector<Vector3d> on;
  const auto take = [&](const Vector3d& origin, const Vector3d& normal, size_t& outer_point) {
    on.clear();
    bool any_below = false;
    for (size_t i = 0; i < points.size(); ++i) {
      const double out = normal.dot(points[i] - origin);
      if (out > flat) {
        outer_point = i;
        return;
      }
      any_below |= out < -flat;
      if (out >= -flat) on.push_back(points[i]);
    }
    for (const HullFace& face : faces)
      if ((face.normal - normal).squaredNorm() < 1e-8 &&
          std::abs(normal.dot(face.corners[0] - origin)) <= 2 * flat)
        return;
    if (any_below) faces.push_back({normal, outline(on, normal)});
  };
  // Whether a distance from a plane, times the length of its normal, is larger than `flat` with
  // certainty.
  const auto is_out = [&](double distance, double square) {
    return distance > 0 && distance * distance > kSurely * flat * flat * square;
  };
  for (size_t i = 0; i < points.size(); ++i)
    for (size_t j = i + 1; j < points.size(); ++j)
      for (size_t k = j + 1; k < points.size(); ++k) {
        const Vector3d u = points[j] - points[i], v = points[k] - points[i], n = u.cross(v);
        const double square = n.squaredNorm();
        const bool above = is_out(n.dot(points[outer[0]] - points[i]), square);
        const bool below = is_out(-n.dot(points[outer[1]] - points[i]), square);
        if ((above && below) || n.norm() <= 1e-4 * u.norm() * v.norm()) continue;
        if (!above) take(points[i], n.normalized(), outer[0]);
        if (!below) take(points[i], -n.normalized(), outer[1]);
      }
  return faces;
}

}  // namespace ayumi
