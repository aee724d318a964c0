#include "ayumi/repair/repair.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/motion/pattern_context.hpp"
#include "ayumi/plan/foot_plan.hpp"
#include "ayumi/plan/sample_plan.hpp"
#include "ayumi/repair/correction_problem.hpp"
#include "ayumi/repair/motion_change.hpp"
#include "ayumi/repair/policy.hpp"
#include "ayumi/repair/repair_pattern.hpp"
#include "tests/support/error_message.hpp"
#include "tests/support/limited_biped.hpp"
#include "tests/support/random_robot.hpp"
#include "tests/support/robot_motions.hpp"
#include "tests/support/ten_faults.hpp"
#include "tests/support/walk.hpp"
#include "tests/support/weighted_change.hpp"

using namespace ayumi;
using namespace ayumi::test;

namespace {

double hill(double t, double center, double width) {
  const double s = (t - center) / width;
  return std::abs(s) < 0.5 ? std::pow(std::cos(M_PI * s), 4) : 0;
}

double middle_of_step(int n, const WalkShape& w = {}) {
  return w.lead + n * w.period + 0.5 * (w.period - w.double_support);
}

const CommandSeries& good_walk() {
  static const CommandSeries series = walk(limited_biped());
  return series;
}

// The trunk jerks back during one step, and the ZMP leaves the sole at the toes by about 10 mm.
CommandSeries zmp_outside() {
  CommandSeries series = good_walk();
  RobotData data(limited_biped());
  for (size_t k = 0; k < series.samples.size(); ++k) {
    CommandSample& s = series.samples[k];
    s.state.base.position.x() -= 0.0145 * hill(k * series.dt, middle_of_step(3), 0.5);
    place_legs(limited_biped(), s.feet, s.state, data);
  }
  complete_series(limited_biped(), series);
  return series;
}

void expect_repaired(const RepairResult& r) {
  ASSERT_EQ(r.status, RepairStatus::repaired) << (r.reasons.empty() ? "" : r.reasons.front());
  EXPECT_TRUE(r.check.consistent);
  EXPECT_LE(r.constraint_violation, 1e-6);
  EXPECT_TRUE(r.reasons.empty());
}

RobotModel hoap1_with(const std::function<void(RobotDescription&)>& change) {
  RobotDescription d = load_robot_description(AYUMI_SOURCE_DIR "/robots/hoap1");
  change(d);
  return RobotModel(d);
}

// A robot whose joint limits, left and right, are 2 degrees inside the range that the walk needs:
// every step exceeds them.
RobotModel hoap1_with_tight(const std::string& joint, const CommandSeries& series) {
  return hoap1_with([&](RobotDescription& d) {
    const RobotModel model(d);
    for (JointDescription& j : d.joints) {
      if (j.name != "l_" + joint && j.name != "r_" + joint) continue;
      j.upper = -1e9;
      for (const CommandSample& s : series.samples)
        j.upper = std::max(j.upper, s.state.theta[model.find_dof(j.name)]);
      j.upper -= 2 * M_PI / 180;
    }
  });
}

CommandSeries hoap1_walk() {
  const RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1");
  return sample(model, walk_pattern(model, {}));
}

}  // namespace

TEST(Repair, ConsistentStaysAsItIs) {
  const RepairResult r = repair(limited_biped(), good_walk());
  EXPECT_EQ(r.status, RepairStatus::already_consistent);
  EXPECT_EQ(r.correction.coefficients.size(), 0);
  EXPECT_EQ(r.max_joint_change, 0);
}

TEST(Repair, ZmpComesInsideAndNothingChangesTwice) {
  const CommandSeries series = zmp_outside();
  ASSERT_LT(check_consistency(limited_biped(), series).summary[FindingKind::support_margin],
            -0.005);
  const RepairResult r = repair(limited_biped(), series);
  expect_repaired(r);
  EXPECT_GT(r.check.summary[FindingKind::support_margin], 0.0019);
  EXPECT_NEAR(r.at, middle_of_step(3), 0.3);
  // The motion only changes around the time of the fault.
  for (size_t k = 0; k < series.samples.size(); ++k) {
    if (std::abs(k * series.dt - middle_of_step(3)) < 0.8) continue;
    ASSERT_EQ(r.series.samples[k].state.theta, series.samples[k].state.theta);
  }
  const RepairResult again = repair(limited_biped(), r.series);
  EXPECT_EQ(again.status, RepairStatus::already_consistent);
}

// Corrections that are made from the result by random changes of the control points of the arms and
// by a random factor do not cost less, if they pass the check with the same ZMP margin.
TEST(Repair, NothingNearbyIsCheaper) {
  const CommandSeries series = zmp_outside();
  RepairOptions options;
  options.zmp_margin = 0.002;
  const RepairResult r = repair(limited_biped(), series, options);
  expect_repaired(r);
  const double least = weighted_change(limited_biped(), series, r.correction);
  Random random(11);
  int feasible = 0;
  for (int i = 0; i < 200 && feasible < 20; ++i) {
    CorrectionTrack other = r.correction;
    const double scale = random.uniform(0.2, 1.5);
    for (Eigen::Index row = 3; row < other.coefficients.rows() - 3; ++row)
      for (Eigen::Index column = 6; column < other.coefficients.cols(); ++column) {
        const std::string& joint = other.joints[column - 6];
        const bool arm = joint.find("shoulder") == 2 || joint.find("elbow") == 2;
        if (arm) other.coefficients(row, column) += 0.002 * random.uniform();
      }
    other.coefficients *= scale;
    const CommandSeries moved = apply_correction(limited_biped(), series, other);
    const ConsistencyReport report = check_consistency(limited_biped(), moved);
    // The ZMP must be as far inside as in the repair, whose program keeps 2.5 mm.
    if (!report.consistent || report.summary[FindingKind::support_margin] < 0.0025) continue;
    ++feasible;
    EXPECT_GE(weighted_change(limited_biped(), series, other), 0.999 * least) << "scale " << scale;
  }
  EXPECT_GE(feasible, 20);
}

TEST(Repair, LockedJointsStayToTheBit) {
  const CommandSeries series = zmp_outside();
  RepairOptions options;
  options.locked_joints = {"l_elbow", "r_elbow", "l_shoulder_pitch"};
  const RepairResult r = repair(limited_biped(), series, options);
  expect_repaired(r);
  for (const std::string& joint : options.locked_joints) {
    const int dof = limited_biped().find_dof(joint);
    for (size_t k = 0; k < series.samples.size(); ++k)
      ASSERT_EQ(r.series.samples[k].state.theta[dof], series.samples[k].state.theta[dof]);
  }
  options.locked_joints = {"l_elbw"};
  EXPECT_THROW(repair(limited_biped(), series, options), Error);
}

TEST(Repair, CommandedQuantitiesAloneNeedNoMotion) {
  CommandSeries series = good_walk();
  for (CommandSample& s : series.samples) s.fz *= 1.1;
  const RepairResult r = repair(limited_biped(), series);
  expect_repaired(r);
  EXPECT_EQ(r.iterations, 0);
  EXPECT_EQ(r.max_joint_change, 0);
  EXPECT_LT(r.check.summary[FindingKind::fz_residual], 1e-9);
}

TEST(Repair, SlippingFootStandsStill) {
  CommandSeries series = good_walk();
  RobotData data(limited_biped());
  for (size_t k = 0; k < series.samples.size(); ++k) {
    CommandSample& s = series.samples[k];
    auto feet = s.feet;
    feet[0].translation().x() += 0.005 * hill(k * series.dt, middle_of_step(2), 0.4);
    place_legs(limited_biped(), feet, s.state, data);
  }
  complete_series(limited_biped(), series);
  const RepairResult r = repair(limited_biped(), series);
  expect_repaired(r);
  EXPECT_LT(r.check.summary[FindingKind::foot_slip], 0.001);
}

TEST(Repair, Hoap1KneesInEveryStep) {
  const CommandSeries series = hoap1_walk();
  const RobotModel model = hoap1_with_tight("knee", series);
  const ConsistencyReport before = check_consistency(model, series);
  ASSERT_FALSE(before.consistent);
  ASSERT_GE(before.findings.size(), 8u);
  const RepairResult r = repair(model, series);
  expect_repaired(r);
  EXPECT_GE(r.max_joint_change, 2 * M_PI / 180);
  EXPECT_LT(r.max_joint_change, 3 * M_PI / 180);
  EXPECT_GT(r.check.summary[FindingKind::support_margin], 0.02);
  RecordProperty("variables", r.variables);
  RecordProperty("constraints", r.constraints);
  RecordProperty("iterations", r.iterations);
}

TEST(Repair, Hoap1SlipperyGround) {
  RepairOptions options;
  options.check.friction = 0.10;
  const RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1");
  expect_repaired(repair(model, hoap1_walk(), options));
}

TEST(Repair, Hoap1FastKnees) {
  const CommandSeries series = hoap1_walk();
  const RobotModel model = hoap1_with([](RobotDescription& d) {
    for (auto& [joint, speed] : d.profiles[0].speed)
      if (joint.ends_with("knee")) speed = 3.2;
  });
  ASSERT_FALSE(check_consistency(model, series).consistent);
  expect_repaired(repair(model, series));
}

// The walk begins and ends with the knee beyond its limit: the posture there changes as well.
TEST(Repair, AFaultyFirstPostureIsMovedToo) {
  RobotDescription d = limited_biped_description();
  const int knee = limited_biped().find_dof("l_knee");
  const double first = good_walk().samples[0].state.theta[knee];
  for (JointDescription& joint : d.joints)
    if (joint.name == "l_knee") joint.upper = first - 0.03;
  d.postures["home"]["l_knee"] = first - 0.1;
  const RobotModel model(d);
  const RepairResult r = repair(model, good_walk());
  expect_repaired(r);
  for (const CommandSample* s : {&r.series.samples.front(), &r.series.samples.back()}) {
    EXPECT_LE(s->state.theta[knee], first - 0.03);
    EXPECT_LT(s->state.dtheta.norm(), 1e-6);
  }
}

TEST(Repair, WhatHasNoSolutionIsRefusedWithReasons) {
  RobotDescription d = limited_biped_description();
  double highest = 0;
  const int knee = limited_biped().find_dof("l_knee");
  for (const CommandSample& s : good_walk().samples)
    highest = std::max(highest, s.state.theta[knee]);
  for (JointDescription& joint : d.joints)
    if (joint.name == "l_knee") joint.upper = highest - 0.03;
  RepairOptions options;
  for (const JointDescription& joint : d.joints) options.locked_joints.push_back(joint.name);
  options.max_iterations = 30;
  const RepairResult r = repair(RobotModel(d), good_walk(), options);
  EXPECT_NE(r.status, RepairStatus::repaired);
  ASSERT_FALSE(r.reasons.empty());
}

// The options are refused even if there is nothing to repair.
TEST(Repair, RefusesOptionsOutOfBounds) {
  const auto refused = [](const std::function<void(RepairOptions&)>& change) {
    RepairOptions options;
    change(options);
    return error_message([&] { repair(limited_biped(), good_walk(), options); }, ErrorCode::usage);
  };
  EXPECT_EQ(refused([](RepairOptions& o) { o.max_iterations = -1; }),
            "the largest number of iterations is -1; it must be from 1 to 10000");
  EXPECT_EQ(refused([](RepairOptions& o) { o.safety = NAN; }),
            "the weight of safety is nan; it must be from 0 to 1e+06");
  EXPECT_EQ(refused([](RepairOptions& o) { o.zmp_margin = NAN; }),
            "the wanted margin of the ZMP is nan m; it must be from 0 to 0.1 m");
}

TEST(Repair, StopsWhenTold) {
  int calls = 0;
  const Progress stop = [&](const ProgressEvent& e) {
    EXPECT_EQ(e.stage, "repair round 1");
    return ++calls < 3;
  };
  EXPECT_THROW(repair(limited_biped(), zmp_outside(), {}, stop), Interrupted);
}

TEST(Repair, SameResultTwice) {
  const CommandSeries series = zmp_outside();
  const RepairResult a = repair(limited_biped(), series), b = repair(limited_biped(), series);
  EXPECT_EQ(a.correction.coefficients, b.correction.coefficients);
}

TEST(Repair, JointBeyondItsLimitToTheEndIsBroughtBackThereToo) {
  CommandSeries series = good_walk();
  const int arm = limited_biped().find_dof("l_shoulder_pitch");
  ASSERT_GE(arm, 0);
  const double limit = series.samples[0].state.theta[arm] + 0.2;
  RobotDescription d = limited_biped_description();
  for (JointDescription& joint : d.joints)
    if (joint.name == "l_shoulder_pitch") joint.upper = limit;
  const RobotModel model(d);
  // A slow ramp to 0.05 rad beyond the limit, which is held to the end.
  const double over = 0.25;
  const double T = 0.8 * series.duration();
  for (size_t k = 0; k < series.samples.size(); ++k) {
    const double s = std::min(1.0, k * series.dt / T);
    series.samples[k].state.theta[arm] += over * s * s * s * (10 - 15 * s + 6 * s * s);
  }
  complete_series(model, series);
  const RepairResult r = repair(model, series);
  ASSERT_EQ(r.status, RepairStatus::repaired);
  EXPECT_LE(r.series.samples.back().state.theta[arm], model.dofs()[arm].upper);
  EXPECT_LT(std::abs(r.series.samples.back().state.dtheta[arm]), 1e-6);
}

// The whole table is measured by tests/bench/bad_starts.cpp.
TEST(BadStarts, EndAtTheSameMotion) {
  for (const FaultyMotion& motion : ten_faulty_motions()) {
    if (motion.name != "elbow beyond its limit" && motion.name != "stance foot displaced by 5 mm")
      continue;
    const RepairResult usual = repair(hoap1(), motion.series, motion.options);
    ASSERT_EQ(usual.status, RepairStatus::repaired) << motion.name;
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
      RepairOptions options = motion.options;
      options.random_start = {0.1, seed};
      const RepairResult other = repair(hoap1(), motion.series, options);
      ASSERT_EQ(other.status, RepairStatus::repaired) << motion.name << ", seed " << seed;
      EXPECT_NE(other.iterations, usual.iterations) << "the start was not used";
      EXPECT_LT(motion_distance(other.series, usual.series), 1e-3)
          << motion.name << ", seed " << seed;
    }
  }
}

// A repair that reaches its limit of work ends with the best motion so far that passes, on every
// machine.
TEST(Repair, EndsWithinItsWork) {
  const CommandSeries series = zmp_outside();
  const RepairResult whole = repair(limited_biped(), series);
  RepairOptions options;
  options.most_work = 0.2 * whole.work.amount /
                      std::max(series.duration(), repair_policy::rounds::kShortestForWork);
  const RepairResult r = repair(limited_biped(), series, options);
  EXPECT_EQ(r.status, RepairStatus::repaired);
  EXPECT_LT(r.work.amount, 0.4 * whole.work.amount);  // the iteration that reaches it is finished
}

TEST(Repair, SameBytesForAnyNumberOfThreads) {
  const CommandSeries series = zmp_outside();
  RepairOptions one, many;
  one.check.threads = 1;
  many.check.threads = 5;
  const RepairResult a = repair(limited_biped(), series, one),
                     b = repair(limited_biped(), series, many);
  EXPECT_EQ(a.iterations, b.iterations);
  EXPECT_EQ(a.correction.coefficients, b.correction.coefficients);
}

namespace {

// The largest distance of a sole from its planned place [m].
double farthest_sole(const CommandSeries& plan, const CommandSeries& motion) {
  double most = 0;
  RobotData data(hoap1());
  for (size_t k = 0; k < plan.samples.size(); k += 20) {
    update_positions(hoap1(), motion.samples[k].state, data);
    for (const Side side : {Side::left, Side::right})
      most = std::max(most, (sole_pose(hoap1(), data, side).translation() -
                             plan.samples[k].feet[static_cast<size_t>(side)].translation())
                                .norm());
  }
  return most;
}

Keyframe cog_key(double t, std::optional<double> x, std::optional<double> y,
                 std::optional<double> height) {
  Keyframe key;
  key.t = t;
  key.cog_x = x;
  key.cog_y = y;
  key.cog_height = height;
  return key;
}

// A walk of which only the phases and footholds are known; the posture is that of home.
Pattern plan_of_walk(const WalkParameters& walk) {
  Pattern pattern = walk_pattern(hoap1(), walk);
  pattern.keyframes.assign(1, Keyframe());
  pattern.keyframes[0].posture = "home";
  return pattern;
}

// Both feet stay on the ground.
Pattern plan_of_standing(double duration) {
  Pattern pattern;
  pattern.robot = "hoap1";
  pattern.phases.emplace_back().until = duration;
  return pattern;
}

GeneratedMotion made_of(const Pattern& pattern) {
  return generate(hoap1(), pattern, sample_plan(hoap1(), pattern), {});
}

// Each key of the COG is followed within the tolerance of the check, or the result names it.
void expect_no_key_is_lost(const Pattern& pattern, const GeneratedMotion& made) {
  for (const Keyframe& key : pattern.keyframes) {
    const bool named = std::any_of(made.missed.begin(), made.missed.end(),
                                   [&](const MissedCog& missed) { return missed.t == key.t; });
    const auto k = static_cast<size_t>(std::lround(key.t / made.repair.series.dt));
    const Eigen::Vector3d& cog = made.repair.series.samples[k].cog;
    double off = 0;
    if (key.cog_x) off = std::max(off, std::abs(cog.x() - *key.cog_x));
    if (key.cog_y) off = std::max(off, std::abs(cog.y() - *key.cog_y));
    if (key.cog_height) off = std::max(off, std::abs(cog.z() - *key.cog_height));
    EXPECT_EQ(named, off > tolerances({}, hoap1(), made.repair.series)[FindingKind::cog_residual])
        << key.t << " s: " << off << " m";
  }
}

}  // namespace

// There is only the plan of a walk and of a squat, and no motion: legs and arms are as they are at
// home.
TEST(FromScratch, MakesAMotionOfThePlanAlone) {
  Pattern squat = plan_of_standing(3);
  const double home = default_cog_height(hoap1(), squat);
  squat.keyframes = {cog_key(0, {}, {}, home), cog_key(1.2, {}, {}, 0.88 * home),
                     cog_key(2.6, {}, {}, home)};
  for (const Pattern& pattern :
       {squat, plan_of_walk({.steps = 4}), plan_of_walk({.steps = 3, .stride = 0.01, .turn = 0.15}),
        plan_of_walk({.steps = 2, .stride = 0, .side = 0.02})}) {
    const CommandSeries plan = sample_plan(hoap1(), pattern);
    const GeneratedMotion made = generate(hoap1(), pattern, plan, {});
    expect_repaired(made.repair);
    EXPECT_LT(farthest_sole(plan, made.repair.series), 1e-3);
    EXPECT_TRUE(made.missed.empty());
    if (pattern.phases.size() > 1) continue;
    EXPECT_NEAR(made.repair.series.samples[1200].cog.z(), 0.88 * home, 2e-3);
  }
}

// Its feet take up the COG's speed in 40 ms as those of a small robot do, and then the targets of
// the knees change too fast; a longer time helps.
TEST(FromScratch, AJumpOfATallRobot) {
  const RobotModel& tall = bundled_robot("humanoid30");
  Pattern pattern;
  pattern.robot = "humanoid30";
  pattern.phases.resize(3);
  pattern.phases[0].until = 1.4;
  pattern.phases[1].until = 1.54;
  pattern.phases[1].support = Support::none;
  pattern.phases[2].until = 2.94;
  pattern.keyframes = {cog_key(0, {}, {}, 0.582),     cog_key(1.265, {}, {}, 0.528),
                       cog_key(1.4, {}, {}, 0.57),    cog_key(1.54, {}, {}, 0.57),
                       cog_key(1.675, {}, {}, 0.528), cog_key(2.94, {}, {}, 0.582)};
  const GeneratedMotion made = generate(tall, pattern, sample_plan(tall, pattern), {});
  expect_repaired(made.repair);
  EXPECT_TRUE(made.repair.check.consistent);
}

// The rows of the program hold what the check measures: how high a sole is when its contact begins,
// and steps of the servo targets at a kink. Otherwise errors of a few percent of a limit remain,
// and many programs with finer knots follow.
TEST(FromScratch, JumpsOfATallRobotNeedFewPrograms) {
  const RobotModel& tall = bundled_robot("humanoid30");
  struct Jump {
    double dip_at, dip, take_off, flight;  // [s], [m], [m], [s]
  };
  for (const Jump& jump : {Jump{1.208, 0.516, 0.564, 0.112}, Jump{1.224, 0.492, 0.558, 0.168}}) {
    const double up = 1.4, down = up + jump.flight;
    Pattern pattern;
    pattern.robot = "humanoid30";
    pattern.phases.resize(3);
    pattern.phases[0].until = up;
    pattern.phases[1].until = down;
    pattern.phases[1].support = Support::none;
    pattern.phases[2].until = down + 1.6;
    pattern.keyframes = {cog_key(0, {}, {}, 0.582),
                         cog_key(jump.dip_at, {}, {}, jump.dip),
                         cog_key(up, {}, {}, jump.take_off),
                         cog_key(down, {}, {}, jump.take_off),
                         cog_key(down + up - jump.dip_at, {}, {}, jump.dip),
                         cog_key(down + 1.4, {}, {}, 0.582)};
    const GeneratedMotion made = generate(tall, pattern, sample_plan(tall, pattern), {});
    expect_repaired(made.repair);
    EXPECT_LE(made.repair.work.rounds, 4) << jump.flight;
  }
}

// The COG has a key at the end alone. The straight way to it leads the ZMP out of the support in
// each step; so only the end is a goal.
TEST(FromScratch, AKeyOfTheCogAtTheEndIsAGoal) {
  Pattern pattern = plan_of_walk({.steps = 3});
  const FootPlan feet(hoap1(), pattern);
  const double end = feet.duration();
  const Eigen::Vector3d middle = feet.support_center(end);
  pattern.keyframes.push_back(cog_key(end, middle.x(), middle.y() + 0.008, {}));
  const CommandSeries plan = sample_plan(hoap1(), pattern);
  ASSERT_FALSE(check_consistency(hoap1(), plan).consistent);
  const GeneratedMotion made = generate(hoap1(), pattern, plan, {});
  expect_repaired(made.repair);
  EXPECT_EQ(made.cog, PlannedCog::zmp);
  EXPECT_TRUE(made.missed.empty());
  EXPECT_NEAR(made.repair.series.samples.back().cog.x(), middle.x(), 2e-3);
  EXPECT_NEAR(made.repair.series.samples.back().cog.y(), middle.y() + 0.008, 2e-3);
}

// A sway and a lean while both feet stand, one slow and one so fast that the ZMP would leave the
// support.
TEST(FromScratch, KeysOfTheCogOverTwoFeetAreFollowedOrNamed) {
  for (const double time : {1.2, 0.25}) {
    Pattern pattern = plan_of_standing(1 + 2 * time);
    const Eigen::Vector3d middle = FootPlan(hoap1(), pattern).support_center(0);
    pattern.keyframes = {cog_key(0.5, middle.x(), middle.y(), {}),
                         cog_key(0.5 + time, middle.x(), middle.y() + 0.025, {}),
                         cog_key(0.5 + 2 * time, middle.x() + 0.01, middle.y() - 0.01, {})};
    const GeneratedMotion made = made_of(pattern);
    expect_repaired(made.repair);
    expect_no_key_is_lost(pattern, made);
    EXPECT_TRUE(time < 1 || made.missed.empty());
  }
}

// Where the COG follows the ZMP, it still reaches the last place that its keys give: without any
// step, and after the keys of the ZMP.
TEST(FromScratch, ACogThatFollowsTheZmpReachesItsLastPlace) {
  Pattern lean = plan_of_standing(3);
  const Eigen::Vector3d middle = FootPlan(hoap1(), lean).support_center(0);
  lean.keyframes = {cog_key(2, middle.x() + 0.01, middle.y() + 0.02, {})};
  Pattern keyed = lean;
  Keyframe zmp;
  zmp.t = 1;
  zmp.zmp.emplace().place = ZmpKey::Place::left;
  keyed.keyframes.insert(keyed.keyframes.begin(), zmp);
  for (const Pattern& pattern : {lean, keyed}) {
    const CommandSeries plan = sample_plan(hoap1(), pattern, {}, {}, {.cog = PlannedCog::zmp});
    EXPECT_NEAR(plan.samples.back().cog.x(), middle.x() + 0.01, 1e-3);
    EXPECT_NEAR(plan.samples.back().cog.y(), middle.y() + 0.02, 1e-3);
  }
}

// The ZMP keys of the walk end over the middle of the feet, but the COG shall end beside it.
TEST(FromScratch, KeysOfTheCogAreNotLostBesideKeysOfTheZmp) {
  Pattern pattern = walk_pattern(hoap1(), {.steps = 2});
  pattern.robot = "hoap1";
  const FootPlan feet(hoap1(), pattern);
  const Eigen::Vector3d middle = feet.support_center(feet.duration());
  Keyframe zmp;
  zmp.t = feet.duration() - 0.1;
  zmp.zmp.emplace().place = ZmpKey::Place::center;
  pattern.keyframes.assign(1, Keyframe());
  pattern.keyframes[0].posture = "home";
  pattern.keyframes.push_back(zmp);
  pattern.keyframes.push_back(cog_key(feet.duration(), middle.x(), middle.y() + 0.01, {}));
  const GeneratedMotion made = made_of(pattern);
  expect_repaired(made.repair);
  expect_no_key_is_lost(pattern, made);
  EXPECT_TRUE(made.missed.empty());
}

// The COG is planned so high that the legs do not reach the ground in the strides. Only a default
// says so, so a lower COG is tried, and the result says how much lower it is.
TEST(FromScratch, LegsThatAreTooShortForThePlanAreHelped) {
  Pattern pattern = plan_of_walk({.steps = 2, .stride = 0.05});
  pattern.cog_height = 0.262;
  EXPECT_THROW(sample(hoap1(), pattern), Error);
  const CommandSeries plan = sample_plan(hoap1(), pattern);
  ASSERT_FALSE(check_consistency(hoap1(), plan).consistent);
  const GeneratedMotion made = generate(hoap1(), pattern, plan, {});
  expect_repaired(made.repair);
  EXPECT_NEAR(made.start.samples.front().cog.z(), 0.262 - made.lowered, 1e-3);
  EXPECT_GT(made.lowered, 0);
  // The changes are those from this start.
  EXPECT_EQ(motion_change(hoap1(), made.start, made.repair.series).joint.size,
            made.repair.max_joint_change);
}

// A key gives the height, which is a little above what the legs reach. No other start is tried; the
// program brings the feet from the nearest postures to their places.
TEST(FromScratch, NearestPosturesAreRepaired) {
  Pattern pattern = plan_of_walk({.steps = 2, .stride = 0.05});
  pattern.keyframes[0].cog_height = 0.251;
  EXPECT_THROW(sample(hoap1(), pattern), Error);
  const GeneratedMotion made = made_of(pattern);
  expect_repaired(made.repair);
  EXPECT_GT(made.repair.iterations, 0);
  EXPECT_EQ(made.lowered, 0);
  EXPECT_EQ(made.cog, PlannedCog::keys);
  expect_no_key_is_lost(pattern, made);
}

// A key leads the COG out of the support in the middle of a step, and three iterations do not
// repair that. The motion in which the COG follows the ZMP misses this key and names it.
TEST(FromScratch, AKeyThatCannotBeFollowedIsNamed) {
  Pattern pattern = plan_of_walk({.steps = 2});
  const FootPlan feet(hoap1(), pattern);
  const double end = feet.duration(), half = 0.001 * std::round(500 * end);
  const Eigen::Vector3d middle = feet.support_center(end);
  pattern.keyframes.push_back(cog_key(half, middle.x(), middle.y() + 0.08, {}));
  pattern.keyframes.push_back(cog_key(end, middle.x(), middle.y(), {}));
  RepairOptions options;
  options.max_iterations = 3;
  const GeneratedMotion made = generate(hoap1(), pattern, sample_plan(hoap1(), pattern), options);
  expect_repaired(made.repair);
  EXPECT_EQ(made.cog, PlannedCog::zmp);
  expect_no_key_is_lost(pattern, made);
  ASSERT_EQ(made.missed.size(), 1u);
  EXPECT_EQ(made.missed[0].t, half);
}
