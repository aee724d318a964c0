// The robot a second time, heat of joints near their limits, surfaces simplified on the way.

#include <gtest/gtest.h>

#include "ayumi/base/error.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/render/clip.hpp"
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

/// Pixels that differ, and the middle of them in x.
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
    s.command_base.position.y() = 0.15;  // to the right of the picture, seen from the front
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
  const RobotModel model = box_robot();  // joints to 2 rad, 5 rad/s, 5 N m
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

// Whatever the home posture is, even with joints at their limits.
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
  s.state.theta[1] = 1.95;
  EXPECT_GT(joint_heat(at_limit, "", s)[size_t(at_limit.dofs()[1].body)], 0.5);
}

// A ghost in the robot's own posture is hidden by it, but for a few pixels of outlines: of about
// 4000 that it has.
TEST(Ghost, HasNoSpeckleWhereItCoincides) {
  const RobotModel model = box_robot();
  SimulationLog log = box_run(model);
  SimulationLog other = log;
  for (SimulationSample& s : other.samples) s.state.base.position.x() += 1e-4;  // a servo's sag
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

TEST(Ghost, HasAHueOfItsOwn) {
  const Eigen::Vector4f tint = Exposure{}.tint;
  EXPECT_GT(tint[0], tint[1] + 0.3f) << "orange, on a robot of blue and silver";
  EXPECT_GT(tint[1], tint[2] + 0.3f);
}

TEST(Surface, TooFineIsSimplifiedAndSaidSo) {
  const RobotModel model = box_robot();
  const SimulationLog log = box_run(model);
  ClipOptions coarse = bare();
  coarse.max_triangles = 600;
  const ClipRenderer renderer(model, log, coarse);
  ASSERT_EQ(renderer.notes().size(), 1u);
  EXPECT_NE(renderer.notes()[0].find("triangles; it is drawn with"), std::string::npos)
      << renderer.notes()[0];
  EXPECT_TRUE(ClipRenderer(model, log, bare()).notes().empty());
}

}  // namespace
}  // namespace ayumi::test
