#include "ayumi/render/visible_region.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "ayumi/render/ground_plane.hpp"
#include "ayumi/sim/ground.hpp"

namespace ayumi::test {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr int kWidth = 320, kHeight = 200;
constexpr double kAspect = double(kWidth) / kHeight;

Camera camera_at(const Vector3d& eye) {
  Camera camera;
  camera.eye = eye;
  return camera;
}

Eigen::Matrix4f clip_of(const Camera& camera) {
  return (projection_matrix(camera, kAspect) * view_matrix(camera)).cast<float>();
}

GroundRectangle level_ground(double height) {
  GroundRectangle ground;
  ground.origin = {0, 0, height};
  ground.u = Vector3d::UnitX();
  ground.v = Vector3d::UnitY();
  ground.normal = Vector3d::UnitZ();
  return ground;
}

// The simulated ground and the drawn ground are two types, and a program can use both.
TEST(VisibleRegion, CompilesBesideTheGroundOfTheSimulation) {
  static_assert(!std::is_same_v<Ground, GroundRectangle>);
  const Ground simulated{World{}};
  EXPECT_EQ(simulated.top(), level_ground(0).origin.z());
}

TEST(VisibleRegion, HoldsEveryPointOfABoxAndLittleMore) {
  const Camera camera = camera_at({2, -1, 0.7});
  const AlignedBox3d box(Vector3d(-0.1, -0.2, -0.1), Vector3d(0.2, 0.1, 0.3));
  VisibleRegion region(clip_of(camera), kWidth, kHeight);
  region.add(box, Isometry3d::Identity());
  const PixelBox seen = region.pixels();
  Eigen::AlignedBox2d exact;
  for (int i = 0; i < 8; ++i) {
    const Vector3d p =
        project(camera, kWidth, kHeight, box.corner(static_cast<AlignedBox3d::CornerType>(i)));
    exact.extend(Eigen::Vector2d(p.x(), kHeight - p.y()));
  }
  EXPECT_NEAR(seen.x, exact.min().x() - 2, 1.01);
  EXPECT_NEAR(seen.y, exact.min().y() - 2, 1.01);
  EXPECT_NEAR(seen.x + seen.width, exact.max().x() + 3, 1.01);
  EXPECT_NEAR(seen.y + seen.height, exact.max().y() + 3, 1.01);
}

TEST(VisibleRegion, StaysInThePictureAndTakesItWholeForWhatIsBehindTheCamera) {
  const Camera camera = camera_at({2, 0, 0.3});
  VisibleRegion outside(clip_of(camera), kWidth, kHeight);
  EXPECT_EQ(outside.pixels().width, 0);
  outside.add(Vector3d(0, 500, 0));
  EXPECT_EQ(outside.pixels().width * outside.pixels().height, 0);
  VisibleRegion behind(clip_of(camera), kWidth, kHeight);
  behind.add(Vector3d(3, 0, 0));
  EXPECT_EQ(behind.pixels().width, kWidth);
  EXPECT_EQ(behind.pixels().height, kHeight);
}

// The tiles are compared with points inside the body, each at its pixel.
TEST(CoveredTiles, HoldsEveryPointOfABodyAndLeavesMuchOut) {
  const Camera camera = camera_at({1.2, -1, 0.7});
  const PixelBox part{20, 10, 280, 180};
  const auto turned = [](double angle) {
    Isometry3d pose = Isometry3d::Identity();
    pose.rotate(Eigen::AngleAxisd(angle, Vector3d(1, 2, 3).normalized()));
    return pose;
  };
  const AlignedBox3d box(Vector3d(-0.02, -0.02, -0.3), Vector3d(0.02, 0.03, 0.25));
  for (const double angle : {0.0, 0.7, 2.1}) {
    CoveredTiles tiles(clip_of(camera), kWidth, kHeight, part);
    tiles.add(box, turned(angle));
    const std::vector<PixelBox> runs = tiles.runs();
    int area = 0;
    for (const PixelBox& run : runs) {
      area += run.width * run.height;
      EXPECT_TRUE(run.x >= part.x && run.y >= part.y && run.x + run.width <= part.x + part.width &&
                  run.y + run.height <= part.y + part.height);
    }
    EXPECT_LT(area, part.width * part.height / 3);
    for (int i = 0; i < 1000; ++i) {
      const Vector3d share(i % 10 / 9.0, i / 10 % 10 / 9.0, i / 100 / 9.0);
      const Vector3d point = turned(angle) * Vector3d(box.min() + share.cwiseProduct(box.sizes()));
      const Vector3d pixel = project(camera, kWidth, kHeight, point);
      const double x = pixel.x(), y = kHeight - pixel.y();
      if (x < part.x || y < part.y || x >= part.x + part.width || y >= part.y + part.height)
        continue;
      EXPECT_TRUE(std::any_of(runs.begin(), runs.end(),
                              [&](const PixelBox& run) {
                                return x >= run.x && x < run.x + run.width && y >= run.y &&
                                       y < run.y + run.height;
                              }))
          << x << " " << y;
    }
  }
}

TEST(CoveredTiles, TakesAllForWhatIsBehindTheCameraAndNothingForWhatIsOutside) {
  const Camera camera = camera_at({2, 0, 0.3});
  const PixelBox part{16, 32, 100, 50};
  const auto area = [&](const std::vector<Vector3d>& points) {
    CoveredTiles tiles(clip_of(camera), kWidth, kHeight, part);
    tiles.add(points);
    int sum = 0;
    for (const PixelBox& run : tiles.runs()) sum += run.width * run.height;
    return sum;
  };
  EXPECT_EQ(area({{3, 0, 0}, {0, 0, 0}}), part.width * part.height);
  EXPECT_EQ(area({{0, 500, 0}, {0, 501, 0}}), 0);
  EXPECT_EQ(area({}), 0);
}

// A corner beside the camera is hundreds of pictures away, but its edges keep their direction.
TEST(CoveredTiles, ACornerFarOutsideDoesNotTurnItsEdges) {
  const Camera camera = camera_at({1.2, -1, 0.7});
  const Vector3d forward = (camera.target - camera.eye).normalized(),
                 side = forward.cross(Vector3d::UnitZ()).normalized(), up = side.cross(forward);
  const std::vector<Vector3d> corners = {
      {0.1, 0, 0}, {-0.3, 0.3, 0}, camera.eye + 0.0006 * forward + 0.4 * side - 0.1 * up};
  CoveredTiles tiles(clip_of(camera), kWidth, kHeight, {0, 0, kWidth, kHeight});
  tiles.add(corners);
  const std::vector<PixelBox> runs = tiles.runs();
  int seen = 0;
  for (int i = 0; i <= 300; ++i)
    for (int k = 0; i + k <= 300; ++k) {
      const Vector3d point = (corners[0] * i + corners[1] * k + corners[2] * (300 - i - k)) / 300.0;
      const Vector3d pixel = project(camera, kWidth, kHeight, point);
      const double x = pixel.x(), y = kHeight - pixel.y();
      if (!(pixel.z() > 0.01) || x < 0 || y < 0 || x >= kWidth || y >= kHeight) continue;
      ++seen;
      EXPECT_TRUE(std::any_of(runs.begin(), runs.end(),
                              [&](const PixelBox& run) {
                                return x >= run.x && x < run.x + run.width && y >= run.y &&
                                       y < run.y + run.height;
                              }))
          << x << " " << y;
    }
  EXPECT_GT(seen, 1000);
}

TEST(Covered, BoundsWhatIsNotZero) {
  constexpr int kSize = 64;
  std::vector<std::uint8_t> image(size_t(kSize) * kSize);
  EXPECT_TRUE(covered(image, kSize).isZero());
  image[size_t(20) * kSize + 12] = 1;
  image[size_t(30) * kSize + 8] = 200;
  const Eigen::Vector4f part = covered(image, kSize);
  EXPECT_FLOAT_EQ(part[0] - part[2], 2.0f * 7 / kSize - 1);
  EXPECT_FLOAT_EQ(part[0] + part[2], 2.0f * 14 / kSize - 1);
  EXPECT_FLOAT_EQ(part[1] - part[3], 2.0f * 19 / kSize - 1);
  EXPECT_FLOAT_EQ(part[1] + part[3], 2.0f * 32 / kSize - 1);
  image.assign(image.size(), 1);
  EXPECT_TRUE(covered(image, kSize).isApprox(Eigen::Vector4f(0, 0, 1, 1)));
}

}  // namespace
}  // namespace ayumi::test
