// Two integrators simulate one robot: Ayumi's plant is compared with MuJoCo.

#include "ayumi/sim/plant_mujoco/mujoco_plant.hpp"

#include <gtest/gtest.h>

#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/sim/plant/plant.hpp"
#include "ayumi/sim/simulator.hpp"
#include "tests/support/hoap1.hpp"
#include "tests/support/hoap1_walk.hpp"
#include "tests/support/walk.hpp"

namespace ayumi {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using test::hoap1;
using test::hoap1_walk;

TEST(MujocoPlant, StandingCarriesTheWeight) {
  const CommandSample s = test::standing(hoap1(), 0).samples[0];
  MujocoPlant plant(hoap1(), hoap1().limits(), World{});
  plant.set_state(s.state);
  StepReport report;
  for (int i = 0; i < 1000; ++i) report = plant.step(s.state.theta, {}, 1e-3);
  double weight = 0;
  for (const auto& sole : report.soles)
    for (const SoleForce& cell : sole) weight += cell.force.z();
  EXPECT_NEAR(weight, hoap1().mass() * kGravity, 0.01);
  EXPECT_LT((plant.data().cog - s.cog).norm(), 0.003);
  EXPECT_LT(report.max_penetration, 0.001);
  EXPECT_FALSE(report.body_contact);
}

// A standing robot sinks into soft soles by its weight over their stiffness, and as fast as in
// Ayumi's plant: with a damping time of 0.1 s, it has sunk by 1 - 1/e after 0.1 s.
TEST(MujocoPlant, SolesAreAsSoftAsTheSidecarStates) {
  constexpr double kStiffness = 20000, kTime = 0.1;
  RobotDescription description = hoap1().description();
  for (auto& [side, sole] : description.soles) {
    sole.stiffness = kStiffness;
    sole.damping_time = kTime;
  }
  const RobotModel robot(description);
  const CommandSample s = test::standing(robot, 0).samples[0];
  MujocoPlant theirs(robot, robot.limits(), World{});
  Plant ours(robot, robot.limits(), World{});
  theirs.set_state(s.state);
  ours.set_state(s.state);
  const double sink = robot.mass() * kGravity / (2 * kStiffness);
  for (int i = 1; i <= 1500; ++i) {
    theirs.step(s.state.theta, {}, 1e-3);
    ours.step(s.state.theta, {}, 1e-3);
    if (i == 100) {
      EXPECT_NEAR(s.cog.z() - theirs.data().cog.z(), (1 - std::exp(-1)) * sink, 0.1 * sink);
    }
    if (i % 100 == 0) {
      EXPECT_NEAR(theirs.data().cog.z(), ours.data().cog.z(), 0.02 * sink) << i;
    }
  }
  EXPECT_NEAR(s.cog.z() - theirs.data().cog.z(), sink, 0.1 * sink);
}

// A twentieth of the weight pulls forward. Contacts that yield along the ground as they do along
// the normal would creep by about 0.2 mm in the time that is measured.
TEST(MujocoPlant, SoftSolesDoNotCreepAlongTheGround) {
  RobotDescription description = hoap1().description();
  for (auto& [side, sole] : description.soles) sole.stiffness = 20000, sole.damping_time = 0.04;
  const RobotModel robot(description);
  const CommandSample s = test::standing(robot, 0).samples[0];
  MujocoPlant plant(robot, robot.limits(), World{});
  plant.set_state(s.state);
  const StepInput pull({ExternalWrench{.force = {robot.mass() * kGravity / 20, 0, 0}}});
  double start = 0;
  for (int i = 1; i <= 1000; ++i) {
    plant.step(s.state.theta, pull, 1e-3);
    if (i == 300) start = sole_pose(robot, plant.data(), Side::left).translation().x();
  }
  EXPECT_NEAR(sole_pose(robot, plant.data(), Side::left).translation().x(), start, 5e-5);
}

struct FlightDifference {
  double ours = 0, theirs = 0;  ///< deviation of the COG from its parabola [m]
  double attitude = 0;          ///< difference of the attitudes of the two bases [rad]
};

/// The differences after 0.3 s of flight with limbs that move.
FlightDifference flight_difference(double step) {
  RobotState s = hoap1().rest_state();
  s.base.position.z() = 2;
  s.base_velocity = Vector3d(0.3, -0.2, 1);
  s.base_angular_velocity = Vector3d(0.5, 1, -0.7);
  const VectorXd target = 0.8 * s.theta;
  Plant ours(hoap1(), hoap1().limits(), World{});
  MujocoPlant theirs(hoap1(), hoap1().limits(), World{});
  ours.set_state(s);
  theirs.set_state(s);
  constexpr double t = 0.3;
  const Vector3d v = centroidal_momentum(hoap1(), ours.data()).linear / hoap1().mass();
  const Vector3d end = ours.data().cog + t * v - Vector3d(0, 0, 0.5 * t * t * kGravity);
  for (int i = 0; i < std::lround(t / step); ++i) {
    ours.step(target, {}, step);
    theirs.step(target, {}, step);
  }
  return {(ours.data().cog - end).norm(), (theirs.data().cog - end).norm(),
          ours.state().base.attitude.angularDistance(theirs.state().base.attitude)};
}

// Ayumi's plant keeps the parabola with any step. The difference between the two falls in
// proportion to the step or faster: both converge to the same motion.
TEST(MujocoPlant, AgreesInFlightAsTheStepShrinks) {
  FlightDifference d[3];
  for (int i = 0; i < 3; ++i) {
    d[i] = flight_difference(1e-3 / std::pow(4, i));
    std::cout << "step " << 1 / std::pow(4, i) << " ms: COG off its parabola by " << 1e3 * d[i].ours
              << " and " << 1e3 * d[i].theirs << " mm, attitude " << d[i].attitude << " rad\n";
    EXPECT_LT(d[i].ours, 1e-10);
  }
  for (int i = 1; i < 3; ++i) {
    EXPECT_LT(d[i].attitude, 0.27 * d[i - 1].attitude);
    EXPECT_LT(d[i].theirs, 0.27 * d[i - 1].theirs);
  }
  EXPECT_LT(d[2].attitude, 1e-4);
  EXPECT_LT(d[2].theirs, 3e-5);
}

SimulationLog run(const SimulateOptions& wanted, const PlantKind& kind) {
  SimulateOptions options = wanted;
  options.plant = kind;
  return simulate(hoap1(), hoap1_walk(), options);
}

class MujocoWalk : public testing::TestWithParam<std::string> {};

TEST_P(MujocoWalk, GoesTheSameWay) {
  SimulateOptions options;
  options.controller.type = controller_type(GetParam());
  const SimulationLog ours = run(options, {}), theirs = run(options, mujoco_plant_kind());
  EXPECT_EQ(ours.plant, "ayumi");
  EXPECT_EQ(theirs.plant, "mujoco");
  EXPECT_EQ(theirs.result.outcome, Outcome::stands);
  ASSERT_EQ(ours.samples.size(), theirs.samples.size());
  double sum = 0, largest = 0;
  for (size_t k = 0; k < ours.samples.size(); ++k) {
    const double difference = (ours.samples[k].cog - theirs.samples[k].cog).norm();
    sum += difference * difference;
    largest = std::max(largest, difference);
  }
  const double rms = std::sqrt(sum / static_cast<double>(ours.samples.size()));
  std::cout << "COG, " << GetParam() << ": RMS " << 1e3 * rms << " mm, largest " << 1e3 * largest
            << " mm\n";
  EXPECT_LT(rms, 0.005);
}

INSTANTIATE_TEST_SUITE_P(Controllers, MujocoWalk, testing::Values("none", "dtad"));

// A copy continues from the same state to the last bit, so that pushes can branch off one run.
TEST(MujocoPlant, CopiesAreBranches) {
  SimulateOptions options;
  options.plant = mujoco_plant_kind();
  Simulator trunk(hoap1(), hoap1_walk(), options);
  trunk.advance(700);
  Simulator branch = trunk;
  trunk.advance(300);
  branch.advance(300);
  EXPECT_EQ(trunk.state().theta, branch.state().theta);
  EXPECT_EQ(trunk.state().base.position, branch.state().base.position);
}

TEST(MujocoPlant, RefusesWhatIsNotANumber) {
  MujocoPlant plant(hoap1(), hoap1().limits(), World{});
  VectorXd target = hoap1().rest_state().theta;
  target[3] = std::nan("");
  try {
    plant.step(target, {}, 1e-3);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("servo target of"), std::string::npos);
  }
}

// MuJoCo itself would continue from the first state of its model without a word.
TEST(MujocoPlant, SaysThatItsStateBecameHuge) {
  MujocoPlant plant(hoap1(), hoap1().limits(), World{});
  RobotState state = hoap1().rest_state();
  state.base.position.z() = 2;
  state.base_angular_velocity = Vector3d::Constant(9e5);
  plant.set_state(state);
  try {
    for (int i = 0; i < 100; ++i) plant.step(state.theta, {}, 1e-3);
    FAIL() << "the base is at a height of " << plant.state().base.position.z() << " m";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("MuJoCo's state is huge or not finite"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace ayumi
