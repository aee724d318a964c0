#include "ayumi/dynamics/tree_cholesky.hpp"

#include <algorithm>

namespace ayumi {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// All bodies but the root, where those with fewer joints between them and the root come first.
// Limbs then take turns, and while a step of one limb waits for a result, steps of the others are
// computed.
std::vector<size_t> outwards(const std::vector<Body>& bodies) {
  std::vector<int> joints(bodies.size(), 0);
  std::vector<size_t> order;
  for (size_t i = 1; i < bodies.size(); ++i) {
    joints[i] = joints[static_cast<size_t>(bodies[i].parent)] + 1;
    order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return joints[a] < joints[b]; });
  return order;
}

}  // namespace

TreeCholesky::TreeCholesky(const RobotModel& model, const kernels::Kernels& kernels)
    : kernels_(&kernels) {
  const int n = model.velocity_count();
  const std::vector<Body>& bodies = model.bodies();
  place_.assign(static_cast<size_t>(n), -1);
  body_place_.assign(bodies.size(), 5);
  bool mimic = false;
  for (int c = 0; c < 6; ++c) {
    column_.push_back(c);
    parent_.push_back(c - 1);
    place_[static_cast<size_t>(c)] = c;
  }
  for (const size_t i : outwards(bodies)) {
    int& place = place_[static_cast<size_t>(6 + bodies[i].dof)];
    if (place >= 0) {
      mimic = true;
      continue;
    }
    place = static_cast<int>(column_.size());
    body_place_[i] = place;
    column_.push_back(6 + bodies[i].dof);
    parent_.push_back(body_place_[static_cast<size_t>(bodies[i].parent)]);
  }
  if (mimic) {
    for (int k = 0; k < n; ++k) parent_[static_cast<size_t>(k)] = k - 1;
    for (size_t i = 1; i < bodies.size(); ++i) body_place_[i] = n - 1;
  }
  size_t size = 0;
  row_of_.resize(static_cast<size_t>(n));
  entry_of_.resize(static_cast<size_t>(n));
  for (int k = 0; k < n; ++k) {
    depth_.push_back(parent(k) < 0 ? 0 : depth(parent(k)) + 1);
    offset_.push_back(static_cast<int>(size));
    row_of_[static_cast<size_t>(column_at(k))] = offset_.back();
    entry_of_[static_cast<size_t>(column_at(k))] = depth_.back();
    size += static_cast<size_t>(depth_.back() / 4 * 4 + 4);
  }
  path_.assign(size, 0);
  for (int k = 0; k < n; ++k)
    for (int i = k; i >= 0; i = parent(i)) path_[static_cast<size_t>(row_begin(k) + depth(i))] = i;
  rows_.assign(size, 0.0);
  inverse_.assign(static_cast<size_t>(n), 0.0);
  scratch_.setZero(n);
}

bool TreeCholesky::factor(const MatrixXd& M) {
  for (int k = 0; k < static_cast<int>(column_.size()); ++k) {
    double* to = rows_.data() + row_begin(k);
    for (int i = k; i >= 0; i = parent(i)) to[depth(i)] = M(column_at(i), column_at(k));
    std::fill(to + depth(k) + 1, to + depth(k) / 4 * 4 + 4, 0.0);
  }
  return factor_rows();
}

bool TreeCholesky::factor_rows() {
  return kernels_->factor(paths(), rows_.data(), inverse_.data());
}

// The entries that were computed last are at the end of the path, so that sums over it begin with
// entries that have been known for long.
void TreeCholesky::multiply(const std::vector<double>& rows, const VectorXd& x, VectorXd& y) const {
  y.setZero(x.size());
  for (int k = 0; k < static_cast<int>(column_.size()); ++k) {
    const double* entry = rows.data() + row_begin(k);
    const int* on = path(k);
    const int above = depth(k);
    const double own = x[k];
    double sum = entry[above] * own;
    for (int t = 0; t < above; ++t) {
      sum += entry[t] * x[on[t]];
      y[on[t]] += entry[t] * own;
    }
    y[k] += sum;
  }
}

void TreeCholesky::solve_lower(VectorXd& y) const {
  for (int k = 0; k < static_cast<int>(column_.size()); ++k) {
    const double* entry = row(k);
    const int* on = path(k);
    const int above = depth(k);
    double even = y[k], odd = 0;
    int t = 0;
    for (; t + 1 < above; t += 2) {
      even -= entry[t] * y[on[t]];
      odd -= entry[t + 1] * y[on[t + 1]];
    }
    if (t < above) even -= entry[t] * y[on[t]];
    y[k] = (odd + even) * inverse_[static_cast<size_t>(k)];
  }
}

void TreeCholesky::solve_upper(VectorXd& y) const {
  for (int k = static_cast<int>(column_.size()) - 1; k >= 0; --k) {
    const double* entry = row(k);
    const int* on = path(k);
    const double own = y[k] *= inverse_[static_cast<size_t>(k)];
    for (int t = depth(k) - 1; t >= 0; --t) y[on[t]] -= entry[t] * own;
  }
}

void TreeCholesky::solve(VectorXd& x) const {
  const int n = static_cast<int>(column_.size());
  VectorXd& y = scratch_;
  for (int k = 0; k < n; ++k) y[k] = x[column_at(k)];
  solve_upper(y);
  solve_lower(y);
  for (int k = 0; k < n; ++k) x[column_at(k)] = y[k];
}

}  // namespace ayumi
