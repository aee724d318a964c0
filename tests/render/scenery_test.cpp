#include "ayumi/render/scenery.hpp"

#include <gtest/gtest.h>

#include "ayumi/render/clip.hpp"
#include "tests/render/box_robot.hpp"

namespace ayumi {
namespace {

using Eigen::Vector3d;

TEST(Scenery, BlocksReachFromThePlaneToTheirTops) {
  World world;
  world.height = -0.02;
  world.blocks = {{.low = {0, 0}, .high = {0.2, 0.1}, .height = 0.01}};
  const Eigen::AlignedBox3d box = bounds(make_scenery(world));
  EXPECT_TRUE(box.min().isApprox(Vector3d(0, 0, -0.02), 1e-6));
  EXPECT_TRUE(box.max().isApprox(Vector3d(0.2, 0.1, 0.01), 1e-6));
  EXPECT_TRUE(make_scenery({}).indices.empty());
}

TEST(Scenery, AFieldKeepsItsExtentWhenItIsThinnedOut) {
  World world;
  HeightField field{.origin = {-0.5, 0}, .spacing = 0.01};
  field.heights = Eigen::MatrixXd::Zero(101, 52);
  field.heights(100, 51) = 0.03;
  world.fields = {field};
  const Triangles fine = make_scenery(world), coarse = make_scenery(world, 20);
  EXPECT_GT(fine.indices.size(), 10 * coarse.indices.size());
  for (const Triangles& scenery : {fine, coarse}) {
    EXPECT_TRUE(bounds(scenery).min().isApprox(Vector3d(-0.5, 0, 0), 1e-6));
    EXPECT_TRUE(bounds(scenery).max().isApprox(Vector3d(0.5, 0.51, 0.03), 1e-6));
  }
}

TEST(Scenery, ABumpComesUpWhereTheFootIsAndGoes) {
  const RobotModel model = test::box_robot();
  SimulationLog log = test::box_run(model);
  log.world.height = -0.01;
  const Bump bump{.foot = Side::left, .place = {0.02, 0}, .height = 0.004};
  log.scenario = {{.at = 0.5, .duration = 0.2, .what = bump}};
  const std::vector<RisingBump> bumps = rising_bumps(model, log);
  ASSERT_EQ(bumps.size(), 1u);
  // The trunk is at (0.05, 0.02 sin 3), and the left sole's frame is at (0.01, 0.04) from it.
  EXPECT_NEAR(bumps[0].block.center.x(), 0.05 + 0.01 + 0.02, 1e-9);
  EXPECT_NEAR(bumps[0].block.center.y(), 0.02 * std::sin(3.0) + 0.04, 1e-9);
  const auto top = [&](double t) {
    const Triangles triangles = make_bumps(bumps, log.world.height, t);
    return triangles.indices.empty() ? -1 : bounds(triangles).max().z();
  };
  EXPECT_EQ(top(0.4), -1);
  EXPECT_NEAR(top(0.51), -0.008, 1e-6) << "half way";
  EXPECT_NEAR(top(0.6), -0.006, 1e-6);
  EXPECT_EQ(top(0.71), -1);
}

/// The share of pixels that differ between two instants of a run.
double changed(const RobotModel& model, const SimulationLog& log, double a, double b) {
  ClipOptions options;
  options.picture = {.width = 160, .height = 120};
  options.camera.mode = CameraMode::fixed;
  ClipRenderer renderer(model, log, options);
  const Image first = renderer.frame(a), second = renderer.frame(b);
  int count = 0;
  for (size_t i = 0; i < first.rgb.size(); i += 3)
    count += std::abs(first.rgb[i] - second.rgb[i]) > 6;
  return 3.0 * count / double(first.rgb.size());
}

TEST(Scenery, AMovingFloorMovesInThePicture) {
  const RobotModel model = test::box_robot();
  SimulationLog log = test::box_run(model);
  for (SimulationSample& sample : log.samples) sample = log.samples.front();
  for (const bool moving : {false, true}) {
    if (moving)
      log.scenario = {{.at = 0.2, .duration = 0.2, .what = FloorPath{.tilt = {0.1, 0.05}}}};
    const double share = changed(model, log, 0.1, 0.9);
    if (moving)
      EXPECT_GT(share, 0.05) << "grid, shadow and horizon";
    else
      EXPECT_LT(share, 0.03) << "the caption's time alone";
  }
}

TEST(Scenery, AHollowIsSeenInThePlane) {
  const RobotModel model = test::box_robot();
  SimulationLog log = test::box_run(model);
  HeightField field{.origin = {-0.3, -0.3}, .spacing = 0.1};
  field.heights = Eigen::MatrixXd::Constant(7, 7, -0.05);
  ClipOptions options;
  options.picture = {.width = 160, .height = 120, .shadow = false};
  options.overlay = test::no_marks();
  const Image plane = ClipRenderer(model, log, options).frame(0);
  log.world.fields = {field};
  const Image hollow = ClipRenderer(model, log, options).frame(0);
  int count = 0;
  for (size_t i = 0; i < plane.rgb.size(); i += 3)
    count += std::abs(plane.rgb[i] - hollow.rgb[i]) > 4;
  EXPECT_GT(count, 1000) << "its ground and its walls";
}

}  // namespace
}  // namespace ayumi
