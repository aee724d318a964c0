// In ordinary walking, HOAP-1's collision shapes keep a clearance, and they detect a foot that
// touches the other one.

#include <gtest/gtest.h>

#include <random>

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/dynamics/self_collision.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "tests/support/degree.hpp"

namespace ayumi {
namespace {

using test::kDegree;

class Hoap1Clearance : public testing::Test {
 protected:
  Hoap1Clearance()
      : model(load_robot("hoap1", {{AYUMI_SOURCE_DIR "/robots"}})), collision(model), data(model) {}

  // The smallest clearance over all pairs, and the pair that has it.
  std::pair<double, std::string> nearest(const RobotState& state) {
    update_positions(model, state, data);
    std::pair<double, std::string> best = {1e9, ""};
    for (const CollisionModel::Pair& pair : collision.pairs()) {
      const double distance = collision.clearance(pair, data, 0.05);
      if (distance < best.first)
        best = {distance, model.bodies()[pair.a].name + " - " + model.bodies()[pair.b].name};
    }
    return best;
  }

  void set(RobotState& state, const std::string& joint, double degrees) {
    const int dof = model.find_dof(joint);
    ASSERT_GE(dof, 0) << joint;
    state.theta[dof] = degrees * kDegree;
  }

  RobotModel model;
  CollisionModel collision;
  RobotData data;
};

TEST_F(Hoap1Clearance, NoPairOfHousingsIsLeftOutUnseen) {
  const auto [distance, pair] = nearest(model.rest_state());
  EXPECT_GT(distance, 0.009) << pair;
  const auto watched = [&](const char* a, const char* b) {
    for (const CollisionModel::Pair& each : collision.pairs()) {
      const std::string first = model.bodies()[each.a].name, second = model.bodies()[each.b].name;
      if ((first == a && second == b) || (first == b && second == a)) return true;
    }
    return false;
  };
  EXPECT_TRUE(watched("l_foot", "r_foot"));
  EXPECT_TRUE(watched("l_shank", "r_shank"));
  EXPECT_TRUE(watched("l_thigh", "torso"));
  EXPECT_TRUE(watched("l_shank", "l_foot"));
  EXPECT_TRUE(watched("l_forearm", "torso"));
  EXPECT_TRUE(watched("l_forearm", "l_thigh"));
}

// Both legs sway by the same angle, each is bent by its own amount, soles are kept level, and arms
// swing a little.
TEST_F(Hoap1Clearance, OrdinaryWalkingIsFree) {
  std::mt19937 random(3);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int trial = 0; trial < 500; ++trial) {
    RobotState state = model.rest_state();
    const double sway = between(-14, 14);
    for (const std::string side : {"l_", "r_"}) {
      const double hip = between(-50, -5), knee = between(5, 75);
      set(state, side + "hip_roll", sway);
      set(state, side + "ankle_roll", -sway);
      set(state, side + "hip_pitch", hip);
      set(state, side + "knee", knee);
      set(state, side + "ankle_pitch", std::clamp(-hip - knee, -55.0, 30.0));
      set(state, side + "shoulder_pitch", between(65, 110));
      set(state, side + "elbow", between(-60, -10));
    }
    const auto [distance, pair] = nearest(state);
    EXPECT_GT(distance, 0.003) << pair << ", trial " << trial;
  }
}

TEST_F(Hoap1Clearance, FeetThatMeetAreSeen) {
  RobotState state = model.rest_state();
  set(state, "l_hip_roll", -6);
  set(state, "l_ankle_roll", 6);
  EXPECT_LT(nearest(state).first, 0);
}

// A file without collision shapes still states the soles, and soles are solid.
TEST_F(Hoap1Clearance, SolesOfFeetWithoutShapesOverlap) {
  RobotDescription bare = model.description();
  for (LinkDescription& link : bare.links) link.collisions.clear();
  const RobotModel robot(bare);
  const CollisionModel soles(robot);
  ASSERT_EQ(soles.pairs().size(), 1u);
  const int left = robot.sole(Side::left).body, right = robot.sole(Side::right).body;
  EXPECT_EQ(std::minmax(soles.pairs()[0].a, soles.pairs()[0].b), std::minmax(left, right));
  RobotData placed(robot);
  const auto clearance = [&](double across, double up) {
    update_positions(robot, robot.rest_state(), placed);
    // The foot bodies stand side by side, `across` apart from sole centre to sole centre.
    const Eigen::Vector3d way = placed.pose(left).translation() - placed.pose(right).translation();
    placed.position[static_cast<size_t>(left)] += Eigen::Vector3d(0, across - way.y(), up);
    return soles.clearance(soles.pairs()[0], placed, 0.1);
  };
  constexpr double kWidth = 0.063;  // of a sole [m]
  EXPECT_NEAR(clearance(kWidth + 0.015, 0), 0.015, 1e-6);
  EXPECT_LT(clearance(kWidth - 0.015, 0), -0.001);
  EXPECT_GT(clearance(kWidth - 0.015, 0.02), 0.001);  // the foot swings over the other one
}

// A sole in the plane of its joint is solid, too.
TEST_F(Hoap1Clearance, SolesAtTheHeightOfTheirJointsOverlap) {
  RobotDescription bare = model.description();
  for (LinkDescription& link : bare.links) link.collisions.clear();
  for (auto& [side, sole] : bare.soles) sole.frame.translation().z() = 0;
  const RobotModel robot(bare);
  const CollisionModel soles(robot);
  ASSERT_EQ(soles.pairs().size(), 1u);
  RobotData placed(robot);
  update_positions(robot, robot.rest_state(), placed);
  const auto left = static_cast<size_t>(robot.sole(Side::left).body),
             right = static_cast<size_t>(robot.sole(Side::right).body);
  placed.rotation[left] = placed.rotation[right];
  placed.position[left] =
      placed.position[right] + placed.rotation[right] * Eigen::Vector3d(0, 0.04, 0);
  EXPECT_LT(soles.clearance(soles.pairs()[0], placed, 0.1), -0.001);
}

}  // namespace
}  // namespace ayumi
