#pragma once

#include <Eigen/Dense>

namespace ayumi::test {

inline double relative_error(const Eigen::MatrixXd& found, const Eigen::MatrixXd& expected) {
  return (found - expected).norm() / expected.norm();
}

}  // namespace ayumi::test
