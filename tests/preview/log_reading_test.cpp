#include "ayumi/preview/log_reading.hpp"

#include <gtest/gtest.h>

#include "ayumi/preview/overlay.hpp"
#include "ayumi/preview/robot_surface.hpp"
#include "tests/preview/box_robot.hpp"

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

TEST(LogReading, GroundNormalTurnsAboutTheSlopeVector) {
  const Eigen::Vector3d n = ground_normal({.slope = {0.1, 0}});
  EXPECT_NEAR(n.y(), -std::sin(0.1), 1e-12);
  EXPECT_NEAR(n.z(), std::cos(0.1), 1e-12);
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
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(area(support_corners(model, poses, {true, false}, up)), 0.09 * 0.05, 1e-12);
  EXPECT_NEAR(area(support_corners(model, poses, {true, true}, up)), 0.09 * 0.13, 1e-12);
  EXPECT_TRUE(support_corners(model, poses, {false, false}, up).empty());
  const Eigen::Vector3d tilted = ground_normal({.slope = {0.1, 0.2}});
  for (const Eigen::Vector3d& corner : support_corners(model, poses, {true, true}, tilted))
    EXPECT_NEAR(tilted.dot(corner), 0, 1e-12);
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
