#include "ayumi/dynamics/tree_cholesky.hpp"

#include <cmath>

namespace ayumi {

using Eigen::MatrixXd;
using Eigen::VectorXd;

TreeCholesky::TreeCholesky(const RobotModel& model) {
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
  L_.setZero(n, n);
  scratch_.setZero(n);
}

bool TreeCholesky::factor(const MatrixXd& M) {
  const int n = static_cast<int>(column_.size());
  for (int k = 0; k < n; ++k)
    for (int i = k; i >= 0; i = parent(i)) L_(i, k) = M(column_at(i), column_at(k));
  for (int k = n - 1; k >= 0; --k) {
    double* row = L_.col(k).data();
    if (!(row[k] > 0)) return false;
    row[k] = std::sqrt(row[k]);
    const double inverse = 1.0 / row[k];
    for (int i = parent(k); i >= 0; i = parent(i)) row[i] *= inverse;
    for (int i = parent(k); i >= 0; i = parent(i)) {
      double* above = L_.col(i).data();
      const double factor = row[i];
      for (int j = i; j >= 0; j = parent(j)) above[j] -= factor * row[j];
    }
  }
  return true;
}

void TreeCholesky::solve_lower(VectorXd& y) const {
  const int n = static_cast<int>(column_.size());
  for (int k = 0; k < n; ++k) {
    const double* row = L_.col(k).data();
    double sum = y[k];
    for (int j = parent(k); j >= 0; j = parent(j)) sum -= row[j] * y[j];
    y[k] = sum / row[k];
  }
}

void TreeCholesky::solve_upper(VectorXd& y) const {
  for (int k = static_cast<int>(column_.size()) - 1; k >= 0; --k) {
    const double* row = L_.col(k).data();
    y[k] /= row[k];
    for (int j = parent(k); j >= 0; j = parent(j)) y[j] -= row[j] * y[k];
  }
}

void TreeCholesky::solve_chain(int last, Eigen::Vector3d* Y) const {
  for (int k = last; k >= 0; k = parent(k)) {
    const double* row = L_.col(k).data();
    Y[k] /= row[k];
    for (int j = parent(k); j >= 0; j = parent(j)) Y[j] -= row[j] * Y[k];
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
