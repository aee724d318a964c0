#include "ayumi/render/renderer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <numbers>

#include "ayumi/base/error.hpp"
#include "tests/render/box_robot.hpp"

namespace ayumi {
namespace {

using Eigen::Vector3d;

std::vector<BodySurface> ball(double radius, const Eigen::Vector4f& color) {
  std::vector<BodySurface> surface(1);
  surface[0].closed = tessellate(Shape(Sphere{radius}), color);
  return surface;
}

Scene ball_scene(double height) {
  Scene scene;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation().z() = height;
  scene.poses = {pose};
  scene.camera.eye = {3, 0, height};
  scene.camera.target = {0, 0, height};
  return scene;
}

/// Whether the pixel has much more red than other colours.
bool is_red(const std::uint8_t* p) { return p[0] > 60 && p[0] > 2 * p[1] && p[0] > 2 * p[2]; }

int count_red(const Image& image) {
  int count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) count += is_red(image.pixel(x, y));
  return count;
}

TEST(Renderer, ABallCoversThePixelsItShould) {
  const double radius = 0.3, distance = 3;
  for (const bool antialias : {false, true}) {
    Renderer renderer(ball(radius, {0.9f, 0.05f, 0.05f, 1}),
                      {.width = 240, .height = 180, .antialias = antialias});
    const Image image = renderer.render(ball_scene(0.6));
    // Seen from `distance`, a ball fills the cone whose sine is r/d.
    const double focal = 90 / std::tan(0.25);
    const double apparent = focal * std::tan(std::asin(radius / distance));
    EXPECT_NEAR(count_red(image) / (std::numbers::pi * apparent * apparent), 1, 0.03) << antialias;
    EXPECT_TRUE(is_red(image.pixel(120, 90)));
    EXPECT_FALSE(is_red(image.pixel(120, 10)));
  }
}

TEST(Renderer, NoPartIsBlack) {
  // The ball is white from all sides: its dark side is well above black too, and nothing is
  // overexposed.
  std::vector<BodySurface> surface = ball(0.3, {0.8f, 0.8f, 0.8f, 1});
  Renderer renderer(surface, {.width = 100, .height = 80, .ground = false});
  Scene scene = ball_scene(0.6);
  for (const double angle : {0.0, 2.0, 4.0}) {
    scene.camera.eye = {3 * std::cos(angle), 3 * std::sin(angle), 0.9};
    const Image image = renderer.render(scene);
    for (int y = 0; y < 80; ++y)
      for (int x = 0; x < 100; ++x) EXPECT_GT(image.pixel(x, y)[1], 70) << x << " " << y;
  }
}

TEST(Renderer, InsideOutAndOpenMeshesLookLikeTheirOutside) {
  const Triangles right = tessellate(Shape(Sphere{0.3}), {0.9f, 0.05f, 0.05f, 1});
  Triangles turned = right;
  for (size_t i = 0; i < turned.indices.size(); i += 3)
    std::swap(turned.indices[i + 1], turned.indices[i + 2]);
  Triangles open = turned;
  open.indices.resize(open.indices.size() - 3);
  std::vector<BodySurface> good(1), mended(1), both_sides(1);
  good[0].closed = right;
  ASSERT_EQ(orient(turned), SurfaceKind::closed);
  mended[0].closed = turned;
  ASSERT_EQ(orient(open), SurfaceKind::open);
  both_sides[0].open = open;
  const RenderOptions options = {.width = 80, .height = 60};
  const Image expected = Renderer(good, options).render(ball_scene(0.6));
  EXPECT_EQ(Renderer(mended, options).render(ball_scene(0.6)).rgb, expected.rgb);
  const Image two_sided = Renderer(both_sides, options).render(ball_scene(0.6));
  int different = 0;
  for (size_t i = 0; i < expected.rgb.size(); ++i)
    different += std::abs(expected.rgb[i] - two_sided.rgb[i]) > 8;
  EXPECT_LT(different, 60) << "the missing triangle only";
}

TEST(Renderer, RobotStandsOnTheGroundWithItsColours) {
  const RobotModel model = test::box_robot();
  Renderer renderer(robot_surface(model), {.width = 320, .height = 240});
  Scene scene;
  RobotState state = model.rest_state();
  state.base.position.z() = 0.30;
  scene.poses = body_poses(model, state);
  scene.camera.eye = {1.6, 0, 0.5};
  scene.camera.target = {0, 0, 0.24};
  const Image image = renderer.render(scene);
  const auto at = [&](const Vector3d& p) {
    const Vector3d pixel = project(scene.camera, 320, 240, p);
    return image.pixel(int(pixel.x()), int(pixel.y()));
  };
  const std::uint8_t* head = at({0.045, 0, 0.48});
  EXPECT_GT(head[2], head[0] + 60) << "blue head";
  const std::uint8_t* foot = at({0.055, 0.04, 0.08});
  EXPECT_GT(foot[1], foot[0] + 40) << "green foot";
  const std::uint8_t* ground = at({0.1, 0.23, 0});
  EXPECT_NEAR(ground[0], ground[2], 12) << "grey ground";
  EXPECT_GT(ground[0], 120);
}

TEST(Renderer, TheShadowFallsOnTheGroundOnce) {
  Renderer with(ball(0.3, {0.9f, 0.05f, 0.05f, 1}), {.width = 240, .height = 180});
  Renderer without(ball(0.3, {0.9f, 0.05f, 0.05f, 1}),
                   {.width = 240, .height = 180, .shadow = false});
  Scene scene = ball_scene(0.6);
  scene.camera.eye = {3, 0, 2};
  scene.camera.target = {0, 0, 0.2};
  scene.camera.field_of_view = 0.9;
  const Image a = with.render(scene), b = without.render(scene);
  int darker = 0;
  for (size_t i = 0; i < a.rgb.size(); i += 3) {
    EXPECT_LE(a.rgb[i], b.rgb[i] + 1);
    darker += a.rgb[i] + 20 < b.rgb[i];
    EXPECT_GT(a.rgb[i] + 1, 0.5 * b.rgb[i]) << "never blended twice";
  }
  EXPECT_GT(darker, 200);
}

TEST(Renderer, ASlopeTiltsTheGround) {
  Renderer renderer(ball(0.01, {0.9f, 0.05f, 0.05f, 1}),
                    {.width = 120, .height = 90, .shadow = false});
  Scene scene = ball_scene(0.3);
  scene.overlay = {};
  scene.ground.rotate(Eigen::AngleAxisd(0.2, Vector3d::UnitX()));  // the ground rises with y
  add_sphere(scene.overlay, {0, 0.5, 0.5 * std::tan(0.2)}, 0.05, {0.9f, 0.05f, 0.05f, 1});
  scene.camera.eye = {3, 0, 0.3};
  const Image image = renderer.render(scene);
  const Vector3d center = project(scene.camera, 120, 90, {0, 0.5, 0.5 * std::tan(0.2)});
  EXPECT_TRUE(is_red(image.pixel(int(center.x()), int(center.y()) - 2))) << "upper half is above";
  const std::uint8_t* low = image.pixel(int(center.x()), int(center.y()) + 2);
  EXPECT_GT(low[1], 50) << "lower half only shines through the ground";
}

TEST(Renderer, OverlaysShineThroughTheRobotFaintly) {
  Renderer renderer(ball(0.3, {0.2f, 0.2f, 0.2f, 1}), {.width = 120, .height = 90});
  Scene scene = ball_scene(0.6);
  const Image bare = renderer.render(scene);
  add_sphere(scene.overlay, {0, 0, 0.6}, 0.05, {0.9f, 0.05f, 0.05f, 1});
  const Image marked = renderer.render(scene);
  EXPECT_GT(marked.pixel(60, 45)[0], bare.pixel(60, 45)[0] + 30);
}

TEST(Renderer, SameSceneSameBytesInAnyThread) {
  const RobotModel model = test::box_robot();
  const auto draw = [&] {
    Renderer renderer(robot_surface(model), {.width = 160, .height = 120});
    Scene scene;
    scene.poses = body_poses(model, model.rest_state());
    renderer.render(scene);
    return renderer.render(scene).rgb;
  };
  const auto here = draw();
  auto first = std::async(std::launch::async, draw), second = std::async(std::launch::async, draw);
  EXPECT_EQ(first.get(), here);
  EXPECT_EQ(second.get(), here);
}

TEST(Renderer, TwoRenderersTakeTurns) {
  Renderer red(ball(0.3, {0.9f, 0.05f, 0.05f, 1}), {.width = 60, .height = 40});
  Renderer grey(ball(0.3, {0.5f, 0.5f, 0.5f, 1}), {.width = 60, .height = 40});
  const int before = count_red(red.render(ball_scene(0.6)));
  EXPECT_EQ(count_red(grey.render(ball_scene(0.6))), 0);
  EXPECT_EQ(count_red(red.render(ball_scene(0.6))), before);
  EXPECT_GT(before, 0);
}

TEST(Renderer, OddAndExtremeSizesWork) {
  for (const auto& [w, h] : {std::pair{1, 1}, {7, 3}, {4096, 2}}) {
    Renderer renderer(ball(0.3, {1, 1, 1, 1}), {.width = w, .height = h});
    EXPECT_EQ(renderer.render(ball_scene(0.6)).rgb.size(), size_t(3) * w * h);
  }
}

TEST(Renderer, AnImpossibleSizeIsNamed) {
  for (const auto& [w, h] : {std::pair{0, 100}, {100, -1}, {5000, 100}}) {
    try {
      Renderer renderer({}, {.width = w, .height = h});
      FAIL() << w << "x" << h;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::usage);
      const std::string size = std::to_string(w) + "x" + std::to_string(h);
      EXPECT_NE(std::string(error.what()).find(size), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("1 to 4096"), std::string::npos);
    }
  }
}

TEST(RobotSurface, ARobotWithoutVisualsIsSticksWhereItHasNoShapes) {
  RobotDescription bare = test::box_robot().description();
  for (LinkDescription& link : bare.links) link.visuals.clear();
  const RobotModel model(bare);
  EXPECT_FALSE(has_visuals(model));
  EXPECT_TRUE(has_visuals(test::box_robot()));
  const std::vector<BodySurface> surface = robot_surface(model);
  const std::vector<Eigen::Isometry3d> poses = body_poses(model, model.rest_state());
  for (size_t i = 1; i < model.bodies().size(); ++i) {
    const Body& body = model.bodies()[i];
    const Triangles& stick = surface[size_t(body.parent)].open;
    double nearest = 1;
    for (const RenderVertex& vertex : stick.vertices)
      nearest =
          std::min(nearest, (vertex.position.cast<double>() - body.placement.translation()).norm());
    EXPECT_LT(nearest, 0.02) << "no stick from " << model.bodies()[size_t(body.parent)].name
                             << " to " << body.name;
  }
}

// If the meshes of some bodies are missing, these bodies are drawn with something else.
TEST(RobotSurface, ABodyWithoutVisualsHasItsCollisionShapesOrSticks) {
  RobotDescription description = test::box_robot().description();
  for (LinkDescription& link : description.links) {
    link.collisions.clear();
    if (&link != &description.links.front()) link.visuals.clear();
  }
  LinkDescription& last = description.links.back();
  last.collisions.push_back({"", Box{{0.1, 0.1, 0.1}}, Eigen::Isometry3d::Identity()});
  const RobotModel model(description);
  const std::vector<BodySurface> surface = robot_surface(model);
  std::vector<bool> has_children(surface.size(), false);
  for (size_t i = 1; i < surface.size(); ++i) has_children[size_t(model.bodies()[i].parent)] = true;
  int drawn = 0;
  for (size_t i = 1; i < surface.size(); ++i) {
    const bool something = !surface[i].closed.indices.empty() || !surface[i].open.indices.empty();
    const bool wanted = has_children[i] || model.bodies()[i].name == last.name;
    EXPECT_EQ(something, wanted) << model.bodies()[i].name;
    drawn += something;
  }
  EXPECT_EQ(count_substitutes(model), drawn);
  EXPECT_EQ(count_substitutes(test::box_robot()), 0);
}

// A link may be invisible on purpose. If meshes are missing, it is drawn nevertheless.
TEST(RobotSurface, ALinkWithoutAVisualIsDrawnIfMeshesAreMissing) {
  RobotDescription description = test::box_robot().description();
  LinkDescription cover;
  cover.name = "cover";
  cover.collisions.push_back({"", Box{{0.2, 0.2, 0.2}}, Eigen::Isometry3d::Identity()});
  description.links.push_back(cover);
  JointDescription fixed;
  fixed.name = "to_cover";
  fixed.parent = "trunk";
  fixed.child = "cover";
  description.joints.push_back(fixed);
  EXPECT_EQ(count_substitutes(RobotModel(description)), 0);
  description.missing_meshes = {"cover.stl of link cover"};
  EXPECT_EQ(count_substitutes(RobotModel(description)), 1);
}

}  // namespace
}  // namespace ayumi
