#include "ayumi/sim/plant/contact_points.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/geometry/box_corner.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/math/polygon.hpp"
#include "ayumi/model/foot_bodies.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// Penetration of a body that rests on four of its points [m]. Chosen: almost rigid, and far above
/// the rounding of positions at 10 m (2e-15 m). Between half and twice the value, figures change by
/// less than 5 %.
constexpr double kStaticSink = 1e-7;

/// Points of a collision shape that may touch the ground, in the frame of the link. `hull` is that
/// of a mesh.
std::vector<ContactPoint> touch_points(const PlacedShape& placed, const MeshHull& hull) {
  std::vector<ContactPoint> points;
  const auto add = [&](const Vector3d& p, double radius) {
    points.push_back({.position = placed.pose * p, .radius = radius});
  };
  if (const auto* box = std::get_if<Box>(&placed.shape)) {
    const Vector3d half = 0.5 * box->size;
    for (int k = 0; k < 8; ++k) add(box_corner(half, k), 0);
  } else if (const auto* sphere = std::get_if<Sphere>(&placed.shape)) {
    add(Vector3d::Zero(), sphere->radius);
  } else if (const auto* capsule = std::get_if<Capsule>(&placed.shape)) {
    for (double s : {-0.5, 0.5}) add({0, 0, s * capsule->length}, capsule->radius);
  } else if (const auto* cylinder = std::get_if<Cylinder>(&placed.shape)) {
    for (int k = 0; k < 16; ++k) {
      const double a = 0.25 * M_PI * (k / 2);
      const double z = (k % 2 - 0.5) * cylinder->length;
      add({cylinder->radius * elementary::cos(a), cylinder->radius * elementary::sin(a), z}, 0);
    }
    for (double s : {-0.5, 0.5}) {
      add({0, 0, s * cylinder->length}, 0);
      points.back().rim = cylinder->radius;
      points.back().axis = placed.pose.linear().col(2);
    }
  } else {
    for (const Vector3d& vertex : hull.vertices) add(vertex, 0);
  }
  return points;
}

/// Whether the foot's sole lies between the ground and a point of the link above the foot when the
/// robot stands at home. An ankle whose shape is nearly as low as the foot does not touch the
/// ground when the leg leans.
class ShieldedByFoot {
 public:
  explicit ShieldedByFoot(const RobotModel& model) : model_(model), data_(model) {
    update_positions(model, model.rest_state(), data_);
  }

  bool operator()(int body, const Vector3d& position) const {
    for (Side side : {Side::left, Side::right}) {
      const Sole& sole = model_.sole(side);
      if (model_.bodies()[static_cast<size_t>(sole.body)].parent != body) continue;
      const Vector3d place =
          sole_pose(model_, data_, side).inverse() * (data_.pose(body) * position);
      if (place.z() > 0 && ConvexPolygon(sole.polygon).margin(place.head<2>()) > 0) return true;
    }
    return false;
  }

 private:
  const RobotModel& model_;
  RobotData data_;
};

}  // namespace

double body_stiffness(const RobotModel& model) {
  return 0.25 * model.mass() * kGravity / kStaticSink;
}

std::vector<ContactPoint> contact_points(const RobotModel& model) {
  std::vector<ContactPoint> points;
  for (Side side : {Side::left, Side::right}) {
    if (!model.has_soles()) break;
    const Sole& sole = model.sole(side);
    const double count = static_cast<double>(sole.polygon.size());
    for (size_t i = 0; i < sole.polygon.size(); ++i) {
      const Vector2d& p = sole.polygon[i];
      ContactPoint point;
      point.body = sole.body;
      point.position = sole.frame * Vector3d(p.x(), p.y(), 0);
      point.stiffness = sole.stiffness / count;
      point.damping_time = sole.damping_time;
      point.side = static_cast<int>(side);
      point.vertex = static_cast<int>(i);
      points.push_back(point);
    }
  }
  std::optional<ShieldedByFoot> shielded;
  if (model.has_soles()) shielded.emplace(model);
  for (size_t l = 0; l < model.links().size(); ++l) {
    const Link& link = model.links()[l];
    if (is_of_foot(model, link.body)) continue;
    for (size_t i = 0; i < link.collisions.size(); ++i) {
      for (ContactPoint point : touch_points(link.collisions[i], model.collision_hulls()[l][i])) {
        point.body = link.body;
        point.position = link.pose * point.position;
        if (shielded && (*shielded)(link.body, point.position)) continue;
        point.axis = link.pose.linear() * point.axis;
        point.stiffness = body_stiffness(model);
        point.damping_time = kBodyDamping;
        points.push_back(point);
      }
    }
  }
  return points;
}

std::vector<PointGroup> group_points(const std::vector<ContactPoint>& points) {
  std::vector<PointGroup> groups;
  for (size_t i = 0; i < points.size(); ++i) {
    if (groups.empty() || groups.back().body != points[i].body)
      groups.push_back({.body = points[i].body, .first = static_cast<int>(i)});
    ++groups.back().count;
  }
  for (PointGroup& group : groups) {
    const ContactPoint* first = &points[static_cast<size_t>(group.first)];
    for (int i = 0; i < group.count; ++i) group.center += first[i].position / group.count;
    for (int i = 0; i < group.count; ++i)
      group.radius = std::max(
          group.radius, (first[i].position - group.center).norm() + first[i].radius + first[i].rim);
  }
  return groups;
}

void corner_weights(const std::vector<Vector2d>& polygon, const Vector2d& p,
                    std::vector<double>& weights) {
  const size_t n = polygon.size();
  const auto area = [](const Vector2d& a, const Vector2d& b, const Vector2d& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
  };
  weights.resize(n);
  double sum = 0;
  for (size_t i = 0; i < n; ++i) {
    double w = area(polygon[(i + n - 1) % n], polygon[i], polygon[(i + 1) % n]);
    for (size_t j = 0; j < n; ++j)  // for all sides that do not end at corner i
      if (j != i && (j + 1) % n != i) w *= std::max(0.0, area(polygon[j], polygon[(j + 1) % n], p));
    weights[i] = w;
    sum += w;
  }
  for (double& w : weights) w = sum > 0 ? w / sum : 1.0 / static_cast<double>(n);
}

}  // namespace ayumi
