// The plant's contacts: which points may touch in a step, their rows of the contact problem, and
// the forces that came out. docs/theory.md, "Contact and servo integration".
#include <algorithm>
#include <cmath>

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/sim/plant.hpp"

namespace ayumi {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr double kNear = 1e-3;         // a gap that may close within a step [m]
constexpr long kInnerKeys = 1l << 40;  // keys of one sole's inner points
constexpr long kEdgeKeys = 1l << 32;   // where edges of the ground meet shapes; times 4096
constexpr long kTipKeys = 1l << 31;    // of those, tips of the height field;
constexpr long kTipsOfShape = 1l << 26;
constexpr long kLinkKeys = 1l << 60;  // where links meet

}  // namespace

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
  for (size_t g = 0; g < groups_.size(); ++g) {
    const PointGroup& group = groups_[g];
    const Matrix3d& R = data_.rotation[group.body];
    active.position = data_.base_position + (data_.position[group.body] + R * group.center);
    active.to_contact = level;
    active.ground_velocity = ground_.velocity(active.position);
    const double height =
        ground_.normal().dot(active.position - floor.translation()) - group.radius - ground_.top();
    const double spread = group.radius * data_.angular_velocity[group.body].norm();
    if (far(height - 3 * dt * spread, group.body, active, dt)) continue;
    for (int i = group.first; i < group.first + group.count; ++i) {
      const ContactPoint& point = points_[static_cast<size_t>(i)];
      const Vector3d center =
          data_.base_position + (data_.position[group.body] + R * point.position);
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

void Plant::find_runs() {
  runs_.clear();
  paired_ = false;
  for (size_t i = 0; i < active_.size();) {
    const int body = active_[i].body, other = active_[i].other;
    size_t end = i;
    for (; end < active_.size() && active_[end].body == body && active_[end].other == other; ++end)
      active_[end].run = runs_.size();
    add_run(i, end - i, body, 1);
    if (other >= 0) add_run(i, end - i, other, -1);
    paired_ |= other >= 0;
    i = end;
  }
  const size_t size =
      runs_.empty()
          ? 0
          : runs_.back().begin +
                static_cast<size_t>((factor_.depth(runs_.back().last) + 1) * runs_.back().width);
  if (J_.size() < size) {
    J_.resize(size);
    Y_.resize(size);
  }
}

void Plant::add_run(size_t first, size_t count, int body, double sign) {
  Run run{.body = body, .last = factor_.last_place(body), .sign = sign};
  run.first = first;
  run.count = count;
  run.width = static_cast<int>(3 * count + 3) / 4 * 4;
  if (!runs_.empty()) {
    const Run& back = runs_.back();
    run.begin = back.begin + static_cast<size_t>((factor_.depth(back.last) + 1) * back.width);
  }
  runs_.push_back(run);
}

void Plant::fill_contact_rows(double dt) {
  find_runs();
  const size_t n = active_.size();
  solver_.resize(static_cast<int>(n));
  compliance_.resize(n);
  shift_.resize(n);
  for (size_t i = 0; i < n; ++i) {
    const double time = dt + active_[i].damping_time, gap = active_[i].gap;
    compliance_[i] = 1.0 / (dt * active_[i].stiffness * time);
    shift_[i] << (gap > 0 ? gap / dt : gap / time), active_[i].deflection / time;
    shift_[i] -= active_[i].to_contact * active_[i].ground_velocity;
    solver_.impulse().segment<3>(3 * static_cast<int>(i)) = active_[i].impulse;
    solver_.friction()[i] = active_[i].friction;
  }
  for (const Run& run : runs_) fill_jacobian(run);
}

void Plant::fill_jacobian(const Run& run) {
  double* J = &J_[run.begin];
  std::fill(J, J + (factor_.depth(run.last) + 1) * run.width, 0.0);
  const auto body = static_cast<size_t>(run.body);
  const kernels::Chain chain = {static_cast<int>(chain_bodies_[body].size()),
                                chain_bodies_[body].data(),
                                chain_lines_[body].data(),
                                data_.links.data(),
                                data_.position[0].data(),
                                data_.axis[0].data()};
  for (size_t i = 0; i < run.count; ++i) {
    const Active& active = active_[run.first + i];
    const Vector3d p = active.position - data_.base_position;
    data_.kernels->contact_lines({p.data(), active.to_contact.data()}, chain, run.width, J + 3 * i);
  }
}

// A = Y' Y + compliance with Y = L^-T J'; b = Y' lower_ + shift, lower_ = L^-T right side. Where
// links touch, J is that of one body less that of the other, and so is Y: sums over both runs.
void Plant::fill_delassus() {
  auto A = solver_.A();
  auto b = solver_.b();
  if (paired_) A.setZero();
  for (size_t i = 0; i < active_.size(); ++i)
    b.segment<3>(3 * static_cast<Eigen::Index>(i)) = shift_[i];
  for (size_t i = 0; i < runs_.size(); ++i) {
    const Run& run = runs_[i];
    double* Y = &Y_[run.begin];
    std::copy_n(&J_[run.begin], (factor_.depth(run.last) + 1) * run.width, Y);
    factor_.solve_path(run.last, run.width, Y);
    const auto first = static_cast<Eigen::Index>(3 * run.first);
    const auto rows = static_cast<Eigen::Index>(3 * run.count);
    for (int k = run.last, t = factor_.depth(k); k >= 0; k = factor_.parent(k), --t)
      for (Eigen::Index r = 0; r < rows; ++r)
        b[first + r] += run.sign * lower_[k] * Y[t * run.width + r];
    for (size_t j = 0; j <= i; ++j) couple(run, runs_[j]);
  }
  for (size_t i = 0; i < active_.size(); ++i)
    A.diagonal().segment<3>(3 * static_cast<Eigen::Index>(i)).array() += compliance_[i];
}

// The block of A of two runs, the second filled before or the same.
void Plant::couple(const Run& run, const Run& other) {
  auto A = solver_.A();
  int k = run.last, j = other.last;
  while (k != j) (k > j ? k : j) = factor_.parent(k > j ? k : j);
  const auto first = static_cast<Eigen::Index>(3 * run.first);
  const auto from = static_cast<Eigen::Index>(3 * other.first);
  const int rows = static_cast<int>(3 * run.count), columns = static_cast<int>(3 * other.count);
  const auto gram = [&](double* to, Eigen::Index stride) {
    data_.kernels->gram(&Y_[run.begin], run.width, &Y_[other.begin], other.width,
                        factor_.depth(k) + 1, rows, columns, to, static_cast<int>(stride));
  };
  if (!paired_) {
    gram(&A(first, from), A.rows());
    if (&other != &run)
      for (Eigen::Index c = 0; c < columns; ++c)
        for (Eigen::Index r = 0; r < rows; ++r) A(from + c, first + r) = A(first + r, from + c);
    return;
  }
  block_.resize(std::max(block_.size(), static_cast<size_t>(run.width * other.width)));
  gram(block_.data(), rows);
  const double sign = run.sign * other.sign;
  for (Eigen::Index c = 0; c < columns; ++c)
    for (Eigen::Index r = 0; r < rows; ++r) {
      const double value = sign * block_[static_cast<size_t>(c * rows + r)];
      A(first + r, from + c) += value;
      if (&other != &run) A(from + c, first + r) += value;
    }
}

Vector3d Plant::contact_rate(size_t i, const Eigen::VectorXd& velocity) const {
  const Active& active = active_[i];
  Vector3d rate = Vector3d::Zero();
  for (size_t r = active.run; r <= active.run + (active.other < 0 ? 0 : 1); ++r) {
    const Run& run = runs_[r];
    const double* J = &J_[run.begin + 3 * (i - run.first)];
    for (int k = run.last, t = factor_.depth(k); k >= 0; k = factor_.parent(k), --t)
      rate +=
          run.sign * velocity[factor_.column_at(k)] * Eigen::Map<const Vector3d>(J + t * run.width);
  }
  return rate;
}

void Plant::report_contacts(double dt) {
  for (std::vector<SoleForce>& sole : report_.soles)
    for (SoleForce& cell : sole) cell = SoleForce{};
  report_.body_contact = false;
  report_.self_contact = {-1, -1};
  report_.max_penetration = 0;
  report_.work.contacts = 0;
  for (size_t i = 0; i < active_.size(); ++i) {
    Active& active = active_[i];
    const Vector3d l = solver_.impulse().segment<3>(3 * static_cast<int>(i));
    const Vector3d force = active.to_contact.transpose() * l;
    const Vector3d rate = contact_rate(i, velocity_);
    active.impulse = l;
    const bool touching = l[0] > 0;
    active.deflection.setZero();
    if (touching) {
      const Vector3d motion = rate - active.to_contact * active.ground_velocity;
      active.deflection =
          -l.tail<2>() / (dt * active.stiffness) - active.damping_time * motion.tail<2>();
      report_.work.contacts += 0.5 * l.dot(contact_rate(i, before_) + rate);
    }
    if (active.other >= 0) {  // within the robot
      if (touching && report_.self_contact[0] < 0)
        report_.self_contact = {active.body, active.other};
      continue;
    }
    external_.linear += force;
    external_.angular += (active.position - data_.cog).cross(force);
    if (active.side < 0)
      report_.body_contact |= touching;
    else
      report_sole(active, force / dt);
  }
}

void Plant::report_sole(const Active& active, const Vector3d& force) {
  report_.max_penetration = std::max(report_.max_penetration, -active.gap);
  if (active.vertex < 0) {
    share_among_cells(active, force);
    return;
  }
  SoleForce& cell = report_.soles[active.side][static_cast<size_t>(active.vertex)];
  cell.position = active.position;
  cell.force += force;
  cell.gap = active.gap;
}

void Plant::share_among_cells(const Active& active, const Vector3d& force) {
  const int side = active.side;
  const Sole& sole = model_->sole(static_cast<Side>(side));
  const Eigen::Isometry3d pose = sole_pose(*model_, data_, static_cast<Side>(side));
  corner_weights(sole.polygon, (pose.inverse() * active.position).head<2>(), weights_);
  for (size_t i = 0; i < weights_.size(); ++i) {
    SoleForce& cell = report_.soles[side][i];
    cell.position = pose * Vector3d(sole.polygon[i].x(), sole.polygon[i].y(), 0);
    cell.force += weights_[i] * force;
  }
}

}  // namespace ayumi
