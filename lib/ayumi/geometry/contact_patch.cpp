// The distance gives the line of contact. The face of one shape that is perpendicular to this line
// is the reference face, and the other shape touches it with its nearest face, edge or corner.
// Projected along the reference face's normal, both overlap in a convex polygon, whose corners are
// corners of either shape or crossings of edges. The ids of the points come from these corners and
// edges, so that a solver recognises a point in the next step. If two points are closer to each
// other than kSame, only the first one is kept.
#include "ayumi/geometry/contact_patch.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/math/elementary.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// A face is perpendicular to the line of contact up to this angle, stated as 1 - cosine. Chosen:
/// 0.26 deg, so that a body that rests on a face with rounding and compliance keeps its patch.
constexpr double kSquare = 1e-5;
/// Two corners that are nearer to each other than this are one [m]. Chosen: 1 um, far below any
/// edge and far above rounding.
constexpr double kSame = 1e-6;
// Definition: parts of the ids of points.
constexpr int kOther = 100, kCrossing = 200, kNearest = 1000, kSwapped = 2000;

/// The part of a core that is farthest out in one direction: a face (anticlockwise seen from
/// outside), an edge or a point.
struct Feature {
  int count = 0;
  std::array<Vector3d, 16> corner;
  Vector3d normal = Vector3d::Zero();  ///< normal of a face

  void add(const Vector3d& p) { corner[static_cast<size_t>(count++)] = p; }
  bool face() const { return count > 2; }
};

Feature of_segment(double half, const Vector3d& direction) {
  Feature f;
  const double z = direction.z();
  if (half == 0) {
    f.add(Vector3d::Zero());
  } else if (std::abs(z) < 0.5) {
    f.add({0, 0, -half});
    f.add({0, 0, half});
  } else {
    f.add({0, 0, z > 0 ? half : -half});
  }
  return f;
}

Feature of_cylinder(const ConvexCore& core, const Vector3d& direction) {
  Feature f;
  const double z = core.half.z(), r = core.disc;
  const double radial = elementary::hypot(direction.x(), direction.y());
  const Vector2d out =
      radial > 1e-9 ? Vector2d(direction.head<2>() / radial) : Vector2d(Vector2d::UnitX());
  if (std::abs(direction.z()) < 0.7) {
    f.add({r * out.x(), r * out.y(), -z});
    f.add({r * out.x(), r * out.y(), z});
    return f;
  }
  const double side = direction.z() > 0 ? 1 : -1;
  f.normal = {0, 0, side};
  for (int k = 0; k < 8; ++k) {
    const double angle = side * 0.25 * M_PI * k, c = elementary::cos(angle),
                 s = elementary::sin(angle);
    f.add({r * (c * out.x() - s * out.y()), r * (s * out.x() + c * out.y()), side * z});
  }
  return f;
}

Feature of_box(const Vector3d& half, const Vector3d& direction) {
  Feature f;
  Eigen::Index k = 0;
  direction.cwiseAbs().maxCoeff(&k);
  const double side = direction[k] > 0 ? 1 : -1;
  const Eigen::Index i = (k + 1) % 3, j = (k + 2) % 3;
  f.normal[k] = side;
  for (const auto& [u, v] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
    Vector3d p;
    p[k] = side * half[k];
    p[i] = u * half[i];
    p[j] = side * v * half[j];
    f.add(p);
  }
  return f;
}

/// The face whose normal is nearest to the direction, within 45 deg; otherwise the corner that is
/// farthest out.
Feature of_hull(const Collider& hull, const Vector3d& direction) {
  Feature f;
  const HullFace* best = nullptr;
  for (const HullFace& face : hull.faces())
    if (!best || face.normal.dot(direction) > best->normal.dot(direction)) best = &face;
  if (best->normal.dot(direction) > 0.7) {
    for (const Vector3d& p : best->corners) f.add(p);
    f.normal = best->normal;
    return f;
  }
  const std::vector<Vector3d>& points = hull.core().points;
  f.add(*std::max_element(points.begin(), points.end(), [&](const auto& p, const auto& q) {
    return p.dot(direction) < q.dot(direction);
  }));
  return f;
}

Feature feature(const Collider& collider, const Isometry3d& core_pose, const Vector3d& direction) {
  const Vector3d d = core_pose.linear().transpose() * direction;
  const ConvexCore& core = collider.core();
  Feature f = !core.points.empty() ? of_hull(collider, d)
              : collider.swept()   ? of_segment(core.half.z(), d)
              : core.disc > 0      ? of_cylinder(core, d)
                                   : of_box(core.half, d);
  for (int i = 0; i < f.count; ++i)
    f.corner[static_cast<size_t>(i)] = core_pose * f.corner[static_cast<size_t>(i)];
  f.normal = core_pose.linear() * f.normal;
  return f;
}

double cross_seen(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// The corners in the plane of the reference face, anticlockwise as seen from outside.
struct Outline {
  int count = 0;
  std::array<Vector2d, 16> corner;
  std::array<int, 16> name;

  const Vector2d& at(int i) const { return corner[static_cast<size_t>((i + count) % count)]; }
  bool holds(const Vector2d& p) const {
    for (int i = 0; i < count; ++i) {
      const Vector2d edge = at(i + 1) - at(i);
      if (cross_seen(edge, p - at(i)) < -kSame * edge.norm()) return false;
    }
    return true;
  }
};

/// Collects the points of the patch over a reference face.
class Over {
 public:
  Over(const Feature& reference, const Feature& other)
      : other_(other), up_(reference.normal), origin_(reference.corner[0]) {
    x_ = (reference.corner[1] - origin_).normalized();
    y_ = up_.cross(x_);
    below_ = seen(reference, false);
    above_ = seen(other, other.face());
  }

  /// Fills the patch, whose normal is already set. `apart` is the sum of the rounding radii of both
  /// shapes.
  void fill(double apart, double reach, bool swapped, ContactPatch& patch) {
    reach_ = reach, apart_ = apart, swapped_ = swapped, patch_ = &patch;
    for (int i = 0; i < above_.count; ++i)
      if (below_.holds(above_.at(i)))
        add(above_.name[static_cast<size_t>(i)], above_.at(i), !swapped);
    if (other_.face())
      for (int i = 0; i < below_.count; ++i)
        if (above_.holds(below_.at(i))) add(kOther + i, below_.at(i), swapped);
    const int edges = other_.face() ? above_.count : above_.count - 1;
    for (int i = 0; i < edges; ++i)
      for (int j = 0; j < below_.count; ++j) cross_edges(i, j);
  }

 private:
  Outline seen(const Feature& f, bool turned) const {
    Outline result;
    result.count = f.count;
    for (int i = 0; i < f.count; ++i) {
      const int from = turned ? f.count - 1 - i : i;
      const Vector3d p = f.corner[static_cast<size_t>(from)] - origin_;
      result.corner[static_cast<size_t>(i)] = {x_.dot(p), y_.dot(p)};
      result.name[static_cast<size_t>(i)] = from;
    }
    return result;
  }

  /// The height of the other shape's face or edge over the reference face.
  double height(const Vector2d& p) const {
    const Vector3d at = origin_ + p.x() * x_ + p.y() * y_;
    if (other_.face()) return other_.normal.dot(other_.corner[0] - at) / other_.normal.dot(up_);
    const Vector3d from = other_.corner[0] - at;
    if (other_.count == 1) return up_.dot(from);
    const Vector3d along = other_.corner[1] - other_.corner[0];
    const Vector3d flat = along - up_.dot(along) * up_;
    const double s = -flat.dot(from) / std::max(flat.squaredNorm(), 1e-30);
    return up_.dot(from + std::clamp(s, 0.0, 1.0) * along);
  }

  void add(int id, const Vector2d& p, bool corner_of_b) {
    const double z = height(p), gap = z - apart_;
    if (gap > reach_ || patch_->count == static_cast<int>(patch_->points.size())) return;
    for (int i = 0; i < count_; ++i)
      if ((places_[static_cast<size_t>(i)] - p).norm() < kSame) return;
    places_[static_cast<size_t>(count_++)] = p;
    PatchPoint& point = patch_->points[static_cast<size_t>(patch_->count++)];
    point.id = id + (swapped_ ? kSwapped : 0);
    point.gap = gap;
    point.position = origin_ + p.x() * x_ + p.y() * y_ + 0.5 * gap * up_;
    point.corner_of_b = corner_of_b;
  }

  void cross_edges(int i, int j) {
    const Vector2d a = above_.at(i), along = above_.at(i + 1) - a;
    const Vector2d b = below_.at(j), edge = below_.at(j + 1) - b;
    const double area = cross_seen(along, edge);
    if (std::abs(area) < 1e-9 * along.norm() * edge.norm()) return;
    const double s = cross_seen(b - a, edge) / area, t = cross_seen(b - a, along) / area;
    if (s <= 0 || s >= 1 || t <= 0 || t >= 1) return;
    add(kCrossing + 16 * above_.name[static_cast<size_t>(i)] + j, a + s * along, false);
  }

  const Feature& other_;
  Vector3d up_, origin_, x_, y_;
  Outline below_, above_;
  double reach_ = 0, apart_ = 0;
  bool swapped_ = false;
  ContactPatch* patch_ = nullptr;
  std::array<Vector2d, 16> places_;
  int count_ = 0;
};

}  // namespace

ContactPatch contact_patch(const Collider& a, const Isometry3d& pose_a, const Collider& b,
                           const Isometry3d& pose_b, double reach) {
  ContactPatch patch;
  const Closest near = closest(a, pose_a, b, pose_b);
  patch.normal = near.normal;
  if (!(near.clearance < reach)) return patch;
  const Feature fa = feature(a, a.core_pose(pose_a), near.normal);
  const Feature fb = feature(b, b.core_pose(pose_b), -near.normal);
  const double square_a = fa.face() ? fa.normal.dot(near.normal) : -1;
  const double square_b = fb.face() ? -fb.normal.dot(near.normal) : -1;
  const bool swapped = square_b > square_a + 1e-9;
  if (std::max(square_a, square_b) > 1 - kSquare) {
    const Feature &reference = swapped ? fb : fa, &other = swapped ? fa : fb;
    patch.normal = swapped ? Vector3d(-fb.normal) : fa.normal;
    Over(reference, other).fill(a.rounding() + b.rounding(), reach, swapped, patch);
  }
  if (patch.count == 0) {
    patch.normal = near.normal;
    patch.count = 1;
    patch.points[0] = {kNearest, 0.5 * (near.on_a + near.on_b), near.clearance, false};
  }
  return patch;
}

}  // namespace ayumi
