// Agreement with an independent implementation of rigid-body dynamics.

#include <gtest/gtest.h>

#ifdef AYUMI_HAS_MUJOCO

#include "ayumi/base/file.hpp"
#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/io/robot_file.hpp"
#include "tests/support/mujoco_model.hpp"
#include "tests/support/random_robot.hpp"

namespace ayumi {
namespace {

constexpr int kStates = 100;
// With one set of numbers the two differ by rounding alone.
constexpr double kSameNumbers = 1e-10;
// MuJoCo's reader turns inertias into principal axes and rounds on the way.
constexpr double kOwnReader = 1e-6;

double relative(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return (a - b).norm() / b.norm();
}

/// Mass, COG, mass matrix and bias forces in random states, relative to their norms.
void expect_agreement(const RobotModel& model, test::MujocoRobot& other, unsigned seed,
                      double tolerance) {
  EXPECT_NEAR(other.mass(), model.mass(), tolerance * model.mass());
  test::Random random(seed);
  RobotData data(model);
  Eigen::MatrixXd M;
  double worst = 0;
  for (int i = 0; i < kStates; ++i) {
    const RobotState state = test::random_state(model, random);
    other.set_state(state);
    const Eigen::VectorXd bias = bias_force(model, state, data);
    mass_matrix(model, data, M);
    const double cog = relative(other.cog(), data.cog);
    const double mass = relative(other.mass_matrix(), M);
    const double force = relative(other.bias_force(), bias);
    ASSERT_LT(cog, tolerance) << "COG, state " << i;
    ASSERT_LT(mass, tolerance) << "mass matrix, state " << i;
    ASSERT_LT(force, tolerance) << "bias force, state " << i;
    worst = std::max({worst, cog, mass, force});
  }
  testing::Test::RecordProperty("worst", text::brief(worst));
  std::cout << "largest relative difference: " << text::brief(worst) << "\n";
}

class MujocoRandomTrees : public testing::TestWithParam<unsigned> {};

TEST_P(MujocoRandomTrees, AgreeOnSameNumbers) {
  const RobotModel model(test::random_tree(GetParam(), 6 + static_cast<int>(GetParam()), false));
  auto other = test::MujocoRobot::from_model(model);
  expect_agreement(model, other, GetParam() + 100, kSameNumbers);
}

INSTANTIATE_TEST_SUITE_P(Seeds, MujocoRandomTrees, testing::Range(1u, 13u));

TEST(MujocoHoap1, AgreesOnSameNumbers) {
  const RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1/robot.json");
  auto other = test::MujocoRobot::from_model(model);
  expect_agreement(model, other, 1, kSameNumbers);
}

TEST(MujocoHoap1, AgreesWithItsOwnReadingOfTheUrdf) {
  const RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1/robot.json");
  auto other =
      test::MujocoRobot::from_urdf(model, read_file(AYUMI_SOURCE_DIR "/robots/hoap1/robot.urdf"));
  expect_agreement(model, other, 2, kOwnReader);
}

}  // namespace
}  // namespace ayumi

#else

TEST(Mujoco, Agrees) { GTEST_SKIP() << "MuJoCo was not found when this was configured"; }

#endif
