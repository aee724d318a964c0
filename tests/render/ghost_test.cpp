// A second drawing of the robot, heat of joints near their limits, and surfaces that are simplified
// for this.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/render/clip.hpp"
#include "ayumi/render/ghost_color.hpp"
#include "ayumi/render/gltf.hpp"
#include "tests/render/box_robot.hpp"

namespace ayumi::test {
namespace {

ClipOptions bare() {
  ClipOptions options;
  options.picture = {.width = 160, .height = 120, .shadow = false, .ground = false};
  options.camera.mode = CameraMode::fixed;
  options.camera.view = "front";
  options.overlay = no_marks();
  return options;
}

/// The number of pixels that differ, and the middle of them in x.
std::pair<int, double> changed(const Image& a, const Image& b) {
  int count = 0;
  double sum = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x)
      if (!std::equal(a.pixel(x, y), a.pixel(x, y) + 3, b.pixel(x, y))) {
        ++count;
        sum += x;
      }
  return {count, count ? sum / count : 0};
}

TEST(Ghost, StandsWhereTheCommandIs) {
  const RobotModel model = box_robot();
  SimulationLog log = box_run(model);
  for (SimulationSample& s : log.samples) {
    s.state.base.position.y() = 0;
    s.state.theta.setZero();
    s.cog.y() = 0;
    // The ghost is to the right in the picture, as seen from the front.
    s.command_base.position.y() = 0.15;
  }
  const Image alone = ClipRenderer(model, log, bare()).frame(0.5);
  ClipOptions with = bare();
  with.ghost.command = true;
  const auto [count, middle] = changed(alone, ClipRenderer(model, log, with).frame(0.5));
  EXPECT_GT(count, 300);
  EXPECT_GT(middle, 90);
}

TEST(Ghost, AnotherRunOfTheSameRobotOnly) {
  const RobotModel model = box_robot();
  const SimulationLog log = box_run(model);
  SimulationLog other = log;
  for (SimulationSample& s : other.samples) s.state.base.position.y() += 0.2;
  other.samples.resize(100);  // a shorter one stays where it ended
  ClipOptions with = bare();
  with.ghost.log = &other;
  const Image alone = ClipRenderer(model, log, bare()).frame(1);
  EXPECT_GT(changed(alone, ClipRenderer(model, log, with).frame(1)).first, 300);
  other.joints.back() = "tail";
  try {
    ClipRenderer(model, log, with);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("another robot"), std::string::npos);
  }
}

TEST(Heat, RisesTowardsTheNearestLimit) {
  const RobotModel model = box_robot();  // limits are 2 rad, 5 rad/s and 5 N m
  SimulationSample s = box_run(model).samples.front();
  s.state.theta.setZero();
  s.state.dtheta = s.torque = Eigen::VectorXd::Zero(model.dof_count());
  const auto heat_of = [&](int dof) {
    return joint_heat(model, "", s)[size_t(model.dofs()[size_t(dof)].body)];
  };
  EXPECT_EQ(heat_of(1), 0);
  s.state.theta[1] = -1.9;
  EXPECT_NEAR(heat_of(1), 0.75, 1e-5) << "a quarter of the last tenth of its range is left";
  s.state.theta[1] = 1.5;
  EXPECT_EQ(heat_of(1), 0) << "a tenth is not reached yet";
  s.state.theta[1] = 2;
  EXPECT_EQ(heat_of(1), 1);
  s.state.dtheta[2] = 4;
  EXPECT_NEAR(heat_of(2), 3 * 0.8 - 2, 1e-5);
  s.torque[3] = -7;
  EXPECT_EQ(heat_of(3), 1);
  EXPECT_EQ(heat_of(0), 0) << "only the body of that joint";
  ClipOptions hot = bare();
  hot.overlay.heat = true;
  SimulationLog log = box_run(model);
  const Image cold = ClipRenderer(model, log, bare()).frame(0);
  for (SimulationSample& sample : log.samples) {
    sample.torque = Eigen::VectorXd::Zero(model.dof_count());
    sample.torque[2] = 5;
  }
  EXPECT_GT(changed(cold, ClipRenderer(model, log, hot).frame(0)).first, 50);
}

// No joint has heat in the home posture, even if joints are at their limits there.
TEST(Heat, TheHomePostureIsCold) {
  for (const char* robot : {"hoap1", "humanoid30"}) {
    const RobotModel model = load_robot(std::string(AYUMI_SOURCE_DIR) + "/robots/" + robot);
    SimulationSample s;
    s.state = model.rest_state();
    for (const float heat : joint_heat(model, "", s)) EXPECT_EQ(heat, 0) << robot;
  }
  RobotDescription d = box_robot().description();
  for (JointDescription& joint : d.joints) joint.lower = 0;
  const RobotModel at_limit(d);
  SimulationSample s;
  s.state = at_limit.rest_state();
  for (const float heat : joint_heat(at_limit, "", s)) EXPECT_EQ(heat, 0);
  s.state.theta[1] = -0.01;  // the servo yields a little
  for (const float heat : joint_heat(at_limit, "", s)) EXPECT_EQ(heat, 0);
  s.state.theta[1] = -0.1;
  EXPECT_EQ(joint_heat(at_limit, "", s)[size_t(at_limit.dofs()[1].body)], 1);
  // A home that is rounded to a place just inside the limit is no other case.
  RobotDescription inside = box_robot().description();
  for (JointDescription& joint : inside.joints) joint.lower = -1e-6;
  const RobotModel near_limit(inside);
  s.state = near_limit.rest_state();
  for (const double yielded : {0.0, -2e-6, -0.01}) {
    s.state.theta[1] = yielded;
    for (const float heat : joint_heat(near_limit, "", s)) EXPECT_EQ(heat, 0) << yielded;
  }
  s.state.theta[1] = -0.1;
  EXPECT_EQ(joint_heat(near_limit, "", s)[size_t(near_limit.dofs()[1].body)], 1);
  s.state.theta[1] = 1.95;
  EXPECT_GT(joint_heat(at_limit, "", s)[size_t(at_limit.dofs()[1].body)], 0.5);
}

// A ghost in the robot's own posture is hidden by the robot, except for a few of its about 4000
// pixels, at outlines.
TEST(Ghost, HasNoSpeckleWhereItCoincides) {
  const RobotModel model = box_robot();
  SimulationLog log = box_run(model);
  SimulationLog other = log;
  // The ghost is displaced by as much as a servo sags.
  for (SimulationSample& s : other.samples) s.state.base.position.x() += 1e-4;
  ClipOptions with = bare();
  for (const std::string& view : view_names()) {
    with.camera.view = view;
    with.ghost.log = nullptr;
    const Image alone = ClipRenderer(model, log, with).frame(0.5);
    with.ghost.log = &log;
    EXPECT_LT(changed(alone, ClipRenderer(model, log, with).frame(0.5)).first, 25) << view;
    with.ghost.log = &other;
    EXPECT_LT(changed(alone, ClipRenderer(model, log, with).frame(0.5)).first, 25) << view;
  }
}

/// A box of the colour `large`, and one of an eighth of its edge and of the colour `small`.
std::vector<BodySurface> two_boxes(const Eigen::Vector4f& large, const Eigen::Vector4f& small) {
  std::vector<BodySurface> robot(2);
  robot[0].closed = tessellate(Box{Eigen::Vector3d::Constant(0.4)}, large);
  robot[1].open = tessellate(Box{Eigen::Vector3d::Constant(0.05)}, small);
  return robot;
}

/// The angle between the hues of two colours [deg].
double between(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  const auto hue = [](const Eigen::Vector3f& c) {
    return Eigen::Vector2f(c[0] - (c[1] + c[2]) / 2, std::sqrt(0.75f) * (c[1] - c[2])).normalized();
  };
  return std::acos(std::clamp(hue(a).dot(hue(b)), -1.0f, 1.0f)) * 180 / M_PI;
}

TEST(Ghost, HasAHueFarFromTheRobots) {
  const std::vector<Eigen::Vector3f> covers = {
      {0.8f, 0.1f, 0.1f}, {0.9f, 0.4f, 0.1f}, {0.9f, 0.8f, 0.1f},
      {0.2f, 0.7f, 0.2f}, {0.1f, 0.6f, 0.6f}, {0.15f, 0.2f, 0.8f},
      {0.5f, 0.2f, 0.7f}, {0.9f, 0.3f, 0.6f}, {0.3f, 0.05f, 0.05f}};
  const Eigen::Vector4f white(0.92f, 0.90f, 0.86f, 1);
  for (const Eigen::Vector3f& cover : covers) {
    const Eigen::Vector4f color(cover[0], cover[1], cover[2], 1);
    EXPECT_GT(between(ghost_colors(two_boxes(color, white)).beside_robot, cover), 110)
        << cover.transpose();
  }
  for (const Eigen::Vector3f& cover : {covers[0], covers[5]}) {
    const Eigen::Vector4f color(cover[0], cover[1], cover[2], 1);
    EXPECT_GT(between(ghost_colors(two_boxes(white, color)).beside_robot, cover), 110)
        << "a few covers of a white robot";
  }
}

TEST(Ghost, OfAGreyRobotIsOrangeAndOfAHotOneIsNot) {
  const Eigen::Vector4f grey(0.5f, 0.5f, 0.5f, 1), black(0, 0, 0, 1);
  EXPECT_EQ(hex_text(ghost_colors(two_boxes(grey, black)).beside_robot), "#ed730d");
  EXPECT_EQ(hex_text(ghost_colors({}).beside_robot), "#ed730d");
  const Eigen::Vector3f hot = ghost_colors(two_boxes(grey, black)).beside_heat;
  for (const float heat : {0.0f, 1.0f}) EXPECT_GT(between(hot, heat_color(heat).head<3>()), 110);
}

// Clips and pages show the same colour: the pages take it from the robot's file.
TEST(Ghost, HasOneColourInClipsAndOnPages) {
  const RobotModel model = box_robot();
  const auto look = robot_look(model);
  EXPECT_EQ(look->ghost.beside_robot, ghost_colors(robot_surface(model)).beside_robot);
  const std::string words =
      "\"extras\":{\"ghost_color\":\"" + hex_text(look->ghost.beside_robot) + "\"}";
  EXPECT_NE(glb_bytes(model, {}).find(words), std::string::npos);
  EXPECT_NE(glb_bytes(model, {}, {.look = look.get(), .max_triangles = 500}).find(words),
            std::string::npos);
  const SimulationLog log = box_run(model);
  ClipOptions with = bare();
  EXPECT_EQ(clip_shape(model, log, with, true)->ghost, look->ghost.beside_robot);
  with.overlay.heat = true;
  EXPECT_EQ(clip_shape(model, log, with, false)->ghost, look->ghost.beside_heat);
}

TEST(Surface, TooFineIsSimplifiedAndSaidSo) {
  const RobotModel model = box_robot();
  const SimulationLog log = box_run(model);
  ClipOptions coarse = bare();
  coarse.max_triangles = 600;
  const ClipRenderer renderer(model, log, coarse);
  ASSERT_EQ(renderer.notes().size(), 1u);
  EXPECT_NE(renderer.notes()[0].find("triangles, but it is drawn with"), std::string::npos)
      << renderer.notes()[0];
  EXPECT_TRUE(ClipRenderer(model, log, bare()).notes().empty());
}

}  // namespace
}  // namespace ayumi::test
