// Sampling a walk: the full model agrees with the pattern, and nothing depends on the place of the
// world's origin, on which side is called left, or on the start time.
#include "ayumi/plan/sample.hpp"

#include <gtest/gtest.h>

#include <chrono>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/polygon.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/motion/differentiate.hpp"
#include "ayumi/motion/pattern_context.hpp"
#include "tests/support/biped.hpp"
#include "tests/support/error_message.hpp"
#include "tests/support/random_robot.hpp"

namespace ayumi {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

WalkParameters short_walk() {
  WalkParameters p;
  p.steps = 3;
  p.stride = 0.04;
  p.period = 0.6;
  p.lift = 0.02;
  return p;
}

// The largest distance between the commanded ZMP and that of the full model [m].
double worst_zmp_error(const RobotModel& model, const CommandSeries& series) {
  RobotData data(model);
  double worst = 0;
  for (const CommandSample& sample : series.samples)
    worst = std::max(worst, (full_model_reaction(model, sample, data).zmp - sample.zmp).norm());
  return worst;
}

double least_margin(const RobotModel& model, const CommandSeries& series) {
  RobotData data(model);
  double least = 1;
  for (const CommandSample& sample : series.samples) {
    std::vector<Eigen::Vector2d> points;
    for (const Side side : {Side::left, Side::right})
      if (supports(sample.support, side))
        for (const Eigen::Vector2d& v : model.sole(side).polygon)
          points.push_back(
              (sample.feet[static_cast<int>(side)] * Vector3d(v.x(), v.y(), 0)).head<2>());
    const Vector3d zmp = full_model_reaction(model, sample, data).zmp;
    least = std::min(least, ConvexPolygon(points).margin(zmp.head<2>()));
  }
  return least;
}

TEST(Sample, FullModelZmpMeetsTheKeys) {
  const RobotModel model = test::biped();
  WalkParameters straight = short_walk(), turning = straight, sideways = straight;
  turning.turn = 0.2;
  sideways.stride = 0;
  sideways.side = 0.03;
  for (const WalkParameters& p : {straight, turning, sideways}) {
    const Pattern pattern = walk_pattern(model, p);
    const CommandSeries series = sample(model, pattern);
    EXPECT_LT(worst_zmp_error(model, series), 0.0005) << pattern.name;
    EXPECT_GT(least_margin(model, series), 0.025) << pattern.name;
    // With the point mass alone, a larger error is left.
    Pattern point_mass = pattern;
    point_mass.full_model = false;
    EXPECT_GT(worst_zmp_error(model, sample(model, point_mass)), 0.002) << pattern.name;
  }
}

TEST(Sample, SolesStandStillAndThePostureMeetsTheCommand) {
  const RobotModel model = test::biped();
  const CommandSeries series = sample(model, walk_pattern(model, short_walk()));
  RobotData data(model);
  std::array<Eigen::Isometry3d, 2> held;
  double lifted = 0;
  for (size_t k = 0; k < series.samples.size(); ++k) {
    const CommandSample& now = series.samples[k];
    update_positions(model, now.state, data);
    EXPECT_LT((data.cog - now.cog).norm(), 1e-10);
    for (const Side side : {Side::left, Side::right}) {
      const int s = static_cast<int>(side);
      const Eigen::Isometry3d sole = sole_pose(model, data, side);
      EXPECT_LT((sole.matrix() - now.feet[s].matrix()).cwiseAbs().maxCoeff(), 1e-9);
      lifted = std::max(lifted, sole.translation().z());
      const bool carried = k > 0 && supports(series.samples[k - 1].support, side);
      if (!carried) held[s] = sole;
      if (carried && supports(now.support, side)) {
        EXPECT_LT((sole.matrix() - held[s].matrix()).cwiseAbs().maxCoeff(), 1e-9);
      }
    }
  }
  EXPECT_NEAR(lifted, 0.02, 1e-6);
}

TEST(Sample, VelocitiesAndAccelerationsAreDerivatives) {
  const RobotModel model = test::biped();
  const CommandSeries series = sample(model, walk_pattern(model, short_walk()));
  RobotData data(model);
  for (size_t k = 1; k + 1 < series.samples.size(); k += 7) {
    const CommandSample& a = series.samples[k - 1];
    const CommandSample& now = series.samples[k];
    const CommandSample& b = series.samples[k + 1];
    // Integrating the mean of the velocities at the two neighbouring midpoints leads to the next
    // sample.
    const RobotState moved = test::integrate(a.state, now.state.velocity(), 2 * series.dt);
    EXPECT_LT((moved.theta - b.state.theta).norm(), 2e-6);
    EXPECT_LT((moved.base.position - b.state.base.position).norm(), 1e-6);
    EXPECT_LT(moved.base.attitude.angularDistance(b.state.base.attitude), 1e-6);
    const VectorXd difference = (b.state.velocity() - a.state.velocity()) / (2 * series.dt);
    EXPECT_LT((difference - now.acceleration).cwiseAbs().maxCoeff(),
              0.05 + 0.02 * now.acceleration.cwiseAbs().maxCoeff());
    // The rate of the COG is computed again, by the floating Jacobian.
    update_velocities(model, now.state, data);
    EXPECT_LT((data.dcog - now.dcog).norm(), 1e-5);
  }
  EXPECT_LT(series.samples.front().state.velocity().cwiseAbs().maxCoeff(), 2e-3);
  EXPECT_LT(series.samples.back().state.velocity().cwiseAbs().maxCoeff(), 2e-3);
}

Pattern moved(const RobotModel& model, Pattern pattern, double yaw, const Vector3d& by) {
  const Eigen::Matrix3d R = rpy_to_matrix({0, 0, yaw});
  const auto move = [&](Foothold& foot) {
    foot.position = R * foot.position + by;
    foot.rpy.z() += yaw;
  };
  RobotData data(model);
  const CommandSeries series = sample(model, pattern, {.dt = 0.1});
  for (const Side side : {Side::left, Side::right}) {
    Foothold foot;
    const Eigen::Isometry3d& start = series.samples.front().feet[static_cast<int>(side)];
    foot.position = start.translation();
    foot.rpy = matrix_to_rpy(start.linear());
    move(foot);
    pattern.start_feet[static_cast<size_t>(side)] = foot;
  }
  for (Phase& phase : pattern.phases)
    if (phase.swing) move(phase.swing->to);
  return pattern;
}

TEST(Sample, TheWorldMayBeTurnedAndMoved) {
  const RobotModel model = test::biped();
  WalkParameters p = short_walk();
  p.turn = 0.1;
  const Pattern pattern = walk_pattern(model, p);
  const Vector3d by(3, -2, 0);
  const double yaw = 2.5;
  const Eigen::Matrix3d R = rpy_to_matrix({0, 0, yaw});
  const CommandSeries here = sample(model, pattern);
  const CommandSeries there = sample(model, moved(model, pattern, yaw, by));
  ASSERT_EQ(here.samples.size(), there.samples.size());
  for (size_t k = 0; k < here.samples.size(); k += 5) {
    const CommandSample& a = here.samples[k];
    const CommandSample& b = there.samples[k];
    EXPECT_LT((a.state.theta - b.state.theta).norm(), 1e-8);
    EXPECT_LT((R * a.cog + by - b.cog).norm(), 1e-9);
    EXPECT_LT((R * a.zmp + by - b.zmp).norm(), 1e-9);
    EXPECT_LT((R * a.dcog - b.dcog).norm(), 1e-7);
    EXPECT_NEAR(a.fz, b.fz, 1e-3);
  }
}

TEST(Sample, MirroredPatternGivesMirroredMotion) {
  const RobotModel model = test::biped();
  WalkParameters p = short_walk();
  p.side = 0.02;
  p.turn = 0.1;
  WalkParameters q = p;
  q.side = -p.side;
  q.turn = -p.turn;
  q.first_swing = other(p.first_swing);
  const CommandSeries a = sample(model, walk_pattern(model, p));
  const CommandSeries b = sample(model, walk_pattern(model, q));
  ASSERT_EQ(a.samples.size(), b.samples.size());
  for (size_t k = 0; k < a.samples.size(); k += 5) {
    EXPECT_NEAR(a.samples[k].cog.y(), -b.samples[k].cog.y(), 1e-9);
    EXPECT_NEAR(a.samples[k].cog.x(), b.samples[k].cog.x(), 1e-9);
    for (const char* joint : {"hip_pitch", "knee", "ankle_pitch"})
      EXPECT_NEAR(a.samples[k].state.theta[model.find_dof(std::string("l_") + joint)],
                  b.samples[k].state.theta[model.find_dof(std::string("r_") + joint)], 1e-8);
    for (const char* joint : {"hip_yaw", "hip_roll", "ankle_roll"})
      EXPECT_NEAR(a.samples[k].state.theta[model.find_dof(std::string("l_") + joint)],
                  -b.samples[k].state.theta[model.find_dof(std::string("r_") + joint)], 1e-8);
  }
}

TEST(Sample, StartingLaterIsTheSameMotionLater) {
  const RobotModel model = test::biped();
  const Pattern pattern = walk_pattern(model, short_walk());
  Pattern later = pattern;
  const double shift = 0.5;
  for (Phase& phase : later.phases) phase.until += shift;
  for (size_t i = 1; i < later.keyframes.size(); ++i) later.keyframes[i].t += shift;
  const CommandSeries a = sample(model, pattern), b = sample(model, later);
  const auto offset = static_cast<size_t>(std::lround(shift / a.dt));
  ASSERT_EQ(a.samples.size() + offset, b.samples.size());
  // Only the small bump that allows a start from rest differs, and it decays.
  for (size_t k = 0; k < a.samples.size(); k += 5)
    EXPECT_LT((a.samples[k].cog - b.samples[k + offset].cog).norm(), 1e-3);
  for (size_t k = 1700; k < a.samples.size(); k += 5)
    EXPECT_LT((a.samples[k].cog - b.samples[k + offset].cog).norm(), 1e-5);
}

TEST(Sample, WeightTimesAccelerationIsTheVerticalForce) {
  const RobotModel model = test::biped();
  Pattern pattern = walk_pattern(model, short_walk());
  Keyframe key;
  key.t = 1.6;
  key.cog_height = 0.245;
  key.place.inside = "/keyframes/x";
  auto at = pattern.keyframes.begin();
  while (at != pattern.keyframes.end() && at->t < key.t) ++at;
  if (at != pattern.keyframes.end() && at->t == key.t) key.t += 0.0005;
  pattern.keyframes.insert(at, key);
  const CommandSeries series = sample(model, pattern);
  RobotData data(model);
  double most = 0;
  for (const CommandSample& now : series.samples) {
    EXPECT_NEAR(full_model_reaction(model, now, data).force.z(), now.fz, 0.02);
    most = std::max(most, std::abs(now.fz - model.mass() * kGravity));
  }
  EXPECT_GT(most, 0.1);
  EXPECT_LT(worst_zmp_error(model, series), 0.0005);
  EXPECT_EQ(series.origin.at("cog_height"), "keys");
}

TEST(Sample, AWalkUpASlopeOfSteps) {
  const RobotModel model = test::biped();
  Pattern pattern = walk_pattern(model, short_walk());
  double height = 0;
  for (Phase& phase : pattern.phases)
    if (phase.swing) {
      phase.swing->to.position.z() = std::min(height += 0.008, 0.024);
    }
  const CommandSeries series = sample(model, pattern);
  EXPECT_LT(worst_zmp_error(model, series), 0.001);
  EXPECT_NEAR(series.samples.back().cog.z() - series.samples.front().cog.z(), 0.024, 1e-9);
}

TEST(Sample, WithoutZmpOrCogTheFeetSayWhereTheZmpIs) {
  const RobotModel model = test::biped();
  Pattern pattern = walk_pattern(model, short_walk());
  pattern.keyframes.clear();
  const CommandSeries series = sample(model, pattern);
  EXPECT_LT(worst_zmp_error(model, series), 0.0005);
  EXPECT_GT(least_margin(model, series), 0.025);
  EXPECT_NE(series.origin.at("zmp").find("phases"), std::string::npos);
}

TEST(Sample, CogKeysGiveZmpAndForceOfTheFullModel) {
  const RobotModel model = test::biped();
  Pattern pattern;
  pattern.phases = {{2.0, Support::both, {}}};
  Keyframe key;
  key.t = 1.0;
  key.cog_x = 0.02;
  key.cog_y = 0.01;
  key.cog_height = 0.25;
  pattern.keyframes = {key};
  const CommandSeries series = sample(model, pattern);
  EXPECT_LT(worst_zmp_error(model, series), 1e-9);
  EXPECT_NEAR(series.samples.back().cog.x(), 0.02, 1e-12);
  EXPECT_NEAR(series.samples.back().cog.z(), 0.25, 1e-12);
  // One coordinate is keyed, and the other is solved.
  pattern.keyframes[0].cog_y.reset();
  const CommandSeries half = sample(model, pattern);
  EXPECT_NEAR(half.samples.back().cog.x(), 0.02, 1e-12);
  EXPECT_NEAR(half.samples.back().cog.y(), 0.0, 1e-9);
  EXPECT_NE(half.origin.at("cog").find("computed in y"), std::string::npos);
}

TEST(Sample, TorsoKeysTiltTheTrunkAndPostureKeysMoveTheArms) {
  const RobotModel model = test::biped({.waist = true});
  Pattern pattern;
  pattern.phases = {{2.0, Support::both, {}}};
  Keyframe key;
  key.t = 1.0;
  key.torso = Vector3d(0.05, 0.1, 0.2);
  key.joints = {{"l_shoulder", 0.7}, {"waist", 0.3}};
  pattern.keyframes = {key};
  const CommandSeries series = sample(model, pattern);
  RobotData data(model);
  update_positions(model, series.samples.back().state, data);
  EXPECT_LT((data.rotation[model.trunk_body()] - rpy_to_matrix(*key.torso)).norm(), 1e-9);
  EXPECT_NEAR(series.samples.back().state.theta[model.find_dof("l_shoulder")], 0.7, 1e-12);
  EXPECT_LT(worst_zmp_error(model, series), 0.0005);
}

TEST(Sample, SamePatternSameBytes) {
  const RobotModel model = test::biped();
  const Pattern pattern = walk_pattern(model, short_walk());
  const CommandSeries a = sample(model, pattern), b = sample(model, pattern);
  for (size_t k = 0; k < a.samples.size(); ++k) {
    EXPECT_EQ(a.samples[k].state.theta, b.samples[k].state.theta);
    EXPECT_EQ(a.samples[k].acceleration, b.samples[k].acceleration);
  }
}

// There are more samples than several threads take at once, with the COG solved and with the COG
// keyed.
TEST(Sample, SameBytesForAnyNumberOfThreads) {
  const RobotModel model = test::biped();
  Pattern walk = walk_pattern(model, short_walk());
  Pattern keyed = walk;
  for (Keyframe& key : keyed.keyframes) key.zmp.reset();
  Keyframe still;
  still.t = 0.1;
  still.cog_x = still.cog_y = 0;
  keyed.keyframes = {still};
  for (Phase& phase : keyed.phases) {
    phase.support = Support::both;
    phase.swing.reset();
  }
  for (const Pattern& pattern : {walk, keyed}) {
    const CommandSeries one = sample(model, pattern, {.threads = 1});
    for (const int threads : {2, 5}) {
      const CommandSeries more = sample(model, pattern, {.threads = threads});
      ASSERT_EQ(one.samples.size(), more.samples.size());
      EXPECT_EQ(one.origin, more.origin);
      for (size_t k = 0; k < one.samples.size(); ++k) {
        const CommandSample &a = one.samples[k], &b = more.samples[k];
        ASSERT_EQ(a.state.theta, b.state.theta) << k;
        ASSERT_EQ(a.state.base.position, b.state.base.position) << k;
        ASSERT_EQ(a.acceleration, b.acceleration) << k;
        ASSERT_EQ(a.zmp, b.zmp) << k;
        ASSERT_EQ(a.fz, b.fz) << k;
      }
    }
  }
}

// If several places cannot be reached, the first is named.
TEST(Sample, SameErrorForAnyNumberOfThreads) {
  const RobotModel model = test::biped();
  Pattern pattern = walk_pattern(model, short_walk());
  const double level = default_cog_height(model, pattern);
  const auto add = [&](double t, double height) {
    Keyframe key;
    key.t = t;
    key.cog_height = height;
    const auto after = std::find_if(pattern.keyframes.begin(), pattern.keyframes.end(),
                                    [&](const Keyframe& other) { return other.t >= t - 1e-9; });
    if (after != pattern.keyframes.end() && std::abs(after->t - t) < 1e-9)
      after->cog_height = height;
    else
      pattern.keyframes.insert(after, key);
  };
  for (const double t : {0.0, 1.0, 2.0}) add(t, level);
  for (const double t : {0.5, 1.5}) add(t, level + 0.08);
  const auto message = [&](int threads) {
    return test::error_message([&] { sample(model, pattern, {.threads = threads}); },
                               ErrorCode::bad_pattern);
  };
  EXPECT_NE(message(1).find("out of reach"), std::string::npos) << message(1);
  EXPECT_EQ(message(1), message(4));
}

TEST(Sample, EightSecondsInAboutOneSecond) {
  const RobotModel model = test::biped();
  WalkParameters p = short_walk();
  p.steps = 9;
  const Pattern pattern = walk_pattern(model, p);
  const auto start = std::chrono::steady_clock::now();
  const CommandSeries series = sample(model, pattern);
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
  RecordProperty("seconds", std::to_string(spent.count()));
  // Leaves room for debug builds.
  EXPECT_LT(spent.count(), 10.0) << series.duration() << " s of motion";
}

// Legs without the ankle's roll: the trunk leans to move the COG aside. The plan says so, and its
// ZMP is where the keys put it, as with legs of six joints.
TEST(Sample, LegsOfFiveJointsKeepTheZmp) {
  RobotDescription robot = test::biped_description();
  for (JointDescription& joint : robot.joints)
    if (joint.name.ends_with("ankle_roll")) joint.type = JointType::fixed;
  const RobotModel model(robot);
  Pattern pattern = stand_pattern(model, 2);
  RobotData data(model);
  update_positions(model, model.rest_state(), data);
  pattern.keyframes.clear();
  for (const auto& [t, aside] : {std::pair{0.4, 0.0}, {1.0, 0.004}, {1.6, 0.0}}) {
    Keyframe key;
    key.t = t;
    key.zmp = ZmpKey{.point = data.cog.head<2>() + Eigen::Vector2d(0, aside)};
    pattern.keyframes.push_back(key);
  }
  const CommandSeries series = sample(model, pattern, {.dt = 0.01});
  const std::string& legs = series.origin.at("legs");
  EXPECT_TRUE(legs.starts_with("a leg has only 5 joints, so it cannot keep the sole level"))
      << legs;
  EXPECT_LT(worst_zmp_error(model, series), 0.0005);
  EXPECT_NEAR(series.samples[100].zmp.y() - data.cog.y(), 0.004, 0.0005);
}

}  // namespace
}  // namespace ayumi
