#include "ayumi/control/support_region.hpp"

#include <gtest/gtest.h>

#include "ayumi/io/robot/robot_file.hpp"

namespace ayumi {
namespace {

// The region that is kept between ticks follows feet, support and margin.
TEST(SupportRegion, IsThePolygonLessItsMargin) {
  const RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1");
  std::array<Eigen::Isometry3d, 2> feet = {Eigen::Isometry3d::Identity(),
                                           Eigen::Isometry3d::Identity()};
  feet[0].translation() = Eigen::Vector3d(0, 0.05, 0);
  feet[1].translation() = Eigen::Vector3d(0, -0.05, 0);
  SupportRegion region;
  const auto expect_right = [&](Support support, double margin) {
    for (int twice = 0; twice < 2; ++twice) {
      const ConvexPolygon& found = region.update(model, feet, support, margin);
      const ConvexPolygon expected = support_polygon(model, feet, support).shrunk(margin);
      EXPECT_EQ(found.vertices(), expected.vertices());
    }
  };
  expect_right(Support::both, 0.002);
  expect_right(Support::left, 0.002);
  feet[1].translation().x() = 0.03;  // the other foot does not matter
  expect_right(Support::left, 0.002);
  expect_right(Support::both, 0.002);
  feet[0].translation().x() = -0.01;
  expect_right(Support::both, 0.002);
  expect_right(Support::both, 0.004);
  expect_right(Support::none, 0.004);
  EXPECT_TRUE(region.update(model, feet, Support::none, 0.004).empty());
  expect_right(Support::both, 1);  // only the middle is left
  EXPECT_EQ(region.update(model, feet, Support::both, 1).vertices().size(), 1u);
}

}  // namespace
}  // namespace ayumi
