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

/// Weights of a convex polygon's corners that make up the point p within it (Wachspress): all
/// non-negative, their sum is 1 and the weighted corners give p.
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
    for (size_t j = 0; j < n; ++j)  // the sides that do not end in corner i
      if (j != i && (j + 1) % n != i) w *= std::max(0.0, area(polygon[j], polygon[(j + 1) % n], p));
    weights[i] = w;
    sum += w;
  }
  for (double& w : weights) w = sum > 0 ? w / sum : 1.0 / static_cast<double>(n);
}

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
      active.key = active.point = i;
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
      active.point = first;
      active.inner = true;
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
  size_t size = 0;
  for (size_t i = 0; i < active_.size(); ++i) {
    const int body = points_[static_cast<size_t>(active_[i].point)].body;
    if (runs_.empty() || runs_.back().body != body)
      runs_.push_back({.body = body, .last = factor_.last_place(body), .first = i});
    ++runs_.back().count;
  }
  for (Run& run : runs_) {
    run.width = static_cast<int>(3 * run.count + 3) / 4 * 4;
    run.begin = size;
    size += static_cast<size_t>((factor_.depth(run.last) + 1) * run.width);
  }
  if (J_.size() < size) {
    J_.resize(size);
    Y_.resize(size);
  }
}

void Plant::fill_contact_rows(double dt) {
  find_runs();
  const size_t n = active_.size();
  solver_.resize(static_cast<int>(n));
  compliance_.resize(n);
  shift_.resize(n);
  for (size_t i = 0; i < n; ++i) {
    const ContactPoint& point = points_[static_cast<size_t>(active_[i].point)];
    const double time = dt + point.damping_time, gap = active_[i].gap;
    compliance_[i] = 1.0 / (dt * point.stiffness * time);
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

// A = Y' Y + compliance with Y = L^-T J'; b = Y' lower_ + shift, lower_ = L^-T right side.
void Plant::fill_delassus() {
  auto A = solver_.A();
  auto b = solver_.b();
  for (const Run& run : runs_) {
    double* Y = &Y_[run.begin];
    std::copy_n(&J_[run.begin], (factor_.depth(run.last) + 1) * run.width, Y);
    factor_.solve_path(run.last, run.width, Y);
    const auto first = static_cast<Eigen::Index>(3 * run.first);
    const auto rows = static_cast<Eigen::Index>(3 * run.count);
    for (size_t i = 0; i < run.count; ++i)
      b.segment<3>(first + 3 * static_cast<int>(i)) = shift_[run.first + i];
    for (int k = run.last, t = factor_.depth(k); k >= 0; k = factor_.parent(k), --t)
      for (Eigen::Index r = 0; r < rows; ++r) b[first + r] += lower_[k] * Y[t * run.width + r];
    for (const Run& other : runs_) {
      if (other.first > run.first) break;
      int k = run.last, j = other.last;
      while (k != j) (k > j ? k : j) = factor_.parent(k > j ? k : j);
      const auto from = static_cast<Eigen::Index>(3 * other.first);
      const int columns = static_cast<int>(3 * other.count);
      data_.kernels->gram(Y, run.width, &Y_[other.begin], other.width, factor_.depth(k) + 1,
                          static_cast<int>(rows), columns, &A(first, from),
                          static_cast<int>(A.rows()));
      if (&other != &run)
        for (Eigen::Index c = 0; c < columns; ++c)
          for (Eigen::Index r = 0; r < rows; ++r) A(from + c, first + r) = A(first + r, from + c);
    }
  }
  for (size_t i = 0; i < active_.size(); ++i)
    A.diagonal().segment<3>(3 * static_cast<Eigen::Index>(i)).array() += compliance_[i];
}

void Plant::report_contacts(double dt) {
  for (std::vector<SoleForce>& sole : report_.soles)
    for (SoleForce& cell : sole) cell = SoleForce{};
  report_.body_contact = false;
  report_.max_penetration = 0;
  for (size_t i = 0, r = 0; i < active_.size(); ++i) {
    Active& active = active_[i];
    const ContactPoint& point = points_[static_cast<size_t>(active.point)];
    if (i == runs_[r].first + runs_[r].count) ++r;
    const double* J = &J_[runs_[r].begin + 3 * (i - runs_[r].first)];
    const Vector3d l = solver_.impulse().segment<3>(3 * static_cast<int>(i));
    const Vector3d force = active.to_contact.transpose() * l;
    external_.linear += force;
    external_.angular += (active_[i].position - data_.cog).cross(force);
    Vector3d motion = active.to_contact * -active.ground_velocity;
    for (int k = runs_[r].last, t = factor_.depth(k); k >= 0; k = factor_.parent(k), --t)
      motion +=
          velocity_[factor_.column_at(k)] * Eigen::Map<const Vector3d>(J + t * runs_[r].width);
    active.impulse = l;
    const bool touching = l[0] > 0;
    active.deflection.setZero();
    if (touching)
      active.deflection =
          -l.tail<2>() / (dt * point.stiffness) - point.damping_time * motion.tail<2>();
    if (point.side < 0) {
      report_.body_contact |= touching;
      continue;
    }
    report_.max_penetration = std::max(report_.max_penetration, -active.gap);
    if (active.inner) {
      share_among_cells(active, force / dt);
      continue;
    }
    SoleForce& cell = report_.soles[point.side][static_cast<size_t>(point.vertex)];
    cell.position = active.position;
    cell.force += force / dt;
    cell.gap = active.gap;
  }
}

void Plant::share_among_cells(const Active& active, const Vector3d& force) {
  const int side = points_[static_cast<size_t>(active.point)].side;
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
