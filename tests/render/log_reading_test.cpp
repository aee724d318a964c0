#include "ayumi/render/log_reading.hpp"

#include <gtest/gtest.h>

#include "ayumi/render/overlay.hpp"
#include "ayumi/render/robot_surface.hpp"
#include "tests/render/box_robot.hpp"

namespace ayumi {
namespace {

TEST(LogReading, SamplesAreInterpolatedAndHeld) {
  const RobotModel model = test::box_robot();
  const SimulationLog log = test::box_run(model);
  EXPECT_DOUBLE_EQ(duration(log), 1.0);
  EXPECT_NEAR(sample_at(log, 0.333).cog.x(), 0.0333, 1e-12) << "between two ticks of 2 ms";
  EXPECT_EQ(sample_at(log, 0.334).cog, log.samples[167].cog) << "at a tick, the tick itself";
  EXPECT_EQ(sample_at(log, -1).cog, log.samples.front().cog);
  EXPECT_EQ(sample_at(log, 9).cog, log.samples.back().cog);
  EXPECT_TRUE(sample_at(log, 0.599).planned_contact[1]) << "contacts of the tick before";
}

TEST(LogReading, APushIsFoundWithItsValue) {
  const RobotModel model = test::box_robot();
  SimulationLog log = test::box_run(model);
  ASSERT_EQ(pushes(log).size(), 1u);
  const PushRecord push = pushes(log)[0];
  EXPECT_NEAR(push.begin, 0.3, 1e-12);
  EXPECT_NEAR(push.end, 0.32, 1e-12);
  EXPECT_NEAR(push.impulse.y(), 0.4, 1e-12);
  EXPECT_EQ(push_text(push), "0.4 N s");
  for (int k = 400; k < 600 && k <= 500; ++k) log.samples[size_t(k)].push_force = {3, 0, 0};
  for (int k = 200; k < 400; ++k) log.samples[size_t(k)].push_force = {0, 0, 0};
  for (int k = 250; k < 380; ++k) log.samples[size_t(k)].push_force = {3, 4, 0};
  ASSERT_EQ(pushes(log).size(), 3u);
  EXPECT_EQ(push_text(pushes(log)[1]), "5 N") << "a long one by its force";
}

TEST(LogReading, ThePushOrTheFallIsWorthShowing) {
  SimulationLog log = test::box_run(test::box_robot());
  log.result.outcome = Outcome::fell;
  log.result.fell_at = 0.8;
  EXPECT_NEAR(telling_instant(log), 0.55, 1e-12);
  for (SimulationSample& sample : log.samples) sample.push_force.setZero();
  EXPECT_NEAR(telling_instant(log), 0.8, 1e-12);
  log.result.outcome = Outcome::stands;
  EXPECT_NEAR(telling_instant(log), 0.5, 1e-12);
  EXPECT_EQ(telling_instants(log, 3), (std::vector<double>{0, 0.5, 1}));
}

TEST(LogReading, FlightsAreWorthShowing) {
  SimulationLog log = test::box_run(test::box_robot());
  for (SimulationSample& sample : log.samples) sample.push_force.setZero();
  for (size_t k = 0; k < log.samples.size(); ++k)
    if (const double t = k * log.dt; t > 0.5999 && t < 0.6999)
      log.samples[k].planned_contact = {false, false};
  ASSERT_EQ(flights(log).size(), 1u);
  EXPECT_NEAR(flights(log)[0].begin, 0.6, 1e-12);
  EXPECT_NEAR(flights(log)[0].end, 0.7, 1e-12);
  EXPECT_NEAR(telling_instant(log), 0.65, 1e-12);
  const std::vector<double> times = telling_instants(log, 4);
  ASSERT_EQ(times.size(), 4u);
  EXPECT_NEAR(times[0], 0.35, 1e-12) << "a little before";
  EXPECT_NEAR(times[1], 0.65, 1e-12) << "the flight itself, not 0.567";
  EXPECT_NEAR(times[2], 0.35 + 0.65 * 2 / 3, 1e-12);
  EXPECT_NEAR(times[3], 1, 1e-12) << "within the run";
}

// The made-up push lasts from 0.3 to 0.32 s.
TEST(LogReading, PushesAreWorthShowing) {
  SimulationLog log = test::box_run(test::box_robot());
  std::vector<double> times = telling_instants(log, 5);
  ASSERT_EQ(times.size(), 5u);
  EXPECT_NEAR(times.front(), 0.05, 1e-12) << "a little before";
  EXPECT_NEAR(times[1], 0.31, 1e-12) << "the push itself, not 0.2875";
  EXPECT_NEAR(times.back(), 1, 1e-12) << "within the run";
  const size_t end = log.samples.size();
  for (size_t k = 0; k < 3 * end; ++k) log.samples.push_back(log.samples[end - 1]);
  EXPECT_NEAR(telling_instants(log, 5).back(), 1.57, 1e-12) << "not the rest of the run";
  log.result.outcome = Outcome::fell;
  log.result.fell_at = 1.9;
  EXPECT_NEAR(telling_instants(log, 5).back(), 3.15, 1e-12) << "after the fall";
}

TEST(LogReading, AWalkIsShownOnBothFeet) {
  SimulationLog log = test::box_run(test::box_robot());
  for (SimulationSample& sample : log.samples) sample.push_force.setZero();
  for (size_t k = 0; k < log.samples.size(); ++k) {
    const bool left = k % 100 < 50;  // 0.1 s on each foot
    log.samples[k].planned_contact = {left, !left};
  }
  const std::vector<double> times = telling_instants(log, 6);  // evenly: all on the left foot
  ASSERT_EQ(times.size(), 6u);
  for (size_t i = 0; i + 1 < times.size(); ++i)
    EXPECT_EQ(sample_at(log, times[i]).planned_contact[0], i % 2 == 0) << times[i];
  EXPECT_NEAR(times[1], 0.15, 1e-12) << "the middle of a step";
  EXPECT_TRUE(std::is_sorted(times.begin(), times.end()));
}

TEST(LogReading, TheGroundIsTheSlopeWithEveryMotionOfTheFloor) {
  SimulationLog log = test::box_run(test::box_robot());
  log.world.slope = {0.1, 0};
  log.world.height = -0.02;
  EXPECT_FALSE(floor_moves(log));
  const Eigen::Vector3d n = ground_at(log, 0.4).linear().col(2);
  EXPECT_NEAR(n.y(), -std::sin(0.1), 1e-12);
  EXPECT_NEAR(n.z(), std::cos(0.1), 1e-12);
  EXPECT_TRUE(ground_at(log, 0.4).translation().isApprox(-0.02 * n, 1e-12));
  // A shift by the world, there and back, and a tilt by the scenario, which stays.
  log.world.motions = {
      {.at = 0, .duration = 0.8, .path = {.shape = MotionShape::half_sine, .shift = {0, 0.05, 0}}}};
  log.scenario = {{.at = 0.2, .duration = 0.2, .what = FloorPath{.tilt = {0.05, 0}}}};
  EXPECT_TRUE(floor_moves(log));
  EXPECT_NEAR(floor_at(log, 0.4).translation().y(), 0.05, 1e-12);
  EXPECT_NEAR(floor_at(log, 0.9).translation().y(), 0, 1e-12);
  EXPECT_NEAR(floor_at(log, 0.1).linear()(2, 1), std::sin(0.1), 1e-12);
  EXPECT_NEAR(floor_at(log, 0.3).linear()(2, 1), std::sin(0.125), 1e-12) << "half way";
  EXPECT_NEAR(floor_at(log, 0.9).linear()(2, 1), std::sin(0.15), 1e-12);
}

TEST(LogReading, MarksLieOnTheHigherSupportingFoot) {
  SimulationLog log = test::box_run(test::box_robot());
  SimulationSample sample = log.samples[0];
  EXPECT_EQ(marked_ground(log, 0, sample).translation().z(), 0) << "on the plane";
  sample.foot_cop[0].z() = 0.012;
  EXPECT_NEAR(marked_ground(log, 0, sample).translation().z(), 0.012, 1e-15);
  sample.foot_force[0].setZero();
  EXPECT_EQ(marked_ground(log, 0, sample).translation().z(), 0) << "nothing carries there";
}

TEST(Overlay, SupportPolygonIsTheHullOfThePlannedSoles) {
  const RobotModel model = test::box_robot();
  RobotState state = model.rest_state();
  state.base.position.z() = 0.30;
  const auto poses = body_poses(model, state);
  const auto area = [](const std::vector<Eigen::Vector3d>& p) {
    double sum = 0;
    for (size_t i = 0; i < p.size(); ++i) sum += p[i].cross(p[(i + 1) % p.size()]).z() / 2;
    return sum;
  };
  EXPECT_NEAR(area(support_corners(model, poses, {true, false})), 0.09 * 0.05, 1e-12);
  EXPECT_NEAR(area(support_corners(model, poses, {true, true})), 0.09 * 0.13, 1e-12);
  EXPECT_TRUE(support_corners(model, poses, {false, false}).empty());
  Eigen::Isometry3d tilted = Eigen::Isometry3d::Identity();
  tilted.rotate(Eigen::AngleAxisd(0.2, Eigen::Vector3d(0.6, 0.8, 0)));
  for (const Eigen::Vector3d& corner : support_corners(model, poses, {true, true}, tilted))
    EXPECT_NEAR(tilted.linear().col(2).dot(corner), 0, 1e-12);
}

TEST(Overlay, EveryMarkCanBeSwitchedOff) {
  const RobotModel model = test::box_robot();
  const SimulationLog log = test::box_run(model);
  const SimulationSample sample = sample_at(log, 0.31);
  const auto poses = body_poses(model, sample.state);
  const auto count = [&](const OverlayOptions& options) {
    return make_overlay(model, log, pushes(log), 0.31, sample, poses, 0.48, options)
        .triangles.indices.size();
  };
  const size_t all = count({});
  for (bool OverlayOptions::*flag :
       {&OverlayOptions::cog, &OverlayOptions::zmp, &OverlayOptions::reference_zmp,
        &OverlayOptions::support, &OverlayOptions::forces, &OverlayOptions::push,
        &OverlayOptions::trails}) {
    OverlayOptions options;
    options.*flag = false;
    EXPECT_LT(count(options), all);
  }
}

}  // namespace
}  // namespace ayumi
