#pragma once
// Factorisation of a matrix with the sparsity of the mass matrix: M = L' L, where L(i, j) can be
// nonzero only if j is i or an ancestor of i, without fill-in (R. Featherstone, Rigid Body Dynamics
// Algorithms, 6.5). If mimic joints tie branches together, all dofs form one chain and the factor
// is dense.

#include <Eigen/Dense>
#include <vector>

#include "ayumi/dynamics/kernels/tree_kernels.hpp"
#include "ayumi/model/robot_model.hpp"

namespace ayumi {

class TreeCholesky {
 public:
  explicit TreeCholesky(const RobotModel& model,
                        const kernels::Kernels& kernels = kernels::best_kernels());

  /// Factorises a symmetric positive definite (6+dof) square matrix that has the zeros of the mass
  /// matrix, in the joint order of the model. Only one triangle is read. Returns false if the
  /// matrix is not positive definite.
  bool factor(const Eigen::MatrixXd& M);

  /// x <- M^-1 x.
  void solve(Eigen::VectorXd& x) const;

  // From here on, vectors are in the order of places: column c of the velocity has the place
  // place_of(c), and ancestors come first.
  int place_of(int column) const { return place_[static_cast<size_t>(column)]; }
  int column_at(int place) const { return column_[static_cast<size_t>(place)]; }
  /// The place of the parent; -1 at the end.
  int parent(int place) const { return parent_[static_cast<size_t>(place)]; }
  /// Number of places above it.
  int depth(int place) const { return depth_[static_cast<size_t>(place)]; }
  /// The depth(place) + 1 places from the root to this one.
  const int* path(int place) const { return path_.data() + row_begin(place); }
  double diagonal(int place) const { return row(place)[depth(place)]; }
  double below(int place, int ancestor) const { return row(place)[depth(ancestor)]; }
  /// The last place on the chain that moves a body.
  int last_place(int body) const { return body_place_[static_cast<size_t>(body)]; }

  // The matrix is stored by rows: the row of a place holds its path from the root and is filled up
  // to a multiple of four numbers.
  size_t row_doubles() const { return rows_.size(); }
  int row_begin(int place) const { return offset_[static_cast<size_t>(place)]; }
  /// The layout with which the kernels write a mass matrix into these rows.
  kernels::Layout layout() const {
    return {row_of_.data(), entry_of_.data(), place_.data(), false};
  }
  /// The rows themselves, which factor() turns into those of L.
  std::vector<double>& rows() { return rows_; }
  bool factor_rows();
  /// y <- M x for such rows.
  void multiply(const std::vector<double>& rows, const Eigen::VectorXd& x,
                Eigen::VectorXd& y) const;

  /// y <- L^-T y and y <- L^-1 y.
  void solve_upper(Eigen::VectorXd& y) const;
  void solve_lower(Eigen::VectorXd& y) const;

  /// Y <- L^-T Y for `width` columns at once (a multiple of four). They are zero except on the path
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
  std::vector<int> path_;               // the paths of all places, laid out like rows_
  std::vector<int> row_of_, entry_of_;  // by velocity column: row_begin and depth of its place
  std::vector<double> rows_, inverse_;  // the rows of L, and the inverse of its diagonal
  mutable Eigen::VectorXd scratch_;
};

}  // namespace ayumi
