// The fastest uniform scaling that passes, for patterns that are too quick, too warm or wrong in
// their posture.

#include "ayumi/study/retime.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "ayumi/author/edit/edit.hpp"
#include "ayumi/author/generate/generate.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/plan/sample.hpp"
#include "tests/support/error_message.hpp"
#include "tests/support/faults.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi::test {
namespace {

constexpr double kTick = 0.01;

// Options with motors whose lasting torque is a fifth smaller.
CheckOptions warm() {
  CheckOptions options;
  options.tolerances = {{"continuous_torque", 0.83}};
  return options;
}

// A walk in which an arm is raised in 0.15 s.
Pattern walk_with_a_quick_arm() {
  Pattern walk = walk_pattern(hoap1(), {.steps = 3, .stride = 0.03, .period = 0.62});
  walk.robot = "hoap1";
  double angle = 8;
  for (const double t : {2.5, 2.65, 3.1}) {
    Keyframe key;
    key.t = t;
    key.joints["l_shoulder_roll"] = angle * M_PI / 180;
    angle = angle < 10 ? 60 : 8;
    const auto next = std::find_if(walk.keyframes.begin(), walk.keyframes.end(),
                                   [&](const Keyframe& k) { return k.t > t; });
    walk.keyframes.insert(next, key);
  }
  return walk;
}

bool passes(const Pattern& pattern, double scale) {
  return check_consistency(hoap1(),
                           sample(hoap1(), retimed(hoap1(), pattern, scale), {.dt = kTick}), warm())
      .consistent;
}

}  // namespace

// At 2.6 times its duration, the arm is slow enough; at 3.1 times, a leg stands alone for so long
// that its motors grow too warm. The scales that pass are a window between the two.
TEST(Retime, FindsAPaceBetweenTooQuickAndTooWarm) {
  const Pattern walk = walk_with_a_quick_arm();
  const FastestPace pace = fastest_pace(hoap1(), walk, {.check = warm(), .dt = kTick});
  ASSERT_TRUE(pace.found) << pace.limited_by;
  EXPECT_GT(pace.scale, 2.3);
  EXPECT_LT(pace.scale, 3.1);
  EXPECT_NE(pace.limited_by.find(" l_shoulder_roll"), std::string::npos) << pace.limited_by;
  EXPECT_TRUE(passes(walk, pace.scale));
  EXPECT_FALSE(passes(walk, pace.scale / 1.004));
  EXPECT_FALSE(passes(walk, 3.1)) << "no window left to find";
  EXPECT_LT(pace.evaluations, 90);
}

// A pattern with goals of VIIP has no motion of its own, so its pace cannot be changed.
TEST(Retime, APatternWithGoalsIsRefused) {
  Pattern steps = walk_pattern(hoap1(), walk_defaults(hoap1()));
  steps.phases.assign(3, Phase{});
  for (size_t i = 0; i < 3; ++i) steps.phases[i].until = 1.0 + 3.0 * static_cast<double>(i);
  steps.phases[1].viip = CogGoal{};
  const std::string message =
      error_message([&] { fastest_pace(hoap1(), steps, {.dt = kTick}); }, ErrorCode::bad_pattern);
  EXPECT_NE(message.find("so the pattern cannot be retimed"), std::string::npos) << message;
}

// No pace mends a wrong posture; for a table, this is reported at once.
TEST(Retime, APostureThatIsWrongIsToldAtOnce) {
  Pattern walk = walk_with_a_quick_arm();
  walk.keyframes.erase(std::remove_if(walk.keyframes.begin(), walk.keyframes.end(),
                                      [](const Keyframe& k) { return !k.joints.empty(); }),
                       walk.keyframes.end());
  Pattern table = baked(hoap1(), walk, sample(hoap1(), walk), "walk.csv");
  EXPECT_TRUE(fastest_pace(hoap1(), table, {.dt = kTick}).found);
  move_joint(hoap1(), *table.table, "l_elbow", 40 * M_PI / 180, 2, 0.8);
  const FastestPace pace = fastest_pace(hoap1(), table, {.dt = kTick});
  EXPECT_FALSE(pace.found);
  EXPECT_TRUE(pace.by_posture);
  EXPECT_EQ(pace.evaluations, 1);
  EXPECT_NE(pace.limited_by.find("joint_position of l_elbow at 2.0"), std::string::npos)
      << pace.limited_by;
}

TEST(Retime, RefusesAResolutionOutOfBounds) {
  const Pattern squat = squat_pattern(hoap1(), {.cycles = 1});
  for (const double resolution : {0.0, -1.0, std::nan("")}) {
    RetimeOptions options;
    options.resolution = resolution;
    EXPECT_EQ(error_message([&] { fastest_pace(hoap1(), squat, options); }, ErrorCode::usage),
              "the resolution of the scale is " + text::exact(resolution) +
                  "; it must be from 1e-05 to 0.5");
  }
}

}  // namespace ayumi::test
