#include "ayumi/render/robot_look.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "ayumi/render/clip.hpp"
#include "ayumi/render/gltf.hpp"
#include "ayumi/render/simplify.hpp"
#include "ayumi/render/snapshots.hpp"
#include "tests/render/box_robot.hpp"

namespace ayumi::test {
namespace {

/// A ball with dents that has 2 n^2 triangles.
MeshPart dented_ball(int n) {
  MeshPart part;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) {
      const double a = std::numbers::pi * i / n, b = 2 * std::numbers::pi * (j % n) / n;
      const double r = 0.08 * (1 + 0.01 * std::sin(9 * a) * std::cos(7 * b));
      part.vertices.emplace_back(r * std::sin(a) * std::cos(b), r * std::sin(a) * std::sin(b),
                                 r * std::cos(a));
    }
  const auto at = [n](int i, int j) { return std::uint32_t(i * (n + 1) + j); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      part.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      part.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return part;
}

/// The box robot with such a ball as its head.
RobotModel heavy_robot(int n) {
  RobotDescription d;
  d.name = "heavy";
  MeshShape mesh;
  mesh.mesh.parts.push_back(dented_ball(n));
  d.links.push_back(
      box_link("trunk", 3, placed(Box{{0.08, 0.14, 0.16}}, {0, 0, 0.06}, {0.8f, 0.8f, 0.9f, 1})));
  d.links.push_back(box_link("head", 0.3, placed(mesh, {0, 0, 0}, {0.1f, 0.25f, 0.8f, 1})));
  d.joints.push_back(hinge("neck", "trunk", "head", {0, 0, 0.22}));
  d.postures["home"] = {};
  return RobotModel(d);
}

SimulationLog still(const RobotModel& model) {
  SimulationLog log;
  log.joints = model.dof_names();
  SimulationSample s;
  s.state = model.rest_state();
  s.cog = s.state.base.position = {0, 0, 0.2};
  s.command_theta = s.torque = s.state.theta;
  log.samples.assign(2, s);
  return log;
}

TEST(RobotLook, OfAnOrdinaryRobotIsItsOwnSurface) {
  const RobotModel model = box_robot();
  const auto look = robot_look(model);
  EXPECT_EQ(look->moved, 0);
  EXPECT_EQ(look->triangles, triangle_count(robot_surface(model)));
  EXPECT_EQ(look->triangles, triangle_count(look->surface));
  const SimulationLog log = box_run(model);
  ClipOptions options;
  options.overlay = no_marks();
  const Image alone = ClipRenderer(model, log, options).frame(0.5);
  options.look = look;
  EXPECT_EQ(alone.rgb, ClipRenderer(model, log, options).frame(0.5).rgb);
}

// In an earlier version, a stop had an effect only after all triangles had been joined, several
// seconds later.
TEST(RobotLook, WorkOnAHeavyRobotStopsWhenAsked) {
  const RobotModel model = heavy_robot(460);
  int heard = 0;
  const auto stop = [&](const ProgressEvent&) { return ++heard < 3; };
  EXPECT_THROW(robot_look(model, stop), Interrupted);
  EXPECT_EQ(heard, 3);
}

// In an earlier version, snapshots, clip and page each read, joined and simplified all triangles
// separately.
TEST(RobotLook, OfAHeavyRobotHasFewTrianglesThatLookTheSame) {
  const RobotModel model = heavy_robot(460);
  const auto look = robot_look(model);
  EXPECT_GT(look->triangles, 400'000u);
  EXPECT_LT(triangle_count(look->surface), 40'000u) << "a smooth ball needs no more";
  EXPECT_GT(look->moved, 0);
  EXPECT_LT(look->moved, 0.3e-3) << "0.3 pixels of a picture of 720 rows";
  const SimulationLog log = still(model);
  ClipOptions options;
  options.overlay = no_marks();
  const ClipRenderer alone(model, log, options);
  ASSERT_EQ(alone.notes().size(), 1u);
  EXPECT_NE(alone.notes()[0].find("triangles, but it is drawn with"), std::string::npos);
  options.look = look;
  const Image thin = ClipRenderer(model, log, options).frame(0);
  RobotLook whole;
  whole.surface = robot_surface(model);
  options.look = std::make_shared<RobotLook>(whole);
  options.max_triangles = 1'000'000;
  const Image fine = ClipRenderer(model, log, options).frame(0);
  ASSERT_EQ(thin.rgb.size(), fine.rgb.size());
  double sum = 0;
  for (size_t i = 0; i < fine.rgb.size(); ++i) sum += std::abs(thin.rgb[i] - fine.rgb[i]);
  EXPECT_LT(sum / double(fine.rgb.size()), 0.2);
  // The look depends on the robot alone, so that a page made later is the same.
  EXPECT_EQ(glb_bytes(model, {}, {.look = look.get()}),
            glb_bytes(model, {}, {.look = robot_look(model).get()}));
}

TEST(RobotLook, ThinsFurtherUntilFewEnoughAreLeft) {
  const std::vector<BodySurface> fine = robot_surface(heavy_robot(60));
  auto some = fine, few = fine, least = fine;
  EXPECT_EQ(thin_to(some, 1e-5, 1'000'000), 1e-5);
  EXPECT_EQ(thin_to(few, 1e-5, triangle_count(some) - 1), 2e-5);
  EXPECT_EQ(thin_to(least, 1e-5, 60), 4e-5);
  EXPECT_LT(triangle_count(least), triangle_count(few));
}

// In an earlier version, a small clip simplified the surface of every robot, by a grid whose cells
// were many pixels wide.
TEST(RobotLook, OfAnOrdinaryRobotIsMovedInNoClip) {
  const RobotModel model = heavy_robot(60);
  const SimulationLog log = still(model);
  ClipOptions options;
  options.picture.width = 64;
  options.picture.height = 36;
  EXPECT_TRUE(clip_shape(model, log, options, true)->notes.empty());
  options.camera.zoom = 6;
  EXPECT_TRUE(clip_shape(model, log, options, true)->notes.empty());
}

}  // namespace
}  // namespace ayumi::test
