#include "ayumi/dynamics/tree_cholesky.hpp"

#include <algorithm>

namespace ayumi {

using Eigen::MatrixXd;
using Eigen::VectorXd;

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
  for (size_t i = 1; i < bodies.size(); ++i) {
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

void TreeCholesky::multiply(const std::vector<double>& rows, const VectorXd& x, VectorXd& y) const {
  y.setZero(x.size());
  for (int k = 0; k < static_cast<int>(column_.size()); ++k) {
    const double* entry = rows.data() + row_begin(k);
    double sum = entry[depth(k)] * x[k];
    for (int i = parent(k), t = depth(k) - 1; i >= 0; i = parent(i), --t) {
      sum += entry[t] * x[i];
      y[i] += entry[t] * x[k];
    }
    y[k] += sum;
  }
}

void TreeCholesky::solve_lower(VectorXd& y) const {
  for (int k = 0; k < static_cast<int>(column_.size()); ++k) {
    const double* entry = row(k);
    double sum = y[k];
    for (int i = parent(k), t = depth(k) - 1; i >= 0; i = parent(i), --t) sum -= entry[t] * y[i];
    y[k] = sum * inverse_[static_cast<size_t>(k)];
  }
}

void TreeCholesky::solve_upper(VectorXd& y) const {
  for (int k = static_cast<int>(column_.size()) - 1; k >= 0; --k) {
    const double* entry = row(k);
    y[k] *= inverse_[static_cast<size_t>(k)];
    for (int i = parent(k), t = depth(k) - 1; i >= 0; i = parent(i), --t) y[i] -= entry[t] * y[k];
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
