// Agreement with an independent implementation of rigid-body dynamics.

#include <gtest/gtest.h>

#ifdef AYUMI_HAS_MUJOCO

#include "ayumi/base/file.hpp"
#include "ayumi/dynamics/cog_jacobian.hpp"
#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/dynamics/tree_dynamics.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "tests/support/dense.hpp"
#include "tests/support/mujoco_model.hpp"
#include "tests/support/random_robot.hpp"
#include "tests/support/relative_error.hpp"

namespace ayumi {
namespace {

using test::relative_error;

constexpr int kStates = 100;
// If both have the same numbers, they differ by rounding alone.
constexpr double kSameNumbers = 1e-10;
// MuJoCo's reader turns inertias into principal axes and rounds on the way.
constexpr double kOwnReader = 1e-6;

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
    const double cog = relative_error(other.cog(), data.cog);
    const double mass = relative_error(other.mass_matrix(), M);
    const double force = relative_error(other.bias_force(), bias);
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

/// Forward dynamics with rotors and viscous friction, COG Jacobian and centroidal momentum.
TEST_P(MujocoRandomTrees, AgreeOnMotionUnderForces) {
  const RobotModel model(test::random_tree(GetParam(), 6 + static_cast<int>(GetParam()), false));
  auto other = test::MujocoRobot::from_model(model);
  test::Random random(GetParam() + 300);
  RobotData data(model);
  TreeDynamics fast(model);
  const int n = model.dof_count();
  const JointDrive drive{random.vector(n, 0.01).cwiseAbs(), random.vector(n, 0.1).cwiseAbs(),
                         Eigen::VectorXd::Zero(n)};
  Eigen::VectorXd found;
  for (int i = 0; i < kStates; ++i) {
    const RobotState state = test::random_state(model, random);
    const Eigen::VectorXd force = random.vector(model.velocity_count(), 2.0);
    other.set_rotors(drive.rotor_inertia, drive.viscous);
    other.set_state(state);
    fast.forward(state, force, found, &drive);
    EXPECT_LT(relative_error(other.acceleration(force), found), 1e-9) << "with drives, state " << i;
    other.set_rotors(Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n));
    found = forward_dynamics(model, state, force, data);
    EXPECT_LT(relative_error(other.acceleration(force), found), 1e-9) << "state " << i;
    fast.forward(state, force, found);
    EXPECT_LT(relative_error(other.acceleration(force), found), 1e-9) << "link axes, state " << i;
    EXPECT_LT(relative_error(other.cog_jacobian(), cog_jacobian_floating(model, data)), 1e-9);
    const Momentum ours = centroidal_momentum(model, data);
    const auto [linear, angular] = other.momentum();
    EXPECT_LT(relative_error(linear, ours.linear), 1e-9);
    EXPECT_LT(relative_error(angular, ours.angular), 1e-9);
  }
}

/// Mimic joints, continuous joints, joints out of order: MuJoCo has the tree with every joint free,
/// and the tie theta_free = G theta + offset reduces it to ours: M = G' M_free G and so on.
TEST_P(MujocoRandomTrees, AgreeOnTiedJoints) {
  const RobotModel model(test::odd_tree(GetParam(), 8 + static_cast<int>(GetParam())));
  const test::FreedTree freed(model);
  const Eigen::MatrixXd T = freed.map();
  auto other = test::MujocoRobot::from_model(freed.model);
  test::Random random(GetParam() + 400);
  RobotData data(model);
  Eigen::MatrixXd M;
  Eigen::VectorXd found;
  for (int i = 0; i < kStates; ++i) {
    const RobotState state = test::random_state(model, random);
    other.set_state(freed.state(state));
    const Eigen::VectorXd force = random.vector(model.velocity_count(), 2.0);
    const Eigen::VectorXd bias = bias_force(model, state, data);
    mass_matrix(model, data, M);
    const Eigen::MatrixXd their_mass = T.transpose() * other.mass_matrix() * T;
    const Eigen::VectorXd their_bias = T.transpose() * other.bias_force();
    EXPECT_LT(relative_error(other.cog(), data.cog), 1e-9);
    EXPECT_LT(relative_error(their_mass, M), 1e-9) << "mass matrix, state " << i;
    EXPECT_LT(relative_error(their_bias, bias), 1e-9) << "bias force, state " << i;
    EXPECT_LT(relative_error(other.cog_jacobian() * T, cog_jacobian_floating(model, data)), 1e-9);
    TreeDynamics(model).forward(state, force, found);
    EXPECT_LT(relative_error(test::solve_dense(their_mass, force - their_bias), found), 1e-9);
    const Momentum ours = centroidal_momentum(model, data);
    EXPECT_LT(relative_error(other.momentum().second, ours.angular), 1e-9);
  }
}

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
