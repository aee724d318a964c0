// The closed forms of (26)(27) as the controller uses them agree with their integrated springs. The
// goals that it refuses are tested too.
#include "ayumi/control/laws/viip_jump.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/model/gravity.hpp"
#include "tests/support/biped.hpp"

namespace ayumi {
namespace {

JumpGoal goal_of(double height, double stoop, JumpGoal::Release release) {
  JumpGoal goal;
  goal.height = height;
  goal.stoop = stoop;
  goal.release = release;
  return goal;
}

// Integrates (26) from rest in small steps. Returns where and when contact is lost, the speed
// there, and the height that is reached after that.
JumpFigures integrated(const JumpGoal& goal) {
  const double k = 2 * kGravity * goal.height / (goal.stoop * goal.stoop), dt = 1e-6;
  double z = -goal.stoop, v = 0, t = 0;
  const bool spring = goal.release == JumpGoal::Release::spring;
  while (spring ? -k * z + kGravity > 0 : z < 0) {
    v -= dt * k * z;
    z += dt * v;
    t += dt;
  }
  JumpFigures f;
  f.lift_off = z;
  f.lift_off_speed = v;
  f.push = t;
  f.apex = z + v * v / (2 * kGravity);
  return f;
}

TEST(JumpFigures, MatchTheSpringIntegrated) {
  for (const auto release : {JumpGoal::Release::ref_z, JumpGoal::Release::spring})
    for (const double height : {0.03, 0.05}) {
      const JumpGoal goal = goal_of(height, 0.04, release);
      const JumpFigures f = jump_figures(goal), g = integrated(goal);
      EXPECT_NEAR(f.apex, g.apex, 1e-6);
      EXPECT_NEAR(f.lift_off, g.lift_off, 1e-6);
      EXPECT_NEAR(f.lift_off_speed, g.lift_off_speed, 1e-5);
      EXPECT_NEAR(f.push, g.push, 1e-5);
      // The time up from lift-off and down to ref z_G.
      const double T = f.flight, v = f.lift_off_speed;
      EXPECT_NEAR(f.lift_off + v * T - 0.5 * kGravity * T * T, 0, 1e-12);
      EXPECT_NEAR(f.touchdown_speed, kGravity * T - v, 1e-12);
    }
  EXPECT_NEAR(jump_figures(goal_of(0.03, 0.04, JumpGoal::Release::ref_z)).apex, 0.03, 1e-15);
  EXPECT_NEAR(jump_figures(goal_of(0.03, 0.04, JumpGoal::Release::spring)).apex,
              0.03 + 0.04 * 0.04 / 0.12, 1e-15);
}

std::string refused(const JumpGoal& goal) {
  const RobotModel model = test::biped();
  CommandSample held;
  held.state = model.rest_state();
  held.cog.z() = 0.25;
  CommandSeries series;
  series.samples = {held};
  const Handover start{held.state, Eigen::Vector3d::Zero(), held.state.theta, held,
                       CommandPlan(series)};
  try {
    const ViipJump jump(model, model.limits(), {}, 0.001, start, held, goal);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_pattern);
    return error.what();
  }
  return "";
}

TEST(ViipJump, RefusesWhatIsNoJump) {
  EXPECT_NE(refused(goal_of(0, 0.03, JumpGoal::Release::ref_z)).find("must be above 0"),
            std::string::npos);
  EXPECT_NE(
      refused(goal_of(0.03, 0.2, JumpGoal::Release::ref_z)).find("the height must be at most"),
      std::string::npos);
  EXPECT_NE(
      refused(goal_of(0.02, 0.045, JumpGoal::Release::spring)).find("f_z would never be zero"),
      std::string::npos);
  EXPECT_EQ(refused(goal_of(0.02, 0.03, JumpGoal::Release::ref_z)), "");
}

}  // namespace
}  // namespace ayumi
