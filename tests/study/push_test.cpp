// The search of push limits on a small study: two directions, coarse steps.
#include "ayumi/study/push.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/study/tune.hpp"
#include "tests/support/error_message.hpp"

namespace ayumi {
namespace {

struct Stand {
  RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1");
  CommandSeries series = sample(model, stand_pattern(model, 1.0));
  PushOptions options;
  Stand() {
    options.phases = {{"standing", 0.5, true}};
    options.controllers = {{ControllerKind::dtad, {}}};
    options.directions = 2;
    options.step = 0.4;
    options.cap = 1.6;
    options.replicas = 1;
    options.threads = 1;
  }
};

bool same(const PushCase& a, const PushCase& b) {
  return a.direction == b.direction && a.bound == b.bound &&
         a.open_loop.impulse == b.open_loop.impulse && a.open_loop.runs == b.open_loop.runs &&
         a.limits[0].impulse == b.limits[0].impulse &&
         a.limits[0].moderate.recovery == b.limits[0].moderate.recovery;
}

TEST(Push, LimitsAreLevelsAroundTheBoundAndDoNotDependOnThreads) {
  Stand stand;
  const std::vector<PushCase> one = push_limits(stand.model, stand.series, stand.options);
  ASSERT_EQ(one.size(), 2u);
  for (const PushCase& c : one) {
    const double level = c.bound * stand.options.step;
    EXPECT_NEAR(c.bound, c.edge_bound, 1e-6 * c.bound);
    const double steps = c.limits[0].impulse / level;
    EXPECT_NEAR(steps, std::round(steps), 1e-9);
    // A robot that stands on stiff legs reaches the bound of a pendulum to within a step.
    EXPECT_GE(c.limits[0].impulse, 0.79 * c.bound);
    EXPECT_LE(c.limits[0].impulse, 1.21 * c.bound);
    EXPECT_TRUE(c.limits[0].moderate.survives);
    EXPECT_FALSE(c.limits[0].capped);
  }
  stand.options.threads = 3;
  int told = 0;
  const std::vector<PushCase> three =
      push_limits(stand.model, stand.series, stand.options, {}, [&](size_t i, const PushCase& c) {
        ++told;
        EXPECT_TRUE(same(c, one[i]));
      });
  EXPECT_EQ(told, 2);
  EXPECT_TRUE(same(one[1], three[1]));
}

TEST(Push, GoesOnFromKnownCases) {
  Stand stand;
  PushCase known;
  known.bound = 7;
  known.limits.resize(1);
  known.limits[0].impulse = 3.5;
  std::vector<size_t> worked;
  const std::vector<PushCase> cases =
      push_limits(stand.model, stand.series, stand.options, {known, std::nullopt},
                  [&](size_t i, const PushCase&) { worked.push_back(i); });
  EXPECT_EQ(worked, std::vector<size_t>{1});
  EXPECT_EQ(cases[0].bound, 7);
  EXPECT_GT(cases[1].limits[0].impulse, 0);
}

TEST(Push, DefaultPhasesAreThoseOfAMiddleStepOnTheLeftFoot) {
  const RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1");
  const WalkParameters walk{.steps = 4};
  const CommandSeries series = sample(model, walk_pattern(model, walk));
  const std::vector<PushPhase> phases = default_push_phases(model, series, {});
  ASSERT_EQ(phases.size(), 5u);
  EXPECT_TRUE(phases[0].standing);
  const auto support = [&](const PushPhase& p) {
    return series.samples[static_cast<size_t>(std::lround(p.at / series.dt))].support;
  };
  EXPECT_EQ(support(phases[1]), Support::both);
  for (int i = 2; i < 5; ++i) EXPECT_EQ(support(phases[i]), Support::left) << i;
  const double single = (1 - walk.double_support) * walk.period;
  EXPECT_NEAR(phases[4].at - phases[2].at, 0.67 * single, 0.003);
  EXPECT_NEAR(phases[2].at - phases[1].at, 0.11 * single + 0.5 * walk.double_support * walk.period,
              0.003);
}

TEST(Push, SummaryOfKnownNumbers) {
  PushCase a, b, standing;
  a.bound = 2, a.open_loop.impulse = 1, a.limits.resize(1), a.limits[0].impulse = 2.4;
  b.bound = 1, b.open_loop.impulse = 0.7, b.limits.resize(1), b.limits[0].impulse = 0.6;
  a.mass = b.mass = 2;
  a.height = 0.9, b.height = 0.4;
  standing = b;
  standing.phase.standing = true;
  const PushSummary s = summarize({a, b, standing}, 0, false, 0.06);
  EXPECT_EQ(s.cases, 2);
  EXPECT_DOUBLE_EQ(s.worst, 0.6);
  EXPECT_DOUBLE_EQ(s.mean, 0.9);
  EXPECT_DOUBLE_EQ(s.open_worst, 0.5);
  EXPECT_DOUBLE_EQ(s.open_mean, 0.6);
  EXPECT_EQ(s.below_open, 1);
  EXPECT_DOUBLE_EQ(s.worst_speed, 0.3);
  EXPECT_DOUBLE_EQ(s.mean_speed, 0.75);
  EXPECT_NEAR(s.worst_froude, 0.3 / std::sqrt(0.4 * 9.80665), 1e-12);
  EXPECT_NEAR(s.mean_froude,
              0.5 * (1.2 / std::sqrt(0.9 * 9.80665) + 0.3 / std::sqrt(0.4 * 9.80665)), 1e-12);
  EXPECT_EQ(summarize({a, b}, 0, false, 0.2).below_open, 0);
}

TEST(Push, RefusesTimesOutsideThePattern) {
  Stand stand;
  stand.options.phases = {{"late", 5.0, false}};
  try {
    push_limits(stand.model, stand.series, stand.options);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("a push at 5 s is not possible. Give a time from"),
              std::string::npos)
        << error.what();
  }
}

// Studies that cannot be done are refused before any work.
TEST(Push, RefusesStudiesThatCannotBeDone) {
  const auto refused = [](const std::function<void(Stand&)>& change) {
    Stand stand;
    change(stand);
    return test::error_message(
        [&] { push_limits(stand.model, stand.series, stand.options, {}, {}); });
  };
  EXPECT_EQ(refused([](Stand& s) { s.options.directions = 0; }),
            "push: the number of directions is 0; it must be from 1 to 360");
  EXPECT_EQ(refused([](Stand& s) { s.options.directions = 361; }),
            "push: the number of directions is 361; it must be from 1 to 360");
  const std::string resolution = "push: the resolution of the search is ";
  const std::string bounds = " capture bounds; it must be from 0.005 to 1 capture bounds";
  EXPECT_EQ(refused([](Stand& s) { s.options.step = 0; }), resolution + "0" + bounds);
  EXPECT_EQ(refused([](Stand& s) { s.options.step = 1e-300; }), resolution + "1e-300" + bounds);
  EXPECT_EQ(refused([](Stand& s) { s.options.cap = INFINITY; }),
            "push: the largest push is inf capture bounds; it must be from 0.1 to 20 capture "
            "bounds");
  EXPECT_EQ(refused([](Stand& s) { s.options.cap = 0.3; }),
            "push: the largest push is 0.3 capture bounds; it must be at least the resolution of "
            "the search, 0.4 capture bounds");
  EXPECT_EQ(refused([](Stand& s) { s.options.duration = NAN; }),
            "push: the duration of a push is nan s; it must be from 0.001 to 1 s");
  EXPECT_EQ(refused([](Stand& s) { s.options.replicas = -1; }),
            "push: the number of variations is -1; it must be from 0 to 100");
  EXPECT_EQ(refused([](Stand& s) { s.series.samples.clear(); }),
            "the motion has no samples. Sample a pattern first");
  EXPECT_NE(refused([](Stand& s) { s.options.phases = {{"late", 0.99, false}}; }), "no error");
}

TEST(Tune, RefusesSearchesThatCannotBeDone) {
  const auto refused = [](const std::function<void(TuneOptions&)>& change) {
    const Stand stand;
    TuneOptions options;
    options.simulate.controller.type = ControllerKind::dtad;
    options.phases = stand.options.phases;
    change(options);
    return test::error_message([&] { tune_gains(stand.model, stand.series, options); },
                               ErrorCode::usage);
  };
  EXPECT_EQ(refused([](TuneOptions& o) { o.simulate.controller.type = ControllerKind::viip; }),
            "tune: controller 'viip' has no gains to tune. Use dtad");
  EXPECT_EQ(refused([](TuneOptions& o) { o.directions = 0; }),
            "tune: the number of directions is 0; it must be from 1 to 360");
  EXPECT_EQ(refused([](TuneOptions& o) { o.level = 0; }),
            "tune: the size of a push is 0 capture bounds; it must be from 0.01 to 5 capture "
            "bounds");
  EXPECT_EQ(refused([](TuneOptions& o) { o.threads = -1; }),
            "tune: the number of threads is -1; it must be from 0 to 1024");
  EXPECT_EQ(refused([](TuneOptions& o) { o.factor = 1; }), "tune: factor must exceed 1");
  for (const int rounds : {0, 1'000'000'000})
    EXPECT_EQ(refused([&](TuneOptions& o) { o.rounds = rounds; }),
              "tune: the number of rounds is " + text::exact(rounds) + "; it must be from 1 to 50");
  EXPECT_EQ(refused([](TuneOptions& o) { o.gains.clear(); }), "tune: give at least one gain");
  const std::string unknown = refused([](TuneOptions& o) { o.gains = {"ksx"}; });
  EXPECT_NE(unknown.find("tune: gain 'ksx' cannot be tuned; did you mean 'ks'?"), std::string::npos)
      << unknown;
}

}  // namespace
}  // namespace ayumi
