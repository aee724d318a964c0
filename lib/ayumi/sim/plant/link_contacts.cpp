#include "ayumi/sim/plant/link_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ayumi/dynamics/kinematics.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

// Definition of keys: 4096 points for each pair of shapes, 4096 pairs of shapes for each pair of
// bodies.
constexpr long kPairKeys = 1l << 24, kShapeKeys = 1l << 12;

}  // namespace

LinkContacts::LinkContacts(const RobotModel& model)
    : shapes_(model, MeshAs::hull),
      center_(model.bodies().size(), Vector3d::Zero()),
      radius_(model.bodies().size(), 0.0) {
  for (const CollisionModel::Pair& pair : shapes_.pairs()) {
    pairs_.push_back({pair.a, pair.b, 0, 0, lines_.size()});
    lines_.resize(lines_.size() + shapes_.shapes(pair.a).size() * shapes_.shapes(pair.b).size());
    bodies_.push_back(pair.a);
    bodies_.push_back(pair.b);
  }
  std::sort(bodies_.begin(), bodies_.end());
  bodies_.erase(std::unique(bodies_.begin(), bodies_.end()), bodies_.end());
  for (size_t body = 0; body < center_.size(); ++body) {
    const auto& shapes = shapes_.shapes(static_cast<int>(body));
    Vector3d& center = center_[body];
    double& radius = radius_[body];
    for (const auto& shape : shapes)
      center += shape.pose * shape.collider.center() / static_cast<double>(shapes.size());
    for (const auto& shape : shapes)
      radius = std::max(
          radius, (shape.pose * shape.collider.center() - center).norm() + shape.collider.radius());
  }
  reset();
}

void LinkContacts::reset() {
  moved_ = last_dt_ = 0;
  least_ = -std::numeric_limits<double>::infinity();
  for (Pair& pair : pairs_) pair.clearance = least_, pair.mark = 0;
  std::fill(lines_.begin(), lines_.end(), Vector3d::Zero());
}

const std::vector<LinkTouch>& LinkContacts::find(const RobotData& data, double near, double dt) {
  touches_.clear();
  if (pairs_.empty()) return touches_;
  double square = 0;
  for (const int body : bodies_) {
    const size_t i = static_cast<size_t>(body);
    const Vector3d& w = data.angular_velocity[i];
    const Vector3d v = data.velocity[i] + w.cross(data.rotation[i] * center_[i]);
    square = std::max(square, v.squaredNorm() + radius_[i] * radius_[i] * w.squaredNorm());
  }
  const double speed = std::sqrt(2 * square);  // at least |v| + r |w| of each body
  // The last step moved the bodies with their present speeds; the next steps may be faster.
  moved_ += 2 * speed * last_dt_;
  last_dt_ = dt;
  const double reach = near + 6 * speed * dt;
  if (least_ - moved_ > reach) return touches_;
  least_ = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < pairs_.size(); ++i) {
    Pair& pair = pairs_[i];
    if (!(pair.clearance - (moved_ - pair.mark) > reach)) {
      pair.clearance = apart(pair, data, reach);
      pair.mark = moved_;
      if (pair.clearance <= reach) touch(pair, static_cast<long>(i), data, reach);
    }
    least_ = std::min(least_, pair.clearance + pair.mark);
  }
  return touches_;
}

// The clearance of a pair, or a lower bound of it if both are larger than `reach`.
double LinkContacts::apart(const Pair& pair, const RobotData& data, double reach) {
  const Isometry3d A = data.pose(pair.a), B = data.pose(pair.b);
  double nearest = std::numeric_limits<double>::infinity();
  size_t line = pair.first;
  for (const auto& a : shapes_.shapes(pair.a)) {
    const Isometry3d pose_a = A * a.pose;
    for (const auto& b : shapes_.shapes(pair.b)) {
      const Isometry3d pose_b = B * b.pose;
      Vector3d& along = lines_[line++];
      double bound = clearance_bound(a.collider, pose_a, b.collider, pose_b);
      if (!along.isZero(0))
        bound = std::max(
            bound, clearance_along(A.linear() * along, a.collider, pose_a, b.collider, pose_b));
      if (bound <= reach) {
        const Closest here = closest(a.collider, pose_a, b.collider, pose_b);
        along = A.linear().transpose() * here.normal;
        bound = here.clearance;
      }
      nearest = std::min(nearest, bound);
    }
  }
  return nearest;
}

void LinkContacts::touch(const Pair& pair, long index, const RobotData& data, double reach) {
  const Isometry3d A = data.pose(pair.a), B = data.pose(pair.b);
  long key = index * kPairKeys;
  for (const auto& a : shapes_.shapes(pair.a)) {
    for (const auto& b : shapes_.shapes(pair.b)) {
      const Isometry3d pose_a = A * a.pose, pose_b = B * b.pose;
      if (clearance_bound(a.collider, pose_a, b.collider, pose_b) <= reach) {
        // In a patch the second shape is the one that is pushed; in a LinkTouch it is the first
        // body.
        const ContactPatch patch = contact_patch(b.collider, pose_b, a.collider, pose_a, reach);
        for (int i = 0; i < patch.count; ++i) {
          const PatchPoint& point = patch.points[static_cast<size_t>(i)];
          touches_.push_back(
              {key + point.id, pair.a, pair.b, point.position, patch.normal, point.gap});
        }
      }
      key += kShapeKeys;
    }
  }
}

}  // namespace ayumi
