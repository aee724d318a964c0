#include "ayumi/author/edit/edit.hpp"

#include <gtest/gtest.h>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/sim/simulate.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi::test {
namespace {

// A walk that uses every track, and that is not its own mirror image in any of them.
Pattern rich() {
  Pattern p = walk_pattern(hoap1(), {.steps = 3, .turn = 0.05, .side = 0.01});
  p.robot = "hoap1";
  p.postures["wave"] = {{"l_shoulder_pitch", 0.3}, {"l_shoulder_roll", 0.5}, {"r_elbow", -0.7}};
  Keyframe& key = p.keyframes[1];
  key.posture = "wave";
  key.joints = {{"l_elbow", -0.4}, {"r_shoulder_twist", 0.2}};
  key.torso = Eigen::Vector3d(0.02, 0.03, -0.01);
  key.weights = {{"l_knee", 2.0}};
  Push push{.magnitude = 0.5, .direction = {0.6, 0.8, 0}};
  p.scenario.push_back({.at = 1.0, .duration = 0.02, .what = push});
  push.kind = PushKind::torque;
  push.on = hoap1().links().back().name;
  push.point = Eigen::Vector3d(0.01, 0.02, 0.03);
  p.scenario.push_back({.at = 1.0, .duration = 0.02, .what = push});
  p.world.slope = Eigen::Vector2d(0.02, 0.01);
  CorrectionTrack track;
  track.spacing = 0.5;
  track.joints = {"l_knee", "r_hip_roll"};
  track.coefficients = Eigen::MatrixXd::Random(5, 8) * 1e-3;
  p.correction = track;
  return p;
}

TEST(Mirror, TwiceIsIdentity) {
  const Pattern p = rich();
  const Pattern once = mirrored(hoap1(), p), twice = mirrored(hoap1(), once);
  EXPECT_NE(pattern_text(once), pattern_text(p));
  EXPECT_EQ(pattern_text(twice), pattern_text(p));
}

TEST(Mirror, TwiceIsIdentityOfATable) {
  Pattern p = walk_pattern(hoap1(), {.steps = 2});
  p = baked(hoap1(), p, sample(hoap1(), p), "t.csv");
  const Pattern twice = mirrored(hoap1(), mirrored(hoap1(), p));
  EXPECT_EQ(twice.table->theta, p.table->theta);
  EXPECT_EQ(twice.table->joints, p.table->joints);
  for (size_t k = 0; k < p.table->base.size(); ++k) {
    EXPECT_EQ(twice.table->base[k].position, p.table->base[k].position);
    EXPECT_EQ(twice.table->base[k].attitude.coeffs(), p.table->base[k].attitude.coeffs());
    EXPECT_EQ(twice.table->zmp[k], p.table->zmp[k]);
  }
}

// In a table that has the joints of one side only, they are renamed to those of the other side.
TEST(Mirror, OneSidedTable) {
  Pattern p = stand_pattern(hoap1(), 1.0);
  p.table.emplace();
  p.table->joints = {"l_elbow"};
  p.table->theta = Eigen::MatrixXd::Constant(1001, 1, -0.5);
  const Pattern once = mirrored(hoap1(), p);
  EXPECT_EQ(once.table->joints, std::vector<std::string>{"r_elbow"});
  EXPECT_EQ(once.table->theta(3, 0), -0.5);
}

// The mirrored pattern has the mirror image of the motion.
TEST(Mirror, MotionIsTheMirrorImage) {
  Pattern p = walk_pattern(hoap1(), {.steps = 2, .turn = 0.1});
  const CommandSeries a = sample(hoap1(), p), b = sample(hoap1(), mirrored(hoap1(), p));
  const MirrorMap map = mirror_map(hoap1());
  ASSERT_EQ(a.samples.size(), b.samples.size());
  for (size_t k = 0; k < a.samples.size(); k += 37) {
    const CommandSample &s = a.samples[k], &m = b.samples[k];
    EXPECT_NEAR(s.cog.x(), m.cog.x(), 1e-5);
    EXPECT_NEAR(s.cog.y(), -m.cog.y(), 1e-5);
    EXPECT_NEAR(s.zmp.y(), -m.zmp.y(), 1e-7);
    for (int dof = 0; dof < hoap1().dof_count(); ++dof)
      EXPECT_NEAR(map.sign[dof] * s.state.theta[dof], m.state.theta[map.dof[dof]], 1e-3);
  }
}

// Under its mirrored ground and disturbances, the mirrored pattern runs like the mirror image of
// the run.
TEST(Mirror, TheRunIsTheMirrorImage) {
  Pattern p = stand_pattern(hoap1(), 1.5);
  p.robot = "hoap1";
  p.world.motions = {{0.2, 0.6, {.tilt = {0.01, 0.005}, .shift = {0, 0.004, 0}}}};
  p.world.patches = {{{-0.2, 0}, {0.2, 0.2}, 0.4}};
  p.world.blocks = {{.low = {-0.06, 0.02}, .high = {-0.02, 0.08}, .height = 0.0005}};
  const auto lasting = [&](const auto& what) { p.scenario.push_back({0.1, 1.0, what}); };
  lasting(Push{.kind = PushKind::force,
               .magnitude = 0.5,
               .on = "l_forearm",
               .point = {0, 0.01, -0.03},
               .direction = {0.6, 0.8, 0}});
  lasting(Payload{.on = "r_forearm", .point = {0, 0.01, 0}, .mass = 0.1});
  lasting(FloorPath{.tilt = {0.01, 0}, .shift = {0.002, -0.003, 0}});
  lasting(Bump{.foot = Side::left, .place = {0.02, 0.01}, .height = 0.001});
  lasting(SensorBias{.tilt = {0.01, 0}, .gyro = {0.02, 0, 0.01}, .load = 0.1});
  lasting(EncoderOffset{.joint = "l_ankle_roll", .offset = 0.01});
  lasting(JointFriction{.joint = "l_knee", .coulomb = 0.1, .viscous = 0.01});
  lasting(GainLoss{.joint = "r_hip_roll", .share = 0.3});
  const auto run = [](const Pattern& pattern) {
    SimulateOptions options;
    options.controller.type = ControllerKind::dtad;
    options.world = pattern.world;
    options.scenario = pattern.scenario;
    return simulate(hoap1(), sample(hoap1(), pattern), options);
  };
  const SimulationLog a = run(p), b = run(mirrored(hoap1(), p));
  ASSERT_EQ(a.samples.size(), b.samples.size());
  double aside = 0;
  for (size_t k = 0; k < a.samples.size(); k += 10) {
    const Eigen::Vector3d &here = a.samples[k].cog, &there = b.samples[k].cog;
    aside = std::max(aside, std::abs(here.y() - a.samples[0].cog.y()));
    ASSERT_LT((here - Eigen::Vector3d(there.x(), -there.y(), there.z())).norm(), 1e-4) << k;
  }
  EXPECT_GT(aside, 0.003) << "the disturbances move the COG aside";
  EXPECT_EQ(pattern_text(mirrored(hoap1(), mirrored(hoap1(), p))), pattern_text(p));
}

TEST(Mirror, MapOfHoap1) {
  const MirrorMap map = mirror_map(hoap1());
  for (const auto& [left, right, sign] :
       {std::tuple{"l_hip_yaw", "r_hip_yaw", -1}, std::tuple{"l_ankle_roll", "r_ankle_roll", -1},
        std::tuple{"l_knee", "r_knee", 1}, std::tuple{"l_shoulder_roll", "r_shoulder_roll", -1},
        std::tuple{"l_elbow", "r_elbow", 1}}) {
    EXPECT_EQ(map.dof[hoap1().find_dof(left)], hoap1().find_dof(right)) << left;
    EXPECT_EQ(map.sign[hoap1().find_dof(left)], sign) << left;
  }
}

TEST(Retime, HalfThenDoubleIsIdentity) {
  Pattern p = rich();
  p.keyframes[2].fz = 60;
  const Pattern back = retimed(hoap1(), retimed(hoap1(), p, 0.5), 2);
  EXPECT_NEAR(*back.keyframes[2].fz, 60, 1e-9);
  Pattern exact = back;
  exact.keyframes[2].fz = 60;
  EXPECT_EQ(pattern_text(exact), pattern_text(p));
  EXPECT_EQ(pattern_text(retimed(hoap1(), p, 1)), pattern_text(p));
}

TEST(Retime, ForceKeysKeepTheAccelerationOfTheNewTime) {
  Pattern p = rich();
  const double weight = hoap1().mass() * kGravity;
  p.keyframes[2].fz = weight + 5;
  EXPECT_NEAR(*retimed(hoap1(), p, 0.5).keyframes[2].fz, weight + 20, 1e-9);
}

// A part takes longer, and everything after it comes later by the same time. If the part is the
// whole pattern, the result is the pattern as a whole retimed.
TEST(Retime, APartIsStretchedAlone) {
  Pattern p = walk_pattern(hoap1(), {.steps = 2});
  const double begin = p.phases[0].until, end = p.phases[1].until, whole = p.duration();
  const Pattern slow = stretched(hoap1(), p, begin, end, 1.5);
  EXPECT_NEAR(slow.duration(), whole + 0.5 * (end - begin), 1e-12);
  EXPECT_EQ(slow.phases[0].until, begin);
  EXPECT_NEAR(slow.phases[1].until - begin, 1.5 * (end - begin), 1e-12);
  for (size_t i = 0; i < p.keyframes.size(); ++i) {
    const double t = p.keyframes[i].t, moved = slow.keyframes[i].t - t;
    EXPECT_NEAR(moved, 0.5 * (std::clamp(t, begin, end) - begin), 1e-12) << t;
  }
  const Pattern all = stretched(hoap1(), p, 0, whole, 1.25);
  EXPECT_NEAR(all.duration(), retimed(hoap1(), p, 1.25).duration(), 1e-12);
  EXPECT_THROW(stretched(hoap1(), p, end, begin, 2), Error);
  p = baked(hoap1(), p, sample(hoap1(), p), "t.csv");
  EXPECT_THROW(stretched(hoap1(), p, begin, end, 2), Error);
}

// The path of a table stays, and its forces are those of the new timing.
TEST(Retime, TableKeepsItsPath) {
  Pattern p = walk_pattern(hoap1(), {.steps = 2});
  p = baked(hoap1(), p, sample(hoap1(), p), "t.csv");
  const Pattern slow = retimed(hoap1(), p, 2);
  EXPECT_EQ(slow.table->theta, p.table->theta);
  EXPECT_TRUE(slow.table->zmp.empty());
  const CommandSeries a = sample(hoap1(), p), b = sample(hoap1(), slow);
  const size_t k = a.samples.size() / 2;
  EXPECT_LT((a.samples[k].state.theta - b.samples[2 * k].state.theta).norm(), 1e-9);
  EXPECT_LT((a.samples[k].state.dtheta - 2 * b.samples[2 * k].state.dtheta).norm(), 1e-4);
}

// Goals move as their controller decides: they can be mirrored, but not baked or retimed.
TEST(Mirror, GoalsOfPhases) {
  Pattern p = stand_pattern(hoap1(), 1.0);
  p.phases[0].viip = StepGoal{4, {0.05, 0.02}, 0.1};
  const auto goal = std::get<StepGoal>(*mirrored(hoap1(), p).phases[0].viip);
  EXPECT_EQ(goal.velocity, Eigen::Vector2d(0.05, -0.02));
  EXPECT_EQ(goal.turn, -0.1);
  EXPECT_THROW(retimed(hoap1(), p, 2), Error);
  EXPECT_THROW(baked(hoap1(), p, {}, "t.csv"), Error);
}

TEST(Retime, RefusesSenselessScales) {
  for (const double scale : {0.0, -1.0, 1e6, std::nan("")})
    EXPECT_THROW(retimed(hoap1(), rich(), scale), Error) << scale;
}

// A baked pattern is the same motion up to rounding.
TEST(Bake, SamplesToTheSameMotion) {
  const Pattern p = rich();
  Pattern plain = p;
  plain.correction.reset();
  const CommandSeries a = sample(hoap1(), plain);
  const Pattern dense = baked(hoap1(), plain, a, "t.csv");
  const CommandSeries b = sample(hoap1(), dense);
  ASSERT_EQ(a.samples.size(), b.samples.size());
  for (size_t k = 0; k < a.samples.size(); k += 17) {
    const CommandSample &s = a.samples[k], &t = b.samples[k];
    EXPECT_LT((s.state.theta - t.state.theta).norm(), 1e-12);
    EXPECT_LT((s.state.base.position - t.state.base.position).norm(), 1e-12);
    EXPECT_EQ(s.cog, t.cog);
    EXPECT_EQ(s.zmp, t.zmp);
    EXPECT_EQ(s.fz, t.fz);
    EXPECT_EQ(s.support, t.support);
    for (int foot : {0, 1}) EXPECT_TRUE(s.feet[foot].isApprox(t.feet[foot], 1e-12));
  }
  EXPECT_EQ(b.joint_weight, a.joint_weight);
  EXPECT_EQ(dense.keyframes.size(), 1u);  // only the keyframe of the weights is left
}

// If one motion leads a foot by keys and the other by swings, both motions are joined in a table.
TEST(Join, ATableOfKeysAndSwingsOfAFoot) {
  KickParameters low;
  low.height = 0.018;
  low.cog_height = starting_height(hoap1());  // a kick of its own would begin lower than the walk
  const Pattern walk = walk_pattern(hoap1(), {.steps = 3});
  const Pattern kick = kick_pattern(hoap1(), low);
  const std::vector<std::pair<Pattern, Pattern>> orders = {{walk, kick}, {kick, walk}};
  for (const auto& [first, second] : orders) {
    const CommandSeries a = sample(hoap1(), first), b = sample(hoap1(), second);
    for (const double over : {0.0, 0.8}) {
      const Pattern both = joined(hoap1(), {first, a}, {second, b}, over, "t.csv");
      const CommandSeries all = sample(hoap1(), both);
      ASSERT_GE(all.samples.size() + 1, a.samples.size() + b.samples.size());
      for (size_t k = 0; k + 1 < a.samples.size(); ++k)
        for (const size_t foot : {0, 1})
          ASSERT_LT(
              (all.samples[k].feet[foot].translation() - a.samples[k].feet[foot].translation())
                  .norm(),
              1e-4)
              << k;
      // The second motion takes place elsewhere, but its feet have the same place relative to each
      // other.
      const auto between = [](const CommandSample& s) {
        return (s.feet[0].inverse() * s.feet[1]).translation().eval();
      };
      const size_t begin = all.samples.size() - b.samples.size();
      for (size_t k = 0; k < b.samples.size(); ++k)
        ASSERT_LT((between(all.samples[begin + k]) - between(b.samples[k])).norm(), 2e-4) << k;
    }
  }
}

// A motion may begin a little beside the end of the one before. In a table, this difference fades,
// so no joint jumps within one tick.
TEST(Join, ASmallDifferenceAtTheJoinFades) {
  const auto elbow = [](double begin, double end) {
    Pattern pattern = stand_pattern(hoap1(), 1);
    pattern.keyframes.emplace_back();
    pattern.keyframes.back().t = 1;
    pattern.keyframes.front().joints["r_elbow"] = begin;
    pattern.keyframes.back().joints["r_elbow"] = end;
    return pattern;
  };
  const Pattern first = elbow(-0.5, -0.6), second = elbow(-0.6001, -0.5);
  const CommandSeries a = sample(hoap1(), first), b = sample(hoap1(), second);
  const CommandSeries all = sample(hoap1(), joined(hoap1(), {first, a}, {second, b}, 0, "t.csv"));
  const int elbow_dof = hoap1().find_dof("r_elbow");
  const size_t join = a.samples.size() - 1;
  for (size_t k = join - 5; k < join + 20; ++k)
    EXPECT_LT(std::abs(all.samples[k].acceleration[6 + elbow_dof]), 0.5) << k;
  EXPECT_NEAR(all.samples[join + 200].state.theta[elbow_dof], b.samples[200].state.theta[elbow_dof],
              1e-12);
}

}  // namespace
}  // namespace ayumi::test
