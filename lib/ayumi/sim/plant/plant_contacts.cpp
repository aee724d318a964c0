// The plant's contacts as a problem: their rows, its matrix, and the forces that came out.
// docs/theory.md, "Contact and servo integration".
#include <algorithm>

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/sim/plant/plant.hpp"

namespace ayumi {

using Eigen::Vector3d;
using Eigen::VectorXd;

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
  contact_rates(before_, rates_before_);
  for (size_t i = 0; i < n; ++i) shift_[i] += Eigen::Map<const Vector3d>(&rates_before_[3 * i]);
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

// A = Y' Y + compliance with Y = L^-T J'; b = Y' lower_ + J v + shift, lower_ = L^-T right side.
// Where links touch, J is that of one body less that of the other, and so is Y: sums over both
// runs.
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
    b.segment(first, rows) += run.sign * times_path(run, Y, lower_).head(rows);
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

// Rows of a run times a vector of the places on its path.
Eigen::Map<const VectorXd> Plant::times_path(const Run& run, const double* rows,
                                             const VectorXd& x) {
  const int lines = factor_.depth(run.last) + 1;
  const int* on = factor_.path(run.last);
  product_.resize(std::max(product_.size(), static_cast<size_t>(run.width + lines)));
  double* of_path = product_.data() + run.width;
  for (int t = 0; t < lines; ++t) of_path[t] = x[on[t]];
  std::fill_n(product_.data(), run.width, 0.0);
  data_.kernels->multiply_add(rows, run.width, lines, run.width, of_path, product_.data());
  return {product_.data(), run.width};
}

// x += L^-T J' l.
void Plant::add_impulses(VectorXd& x) {
  for (const Run& run : runs_) {
    const Eigen::Index rows = static_cast<Eigen::Index>(3 * run.count);
    const Eigen::Map<const VectorXd> l(solver_.impulse().data() + 3 * run.first, rows);
    const int* on = factor_.path(run.last);
    const double* Y = &Y_[run.begin];
    for (int t = factor_.depth(run.last); t >= 0; --t)
      x[on[t]] += run.sign * l.dot(Eigen::Map<const VectorXd>(Y + t * run.width, rows));
  }
}

// J times a velocity, three rates per contact.
void Plant::contact_rates(const VectorXd& velocity, std::vector<double>& rates) {
  for (int k = 0; k < velocity.size(); ++k) placed_[k] = velocity[factor_.column_at(k)];
  rates.assign(3 * active_.size(), 0.0);
  for (const Run& run : runs_) {
    const Eigen::Index rows = static_cast<Eigen::Index>(3 * run.count);
    Eigen::Map<VectorXd>(&rates[3 * run.first], rows) +=
        run.sign * times_path(run, &J_[run.begin], placed_).head(rows);
  }
}

// Forces are those of the contacts' impulses over `whole`, of which the step or its part is dt.
void Plant::report_contacts(double dt, double whole) {
  if (active_.empty()) return;
  contact_rates(velocity_, rates_);
  for (size_t i = 0; i < active_.size(); ++i) {
    Active& active = active_[i];
    const Vector3d l = solver_.impulse().segment<3>(3 * static_cast<int>(i));
    const Vector3d force = turned_forward(active.to_contact.transpose() * l);
    const Eigen::Map<const Vector3d> rate(&rates_[3 * i]), earlier(&rates_before_[3 * i]);
    active.impulse = l;
    const bool touching = l[0] > 0;
    active.deflection.setZero();
    if (touching) {
      const Vector3d motion = rate - active.to_contact * active.ground_velocity;
      active.deflection =
          -l.tail<2>() / (dt * active.stiffness) - active.damping_time * motion.tail<2>();
      report_.work.contacts += 0.5 * l.dot(earlier + rate);
    }
    if (active.other >= 0) {  // within the robot
      if (touching && report_.self_contact[0] < 0)
        report_.self_contact = {active.body, active.other};
      continue;
    }
    external_.linear += force;
    external_.angular += turned_forward(active.position - data_.cog).cross(force);
    if (active.side < 0)
      report_.body_contact |= touching;
    else
      report_sole(active, force / whole);
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
