// Contact i with stiffness k, damping time T, gap g and tangential deflection d obeys, at the end
// of a step of length h,
//   u_n = J_n v+ + g/(h + T) + R l_n,   u_t = J_t v+ + d/(h + T) + R l_t,   R = 1/(h k (h + T)),
// which is the implicit spring l/h = -k (g + h v) - k T v solved for the velocity. For g > 0 the
// damping is left out, so that the point just arrives. u and l obey the law of ContactSolver.
//
// J of a contact is zero off the path from its body to the root, and so is Y = L^-T J'. Therefore
// A = Y' Y + R needs sums over common ancestors only. Where links touch each other, J is that of
// one body minus that of the other, and the products are sums over both blocks.
#include "ayumi/sim/plant/contact_rows.hpp"

#include <algorithm>
#include <cmath>

namespace ayumi {

using Eigen::Vector3d;
using Eigen::VectorXd;

ContactRows::ContactRows(const RobotModel& model, const TreeCholesky& factor, size_t points)
    : chain_bodies_(model.bodies().size()),
      chain_lines_(model.bodies().size()),
      placed_(VectorXd::Zero(model.velocity_count())) {
  for (size_t body = 0; body < chain_bodies_.size(); ++body)
    for (int b = static_cast<int>(body); b > 0; b = model.bodies()[b].parent) {
      chain_bodies_[body].push_back(b);
      chain_lines_[body].push_back(factor.depth(factor.place_of(6 + model.bodies()[b].dof)));
    }
  const auto columns = static_cast<size_t>(model.velocity_count());
  const size_t usual = std::min<size_t>(points, 16);  // usually the corners of both soles
  solver_.resize(static_cast<int>(usual));
  J_.resize(usual * 4 * columns);
  Y_.resize(J_.size());
  blocks_.reserve(64);
  product_.reserve(3 * usual + 4 + columns);
  rates_.reserve(3 * points);
  rates_before_.reserve(rates_.capacity());
  compliance_.resize(usual);
  shift_.resize(usual);
}

void ContactRows::set(const std::vector<ActiveContact>& contacts, const RobotData& data,
                      const TreeCholesky& factor, const VectorXd& before, double dt) {
  find_blocks(contacts, factor);
  count_ = contacts.size();
  solver_.resize(static_cast<int>(count_));
  compliance_.resize(count_);
  shift_.resize(count_);
  for (size_t i = 0; i < count_; ++i) {
    const ActiveContact& contact = contacts[i];
    const double time = dt + contact.damping_time, gap = contact.gap;
    compliance_[i] = 1.0 / (dt * contact.stiffness * time);
    shift_[i] << (gap > 0 ? gap / dt : gap / time), contact.deflection / time;
    shift_[i] -= contact.to_contact * contact.ground_velocity;
    solver_.impulse().segment<3>(3 * static_cast<int>(i)) = contact.impulse;
    solver_.friction()[i] = contact.friction;
  }
  for (const Block& block : blocks_) fill_jacobian(block, contacts, data, factor);
  multiply(data, factor, before, rates_before_);
  for (size_t i = 0; i < count_; ++i)
    shift_[i] += Eigen::Map<const Vector3d>(&rates_before_[3 * i]);
}

void ContactRows::find_blocks(const std::vector<ActiveContact>& contacts,
                              const TreeCholesky& factor) {
  blocks_.clear();
  linked_ = false;
  for (size_t i = 0; i < contacts.size();) {
    const int body = contacts[i].body, other = contacts[i].other;
    size_t end = i;
    while (end < contacts.size() && contacts[end].body == body && contacts[end].other == other)
      ++end;
    add_block(i, end - i, body, 1, factor);
    if (other >= 0) add_block(i, end - i, other, -1, factor);
    linked_ |= other >= 0;
    i = end;
  }
  const size_t size = blocks_.empty() ? 0 : end_of(blocks_.back(), factor);
  if (J_.size() < size) {
    J_.resize(size);
    Y_.resize(size);
  }
}

void ContactRows::add_block(size_t first, size_t count, int body, double sign,
                            const TreeCholesky& factor) {
  Block block{.body = body, .last = factor.last_place(body), .sign = sign};
  block.first = first;
  block.count = count;
  block.width = static_cast<int>(3 * count + 3) / 4 * 4;
  if (!blocks_.empty()) block.begin = end_of(blocks_.back(), factor);
  blocks_.push_back(block);
}

void ContactRows::fill_jacobian(const Block& block, const std::vector<ActiveContact>& contacts,
                                const RobotData& data, const TreeCholesky& factor) {
  double* J = &J_[block.begin];
  std::fill(J, J + (factor.depth(block.last) + 1) * block.width, 0.0);
  const auto body = static_cast<size_t>(block.body);
  const kernels::Chain chain = {static_cast<int>(chain_bodies_[body].size()),
                                chain_bodies_[body].data(),
                                chain_lines_[body].data(),
                                data.links.data(),
                                data.position[0].data(),
                                data.axis[0].data()};
  for (size_t i = 0; i < block.count; ++i) {
    const ActiveContact& contact = contacts[block.first + i];
    const Vector3d p = contact.position - data.base_position;
    data.kernels->contact_lines({p.data(), contact.to_contact.data()}, chain, block.width,
                                J + 3 * i);
  }
}

bool ContactRows::all_stick() const {
  if (linked_) return false;
  for (size_t i = 0; i < count_; ++i) {
    const Vector3d l = impulse(i);
    if (l[0] > 0 && !inside_cone(l, solver_.friction()[i])) return false;
  }
  return true;
}

// Lines of J' times the root of the stiffness: their product with themselves is J' J/R.
void ContactRows::add_springs(const RobotData& data, const TreeCholesky& factor,
                              std::vector<double>& matrix, VectorXd& x) {
  for (const Block& block : blocks_) {
    const int lines = factor.depth(block.last) + 1, width = (lines + 3) / 4 * 4;
    const int* on = factor.path(block.last);
    const auto most = 3 * block.count;
    springs_.resize(std::max(springs_.size(), most * static_cast<size_t>(width)));
    pull_.resize(std::max(pull_.size(), most));
    int rows = 0;
    for (size_t i = 0; i < block.count; ++i) {
      const size_t contact = block.first + i;
      if (!(impulse(contact)[0] > 0)) continue;
      const double root = std::sqrt(1 / compliance_[contact]);
      for (int k = 0; k < 3; ++k) pull_[static_cast<size_t>(rows + k)] = -root * shift_[contact][k];
      double* to = &springs_[static_cast<size_t>(rows * width)];
      const double* from = &J_[block.begin] + 3 * i;
      for (int t = 0; t < lines; ++t, ++to, from += block.width) {
        to[0] = root * from[0];
        to[width] = root * from[1];
        to[2 * width] = root * from[2];
      }
      for (int t = lines; t < width; ++t, ++to) to[0] = to[width] = to[2 * width] = 0;
      rows += 3;
    }
    if (rows == 0) continue;
    const auto room = static_cast<size_t>(width * (width + 1));
    gram_.resize(std::max(gram_.size(), room));
    data.kernels->gram(springs_.data(), width, springs_.data(), width, rows, width, width,
                       gram_.data(), width);
    double* on_path = gram_.data() + width * width;
    std::fill_n(on_path, width, 0.0);
    data.kernels->multiply_add(springs_.data(), width, rows, width, pull_.data(), on_path);
    for (int t = 0; t < lines; ++t) {
      double* row = &matrix[static_cast<size_t>(factor.row_begin(on[t]))];
      const double* entry = gram_.data() + t * width;
      for (int s = 0; s <= t; ++s) row[s] += entry[s];
      x[on[t]] += on_path[t];
    }
  }
}

bool ContactRows::take_springs(const RobotData& data, const TreeCholesky& factor,
                               const VectorXd& change, ContactSolution& solution) {
  solution = {.iterations = 1};
  rates_change_.assign(3 * count_, 0.0);
  for (const Block& block : blocks_) {
    const auto rows = static_cast<Eigen::Index>(3 * block.count);
    Eigen::Map<VectorXd>(&rates_change_[3 * block.first], rows) =
        times_path(block, &J_[block.begin], change, data, factor).head(rows);
  }
  for (size_t i = 0; i < count_; ++i) {
    Eigen::Map<Vector3d> u(&rates_change_[3 * i]);
    u += shift_[i];
    if (impulse(i)[0] > 0) {
      u *= -1 / compliance_[i];  // this is now the impulse
      if (!(u[0] > 0 && inside_cone(u, solver_.friction()[i]))) return false;
    } else {
      solution.residual = std::max(solution.residual, -u[0]);
      if (solution.residual > kContactTolerance) return false;
      u.setZero();
    }
  }
  solver_.impulse() = Eigen::Map<const VectorXd>(rates_change_.data(), rates_change_.size());
  return true;
}

ContactSolution ContactRows::solve(const RobotData& data, const TreeCholesky& factor, VectorXd& x) {
  fill_problem(data, factor, x);
  const ContactSolution solution = solver_.solve();
  for (const Block& block : blocks_) {
    const auto rows = static_cast<Eigen::Index>(3 * block.count);
    const Eigen::Map<const VectorXd> l(solver_.impulse().data() + 3 * block.first, rows);
    const int* on = factor.path(block.last);
    const double* Y = &Y_[block.begin];
    for (int t = factor.depth(block.last); t >= 0; --t)
      x[on[t]] += block.sign * l.dot(Eigen::Map<const VectorXd>(Y + t * block.width, rows));
  }
  return solution;
}

// A = Y' Y + compliance, b = Y' x + J v + shift.
void ContactRows::fill_problem(const RobotData& data, const TreeCholesky& factor,
                               const VectorXd& x) {
  auto A = solver_.A();
  auto b = solver_.b();
  if (linked_) A.setZero();
  for (size_t i = 0; i < count_; ++i) b.segment<3>(3 * static_cast<Eigen::Index>(i)) = shift_[i];
  for (size_t i = 0; i < blocks_.size(); ++i) {
    const Block& block = blocks_[i];
    double* Y = &Y_[block.begin];
    std::copy_n(&J_[block.begin], (factor.depth(block.last) + 1) * block.width, Y);
    factor.solve_path(block.last, block.width, Y);
    const auto first = static_cast<Eigen::Index>(3 * block.first);
    const auto rows = static_cast<Eigen::Index>(3 * block.count);
    b.segment(first, rows) += block.sign * times_path(block, Y, x, data, factor).head(rows);
    for (size_t j = 0; j <= i; ++j) couple(block, blocks_[j], data, factor);
  }
  for (size_t i = 0; i < count_; ++i)
    A.diagonal().segment<3>(3 * static_cast<Eigen::Index>(i)).array() += compliance_[i];
}

// The part of A for two blocks. `other` was filled before, or is the same block.
void ContactRows::couple(const Block& block, const Block& other, const RobotData& data,
                         const TreeCholesky& factor) {
  auto A = solver_.A();
  int k = block.last, j = other.last;
  while (k != j) (k > j ? k : j) = factor.parent(k > j ? k : j);
  const auto first = static_cast<Eigen::Index>(3 * block.first);
  const auto from = static_cast<Eigen::Index>(3 * other.first);
  const int rows = static_cast<int>(3 * block.count), columns = static_cast<int>(3 * other.count);
  const auto gram = [&](double* to, Eigen::Index stride) {
    data.kernels->gram(&Y_[block.begin], block.width, &Y_[other.begin], other.width,
                       factor.depth(k) + 1, rows, columns, to, static_cast<int>(stride));
  };
  if (!linked_) {
    gram(&A(first, from), A.rows());
    if (&other != &block)
      for (Eigen::Index c = 0; c < columns; ++c)
        for (Eigen::Index r = 0; r < rows; ++r) A(from + c, first + r) = A(first + r, from + c);
    return;
  }
  gram_.resize(std::max(gram_.size(), static_cast<size_t>(block.width * other.width)));
  gram(gram_.data(), rows);
  const double sign = block.sign * other.sign;
  for (Eigen::Index c = 0; c < columns; ++c)
    for (Eigen::Index r = 0; r < rows; ++r) {
      const double value = sign * gram_[static_cast<size_t>(c * rows + r)];
      A(first + r, from + c) += value;
      if (&other != &block) A(from + c, first + r) += value;
    }
}

// The rows of a block times a vector of the places on its path.
Eigen::Map<const VectorXd> ContactRows::times_path(const Block& block, const double* rows,
                                                   const VectorXd& x, const RobotData& data,
                                                   const TreeCholesky& factor) {
  const int lines = factor.depth(block.last) + 1;
  const int* on = factor.path(block.last);
  product_.resize(std::max(product_.size(), static_cast<size_t>(block.width + lines)));
  double* on_path = product_.data() + block.width;
  for (int t = 0; t < lines; ++t) on_path[t] = x[on[t]];
  std::fill_n(product_.data(), block.width, 0.0);
  data.kernels->multiply_add(rows, block.width, lines, block.width, on_path, product_.data());
  return {product_.data(), block.width};
}

// J times a velocity: three rates for each contact.
void ContactRows::multiply(const RobotData& data, const TreeCholesky& factor,
                           const VectorXd& velocity, std::vector<double>& rates) {
  for (int k = 0; k < velocity.size(); ++k) placed_[k] = velocity[factor.column_at(k)];
  rates.assign(3 * count_, 0.0);
  for (const Block& block : blocks_) {
    const auto rows = static_cast<Eigen::Index>(3 * block.count);
    Eigen::Map<VectorXd>(&rates[3 * block.first], rows) +=
        block.sign * times_path(block, &J_[block.begin], placed_, data, factor).head(rows);
  }
}

}  // namespace ayumi
