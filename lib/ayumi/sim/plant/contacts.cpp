// A gap g that changes at the rate v (negative while the gap closes) becomes a contact if
// g + 3 h min(v, 0) < kContactMargin. Gravity and servos can increase the speed of approach within
// a step of length h, so the distance of three steps at the present speed is allowed for. Groups of
// points, whole robots and pairs of bodies are excluded first by lower bounds of their gaps, so
// that limbs in the air cost little time.
#include "ayumi/sim/plant/contacts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/foot_bodies.hpp"

namespace ayumi {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// A gap that may close within a step [m]. It bounds the work of the solver, but no force: a
/// contact that stays open gets the impulse 0. Chosen: 50 times the free fall within three steps of
/// 1 ms. Its effect is in constants.md.
constexpr double kContactMargin = 1e-3;

/// Tilt below which a circle has no lowest point [rad]. Chosen: on a rim of 0.1 m, a tilt of 1 mrad
/// lifts the far side by 0.2 mm; eight fixed points on the rim carry a cylinder that is more
/// upright. No measured case changes between half and twice the value (constants.md).
constexpr double kLevelTilt = 1e-3;

/// A gap that stays open for this number of steps with the present speed of approach is not a
/// contact. Chosen: gravity and servos can increase the speed of approach within a step. Half or
/// twice the value changes measured cases by 5 % or more (constants.md).
constexpr double kStepsAhead = 3;

/// Gap within which edges and nodes of the ground are tested against shapes and soles [m]. Chosen:
/// it is sufficient for the margin plus a closing speed of 0.7 m/s over kStepsAhead steps of 1 ms.
/// No measured case changes between half and twice the value (constants.md).
constexpr double kEdgeReach = 3 * kContactMargin;

// Keys of contacts that do not belong to a ContactPoint. Definition: the ranges do not overlap for
// 1024 blocks, 2^24 nodes of the height field, and the pairs of LinkContacts.
constexpr long kInnerKeys = 1l << 40;    // points between the corners of one sole
constexpr long kEdgeKeys = 1l << 32;     // edges of the ground that touch shapes, times 4096
constexpr long kTipKeys = 1l << 31;      // among these, nodes of the height field
constexpr long kTipsOfShape = 1l << 26;  // nodes for each shape
constexpr long kLinkKeys = 1l << 60;     // contacts between links

/// The axes of a contact: the normal, a tangent near x (near y if the normal is near x), and their
/// cross product.
void set_contact_axes(const Vector3d& normal, ActiveContact& contact) {
  Vector3d along = Vector3d::UnitX() - normal.x() * normal;
  if (along.squaredNorm() < 0.01) along = Vector3d::UnitY() - normal.y() * normal;
  along.normalize();
  contact.to_contact.row(0) = normal;
  contact.to_contact.row(1) = along;
  contact.to_contact.row(2) = normal.cross(along);
}

/// Whether the gap of a body's point near `contact` stays open in the next steps.
bool stays_open(double gap, int body, const ActiveContact& contact, const RobotData& data,
                double dt) {
  const Vector3d approach = point_velocity(data, body, contact.position) - contact.ground_velocity;
  return gap + kStepsAhead * dt * std::min(contact.to_contact.row(0).dot(approach), 0.0) >
         kContactMargin;
}

}  // namespace

ContactSet::ContactSet(const RobotModel& model, const World& world)
    : ground_(world),
      points_(contact_points(model)),
      groups_(group_points(points_)),
      links_(model),
      link_friction_(world.friction),
      link_stiffness_(body_stiffness(model)) {
  for (const PointGroup& group : groups_)
    widest_ = std::max(widest_, group.center.norm() + group.radius);
  for (size_t i = 0; i < model.bodies().size(); ++i)
    is_foot_.push_back(is_of_foot(model, static_cast<int>(i)));
  active_.reserve(points_.size() + 64);
  previous_.reserve(points_.size() + 64);
  outline_.reserve(16);
  inner_.reserve(64);
}

void ContactSet::reset() {
  active_.clear();
  links_.reset();
}

void ContactSet::remove_arriving() {
  std::erase_if(active_, [](const ActiveContact& c) { return c.gap > 0 && c.impulse.isZero(0); });
}

bool ContactSet::is_pivot(const ActiveContact& contact) const {
  const ContactPoint* point = point_of(contact);
  return point ? point->radius == 0 && point->rim == 0 : contact.side >= 0;
}

// A lower bound of a group's height over everything that belongs to the ground.
double ContactSet::height_above_all(const PointGroup& group, const RobotData& data) const {
  const Vector3d up = ground_.normal();
  const Vector3d turned = data.rotation[group.body].transpose() * up;
  const Vector3d origin = data.base_position - ground_.pose().translation();
  return up.dot(origin + data.position[group.body]) + turned.dot(group.center) - group.radius -
         ground_.top();
}

// An upper bound of the speed at which a point of the robot approaches the ground.
double ContactSet::fastest_approach(const RobotData& data) const {
  if (!ground_.at_rest()) return std::numeric_limits<double>::infinity();
  double speed = 0, turning = 0;
  for (const PointGroup& group : groups_) {
    speed = std::max(speed, data.velocity[group.body].squaredNorm());
    turning = std::max(turning, data.angular_velocity[group.body].squaredNorm());
  }
  return std::sqrt(speed) + std::sqrt(turning) * widest_;
}

void ContactSet::collect(const RobotData& data, double dt) {
  previous_.swap(active_);
  active_.clear();
  const Eigen::Isometry3d& floor = ground_.pose();
  ActiveContact probe;
  set_contact_axes(ground_.normal(), probe);
  level_ = probe.to_contact;
  const double reach = kContactMargin + kStepsAhead * dt * fastest_approach(data);
  for (const PointGroup& group : groups_) {
    const Matrix3d& R = data.rotation[group.body];
    if (height_above_all(group, data) > reach) continue;
    probe.position = data.base_position + (data.position[group.body] + R * group.center);
    probe.ground_velocity = ground_.velocity(probe.position);
    const double height =
        ground_.normal().dot(probe.position - floor.translation()) - group.radius - ground_.top();
    const double spread = group.radius * data.angular_velocity[group.body].norm();
    if (stays_open(height - kStepsAhead * dt * spread, group.body, probe, data, dt)) continue;
    collect_points(group, data, dt);
    if (points_[static_cast<size_t>(group.first)].side >= 0 && !ground_.plain())
      collect_under_sole(group, data, dt);
  }
  if (!ground_.plain()) collect_edges(data, dt);
  collect_links(data, dt);
  keep_impulses();
}

void ContactSet::collect_points(const PointGroup& group, const RobotData& data, double dt) {
  const Eigen::Isometry3d& floor = ground_.pose();
  const Matrix3d to_floor = floor.linear().transpose();
  const Matrix3d& R = data.rotation[group.body];
  ActiveContact contact;
  for (int i = group.first; i < group.first + group.count; ++i) {
    const ContactPoint& point = points_[static_cast<size_t>(i)];
    Vector3d center = data.base_position + (data.position[group.body] + R * point.position);
    if (point.rim > 0) {
      const Vector3d across = R * point.axis, up = ground_.normal();
      // Direction downwards in the plane of the circle.
      const Vector3d out = across.dot(up) * across - up;
      if (out.squaredNorm() < kLevelTilt * kLevelTilt) continue;
      center += point.rim / out.norm() * out;
    }
    const Vector3d local = to_floor * (center - floor.translation());
    contact.key = i;
    contact.body = point.body;
    contact.side = point.side;
    contact.vertex = point.vertex;
    contact.stiffness = point.stiffness;
    contact.damping_time = point.damping_time;
    contact.ground_velocity = ground_.velocity(center);
    if (ground_.plain()) {
      contact.gap = local.z() - ground_.top() - point.radius;
      contact.to_contact = level_;
    } else {
      const GroundTouch touch = ground_.touch(local);
      contact.gap = touch.gap - point.radius;
      set_contact_axes(floor.linear() * touch.normal, contact);
      contact.ground_velocity += touch.rise * ground_.normal();
    }
    contact.position = center - point.radius * contact.to_contact.row(0).transpose();
    if (stays_open(contact.gap, group.body, contact, data, dt)) continue;
    contact.friction = ground_.friction(local);
    active_.push_back(contact);
  }
}

// Corners, edges and nodes of the ground under the soles of a body. One body may carry both soles.
void ContactSet::collect_under_sole(const PointGroup& group, const RobotData& data, double dt) {
  const Eigen::Isometry3d& floor = ground_.pose();
  const Matrix3d& R = data.rotation[group.body];
  for (int first = group.first; first < group.first + group.count;) {
    const int side = points_[static_cast<size_t>(first)].side;
    int last = first;
    outline_.clear();
    for (; last < group.first + group.count && points_[static_cast<size_t>(last)].side == side;
         ++last)
      outline_.push_back(floor.inverse() *
                         Vector3d(data.base_position + data.position[group.body] +
                                  R * points_[static_cast<size_t>(last)].position));
    inner_.clear();
    if (side >= 0 && outline_.size() > 2) ground_.inner_points(outline_, kEdgeReach, inner_);
    for (const InnerPoint& inner : inner_) {
      ActiveContact contact;
      contact.key = kInnerKeys * (side + 1) + inner.id;
      contact.body = group.body;
      contact.side = side;
      contact.stiffness = points_[static_cast<size_t>(first)].stiffness;
      contact.damping_time = points_[static_cast<size_t>(first)].damping_time;
      contact.gap = inner.gap;
      contact.position = floor * inner.on_sole;
      set_contact_axes(ground_.normal(), contact);
      contact.ground_velocity = ground_.velocity(contact.position) + inner.rise * ground_.normal();
      if (stays_open(contact.gap, group.body, contact, data, dt)) continue;
      contact.friction = ground_.friction(inner.on_sole);
      active_.push_back(contact);
    }
    first = last;
  }
}

// Tests edges and corners of blocks and nodes of the height field against faces and edges of the
// shapes that are not feet. collect_points() has already tested the corners of these shapes against
// the ground.
void ContactSet::collect_edges(const RobotData& data, double dt) {
  for (size_t i = 0; i < is_foot_.size(); ++i) {
    const int body = static_cast<int>(i);
    const double radius = links_.radius(body);
    if (is_foot_[i] || radius == 0) continue;
    const Vector3d center = data.pose(body) * links_.center(body) - ground_.pose().translation();
    if (ground_.normal().dot(center) - radius > ground_.top() + kEdgeReach) continue;
    long key = kEdgeKeys * (body + 1l);
    for (const CollisionModel::PlacedCollider& shape : links_.shapes(body))
      for (const SolidBlock& block : ground_.solids())
        collect_edges(body, shape, block, ++key, data, dt);
    ground_.tips(ground_.pose().inverse() * (center + ground_.pose().translation()),
                 radius + kEdgeReach, tips_);
    key = kEdgeKeys * (body + 1l) + kTipKeys;
    for (const CollisionModel::PlacedCollider& shape : links_.shapes(body)) {
      for (const FieldTip& tip : tips_)
        collect_edges(body, shape, tip.solid, key + tip.id, data, dt);
      key += kTipsOfShape;
    }
  }
}

void ContactSet::collect_edges(int body, const CollisionModel::PlacedCollider& shape,
                               const SolidBlock& block, long key, const RobotData& data,
                               double dt) {
  const Eigen::Isometry3d& floor = ground_.pose();
  const Eigen::Isometry3d pose = data.pose(body) * shape.pose, block_pose = floor * block.pose;
  if (clearance_bound(block.collider, block_pose, shape.collider, pose) > kEdgeReach) return;
  const ContactPatch patch =
      contact_patch(block.collider, block_pose, shape.collider, pose, kEdgeReach);
  for (int i = 0; i < patch.count; ++i) {
    const PatchPoint& point = patch.points[static_cast<size_t>(i)];
    if (point.corner_of_b) continue;
    ActiveContact contact;
    contact.key = (key << 12) + point.id;
    contact.body = body;
    contact.stiffness = link_stiffness_;
    contact.damping_time = kBodyDamping;
    contact.gap = point.gap;
    contact.position = point.position;
    set_contact_axes(patch.normal, contact);
    contact.ground_velocity = ground_.velocity(point.position) + block.rise * ground_.normal();
    if (stays_open(contact.gap, body, contact, data, dt)) continue;
    contact.friction = ground_.friction(floor.inverse() * point.position);
    active_.push_back(contact);
  }
}

void ContactSet::collect_links(const RobotData& data, double dt) {
  for (const LinkTouch& touch : links_.find(data, kContactMargin, dt)) {
    ActiveContact contact;
    contact.key = kLinkKeys + touch.key;
    contact.body = touch.a;
    contact.other = touch.b;
    contact.stiffness = link_stiffness_;
    contact.damping_time = kBodyDamping;
    contact.gap = touch.gap;
    contact.position = touch.position;
    set_contact_axes(touch.normal, contact);
    contact.ground_velocity = point_velocity(data, touch.b, touch.position);
    if (stays_open(contact.gap, contact.body, contact, data, dt)) continue;
    contact.ground_velocity
        .setZero();  // the rows of the Jacobian contain the other body's velocity
    contact.friction = link_friction_;
    active_.push_back(contact);
  }
}

// A contact of the last step gives its impulse and deflection to the contact with the same key.
void ContactSet::keep_impulses() {
  const auto by_key = [](const ActiveContact& a, const ActiveContact& b) { return a.key < b.key; };
  if (!std::is_sorted(active_.begin(), active_.end(), by_key))
    std::sort(active_.begin(), active_.end(), by_key);
  size_t last = 0;
  for (ActiveContact& contact : active_) {
    while (last < previous_.size() && previous_[last].key < contact.key) ++last;
    if (last == previous_.size()) break;
    if (previous_[last].key != contact.key) continue;
    contact.impulse = previous_[last].impulse;
    contact.deflection = previous_[last].deflection;
  }
}

}  // namespace ayumi
