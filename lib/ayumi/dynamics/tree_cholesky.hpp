#pragma once
// Factorisation of a matrix with the sparsity of the mass matrix: M = L' L, L(i, j) only for j an
// ancestor of i, without fill-in (R. Featherstone, Rigid Body Dynamics Algorithms, 6.5). Where
// mimic joints tie branches together all dofs form one chain and the factor is dense.

#include <Eigen/Dense>
#include <vector>

#include "ayumi/dynamics/kernels/tree_kernels.hpp"
#include "ayumi/model/robot_model.hpp"

namespace ayumi {

class TreeCholesky {
 public:
  explicit TreeCholesky(const RobotModel& model,
                        const kernels::Kernels& kernels = kernels::best_kernels());

  /// Of a symmetric positive definite (6+dof) square matrix with the mass matrix's zeros, joint
  /// order of the model. Only one triangle is read. False when it is not positive definite.
  bool factor(const Eigen::MatrixXd& M);

  /// x <- M^-1 x.
  void solve(Eigen::VectorXd& x) const;

  // Vectors are in `place` order from here on: place_of(c) of velocity column c, ancestors first.
  int place_of(int column) const { return place_[static_cast<size_t>(column)]; }
  int column_at(int place) const { return column_[static_cast<size_t>(place)]; }
  int parent(int place) const { return parent_[static_cast<size_t>(place)]; }  ///< -1 at the end
  int depth(int place) const { return depth_[static_cast<size_t>(place)]; }    ///< places above it
  /// The depth(place) + 1 places from the root to this one.
  const int* path(int place) const { return path_.data() + row_begin(place); }
  double diagonal(int place) const { return row(place)[depth(place)]; }
  double below(int place, int ancestor) const { return row(place)[depth(ancestor)]; }
  /// The last place on the chain that moves a body.
  int last_place(int body) const { return body_place_[static_cast<size_t>(body)]; }

  // The matrix by rows: that of a place holds its path from the root, filled up to fours.
  size_t row_doubles() const { return rows_.size(); }
  int row_begin(int place) const { return offset_[static_cast<size_t>(place)]; }
  /// Where the kernels put the entries of a mass matrix stored so.
  kernels::Layout layout() const {
    return {row_of_.data(), entry_of_.data(), place_.data(), false};
  }
  /// factor() of the rows themselves, which become those of L.
  std::vector<double>& rows() { return rows_; }
  bool factor_rows();
  /// y <- M x for such rows.
  void multiply(const std::vector<double>& rows, const Eigen::VectorXd& x,
                Eigen::VectorXd& y) const;

  /// y <- L^-T y and y <- L^-1 y.
  void solve_upper(Eigen::VectorXd& y) const;
  void solve_lower(Eigen::VectorXd& y) const;

  /// Y <- L^-T Y for `width` columns at once (a multiple of four) that are zero but on the path
  /// from the root to `last`; Y has depth(last) + 1 rows, one after the other.
  void solve_path(int last, int width, double* Y) const {
    kernels_->solve_path(paths(), rows_.data(), inverse_.data(), last, width, Y);
  }

 private:
  const double* row(int place) const { return rows_.data() + row_begin(place); }
  kernels::Paths paths() const {
    return {static_cast<int>(parent_.size()), parent_.data(), depth_.data(), offset_.data()};
  }

  const kernels::Kernels* kernels_;
  std::vector<int> place_, column_, parent_, depth_, offset_, body_place_;
  std::vector<int> path_;               // as rows_
  std::vector<int> row_of_, entry_of_;  // by velocity column: row_begin and depth of its place
  std::vector<double> rows_, inverse_;  // of L; of its diagonal
  mutable Eigen::VectorXd scratch_;
};

}  // namespace ayumi
