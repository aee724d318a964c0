// Sign tests begin and end where no parts of the robot overlap.

#include "ayumi/io/formats/sign_test.hpp"

#include <gtest/gtest.h>

#include <string>

#include "ayumi/base/error.hpp"
#include "ayumi/limits/table_safety.hpp"
#include "tests/support/degree.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi::test {
namespace {

std::string refusal_at(const Eigen::VectorXd& start) {
  try {
    sign_tests(hoap1(), start, 0.01);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_model);
    return error.what();
  }
  return "";
}

Eigen::VectorXd with_left_hip_roll(double angle) {
  Eigen::VectorXd start = hoap1().posture();
  start[hoap1().find_dof("l_hip_roll")] = angle;
  return start;
}

TEST(SignTest, AStartPostureInWhichPartsOverlapIsRefused) {
  EXPECT_EQ(refusal_at(hoap1().posture()), "");
  EXPECT_NE(refusal_at(with_left_hip_roll(-15 * kDegree)).find("overlap in the start posture"),
            std::string::npos);
}

// The encoders of a unit read 0 when its tests begin.
TEST(SignTest, TheTestsOfAUnitBeginWithReadingsOfZero) {
  RobotDescription description = hoap1().description();
  description.servos.at("l_knee").offset = 0.4 * kDegree;
  description.servos.at("r_ankle_roll").offset = -0.3 * kDegree;
  const RobotModel unit(description);
  for (const SignTest& test : sign_tests(unit, sign_test_start(unit), 0.01))
    for (const int joint : {unit.find_dof("l_knee"), unit.find_dof("r_ankle_roll")})
      EXPECT_EQ(encoder_counts(unit, test.table, {})(0, joint), 0) << test.name;
}

// A joint that would move a leg into the other one moves away from it.
TEST(SignTest, AJointDoesNotMoveIntoAnotherPart) {
  const int roll = hoap1().find_dof("l_hip_roll");
  // The greatest angle inwards at which the legs do not yet overlap.
  double free = 0, met = -15 * kDegree;
  for (int k = 0; k < 20; ++k) {
    const double middle = 0.5 * (free + met);
    (refusal_at(with_left_hip_roll(middle)).find("start posture") == std::string::npos ? free
                                                                                       : met) =
        middle;
  }
  const Eigen::VectorXd start = with_left_hip_roll(free + 0.5 * kDegree);
  ASSERT_EQ(refusal_at(start), "");
  for (const SignTest& test : sign_tests(hoap1(), start, 0.01)) {
    if (test.dof == roll) {
      EXPECT_NEAR(test.to - test.from, 5 * kDegree, 1e-12);
    }
    const bool right = test.name.ends_with("r_hip_roll");
    if (right) {
      EXPECT_NEAR(test.to - test.from, -5 * kDegree, 1e-12);
    }
  }
}

}  // namespace
}  // namespace ayumi::test
