#pragma once
// Factorisation of a matrix with the sparsity of the mass matrix: M = L' L, L(i, j) only for j an
// ancestor of i, without fill-in (R. Featherstone, Rigid Body Dynamics Algorithms, 6.5). Where
// mimic joints tie branches together all dofs form one chain and the factor is dense.

#include <Eigen/Dense>
#include <vector>

#include "ayumi/model/robot_model.hpp"

namespace ayumi {

class TreeCholesky {
 public:
  explicit TreeCholesky(const RobotModel& model);

  /// Of a symmetric positive definite (6+dof) square matrix with the mass matrix's zeros, joint
  /// order of the model. Only one triangle is read. False when it is not positive definite.
  bool factor(const Eigen::MatrixXd& M);

  /// x <- M^-1 x.
  void solve(Eigen::VectorXd& x) const;

  // The two halves of solve() for right sides that touch one chain of ancestors only. Vectors are
  // in `place` order here: place_of(c) of velocity column c, ancestors first.
  int place_of(int column) const { return place_[static_cast<size_t>(column)]; }
  int column_at(int place) const { return column_[static_cast<size_t>(place)]; }
  int parent(int place) const { return parent_[static_cast<size_t>(place)]; }  ///< -1 at the end
  double diagonal(int place) const { return L_(place, place); }
  double below(int place, int ancestor) const { return L_(ancestor, place); }
  /// The last place on the chain that moves a body.
  int last_place(int body) const { return body_place_[static_cast<size_t>(body)]; }

  /// y <- L^-T y and y <- L^-1 y, in place order.
  void solve_upper(Eigen::VectorXd& y) const;
  void solve_lower(Eigen::VectorXd& y) const;

  /// Y <- L^-T Y for three columns at once (Y: one entry per place) that are zero but on the chain
  /// from `last` to the root, where they stay zero.
  void solve_chain(int last, Eigen::Vector3d* Y) const;

 private:
  std::vector<int> place_, column_, parent_, body_place_;
  Eigen::MatrixXd L_;  // transposed: row of L = column here, contiguous
  mutable Eigen::VectorXd scratch_;
};

}  // namespace ayumi
