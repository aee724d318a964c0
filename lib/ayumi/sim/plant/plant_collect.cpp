// Which points of the robot may touch in a step, and how. docs/theory.md, "Contact and servo
// integration".
#include <algorithm>
#include <cmath>
#include <limits>

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/sim/plant/plant.hpp"

namespace ayumi {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr double kLevel = 1e-3;        // tilt below which a circle has no lowest point [rad]
constexpr double kNear = 1e-3;         // a gap that may close within a step [m]
constexpr long kInnerKeys = 1l << 40;  // keys of one sole's inner points
constexpr long kEdgeKeys = 1l << 32;   // where edges of the ground meet shapes; times 4096
constexpr long kTipKeys = 1l << 31;    // of those, tips of the height field;
constexpr long kTipsOfShape = 1l << 26;
constexpr long kLinkKeys = 1l << 60;  // where links meet

}  // namespace

// A lower bound of a group's height over everything the ground has.
double Plant::above_ground(const PointGroup& group) const {
  const Vector3d up = ground_.normal();
  const Vector3d turned = data_.rotation[group.body].transpose() * up;
  const Vector3d origin = data_.base_position - ground_.pose().translation();
  return up.dot(origin + data_.position[group.body]) + turned.dot(group.center) - group.radius -
         ground_.top();
}

// No point of the robot is faster against the floor.
double Plant::fastest_approach() const {
  if (!ground_.at_rest()) return std::numeric_limits<double>::infinity();
  double speed = 0, turning = 0;
  for (const PointGroup& group : groups_) {
    speed = std::max(speed, data_.velocity[group.body].squaredNorm());
    turning = std::max(turning, data_.angular_velocity[group.body].squaredNorm());
  }
  return std::sqrt(speed) + std::sqrt(turning) * widest_;
}

// Gravity and servos can change the approach within the step: keep what may arrive in three.
bool Plant::far(double gap, int body, const Active& active, double dt) const {
  const Vector3d approach = point_velocity(data_, body, active.position) - active.ground_velocity;
  return gap + 3 * dt * std::min(active.to_contact.row(0).dot(approach), 0.0) > kNear;
}

void Plant::place_frame(const Vector3d& normal, Active& active) const {
  Vector3d along = Vector3d::UnitX() - normal.x() * normal;
  if (along.squaredNorm() < 0.01) along = Vector3d::UnitY() - normal.y() * normal;
  along.normalize();
  active.to_contact.row(0) = normal;
  active.to_contact.row(1) = along;
  active.to_contact.row(2) = normal.cross(along);
}

void Plant::collect_contacts(double dt) {
  last_active_.swap(active_);
  active_.clear();
  const Eigen::Isometry3d& floor = ground_.pose();
  const Matrix3d to_floor = floor.linear().transpose();
  Active active;
  place_frame(ground_.normal(), active);
  const Matrix3d level = active.to_contact;
  const double reach = kNear + 3 * dt * fastest_approach();
  for (size_t g = 0; g < groups_.size(); ++g) {
    const PointGroup& group = groups_[g];
    const Matrix3d& R = data_.rotation[group.body];
    if (above_ground(group) > reach) continue;
    active.position = data_.base_position + (data_.position[group.body] + R * group.center);
    active.to_contact = level;
    active.ground_velocity = ground_.velocity(active.position);
    const double height =
        ground_.normal().dot(active.position - floor.translation()) - group.radius - ground_.top();
    const double spread = group.radius * data_.angular_velocity[group.body].norm();
    if (far(height - 3 * dt * spread, group.body, active, dt)) continue;
    for (int i = group.first; i < group.first + group.count; ++i) {
      const ContactPoint& point = points_[static_cast<size_t>(i)];
      Vector3d center = data_.base_position + (data_.position[group.body] + R * point.position);
      if (point.rim > 0) {
        const Vector3d across = R * point.axis, up = ground_.normal();
        const Vector3d out = across.dot(up) * across - up;  // down, within the circle
        if (out.squaredNorm() < kLevel * kLevel) continue;
        center += point.rim / out.norm() * out;
      }
      const Vector3d local = to_floor * (center - floor.translation());
      active.key = i;
      active.body = point.body;
      active.side = point.side;
      active.vertex = point.vertex;
      active.stiffness = point.stiffness;
      active.damping_time = point.damping_time;
      active.ground_velocity = ground_.velocity(center);
      if (ground_.plain()) {
        active.gap = local.z() - ground_.top() - point.radius;
        active.to_contact = level;
      } else {
        const GroundTouch touch = ground_.touch(local);
        active.gap = touch.gap - point.radius;
        place_frame(floor.linear() * touch.normal, active);
        active.ground_velocity += touch.rise * ground_.normal();
      }
      active.position = center - point.radius * active.to_contact.row(0).transpose();
      if (far(active.gap, group.body, active, dt)) continue;
      active.friction = ground_.friction(local);
      active_.push_back(active);
    }
    if (points_[static_cast<size_t>(group.first)].side >= 0 && !ground_.plain())
      collect_inner(g, dt);
  }
  if (!ground_.plain()) collect_edges(dt);
  collect_links(dt);
  remember_impulses();
}

// Corners and edges of the ground under the sole whose points this group holds.
void Plant::collect_inner(size_t g, double dt) {
  const PointGroup& group = groups_[g];
  const Eigen::Isometry3d& floor = ground_.pose();
  const Matrix3d& R = data_.rotation[group.body];
  // A body may carry both soles, or a sole may share its group with nothing else: by side.
  for (int first = group.first; first < group.first + group.count;) {
    const int side = points_[static_cast<size_t>(first)].side;
    int last = first;
    outline_.clear();
    for (; last < group.first + group.count && points_[static_cast<size_t>(last)].side == side;
         ++last)
      outline_.push_back(floor.inverse() *
                         Vector3d(data_.base_position + data_.position[group.body] +
                                  R * points_[static_cast<size_t>(last)].position));
    inner_.clear();
    if (side >= 0 && outline_.size() > 2) ground_.inner_points(outline_, 3 * kNear, inner_);
    for (const InnerPoint& inner : inner_) {
      Active active;
      active.key = kInnerKeys * (side + 1) + inner.id;
      active.body = group.body;
      active.side = side;
      active.stiffness = points_[static_cast<size_t>(first)].stiffness;
      active.damping_time = points_[static_cast<size_t>(first)].damping_time;
      active.gap = inner.gap;
      active.position = floor * inner.on_sole;
      place_frame(ground_.normal(), active);
      active.ground_velocity = ground_.velocity(active.position) + inner.rise * ground_.normal();
      if (far(active.gap, group.body, active, dt)) continue;
      active.friction = ground_.friction(inner.on_sole);
      active_.push_back(active);
    }
    first = last;
  }
}

// Edges and corners of blocks and tips of the height field against faces and edges of the shapes
// that are not feet. Corners of shapes have met the ground already.
void Plant::collect_edges(double dt) {
  for (size_t i = 0; i < is_foot_.size(); ++i) {
    const int body = static_cast<int>(i);
    const double radius = links_.radius(body);
    if (is_foot_[i] || radius == 0) continue;
    const Vector3d center = data_.pose(body) * links_.center(body) - ground_.pose().translation();
    if (ground_.normal().dot(center) - radius > ground_.top() + 3 * kNear) continue;
    long key = kEdgeKeys * (body + 1l);
    for (const CollisionModel::PlacedCollider& shape : links_.shapes(body))
      for (const SolidBlock& block : ground_.solids()) collect_edges(body, shape, block, ++key, dt);
    ground_.tips(ground_.pose().inverse() * (center + ground_.pose().translation()),
                 radius + 3 * kNear, tips_);
    key = kEdgeKeys * (body + 1l) + kTipKeys;
    for (const CollisionModel::PlacedCollider& shape : links_.shapes(body)) {
      for (const FieldTip& tip : tips_) collect_edges(body, shape, tip.solid, key + tip.id, dt);
      key += kTipsOfShape;
    }
  }
}

void Plant::collect_edges(int body, const CollisionModel::PlacedCollider& shape,
                          const SolidBlock& block, long key, double dt) {
  const Eigen::Isometry3d& floor = ground_.pose();
  const Eigen::Isometry3d pose = data_.pose(body) * shape.pose, block_pose = floor * block.pose;
  if (clearance_bound(block.collider, block_pose, shape.collider, pose) > 3 * kNear) return;
  const ContactPatch patch =
      contact_patch(block.collider, block_pose, shape.collider, pose, 3 * kNear);
  for (int i = 0; i < patch.count; ++i) {
    const PatchPoint& point = patch.points[static_cast<size_t>(i)];
    if (point.corner_of_b) continue;
    Active active;
    active.key = (key << 12) + point.id;
    active.body = body;
    active.stiffness = link_stiffness_;
    active.damping_time = kBodyDamping;
    active.gap = point.gap;
    active.position = point.position;
    place_frame(patch.normal, active);
    active.ground_velocity = ground_.velocity(point.position) + block.rise * ground_.normal();
    if (far(active.gap, body, active, dt)) continue;
    active.friction = ground_.friction(floor.inverse() * point.position);
    active_.push_back(active);
  }
}

void Plant::collect_links(double dt) {
  for (const LinkTouch& touch : links_.find(data_, kNear, dt)) {
    Active active;
    active.key = kLinkKeys + touch.key;
    active.body = touch.a;
    active.other = touch.b;
    active.stiffness = link_stiffness_;
    active.damping_time = kBodyDamping;
    active.gap = touch.gap;
    active.position = touch.position;
    place_frame(touch.normal, active);
    active.ground_velocity = point_velocity(data_, touch.b, touch.position);
    if (far(active.gap, active.body, active, dt)) continue;
    active.ground_velocity.setZero();  // the other body's is part of the rows
    active.friction = link_friction_;
    active_.push_back(active);
  }
}

// Points that touched in the last step start from their impulse; those that have left forget it.
void Plant::remember_impulses() {
  const auto by_key = [](const Active& a, const Active& b) { return a.key < b.key; };
  if (!std::is_sorted(active_.begin(), active_.end(), by_key))
    std::sort(active_.begin(), active_.end(), by_key);
  size_t last = 0;
  for (Active& active : active_) {
    while (last < last_active_.size() && last_active_[last].key < active.key) ++last;
    if (last == last_active_.size()) break;
    if (last_active_[last].key != active.key) continue;
    active.impulse = last_active_[last].impulse;
    active.deflection = last_active_[last].deflection;
  }
}

}  // namespace ayumi
