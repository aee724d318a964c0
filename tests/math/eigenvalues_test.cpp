#include "ayumi/math/eigenvalues.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <complex>
#include <limits>
#include <optional>
#include <vector>

namespace ayumi {
namespace {

// The companion matrix of (x - 2)(x + 3)(x^2 - 2 x + 5) has the roots of that polynomial.
TEST(Eigenvalues, OfACompanionMatrixAreItsRoots) {
  // x^4 - x^3 - 3 x^2 + 17 x - 30
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(4, 4);
  A.diagonal(-1).setOnes();
  A.col(3) << 30, -17, 3, 1;
  const std::optional<Eigen::VectorXcd> found = eigenvalues(A);
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), 4);
  const std::vector<std::complex<double>> roots = {{2, 0}, {-3, 0}, {1, 2}, {1, -2}};
  for (const std::complex<double>& root : roots) {
    double nearest = 1e9;
    for (const std::complex<double>& value : *found)
      nearest = std::min(nearest, std::abs(value - root));
    EXPECT_LT(nearest, 1e-12) << root.real() << " + " << root.imag() << " i";
  }
}

TEST(Eigenvalues, OfAMatrixThatIsNotFiniteAreNotFound) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Identity(3, 3);
  for (const double value :
       {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    A(1, 2) = value;
    EXPECT_FALSE(eigenvalues(A));
  }
}

// The eigenvalues of Q diag(d) Q' with a rotation Q are d, in rising order.
TEST(Eigenvalues, OfASymmetricMatrixRise) {
  const Eigen::Vector3d d(0.3, 1.7, 2.9);
  const Eigen::Matrix3d Q = Eigen::Quaterniond(0.5, -0.1, 0.7, 0.4).normalized().toRotationMatrix();
  Eigen::Matrix3d A = Q * d.reverse().asDiagonal() * Q.transpose();
  EXPECT_LT((symmetric_eigenvalues(A) - d).norm(), 1e-14);
  A.triangularView<Eigen::StrictlyUpper>().setZero();  // only the lower triangle is read
  EXPECT_LT((symmetric_eigenvalues(A) - d).norm(), 1e-14);
}

}  // namespace
}  // namespace ayumi
