#include "ayumi/author/generate/generate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "ayumi/plan/sample.hpp"
#include "tests/support/biped.hpp"

namespace ayumi {
namespace {

std::string message_of(const WalkParameters& parameters) {
  try {
    walk_pattern(test::biped(), parameters);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    return error.what();
  }
  return "";
}

TEST(WalkPattern, AlternatesFeetAndClosesThem) {
  const RobotModel model = test::biped();
  WalkParameters p;
  p.steps = 4;
  p.stride = 0.03;
  const Pattern pattern = walk_pattern(model, p);
  ASSERT_EQ(pattern.phases.size(), 1u + 2 * 5);
  std::vector<Swing> swings;
  double last = 0;
  for (const Phase& phase : pattern.phases) {
    EXPECT_GT(phase.until, last);
    last = phase.until;
    EXPECT_NEAR(phase.until * 1000, std::round(phase.until * 1000), 1e-9);
    if (phase.swing) swings.push_back(*phase.swing);
    EXPECT_EQ(phase.swing.has_value(), phase.support != Support::both);
  }
  ASSERT_EQ(swings.size(), 5u);
  EXPECT_EQ(swings[0].foot, Side::right);
  for (size_t i = 1; i < swings.size(); ++i) EXPECT_EQ(swings[i].foot, other(swings[i - 1].foot));
  EXPECT_NEAR(swings[0].to.position.x(), 0.03, 1e-12);
  EXPECT_NEAR(swings[3].to.position.x(), 0.12, 1e-12);
  EXPECT_NEAR(swings[4].to.position.x(), 0.12, 1e-12);  // the foot lands beside the last foothold
  EXPECT_NEAR(swings[3].to.position.y(), 0.05, 1e-12);
  EXPECT_NEAR(swings[4].to.position.y(), -0.05, 1e-12);
}

TEST(WalkPattern, SidewaysPerPairAndTurnPerStep) {
  const RobotModel model = test::biped();
  WalkParameters p;
  p.steps = 4;
  p.stride = 0;
  p.side = 0.02;
  const auto feet = [&](const WalkParameters& q) {
    const CommandSeries series = sample(model, walk_pattern(model, q), {.dt = 0.005});
    return series.samples.back().feet;
  };
  auto end = feet(p);
  EXPECT_NEAR(end[0].translation().y(), 0.05 + 2 * 0.02, 1e-9);
  EXPECT_NEAR(end[1].translation().y(), -0.05 + 2 * 0.02, 1e-9);
  p.side = 0;
  p.turn = 0.1;
  end = feet(p);
  for (const auto& foot : end)
    EXPECT_NEAR(std::atan2(foot.linear()(1, 0), foot.linear()(0, 0)), 0.4, 1e-9);
  EXPECT_NEAR((end[0].translation() - end[1].translation()).norm(), 0.10, 2e-4);
}

TEST(WalkPattern, StartsAndEndsAtRest) {
  const RobotModel model = test::biped();
  const CommandSeries series = sample(model, walk_pattern(model, {}));
  for (const size_t k : {size_t{0}, series.samples.size() - 1}) {
    EXPECT_LT(series.samples[k].dcog.norm(), 1e-4);
    EXPECT_LT(series.samples[k].ddcog.norm(), 1e-2);
  }
  const Eigen::Vector3d middle = 0.5 * (series.samples.back().feet[0].translation() +
                                        series.samples.back().feet[1].translation());
  EXPECT_NEAR(series.samples.back().cog.y(), middle.y(), 1e-6);
  // The change of the keys for a start from rest is small, and it is reported if it is not.
  EXPECT_LT((series.samples[700].zmp - series.samples[0].zmp).norm(), 1e-3);
}

TEST(WalkPattern, BendsTheLegsOfARobotThatStandsStraight) {
  RobotDescription straight = test::biped_description();
  straight.postures["home"] = {};
  const RobotModel model(straight);
  const Pattern pattern = walk_pattern(model, {});
  EXPECT_GT(pattern.cog_height, 0.1);
  EXPECT_GT(sample(model, pattern, {.dt = 0.005}).samples.size(), 100u);
  // 0 stands for the COG height of the home posture, in which the knees are already bent.
  EXPECT_EQ(walk_pattern(test::biped(), {}).cog_height, 0);
}

TEST(StandingPatterns, BendTheLegsOfARobotThatStandsStraight) {
  RobotDescription straight = test::biped_description();
  straight.postures["home"] = {};
  const RobotModel model(straight);
  for (const Pattern& pattern :
       {stand_pattern(model, 0.5), sway_pattern(model, sway_defaults(model)),
        squat_pattern(model, squat_defaults(model))}) {
    EXPECT_EQ(pattern.cog_height, walk_pattern(model, {}).cog_height) << pattern.name;
    EXPECT_GT(sample(model, pattern, {.dt = 0.01}).samples.size(), 20u) << pattern.name;
  }
  EXPECT_EQ(stand_pattern(test::biped(), 1).cog_height, 0);
}

// Every foothold is on a stair with its whole sole, and both feet end on the last stair.
TEST(WalkPattern, StairsCarryTheWholeSole) {
  const RobotModel& model = test::biped();
  WalkParameters p = stair_defaults(model, 0.01);
  const Pattern pattern = walk_pattern(model, p);
  ASSERT_EQ(pattern.world.blocks.size(), 3u);
  int swings = 0;
  for (const Phase& phase : pattern.phases) {
    if (!phase.swing) continue;
    const Eigen::Vector3d& to = phase.swing->to.position;
    const GroundBlock& stair = pattern.world.blocks[static_cast<size_t>(swings++ / 2)];
    EXPECT_NEAR(to.z(), stair.height, 1e-12);
    for (const Eigen::Vector2d& corner : model.sole(phase.swing->foot).polygon) {
      const Eigen::Vector2d at = to.head<2>() + corner;
      EXPECT_TRUE((at.array() > stair.low.array()).all() && (at.array() < stair.high.array()).all())
          << at.transpose();
    }
  }
  EXPECT_EQ(swings, 6);
}

TEST(WalkPattern, NamesTheParameterOutOfRange) {
  const auto with = [](auto change) {
    WalkParameters p;
    change(p);
    return message_of(p);
  };
  EXPECT_EQ(message_of({}), "");
  EXPECT_NE(with([](auto& p) { p.steps = 0; }).find("steps 0 is out of range"), std::string::npos);
  EXPECT_NE(with([](auto& p) { p.stride = 2; }).find("stride 2 m is out of range"),
            std::string::npos);
  EXPECT_NE(with([](auto& p) { p.stride = NAN; }).find("stride nan"), std::string::npos);
  EXPECT_NE(with([](auto& p) { p.period = 0.1; }).find("from 0.2 to 10 s"), std::string::npos);
  EXPECT_NE(with([](auto& p) { p.double_support = 0; }).find("double_support"), std::string::npos);
  EXPECT_NE(with([](auto& p) { p.lift = 0; }).find("lift"), std::string::npos);
  EXPECT_NE(with([](auto& p) { p.rise = 0.01; }).find("too short for stairs"), std::string::npos);
  EXPECT_NE(with([](auto& p) { p.rise = 0.01, p.turn = 0.1; }).find("not possible with stairs"),
            std::string::npos);
  EXPECT_NE(with([](auto& p) { p.turn = 1; }).find("turn"), std::string::npos);
  EXPECT_NE(with([](auto& p) { p.side = -1; }).find("side"), std::string::npos);
  EXPECT_NE(with([](auto& p) { p.cog_height = 0.01; }).find("cog_height"), std::string::npos);
  EXPECT_NE(with([](auto& p) { p.cog_height = -1; }).find(" m, or 0 for the usual height"),
            std::string::npos);
}

TEST(SwayPattern, ReachesItsAmplitudeAtRestAndComesBack) {
  const RobotModel model = test::biped();
  SwayParameters p;
  p.side = 0.02;
  p.cycles = 1;
  p.period = 1;
  const Pattern pattern = sway_pattern(model, p);
  const CommandSeries series = sample(model, pattern, {.dt = 0.005});
  const double middle = series.samples.front().cog.y();
  double left = 0, right = 0;
  for (const CommandSample& now : series.samples) {
    left = std::max(left, now.cog.y() - middle);
    right = std::min(right, now.cog.y() - middle);
  }
  EXPECT_NEAR(left, 0.02, 1e-6);
  EXPECT_NEAR(right, -0.02, 1e-6);
  EXPECT_NEAR(series.samples.back().cog.y(), middle, 1e-9);
  for (const Keyframe& key : pattern.keyframes) {
    EXPECT_FALSE(key.cog_x.has_value());  // the axis that does not sway is left to the solver
    EXPECT_LT(std::abs(series.samples[std::lround(key.t / 0.005)].dcog.y()), 1e-5) << key.t;
  }
}

TEST(SquatPattern, GoesDownByItsDepth) {
  const RobotModel model = test::biped();
  SquatParameters p;
  p.depth = 0.02;
  p.cycles = 2;
  const CommandSeries series = sample(model, squat_pattern(model, p), {.dt = 0.005});
  const double home = series.samples.front().cog.z();
  double lowest = home;
  int below = 0;
  for (const CommandSample& now : series.samples) {
    lowest = std::min(lowest, now.cog.z());
    below += now.cog.z() < home - 0.02 + 1e-4;
  }
  EXPECT_NEAR(lowest, home - 0.02, 5e-5);  // keys are rounded to a tenth of a millimetre
  EXPECT_GE(below * 0.005, 2 * p.hold);
  EXPECT_NEAR(series.samples.back().cog.z(), home, 5e-5);
}

TEST(Generators, DefaultsScaleWithTheRobot) {
  const RobotModel model = test::biped();
  const WalkParameters p = walk_defaults(model);
  const double size = sample(model, stand_pattern(model, 0.1)).samples[0].cog.z() / 0.245;
  EXPECT_NEAR(p.stride, size * WalkParameters{}.stride, 6e-4);
  EXPECT_NEAR(p.period, std::sqrt(size) * WalkParameters{}.period, 6e-3);
}

TEST(Generators, NameTheirParameterOutOfRange) {
  const RobotModel model = test::biped();
  const auto message = [&](const auto& make) -> std::string {
    try {
      make();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::usage);
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message([&] { sway_pattern(model, {.period = 0}); }).find("sway: period 0 s"),
            std::string::npos);
  EXPECT_NE(message([&] { sway_pattern(model, {.cycles = 0}); }).find("sway: cycles 0"),
            std::string::npos);
  EXPECT_NE(message([&] { squat_pattern(model, {.depth = 3}); }).find("squat: depth 3 m"),
            std::string::npos);
  EXPECT_NE(message([&] { squat_pattern(model, {.hold = NAN}); }).find("squat: hold nan"),
            std::string::npos);
}

TEST(StandPattern, StandsStill) {
  const RobotModel model = test::biped();
  const CommandSeries series = sample(model, stand_pattern(model, 1.5));
  EXPECT_EQ(series.samples.size(), 1501u);
  for (const CommandSample& now : series.samples) {
    EXPECT_LT((now.cog - series.samples[0].cog).norm(), 1e-12);
    EXPECT_LT(now.state.velocity().norm(), 1e-9);
  }
  EXPECT_THROW(stand_pattern(model, 0), Error);
}

// The ZMP that a shuffle keys under a standing foot is nearer to the other foot by the requested
// distance.
TEST(Generate, ZmpInwardsOfTheStandingSole) {
  const RobotModel model = test::biped();
  WalkParameters p = walk_defaults(model);
  p.steps = 3;
  const auto keyed = [&](double inwards) {
    p.zmp_inwards = inwards;
    const CommandSeries series = sample(model, walk_pattern(model, p), {.dt = 0.005});
    std::vector<double> sideways;
    for (const CommandSample& sample : series.samples)
      if (sample.support == Support::left || sample.support == Support::right)
        sideways.push_back(sample.zmp.y() * (sample.support == Support::left ? 1 : -1));
    return sideways;
  };
  const std::vector<double> middle = keyed(0), inner = keyed(0.02);
  const double mean =
      std::accumulate(middle.begin(), middle.end(), 0.0) / static_cast<double>(middle.size());
  for (const double y : middle) EXPECT_NEAR(y, mean, 2e-3);
  for (const double y : inner) EXPECT_NEAR(y, mean - 0.02, 2e-3);
}

// Before the first and after the last step, the COG of a shuffle does not sway farther than in
// between, because legs without the roll of the ankle could not carry it there.
TEST(Generate, AShuffleSwaysNoFartherAtItsEnds) {
  const RobotModel model = test::biped();
  WalkParameters p = walk_defaults(model);
  p.steps = 7;
  p.stride = 0;
  p.period = 0.3;
  p.zmp_inwards = 0.9 * half_sole_width(model);
  const CommandSeries series = sample(model, walk_pattern(model, p), {.dt = 0.005});
  size_t first = series.samples.size(), last = 0;
  for (size_t k = 0; k < series.samples.size(); ++k) {
    if (series.samples[k].support == Support::both) continue;
    first = std::min(first, k);
    last = k;
  }
  double middle = 0, ends = 0;
  for (size_t k = 0; k < series.samples.size(); ++k) {
    double& most = k < first || k > last ? ends : middle;
    most = std::max(most, std::abs(series.samples[k].cog.y() - series.samples[0].cog.y()));
  }
  EXPECT_GT(middle, 0.002);
  EXPECT_LT(ends, 1.05 * middle);
}

}  // namespace
}  // namespace ayumi
