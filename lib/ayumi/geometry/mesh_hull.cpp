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
/// Number of consecutive vertices that are passed over together if they cannot be farthest out.
/// Chosen: neighbours in a file mostly are neighbours in space.
constexpr size_t kBlock = 32;
/// Distance from a plane below which points count as being in it, relative to the points' extent.
/// Chosen: above the rounding of single precision, in which mesh files store vertices.
constexpr double kCoplanar = 1e-6;
/// Factor on the square of this distance above which rounding cannot bring a point back into the
/// plane. Chosen: far above the rounding of doubles.
constexpr double kSurely = 1.01;
/// Largest number of corners of a face. Definition: the number that contact_patch() can handle.
constexpr size_t kFaceCorners = 16;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Whether the line through two points certainly runs through the inside of the hull: every plane
/// that contains the line has a point more than `flat` on each of its sides, so no face of the hull
/// has both points. The function searches for three points whose triangle surrounds the line, as
/// seen along the line.
bool surely_inside(const std::vector<Vector3d>& points, const Vector3d& origin,
                   const Vector3d& edge, double flat) {
  const double length = edge.norm();
  if (!(length > 0)) return false;
  const Vector3d along = edge / length, x = along.unitOrthogonal(), y = along.cross(x);
  const auto surrounds = [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    const double area = cross(a, b);  // the distance of the side from the line, times its length
    return area > 0 && area * area > kSurely * flat * flat * (b - a).squaredNorm();
  };
  // The rightmost and the leftmost point so far; they are less than half a turn apart.
  Eigen::Vector2d right = Eigen::Vector2d::Zero(), left = right;
  for (const Vector3d& p : points) {
    const Vector3d d = p - origin;
    const Eigen::Vector2d w(x.dot(d), y.dot(d));
    if (w.squaredNorm() <= 4 * flat * flat) continue;
    if (right.isZero(0)) {
      right = left = w;
      continue;
    }
    const double from_right = cross(right, w), from_left = cross(left, w);
    if (from_right > 0 && from_left > 0)
      left = w;
    else if (from_right < 0 && from_left < 0)
      right = w;
    else if (surrounds(right, left) && surrounds(left, w) && surrounds(w, right))
      return true;
  }
  return false;
}

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

Eigen::AlignedBox3d bounding_box(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const MeshPart& part : mesh.parts)
    for (const Eigen::Vector3f& v : part.vertices) box.extend(v.cast<double>());
  if (!(box.min().x() <= box.max().x())) return {Vector3d::Zero(), Vector3d::Zero()};
  return box;
}

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
  std::vector<Eigen::AlignedBox3d> blocks((all.size() + kBlock - 1) / kBlock);
  for (size_t k = 0; k < all.size(); ++k) blocks[k / kBlock].extend(all[k]);
  for (int i = 0; i < kDirections; ++i) {  // a spiral from pole to pole
    const double z = 1 - (2 * i + 1.0) / kDirections, turn = M_PI * (3 - std::sqrt(5.0)) * i;
    const double r = std::sqrt(1 - z * z);
    const Vector3d out(r * elementary::cos(turn), r * elementary::sin(turn), z);
    size_t farthest = 0;
    double most = all[0].dot(out);
    for (size_t b = 0; b < blocks.size(); ++b) {
      // No vertex of the block is farther out than this corner. Rounding does not change this,
      // because products and sums are monotonic.
      const Vector3d corner = (out.array() > 0).select(blocks[b].max(), blocks[b].min());
      if (corner.dot(out) <= most) continue;
      for (size_t k = b * kBlock; k < std::min((b + 1) * kBlock, all.size()); ++k) {
        const double distance = all[k].dot(out);
        if (!(most < distance)) continue;
        most = distance;
        farthest = k;
      }
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
    for (size_t j = i + 1; j < points.size(); ++j) {
      if (surely_inside(points, points[i], points[j] - points[i], flat)) continue;
      for (size_t k = j + 1; k < points.size(); ++k) {
        const Vector3d u = points[j] - points[i], v = points[k] - points[i], n = u.cross(v);
        const double square = n.squaredNorm();
        const bool above = is_out(n.dot(points[outer[0]] - points[i]), square);
        const bool below = is_out(-n.dot(points[outer[1]] - points[i]), square);
        if ((above && below) || n.norm() <= 1e-4 * u.norm() * v.norm()) continue;
        if (!above) take(points[i], n.normalized(), outer[0]);
        if (!below) take(points[i], -n.normalized(), outer[1]);
      }
    }
  return faces;
}

MeshHull::MeshHull(const TriangleMesh& mesh)
    : center(bounding_box(mesh).center()), vertices(outer_vertices(mesh)), points(vertices) {
  for (Vector3d& p : points) p -= center;
  faces = hull_faces(points);
}

}  // namespace ayumi
