// Ground and disturbances in MuJoCo agree with closed forms for a block, and with Ayumi's own
// plant.

#include <gtest/gtest.h>

#include "ayumi/base/error.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/sim/plant_mujoco/mujoco_plant.hpp"
#include "ayumi/sim/schedule.hpp"
#include "ayumi/sim/simulate.hpp"
#include "tests/support/block.hpp"
#include "tests/support/ground.hpp"
#include "tests/support/hoap1.hpp"
#include "tests/support/walk.hpp"

namespace ayumi {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using test::hoap1;

constexpr double kStep = 1e-3;

struct Block {
  Block(const World& world, const Vector3d& place, double slope = 0)
      : model(test::block_description({0.2, 0.1, 0.04}, 2.0)), plant(model, model.limits(), world) {
    RobotState s = model.rest_state();
    s.base.attitude = exp_rotation({0, slope, 0});
    s.base.position = s.base.attitude * place;
    plant.set_state(s);
  }
  void run(double time, const StepInput& input = {}) {
    for (long i = 0; i < std::lround(time / kStep); ++i) plant.step(VectorXd(0), input, kStep);
  }
  const Vector3d& position() const { return plant.state().base.position; }
  RobotModel model;
  MujocoPlant plant;
};

GroundBlock rectangle(const Vector2d& low, const Vector2d& high, double height) {
  GroundBlock block;
  block.low = low;
  block.high = high;
  block.height = height;
  return block;
}

TEST(MujocoGround, BlocksDiscsAndThePlaneBelowCarry) {
  World world;
  world.height = -0.01;
  world.blocks.push_back(rectangle({-0.5, -0.5}, {0.5, 0.5}, 0.05));
  GroundBlock disc;
  disc.kind = GroundBlock::Kind::disc;
  disc.center = {0, 2};
  disc.radius = 0.3;
  disc.height = 0.02;
  world.blocks.push_back(disc);
  // The corners' balls reach half a millimetre below the block.
  for (const auto& [y, height] : {std::pair{0.0, 0.05}, {1.0, -0.01}, {2.0, 0.02}}) {
    Block block(world, {0, y, height + 0.022});
    block.run(0.5);
    EXPECT_NEAR(block.position().z(), height + 0.0205, 3e-4) << y;
  }
}

TEST(MujocoGround, PatchesHaveTheirOwnFriction) {
  const double angle = 0.3, mu = 0.1;
  World world{.friction = 0.8, .slope = {0, angle}};
  world.patches.push_back({{-0.3, -1}, {5, 1}, mu});
  for (const double y : {0.0, 2.0}) {
    Block block(world, {0, y, 0.0205}, angle);
    block.run(0.1);
    const Vector3d start = block.position();
    const double v0 = block.plant.state().base_velocity.norm();
    block.run(0.5);
    const double a = kGravity * (std::sin(angle) - mu * std::cos(angle));
    const double distance = y > 1 ? 0 : v0 * 0.5 + 0.5 * a * 0.25;
    EXPECT_NEAR((block.position() - start).norm(), distance, 0.01 * distance + 2e-3);
  }
}

// The height field is an inclined plane, above and below the plane around it.
TEST(MujocoGround, AnInclinedFieldIsASlope) {
  const double angle = 0.3, mu = 0.15;
  const World world = test::inclined_field(angle, mu);
  Block block(world, {0, 0, 0.0205}, angle);
  block.run(0.1);
  const Vector3d start = block.position();
  const double v0 = block.plant.state().base_velocity.norm(), T = 0.6;
  block.run(T);
  const double distance = test::sliding_distance(angle, mu, v0, T);
  EXPECT_NEAR((block.position() - start).norm(), distance, 0.02 * distance);
}

// A block on a floor that is shaken more gently than friction holds moves with the floor; with
// stronger shaking it slips.
TEST(MujocoGround, AMovingFloorCarriesABlockAsFarAsFrictionHolds) {
  const double mu = 0.4, w = 2 * M_PI * 2;
  for (const double share : {0.8, 1.5}) {
    const double amplitude = share * mu * kGravity / (w * w);
    Block block(World{.friction = mu}, {0, 0, 0.0205});
    const double apart = test::moved_on_floor(block, test::shaking(amplitude), kStep);
    if (share < 1) {
      EXPECT_LT(apart, 0.05 * amplitude);
    } else {
      EXPECT_GT(apart, 0.2 * amplitude);
    }
  }
}

/// One disturbance of each kind, from 0.3 s for 0.7 s.
std::vector<Disturbance> disturbances() {
  std::vector<Disturbance> all;
  const auto add = [&](const auto& what, double duration = 0.7) {
    all.push_back({.at = 0.3, .duration = duration, .what = what});
  };
  add(Push{.kind = PushKind::impulse, .magnitude = 0.4}, 0.02);
  add(Push{
      .kind = PushKind::force, .magnitude = 4, .on = "r_forearm", .direction = Vector3d::UnitY()});
  add(Push{.kind = PushKind::torque, .magnitude = 0.6});
  add(Payload{.on = "r_forearm", .point = {0, 0, -0.05}, .mass = 0.3});
  add(FloorPath{MotionShape::half_sine, 0, {0.03, 0.02}, {0.01, 0.02, 0.005}});
  add(FrictionChange{0.3});
  add(Bump{.foot = Side::left,
           .place = hoap1().sole(Side::left).center,
           .radius = 0.015,
           .height = 0.003});
  add(Latency{0.004});
  add(SensorBias{.tilt = {0.005, 0.005}});
  add(EncoderOffset{.joint = "l_ankle_pitch", .offset = 0.02});
  add(JointFriction{.coulomb = 0.3, .viscous = 0.1});
  add(GainLoss{.joint = "l_knee", .share = 0.4});
  return all;
}

class MujocoDisturbance : public testing::TestWithParam<Disturbance> {};

// COG and force on the ground agree in both plants under each of the twelve disturbances.
TEST_P(MujocoDisturbance, DoesTheSameInBothPlants) {
  static const CommandSeries stand = test::standing(hoap1(), 1.3);
  SimulateOptions options;
  options.settle = 0;
  options.scenario = {GetParam()};
  const SimulationLog ours = simulate(hoap1(), stand, options);
  options.plant = mujoco_plant_kind();
  const SimulationLog theirs = simulate(hoap1(), stand, options);
  ASSERT_EQ(ours.samples.size(), theirs.samples.size());
  double largest = 0, moved = 0, force = 0;
  for (size_t k = 0; k < ours.samples.size(); ++k) {
    // The balls at the corners are only flush with the sole while it is flat.
    largest = std::max(largest, (ours.samples[k].cog - theirs.samples[k].cog).norm());
    moved = std::max(moved, (ours.samples[k].cog - ours.samples[250].cog).norm());
    if (k > 1000) force += (ours.samples[k].fz - theirs.samples[k].fz) / 300;
  }
  std::cout << name_of(GetParam()) << ": COG moves " << 1e3 * moved << " mm, differs by "
            << 1e3 * largest << " mm, f_z by " << force << " N\n";
  EXPECT_NE(ours.result.outcome, Outcome::fell);
  EXPECT_NE(theirs.result.outcome, Outcome::fell);
  EXPECT_LT(largest, 0.001 + 0.15 * moved);
  EXPECT_LT(std::abs(force), 0.5);
}

INSTANTIATE_TEST_SUITE_P(All, MujocoDisturbance, testing::ValuesIn(disturbances()),
                         [](const auto& info) { return std::string(name_of(info.param)); });

// Servos in MuJoCo have the zeros of their unit, too: with its own file, a unit with offsets stands
// as a robot without offsets does, and on a file without offsets its elbow is wrong by the offset.
TEST(MujocoGround, OffsetsOfAUnitAreThoseOfItsFile) {
  static const CommandSeries stand = test::standing(hoap1(), 0.5);
  const double offset = 0.01;
  RobotDescription description = hoap1().description();
  for (const char* joint : {"l_knee", "r_ankle_roll", "l_elbow"})
    description.servos.at(joint).offset = offset;
  const RobotModel unit(description);
  SimulateOptions options;
  options.settle = 0;
  options.plant = mujoco_plant_kind();
  options.sensor_noise = false;
  for (const ControllerKind kind : {ControllerKind::none, ControllerKind::dtad}) {
    options.controller.type = kind;
    const SimulationLog plain = simulate(hoap1(), stand, options);
    const SimulationLog own = simulate(unit, stand, options);
    ASSERT_EQ(own.samples.size(), plain.samples.size());
    double furthest = 0;
    for (size_t k = 0; k < own.samples.size(); ++k)
      furthest = std::max(
          furthest,
          (own.samples[k].state.theta - plain.samples[k].state.theta).cwiseAbs().maxCoeff());
    EXPECT_LT(furthest, 1e-6);  // MuJoCo stops its solver at a tolerance
  }
  options.controller.type = ControllerKind::none;
  const SimulationLog plain = simulate(hoap1(), stand, options);
  const RobotUnit individual{unit, unit.limits()};
  options.unit = &individual;
  const SimulationLog other = simulate(hoap1(), stand, options);
  const int elbow = unit.find_dof("l_elbow");
  EXPECT_NEAR(other.samples.back().state.theta[elbow] - plain.samples.back().state.theta[elbow],
              offset, 0.01 * offset);
}

TEST(MujocoGround, TooManyBumpsAreRefused) {
  Block block(World{}, {0, 0, 0.0205});
  StepInput input;
  input.bumps.resize(5);
  try {
    block.plant.step(VectorXd(0), input, kStep);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("room for 4 bumps"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace ayumi
