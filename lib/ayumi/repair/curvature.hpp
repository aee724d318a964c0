#pragma once
// Second derivatives of the rows of one collocation point, times their multipliers, by the
// correction's value and acceleration. With a column's turning axis omega_i (0 where it slides) and
// its motion of a point J_i, i above j in the tree,
//   d2(point)/di dj = omega_i x J_j,
// which gives those of soles and of the COG. A sum of ground wrench rows is the wrench's power on a
// rigid motion s of the world: the rate d/dt (p . v) of the momentum p(q) = M(q) s along it, less
// gravity. That gives
//   by acceleration and value  G = dp/dq: inverse dynamics at rest, acceleration s, no gravity
//   by rate and rate           G + G'
// The friction cone curves by the tangential force.
// Small terms are left out: value against rate, the paths of accelerations other than gravity,
// torques, clearances (their nearest points jump from corner to corner), tied joints, and terms of
// a base rotation vector that is not 0.

#include <Eigen/Core>
#include <span>

#include "ayumi/repair/constraint_rows.hpp"

namespace ayumi {

struct Curvature {
  Eigen::MatrixXd value;  ///< second derivatives by value and value, (6+dof) square, symmetric
  Eigen::MatrixXd acceleration;  ///< second derivatives by acceleration (rows) and value (columns)
  Eigen::Matrix2d cone = Eigen::Matrix2d::Zero();  ///< second derivatives by the tangential force
  std::array<Eigen::MatrixXd, 3> force_by;  ///< derivatives of the tangential force by value, rate
                                            ///< and acceleration [2 x 6+dof]
};

/// `blocks` are the row blocks of `point`, and `multipliers` are those of all rows. `state` must
/// have derivatives.
Curvature curvature_of(const RobotModel& model, std::span<const RowBlock> blocks,
                       const Eigen::VectorXd& multipliers, const CollocationPoint& point,
                       const PointState& state, DerivativeWorkspace& workspace);

/// Whether no row is curved. Then curvature_of() leaves its matrices empty.
bool is_flat(const Curvature& curvature);

}  // namespace ayumi
