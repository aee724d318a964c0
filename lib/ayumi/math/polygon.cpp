#include "ayumi/math/polygon.hpp"

#include <algorithm>
#include <limits>

namespace ayumi {

using Eigen::Vector2d;

namespace {

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

Vector2d nearest_on_segment(const Vector2d& a, const Vector2d& b, const Vector2d& p) {
  const Vector2d ab = b - a;
  const double length2 = ab.squaredNorm();
  const double s = length2 > 0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
  return a + s * ab;
}

}  // namespace

ConvexPolygon::ConvexPolygon(std::vector<Vector2d> points) { assign(points); }

// Computes the hull by Andrew's monotone chain.
void ConvexPolygon::assign(std::vector<Vector2d>& points) {
  std::sort(points.begin(), points.end(), [](const Vector2d& a, const Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) {
    vertices_ = points;
    return;
  }
  std::vector<Vector2d>& hull = vertices_;
  hull.resize(2 * points.size());
  size_t k = 0;
  auto add = [&](const Vector2d& p, size_t floor) {
    while (k >= floor && cross(hull[k - 1] - hull[k - 2], p - hull[k - 1]) <= 0) --k;
    hull[k++] = p;
  };
  for (const Vector2d& p : points) add(p, 2);
  const size_t lower = k + 1;
  for (size_t i = points.size() - 1; i-- > 0;) add(points[i], lower);
  hull.resize(k - 1);
}

double ConvexPolygon::margin(const Vector2d& p) const {
  if (vertices_.empty()) return -std::numeric_limits<double>::infinity();
  const size_t n = vertices_.size();
  if (n >= 3) {
    double inside = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < n; ++i) {
      const Vector2d edge = vertices_[(i + 1) % n] - vertices_[i];
      inside = std::min(inside, cross(edge, p - vertices_[i]) / edge.norm());
    }
    if (inside >= 0) return inside;
  }
  return -(p - project(p)).norm();
}

Vector2d ConvexPolygon::project(const Vector2d& p) const {
  const size_t n = vertices_.size();
  if (n == 0) return p;
  bool inside = n >= 3;
  Vector2d best = vertices_[0];
  double best_distance = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < n; ++i) {
    const Vector2d &a = vertices_[i], &b = vertices_[(i + 1) % n];
    if (cross(b - a, p - a) < 0) inside = false;
    const Vector2d q = nearest_on_segment(a, b, p);
    const double distance = (p - q).squaredNorm();
    if (distance < best_distance) {
      best_distance = distance;
      best = q;
    }
  }
  return inside ? p : best;
}

ConvexPolygon ConvexPolygon::shrunk(double distance) const {
  std::vector<Vector2d> kept, next;
  ConvexPolygon result;
  shrink_into(distance, kept, next, result);
  return result;
}

// Clips the polygon by each edge moved inwards (Sutherland-Hodgman).
void ConvexPolygon::shrink_into(double distance, std::vector<Vector2d>& kept,
                                std::vector<Vector2d>& next, ConvexPolygon& result) const {
  kept = vertices_;
  if (vertices_.size() < 3 || distance <= 0) {
    result.vertices_ = vertices_;
    return;
  }
  const size_t n = vertices_.size();
  for (size_t i = 0; i < n && !kept.empty(); ++i) {
    const Vector2d edge = (vertices_[(i + 1) % n] - vertices_[i]).normalized();
    auto depth = [&](const Vector2d& p) { return cross(edge, p - vertices_[i]) - distance; };
    next.clear();
    for (size_t j = 0; j < kept.size(); ++j) {
      const Vector2d &a = kept[j], &b = kept[(j + 1) % kept.size()];
      const double da = depth(a), db = depth(b);
      if (da >= 0) next.push_back(a);
      if ((da >= 0) != (db >= 0)) next.push_back(a + da / (da - db) * (b - a));
    }
    kept.swap(next);
  }
  if (kept.empty()) kept.push_back(centroid());
  result.assign(kept);
}

double ConvexPolygon::support(const Vector2d& n) const {
  double best = -std::numeric_limits<double>::infinity();
  for (const Vector2d& v : vertices_) best = std::max(best, n.dot(v));
  return best;
}

Vector2d ConvexPolygon::centroid() const {
  Vector2d sum = Vector2d::Zero();
  double area = 0;
  for (size_t i = 1; i + 1 < vertices_.size(); ++i) {
    const double a = cross(vertices_[i] - vertices_[0], vertices_[i + 1] - vertices_[0]);
    area += a;
    sum += a / 3.0 * (vertices_[0] + vertices_[i] + vertices_[i + 1]);
  }
  if (area > 0) return sum / area;
  sum.setZero();
  for (const Vector2d& v : vertices_) sum += v;
  return vertices_.empty() ? sum : Vector2d(sum / static_cast<double>(vertices_.size()));
}

}  // namespace ayumi
