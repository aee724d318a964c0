#include "ayumi/math/rotation.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/support/random_robot.hpp"

namespace ayumi {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

TEST(Rotation, ExponentialMatchesAngleAndAxis) {
  test::Random random(1);
  for (double angle : {0.0, 1e-12, 1e-8, 1e-4, 0.1, 1.0, 3.0, 3.1415}) {
    const Vector3d axis = random.vector().normalized();
    const Matrix3d expected = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    EXPECT_LT((exp_rotation(angle * axis).toRotationMatrix() - expected).norm(), 1e-15);
  }
}

TEST(Rotation, LogarithmInvertsTheExponential) {
  test::Random random(2);
  for (double angle : {0.0, 1e-12, 1e-8, 1e-4, 0.1, 1.0, 3.0, 3.1415}) {
    const Vector3d r = angle * random.vector().normalized();
    EXPECT_LT((log_rotation(exp_rotation(r)) - r).norm(), 1e-14 + 1e-9 * angle);
    const Quaterniond q = exp_rotation(r);
    EXPECT_LT((log_rotation(Quaterniond(-q.coeffs())) - r).norm(), 1e-14 + 1e-9 * angle);
  }
}

TEST(Rotation, RollPitchYawThereAndBack) {
  test::Random random(3);
  for (int i = 0; i < 100; ++i) {
    const Vector3d rpy(3 * random.uniform(), 1.5 * random.uniform(), 3 * random.uniform());
    EXPECT_LT((matrix_to_rpy(rpy_to_matrix(rpy)) - rpy).norm(), 1e-11);
  }
  const double half = std::numbers::pi / 2;
  EXPECT_LT((rpy_to_matrix({0, half, 0}) * Vector3d::UnitX() + Vector3d::UnitZ()).norm(), 1e-15);
}

TEST(Rotation, SkewIsTheCrossProduct) {
  test::Random random(4);
  const Vector3d a = random.vector(), b = random.vector();
  EXPECT_EQ(skew(a) * b, a.cross(b));
}

TEST(Rotation, TakesOneDirectionToAnother) {
  const Eigen::Vector3d from(1, 2, -2), to(0, 3, 4);
  const Eigen::Quaterniond q = rotation_between(from, to);
  EXPECT_LT((q * from.normalized() - to.normalized()).norm(), 1e-12);
  EXPECT_NEAR(log_rotation(q).norm(), std::acos(from.normalized().dot(to.normalized())), 1e-12);
  EXPECT_LT((rotation_between(from, -from) * from + from).norm(), 1e-12);
}

}  // namespace
}  // namespace ayumi
