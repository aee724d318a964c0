#include "ayumi/render/camera.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "ayumi/base/error.hpp"

namespace ayumi {
namespace {

using Eigen::Vector3d;

Camera level_camera() {
  Camera camera;
  camera.eye = {4, 0, 1};
  camera.target = {0, 0, 1};
  camera.field_of_view = 0.6;
  return camera;
}

TEST(Camera, TargetIsInTheMiddle) {
  const Vector3d p = project(level_camera(), 640, 480, {0, 0, 1});
  EXPECT_NEAR(p.x(), 320, 1e-9);
  EXPECT_NEAR(p.y(), 240, 1e-9);
  EXPECT_NEAR(p.z(), 4, 1e-12);
}

TEST(Camera, ProjectionIsThatOfAPinhole) {
  // Looking along -x, y is to the right; focal length in pixels = (h/2) / tan(fov/2).
  const double focal = 240 / std::tan(0.3);
  const Vector3d p = project(level_camera(), 640, 480, {1, 0.2, 1.5});
  EXPECT_NEAR(p.x(), 320 + focal * 0.2 / 3, 1e-9);
  EXPECT_NEAR(p.y(), 240 - focal * 0.5 / 3, 1e-9);
  EXPECT_LT(project(level_camera(), 640, 480, {5, 0, 1}).z(), 0) << "behind the camera";
}

TEST(Camera, LookingStraightDownIsFinite) {
  Camera camera;
  camera.eye = {0, 0, 3};
  camera.target = {0, 0, 0};
  const Eigen::Matrix4d view = view_matrix(camera);
  EXPECT_TRUE(view.allFinite());
  EXPECT_NEAR((view.topLeftCorner<3, 3>().determinant()), 1, 1e-12);
}

std::vector<Vector3d> walk() {
  std::vector<Vector3d> cog;
  for (int k = 0; k <= 400; ++k) cog.emplace_back(0.002 * k, 0.03 * std::sin(0.06 * k), 0.25);
  return cog;
}

TEST(CameraPath, FollowsWithoutTheSway) {
  const CameraPath path({.mode = CameraMode::follow, .view = "side"}, walk(), 0.01, 0.48, 1.6);
  const Camera early = path.at(1.0), late = path.at(3.0);
  EXPECT_NEAR(late.target.x() - early.target.x(), 0.4, 1e-9);
  EXPECT_LT(std::abs(early.target.y()), 0.02);
  EXPECT_EQ(early.target.z(), late.target.z());
  EXPECT_LT(early.eye.y(), early.target.y()) << "from the robot's right: it walks to the right";
  const Vector3d ahead = project(early, 160, 100, early.target + Vector3d(0.1, 0, 0));
  EXPECT_GT(ahead.x(), 80);
}

TEST(CameraPath, FixedStandsStillAndHoldsTheWholePath) {
  const std::vector<Vector3d> cog = walk();
  const CameraPath path({.mode = CameraMode::fixed, .view = "side"}, cog, 0.01, 0.48, 1.6);
  EXPECT_EQ(path.at(0).eye, path.at(4).eye);
  for (const Vector3d& point : cog) {
    const Vector3d p = project(path.at(0), 160, 100, point);
    EXPECT_TRUE(p.x() > 0 && p.x() < 160 && p.y() > 0 && p.y() < 100) << p.transpose();
  }
}

TEST(CameraPath, OrbitTurnsAtItsRate) {
  const std::vector<Vector3d> still(500, Vector3d(0, 0, 0.25));
  const CameraPath path({.mode = CameraMode::orbit, .orbit_rate = 0.7}, still, 0.01, 0.48, 1.6);
  const Vector3d a = path.at(0).eye - path.at(0).target, b = path.at(2).eye - path.at(2).target;
  EXPECT_NEAR(std::atan2(a.x() * b.y() - a.y() * b.x(), a.head<2>().dot(b.head<2>())), 1.4, 1e-9);
  EXPECT_NEAR(a.norm(), b.norm(), 1e-12);
}

TEST(CameraPath, EveryNamedViewHoldsTheRobotWhole) {
  for (const std::string& view : view_names()) {
    const CameraPath path({.view = view}, {Vector3d(0, 0, 0.25)}, 0.01, 0.48, 1.6);
    for (const double z : {0.0, 0.48}) {
      const Vector3d p = project(path.at(0), 160, 100, {0, 0, z});
      EXPECT_TRUE(p.y() > 2 && p.y() < 98) << view << " " << z << " " << p.transpose();
    }
  }
}

// Parallel lines stay parallel: a metre has the same length near and far, and heights are vertical.
TEST(CameraPath, TheOrthographicSideViewMeasures) {
  const CameraPath path({.view = "ortho-side"}, walk(), 0.01, 0.48, 1.6);
  const Camera camera = path.at(1);
  const auto at = [&](double x, double y, double z) {
    return project(camera, 160, 100, {x, y, z});
  };
  const double metre = 100 / camera.parallel_height;
  for (const double y : {-0.3, 0.0, 0.4}) {
    EXPECT_NEAR(at(0.2, y, 0.1).x() - at(0.0, y, 0.1).x(), 0.2 * metre, 1e-9);
    EXPECT_NEAR(at(0.1, y, 0.0).y() - at(0.3, y, 0.4).y(), 0.4 * metre, 1e-9);
  }
  EXPECT_GT(at(0, 0.4, 0).z(), at(0, -0.3, 0).z()) << "and still knows what is nearer";
}

// A squat and a jump do not move the camera; a fall and stairs do, so that the robot remains in
// sight.
TEST(CameraPath, FollowsAFallAndStairs) {
  const auto height_at = [](double end, CameraMode mode) {
    std::vector<Vector3d> cog;
    for (int k = 0; k <= 400; ++k) cog.emplace_back(0, 0, 0.25 + (end - 0.25) * k / 400);
    return CameraPath({.mode = mode}, cog, 0.01, 0.48, 1.6).at(4).target.z();
  };
  const double level = height_at(0.25, CameraMode::follow);
  EXPECT_EQ(height_at(0.2, CameraMode::follow), level);
  EXPECT_EQ(height_at(0.3, CameraMode::follow), level);
  EXPECT_LT(height_at(0.05, CameraMode::follow), level - 0.08);
  EXPECT_GT(height_at(0.6, CameraMode::follow), level + 0.15);
  EXPECT_EQ(height_at(0.05, CameraMode::fixed), level);
}

TEST(CameraPath, FramedPointsAreJustWithinThePicture) {
  for (const std::string& view : view_names())
    for (const double aspect : {0.5, 1.0, 2.5}) {
      const Camera camera = CameraPath({.view = view}, walk(), 0.01, 0.48, aspect).at(2);
      const Eigen::Matrix3d axes = view_matrix(camera).topLeftCorner<3, 3>();
      std::vector<Vector3d> points, offsets;
      for (int i = 0; i < 40; ++i) {
        points.push_back(camera.target + Vector3d(0.3 * std::sin(i), 0.2 * std::cos(3 * i) + 0.1,
                                                  0.25 * std::sin(2.3 * i) - 0.05));
        offsets.push_back(axes * (points.back() - camera.target));
      }
      const Camera moved = framed(camera, framing(camera, aspect, offsets, 0.9));
      Eigen::AlignedBox2d box;
      for (const Vector3d& p : points)
        box.extend(Eigen::Vector2d(project(moved, 1000, 1000, p).head<2>()));
      // `project` takes a square picture, so its horizontal coordinates are scaled by the aspect
      // ratio.
      const double half_x = 500 * aspect;
      const Eigen::Vector2d reach((box.max().x() - 500) / half_x, (box.max().y() - 500) / 500);
      const Eigen::Vector2d back((500 - box.min().x()) / half_x, (500 - box.min().y()) / 500);
      EXPECT_NEAR(std::max(reach.maxCoeff(), back.maxCoeff()), 0.9, 1e-6) << view << aspect;
      EXPECT_NEAR(reach.x(), back.x(), 0.15) << "about in the middle";
      EXPECT_NEAR(reach.y(), back.y(), 0.15);
    }
}

TEST(CameraPath, AnUnknownViewIsNamed) {
  try {
    CameraPath({.view = "sid"}, {Vector3d::Zero()}, 0.01, 0.48, 1.6);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    EXPECT_NE(std::string(error.what()).find("did you mean 'side'"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace ayumi
