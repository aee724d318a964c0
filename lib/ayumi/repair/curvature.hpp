#pragma once
// Second derivatives of the constraints of one instant, times their multipliers, by the
// correction's value and acceleration. With a column's turning axis omega_i (0 where it slides) and
// its motion of a point J_i, i above j in the tree,
//   d2(point)/di dj = omega_i x J_j,
// which gives those of soles and of the COG. A sum of ground wrench rows is the wrench's power on a
// rigid motion xi of the world, d/dt (p . v) of the momentum p(q) = M(q) xi along it, less gravity:
//   by acceleration and value  G = dp/dq: inverse dynamics at rest, acceleration xi, no gravity
//   by rate and rate           G + G'
// The friction cone's own curvature goes by the tangential force.
// What is left out is small: value and rate, the path of accelerations but gravity's, torques,
// clearances (which jump from corner to corner), tied joints, and what a base rotation vector that
// is not 0 adds.

#include <Eigen/Core>
#include <span>

#include "ayumi/repair/correction_constraints.hpp"

namespace ayumi {

struct Curvature {
  Eigen::MatrixXd value;         ///< (6+dof) square, symmetric: by value and value
  Eigen::MatrixXd acceleration;  ///< by acceleration (rows) and value
  Eigen::Matrix2d cone = Eigen::Matrix2d::Zero();  ///< by the tangential force
  std::array<Eigen::MatrixXd, 3> force_by;         ///< it by value, rate, acceleration [2 x 6+dof]
};

/// `blocks` are those of `instant`, `multipliers` of all constraints; `state` with derivatives.
Curvature curvature_of(const RobotModel& model, std::span<const ConstraintBlock> blocks,
                       const Eigen::VectorXd& multipliers, const CollocationPoint& instant,
                       const PointState& state, TreeDynamics& dynamics);

/// As curvature_of() leaves it where nothing curves.
bool is_flat(const Curvature& curvature);

}  // namespace ayumi
