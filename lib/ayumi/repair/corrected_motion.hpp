#pragma once
// One sample of a motion with a correction added, as apply_correction() adds it, and the
// derivatives of its state by the correction. With correction values d, rates d', accelerations
// d'':
//   p = p0 + d_p,  R = exp(r) R0,  theta = theta0 + d_theta,
//   w = J(r) r' + exp(r) w0,  dw = d/dt(J(r) r') + (J(r) r') x exp(r) w0 + exp(r) dw0,
// where J is the left Jacobian of the rotation group.

#include <Eigen/Core>

#include "ayumi/motion/command_series.hpp"

namespace ayumi {

struct CorrectedMotion {
  RobotState state;
  Eigen::VectorXd acceleration;

  Eigen::Matrix3d tangent;          ///< J(r): turn of the base by r
  Eigen::Matrix3d w_value, w_rate;  ///< derivatives of w with respect to r and r'
  Eigen::Matrix3d dw_value, dw_rate,
      dw_acceleration;  ///< derivatives of dw with respect to r, r', r''
};

/// Fills `state` and `acceleration`. `value`, `rate` and `second` contain the correction of base
/// position, base rotation vector and theta (6 + dof), and its first and second derivative.
/// Allocates nothing if `motion` already has its size.
void fill_motion(const CommandSample& sample, const Eigen::VectorXd& value,
                 const Eigen::VectorXd& rate, const Eigen::VectorXd& second,
                 CorrectedMotion& motion);

/// Fills the derivatives.
void fill_motion_derivatives(const CommandSample& sample, const Eigen::VectorXd& value,
                             const Eigen::VectorXd& rate, const Eigen::VectorXd& second,
                             CorrectedMotion& motion);

}  // namespace ayumi
