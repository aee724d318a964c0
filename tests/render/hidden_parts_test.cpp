#include "ayumi/render/hidden_parts.hpp"

#include <gtest/gtest.h>

#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/render/renderer.hpp"

namespace ayumi::test {
namespace {

using Eigen::Vector3d;

const Eigen::Vector4f kGrey = {0.5f, 0.5f, 0.5f, 1};

Eigen::Isometry3d moved(double x, double y, double z) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Vector3d(x, y, z);
  return pose;
}

size_t count_of(const std::vector<BodySurface>& robot) {
  size_t count = 0;
  for (const BodySurface& body : robot)
    for (const Triangles* part : parts_of(body)) count += part->indices.size() / 3;
  return count;
}

TEST(HiddenParts, ABallInABoxGoesAndOneThatLooksOutStays) {
  const Triangles ball = tessellate(Shape(Sphere{0.05}), kGrey);
  const Triangles box = tessellate(Shape(Box{{0.2, 0.2, 0.2}}), kGrey);
  std::vector<BodySurface> robot(1);
  append(robot[0].closed, box);
  append(robot[0].closed, ball);
  append(robot[0].open, ball, moved(0.02, 0, 0));
  leave_out_hidden(robot);
  EXPECT_EQ(count_of(robot), box.indices.size() / 3) << "the box stays";
  // Half of the ball is outside.
  robot.assign(1, {});
  append(robot[0].closed, box);
  append(robot[0].closed, ball, moved(0.1, 0, 0));
  leave_out_hidden(robot);
  const size_t left = count_of(robot) - box.indices.size() / 3;
  EXPECT_GT(left, ball.indices.size() / 3 * 2 / 5);
  EXPECT_LT(left, ball.indices.size() / 3 * 7 / 10);
}

TEST(HiddenParts, WhatHidesMustBeConvexOpaqueAndOfTheSameBody) {
  const Triangles ball = tessellate(Shape(Sphere{0.05}), kGrey);
  const Triangles box = tessellate(Shape(Box{{0.2, 0.2, 0.2}}), kGrey);
  const Triangles glass = tessellate(Shape(Box{{0.2, 0.2, 0.2}}), {0.5f, 0.5f, 0.5f, 0.5f});
  const auto expect_all_stays = [](std::vector<BodySurface> robot) {
    const size_t before = count_of(robot);
    leave_out_hidden(robot);
    EXPECT_EQ(count_of(robot), before);
  };
  std::vector<BodySurface> robot(1);
  append(robot[0].closed, glass);
  append(robot[0].closed, ball);
  expect_all_stays(robot);
  robot.assign(2, {});
  append(robot[0].closed, box);
  append(robot[1].closed, ball);
  expect_all_stays(robot);
  // The box has a dent: one corner is moved inwards.
  Triangles dented = box;
  for (RenderVertex& vertex : dented.vertices)
    if (vertex.position.minCoeff() > 0) vertex.position *= 0.2f;
  robot.assign(1, {});
  append(robot[0].closed, dented);
  append(robot[0].closed, ball);
  expect_all_stays(robot);
}

// Pictures from all sides are compared with and without the hidden parts.
TEST(HiddenParts, PicturesAreTheSame) {
  const RobotModel model =
      load_robot(std::string(AYUMI_SOURCE_DIR) + "/robots/hoap1", {}, {.meshes = true});
  const std::vector<BodySurface> whole = robot_surface(model);
  std::vector<BodySurface> seen = whole;
  leave_out_hidden(seen);
  EXPECT_LT(count_of(seen), count_of(whole) * 95 / 100);
  EXPECT_GT(count_of(seen), count_of(whole) / 2);
  Scene scene;
  RobotState state = model.rest_state();
  state.base.position.z() = 0.28;
  for (Eigen::Index i = 0; i < state.theta.size(); ++i) state.theta[i] += i % 2 ? 0.3 : -0.3;
  scene.poses = body_poses(model, state);
  scene.camera.target = {0, 0, 0.25};
  // The shadow is left out, because it is that of a simplified robot, which differs if there are
  // fewer triangles.
  const RenderOptions options = {.width = 320, .height = 320, .shadow = false};
  Renderer all(whole, options), few(seen, options);
  for (const Vector3d& eye : {Vector3d(1, 0, 0.3), Vector3d(0, 1, 0.4), Vector3d(-1, 0.1, 0.3),
                              Vector3d(0.3, -1, 0.6), Vector3d(0.2, 0.1, 1.2)}) {
    scene.camera.eye = eye;
    EXPECT_EQ(all.render(scene).rgb, few.render(scene).rgb) << eye.transpose();
  }
}

}  // namespace
}  // namespace ayumi::test
