// The quickest timing along a motion: its rows agree with the check's inverse dynamics, one joint
// agrees with its bang-bang motion, and walks are compared with their fastest uniform pace.

#include "ayumi/study/local_retime.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "ayumi/author/edit/edit.hpp"
#include "ayumi/author/generate/generate.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/demand/motion_demand.hpp"
#include "ayumi/math/random.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/plan/foot_plan.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/sim/simulate.hpp"
#include "ayumi/study/pauses.hpp"
#include "ayumi/study/retime.hpp"
#include "tests/support/error_message.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi::test {
namespace {

LocalPace local_pace(const RobotModel& model, const Pattern& pattern,
                     const LocalRetimeOptions& options = {}) {
  return fastest_local_pace(model, pattern, "quick.csv", options);
}

Outcome open_loop(const RobotModel& model, const CommandSeries& series) {
  SimulateOptions options;
  options.controller.type.kind = ControllerKind::none;
  return simulate(model, series, options).result.outcome;
}

// Both arms are raised to the side from one posture to another; nothing else moves.
Pattern raised_arms(double angle, double duration) {
  Pattern pattern = stand_pattern(hoap1(), duration);
  pattern.robot = "hoap1";
  const auto key_at = [&](double t) -> Keyframe& {
    for (Keyframe& key : pattern.keyframes)
      if (key.t == t) return key;
    pattern.keyframes.emplace_back();
    pattern.keyframes.back().t = t;
    return pattern.keyframes.back();
  };
  for (const auto& [t, turn] : std::map<double, double>{{0, 0.2}, {duration, 0.2 + angle}}) {
    key_at(t).joints["l_shoulder_roll"] = turn;
    key_at(t).joints["r_shoulder_roll"] = -turn;
  }
  return pattern;
}

}  // namespace

// At a random timing (u, x), the rows of torques, friction and the ZMP agree with the check of the
// motion with these rates: the room of a row is that of the limit.
TEST(LocalRetime, RowsAreThoseOfInverseDynamics) {
  Pattern walk = walk_pattern(hoap1(), {.steps = 2, .stride = 0.03});
  const CommandSeries path = sample(hoap1(), walk);
  PathLimitOptions options;
  options.own_margin = 0;
  PathLimits limits(hoap1(), path, options);
  Random random(3);
  const size_t count = limits.points().size();
  std::vector<double> u, x, share(count, 1);
  for (size_t i = 0; i < count; ++i) {
    u.push_back(4 * random.uniform() - 2);
    x.push_back(0.3 + 2 * random.uniform());
  }
  limits.linearize(u, x, share);

  CommandSeries played = path;
  for (size_t i = 0; i < count; ++i) {
    CommandSample& s = played.samples[static_cast<size_t>(limits.sample_of(static_cast<int>(i)))];
    Eigen::VectorXd rate(s.acceleration.size());
    rate << s.state.base_velocity, s.state.base_angular_velocity, s.state.dtheta;
    s.acceleration = x[i] * s.acceleration + u[i] * rate;
    s.state.base_velocity *= std::sqrt(x[i]);
    s.state.base_angular_velocity *= std::sqrt(x[i]);
    s.state.dtheta *= std::sqrt(x[i]);
  }
  const ActuatorLimits& actuators = hoap1().limits();
  const ContactPlan plan = contact_plan(path);
  MotionDynamics dynamics(hoap1(), actuators, played, plan);
  std::map<std::string, int> compared;
  for (size_t i = 0; i < count; ++i) {
    const SampleDynamics& demand = dynamics.at(limits.sample_of(static_cast<int>(i)));
    double margin = 1e9;
    std::map<int, double> torque;
    double slip = 0;
    for (const PathRow& row : limits.rows_at(static_cast<int>(i))) {
      const std::string name = row.kind->name;
      const double room = row.row.most - row.row.u * u[i] - row.row.x * x[i];
      ++compared[name];
      if (name == "support")
        margin = std::min(margin, room * hoap1().mass() * kGravity / demand.use.normal_force);
      if (name == "friction") slip = room;
      if (name == "torque")
        torque[row.item] = torque.contains(row.item) ? std::min(torque[row.item], room) : room;
    }
    EXPECT_NEAR(margin, demand.use.margin, 1e-6) << i;
    EXPECT_NEAR(
        slip,
        (0.8 * demand.use.normal_force - demand.use.tangential_force) / (hoap1().mass() * kGravity),
        1e-4)
        << i;
    for (const auto& [dof, room] : torque)
      EXPECT_NEAR(room, 1 - std::abs(demand.torque[dof]) / actuators.peak_torque[dof], 1e-9)
          << i << " " << hoap1().dofs()[dof].name;
  }
  EXPECT_GT(compared["torque"], 1000);
  EXPECT_GT(compared["table_step"], 1000);
}

// One joint turns from rest to rest by an angle L with a largest acceleration a: whatever the
// course of the given motion is, it takes
//   2 sqrt(L / a),
// and the smoothing adds 36 ms.
TEST(LocalRetime, OneJointTakesItsBangBangTime) {
  const double angle = 1, most = 8;
  LocalRetimeOptions options;
  options.path.check.tolerances = {{"joint_acceleration", most}};
  options.path.most_pace = 40;
  options.path.spacing = 0.002;
  const double share = 0.97;
  for (const double given : {3.0, 1.2}) {
    const LocalPace pace = local_pace(hoap1(), raised_arms(angle, given), options);
    ASSERT_TRUE(pace.found) << pace.limited_by;
    EXPECT_NEAR(pace.series.duration(), 2 * std::sqrt(angle / (share * most)) + 0.036, 0.01)
        << given;
    ASSERT_FALSE(pace.binding.empty());
    EXPECT_EQ(pace.binding.front().limit, "acceleration");
    EXPECT_GT(pace.binding.front().share, 0.9);
  }
}

// If a largest speed v limits the same motion as well, the motion takes L / v + v / a.
TEST(LocalRetime, OneJointTakesItsTimeAtALargestSpeed) {
  const double angle = 1.4, most = 40, speed = hoap1().limits().speed[0];
  LocalRetimeOptions options;
  options.path.check.tolerances = {{"joint_acceleration", most}, {"joint_speed", 0.5}};
  options.path.most_pace = 40;
  const LocalPace pace = local_pace(hoap1(), raised_arms(angle, 3), options);
  ASSERT_TRUE(pace.found) << pace.limited_by;
  const double v = std::sqrt(0.97) * 0.5 * speed, a = 0.97 * most;
  EXPECT_NEAR(pace.series.duration(), angle / v + v / a + 0.036, 0.03);
}

// The walks are at least a tenth quicker than at the fastest uniform pace, consistent, and the
// robot stands in open loop if it does so at that pace.
TEST(LocalRetime, WalksAreQuickerThanAtTheirFastestUniformPace) {
  const RobotModel humanoid = load_robot(AYUMI_SOURCE_DIR "/robots/humanoid30");
  struct Case {
    const RobotModel& model;
    WalkParameters walk;
  };
  WalkParameters large = walk_defaults(humanoid);
  large.steps = 3;
  large.turn = 0.1;
  for (const Case& c :
       {Case{hoap1(), {.steps = 3, .stride = 0.035, .period = 0.7}},
        Case{hoap1(), {.steps = 2, .stride = 0, .side = 0.03}}, Case{humanoid, large}}) {
    const Pattern walk = walk_pattern(c.model, c.walk);
    const FastestPace uniform = fastest_pace(c.model, walk, {});
    ASSERT_TRUE(uniform.found);
    const CommandSeries at_once = sample(c.model, retimed(c.model, walk, uniform.scale));
    const LocalPace pace = local_pace(c.model, walk);
    ASSERT_TRUE(pace.found) << pace.limited_by;
    EXPECT_LE(pace.series.duration(), 0.9 * at_once.duration());
    // The written motion is the one that was checked.
    const CommandSeries again = sample(c.model, pace.pattern);
    EXPECT_TRUE(check_consistency(c.model, again).consistent);
    EXPECT_EQ(again.samples.size(), pace.series.samples.size());
    EXPECT_EQ(open_loop(c.model, at_once), Outcome::stands);
    EXPECT_EQ(open_loop(c.model, again), Outcome::stands);
  }
}

// The postures are those of the path, and phases, pushes and keys of weights move with them.
TEST(LocalRetime, ThePathStaysAndThePlanMovesAlong) {
  Pattern walk = walk_pattern(hoap1(), {.steps = 2, .stride = 0.03});
  Disturbance push;
  push.at = 1.5;
  push.what = Push{};
  walk.scenario.push_back(push);
  const LocalPace pace = local_pace(hoap1(), walk);
  ASSERT_TRUE(pace.found) << pace.limited_by;
  const CommandSeries path = sample(hoap1(), retimed(hoap1(), walk, pace.path_scale));
  ASSERT_EQ(pace.pattern.phases.size(), walk.phases.size());
  for (size_t i = 0; i + 1 < walk.phases.size(); ++i) {
    const auto at = [](const CommandSeries& series, double t) {
      return series.samples[static_cast<size_t>(std::lround(t / series.dt))].state.theta;
    };
    const Eigen::VectorXd before = at(path, walk.phases[i].until * pace.path_scale);
    const Eigen::VectorXd after = at(pace.series, pace.pattern.phases[i].until);
    EXPECT_LT((after - before).cwiseAbs().maxCoeff(), 0.01) << i;
    EXPECT_EQ(pace.pattern.phases[i].support, walk.phases[i].support);
  }
  // The push is in the same phase as before.
  const auto phase_of = [](const Pattern& pattern, double t) {
    size_t i = 0;
    while (pattern.phases[i].until < t) ++i;
    return i;
  };
  EXPECT_EQ(phase_of(pace.pattern, pace.pattern.scenario[0].at), phase_of(walk, 1.5));
  EXPECT_LT((pace.series.samples.back().state.theta - path.samples.back().state.theta)
                .cwiseAbs()
                .maxCoeff(),
            1e-8);
}

// A pause between two motions, and the pauses at both ends, last as long as the author wrote. This
// also holds if the COG is solved from the ZMP, and in a table; otherwise they become shorter.
TEST(LocalRetime, PausesKeepTheirLength) {
  Pattern walk = walk_pattern(hoap1(), {.steps = 2, .stride = 0.03});
  const double end = walk.phases.back().until;
  // Three seconds of standing at the end, then an arm that moves, and half a second more.
  walk.phases.push_back({end + 4, Support::both, {}, {}, {}});
  Keyframe before, after;
  before.t = end + 3;
  after.t = end + 3.5;
  walk.keyframes.front().joints["l_shoulder_roll"] = 0.2;
  before.joints["l_shoulder_roll"] = 0.2;
  after.joints["l_shoulder_roll"] = 0.8;
  walk.keyframes.push_back(before);
  walk.keyframes.push_back(after);
  const CommandSeries given = sample(hoap1(), walk);
  const Pattern table = baked(hoap1(), walk, given, "given.csv");
  const std::vector<TimeSpan> pauses = pauses_of(given);
  const auto length = [](const TimeSpan& span) { return span.second - span.first; };
  ASSERT_GE(pauses.size(), 2u);
  ASSERT_GT(length(pauses[pauses.size() - 2]), 2);
  LocalRetimeOptions keep;
  keep.keep_pauses = true;
  for (const Pattern& pattern : {walk, table}) {
    const LocalPace pace = local_pace(hoap1(), pattern, keep);
    ASSERT_TRUE(pace.found) << pace.limited_by;
    const std::vector<TimeSpan> kept = pauses_of(pace.series);
    ASSERT_EQ(kept.size(), pauses.size());
    for (size_t i = 0; i < kept.size(); ++i)
      // The COG of a quicker walk takes longer to come to rest: ln(scale^-2) / omega.
      EXPECT_NEAR(length(kept[i]), length(pauses[i]), 0.2) << i;
    double paused = 0;
    for (const BindingLimit& limit : pace.binding)
      if (limit.limit == "pause") paused = limit.share;
    EXPECT_GT(paused * pace.series.duration(), 2);
    EXPECT_LT(pace.scale, 0.95);
    const LocalPace shrunk = local_pace(hoap1(), pattern);
    ASSERT_TRUE(shrunk.found) << shrunk.limited_by;
    EXPECT_LT(shrunk.series.duration(), pace.series.duration() - 1.5);
  }
}

// Gravity determines the time of a flight.
TEST(LocalRetime, AFlightKeepsItsTime) {
  const Pattern jump = jump_pattern(hoap1(), jump_defaults(hoap1()));
  LocalRetimeOptions options;
  options.path.check.profile = "hoap1-strong";
  const LocalPace pace = local_pace(hoap1(), jump, options);
  ASSERT_TRUE(pace.found) << pace.limited_by;
  EXPECT_LT(pace.scale, 0.95);
  const auto flight = [](const Pattern& pattern) {
    for (size_t i = 1; i < pattern.phases.size(); ++i)
      if (pattern.phases[i].support == Support::none)
        return pattern.phases[i].until - pattern.phases[i - 1].until;
    return 0.0;
  };
  EXPECT_NEAR(flight(pace.pattern), flight(jump), 1e-6);
}

// A posture beyond a joint's limit stays beyond it with any timing.
TEST(LocalRetime, APostureThatIsWrongIsTold) {
  const LocalPace pace = local_pace(hoap1(), raised_arms(3, 3));
  EXPECT_FALSE(pace.found);
  EXPECT_TRUE(pace.by_posture);
  EXPECT_NE(pace.limited_by.find("joint_position"), std::string::npos) << pace.limited_by;
}

TEST(LocalRetime, TheSameForAnyNumberOfThreads) {
  const Pattern walk = walk_pattern(hoap1(), {.steps = 1, .stride = 0.03});
  LocalRetimeOptions one;
  one.path.check.threads = 1;
  LocalRetimeOptions three;
  three.path.check.threads = 3;
  EXPECT_EQ(local_pace(hoap1(), walk, one).pattern.table->theta,
            local_pace(hoap1(), walk, three).pattern.table->theta);
}

// Without constants of its servos a robot cannot be simulated; then the first timing is the result.
TEST(LocalRetime, ARobotThatCannotBeSimulatedIsNotPlayed) {
  RobotDescription description = hoap1().description();
  description.servos.clear();
  const RobotModel model(description);
  const Pattern walk = walk_pattern(model, {.steps = 2});
  LocalRetimeOptions options;
  options.path.most_margin = 0;
  options.world = World{};
  const LocalPace pace = local_pace(model, walk, options);
  ASSERT_TRUE(pace.found) << pace.limited_by;
  EXPECT_FALSE(pace.stands.has_value());
  EXPECT_NE(pace.not_simulated.find("servo"), std::string::npos) << pace.not_simulated;
}

// A timing that brings the ZMP to the edge of the soles falls in open loop. If it has to stand
// where the uniform pace stands, the result stands.
TEST(LocalRetime, StandsWhereTheUniformPaceStands) {
  const Pattern walk = walk_pattern(hoap1(), {.steps = 8});
  LocalRetimeOptions options;
  options.path.most_margin = 0;
  const LocalPace quick = local_pace(hoap1(), walk, options);
  ASSERT_TRUE(quick.found);
  ASSERT_NE(open_loop(hoap1(), quick.series), Outcome::stands) << "otherwise this shows nothing";
  options.world = World{};
  const LocalPace safe = local_pace(hoap1(), walk, options);
  ASSERT_TRUE(safe.found);
  EXPECT_EQ(safe.stands, true);
  EXPECT_TRUE(safe.report.consistent);
  EXPECT_EQ(open_loop(hoap1(), safe.series), Outcome::stands);
  EXPECT_GT(safe.scale, quick.scale);
}

// A walk whose ZMP is near the heel or the toes of the standing foot: the first timing keeps it
// there and falls in open loop, but the uniform pace stands. Other timings are tried, and the
// result stands. Near the toes, the ZMP stays 15 mm inside the soles, so no margin shows the
// danger.
TEST(LocalRetime, OtherTimingsAreTriedIfTheFirstFalls) {
  struct Case {
    double forward, cog_height;  // [m]; height 0 is the default
  };
  for (const auto& [forward, cog_height] : {Case{-0.034, 0}, Case{0.030, 0.236}}) {
    Pattern walk = walk_pattern(hoap1(), {.steps = 8, .cog_height = cog_height});
    const FootPlan feet(hoap1(), walk);
    for (Keyframe& key : walk.keyframes) {
      if (!key.zmp ||
          (key.zmp->place != ZmpKey::Place::left && key.zmp->place != ZmpKey::Place::right))
        continue;
      const Side side = key.zmp->place == ZmpKey::Place::left ? Side::left : Side::right;
      key.zmp = ZmpKey{ZmpKey::Place::point,
                       feet.sole_center(side, key.t).head<2>() + Eigen::Vector2d(forward, 0)};
    }
    LocalRetimeOptions options;
    const LocalPace first = local_pace(hoap1(), walk, options);
    ASSERT_TRUE(first.found) << first.limited_by;
    EXPECT_FALSE(first.stands.has_value());
    ASSERT_NE(open_loop(hoap1(), first.series), Outcome::stands) << "otherwise this shows nothing";
    options.world = World{};
    int others = 0;
    const LocalPace safe =
        fastest_local_pace(hoap1(), walk, "quick.csv", options, [&](const ProgressEvent& event) {
          if (event.detail.find("another timing") != std::string::npos) ++others;
          return true;
        });
    ASSERT_TRUE(safe.found) << safe.limited_by;
    EXPECT_GT(others, 0);
    EXPECT_EQ(safe.stands, true);
    EXPECT_EQ(safe.uniform, safe.binding.empty());
    EXPECT_TRUE(safe.report.consistent);
    EXPECT_EQ(open_loop(hoap1(), safe.series), Outcome::stands);
  }
}

TEST(LocalRetime, RefusesAMarginOutOfBoundsAndANameThatIsNone) {
  const Pattern squat = squat_pattern(hoap1(), {.cycles = 1});
  for (const double margin : {-1.0, 1.5, std::nan("")}) {
    LocalRetimeOptions options;
    options.path.most_margin = margin;
    const std::string message =
        error_message([&] { local_pace(hoap1(), squat, options); }, ErrorCode::usage);
    EXPECT_EQ(message, "the largest margin of the ZMP is " + text::exact(margin) +
                           " m; it must be from 0 to 1 m");
  }
  for (const std::string& name : {std::string(), std::string("a\0b", 3)}) {
    const std::string message =
        error_message([&] { fastest_local_pace(hoap1(), squat, name, {}); }, ErrorCode::usage);
    EXPECT_NE(message.find("needs a file name"), std::string::npos) << message;
  }
}

}  // namespace ayumi::test
