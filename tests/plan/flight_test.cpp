// Jumps as patterns: between lift-off and touchdown the COG follows a parabola, nothing turns the
// robot, and the soles clear the ground; on the ground they stand still.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/dynamics/reach.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/motion/differentiate.hpp"
#include "ayumi/plan/sample.hpp"
#include "tests/support/biped.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi {
namespace {

using Eigen::Vector3d;

JumpParameters small_jump(const RobotModel& model) {
  JumpParameters p = jump_defaults(model);
  p.height = 0.02;
  return p;
}

struct FlightFigures {
  double momentum = 0;   // largest angular momentum about the COG [N m s]
  double fall = 0;       // largest deviation of the COG acceleration from free fall [m/s^2]
  double rise = 0;       // rise of the COG above lift-off [m]
  double clearance = 0;  // largest clearance of the lower sole [m]
};

FlightFigures flight_of(const RobotModel& model, const CommandSeries& series) {
  FlightFigures f;
  RobotData data(model);
  double lift_off = 0;
  for (size_t k = 1; k < series.samples.size(); ++k) {
    const CommandSample& s = series.samples[k];
    if (s.support != Support::none) continue;
    if (series.samples[k - 1].support != Support::none) lift_off = s.cog.z();
    EXPECT_EQ(s.fz, 0);
    update_velocities(model, s.state, data);
    f.momentum = std::max(f.momentum, centroidal_momentum(model, data).angular.norm());
    f.fall = std::max(f.fall, (s.ddcog + Vector3d(0, 0, kGravity)).norm());
    f.rise = std::max(f.rise, s.cog.z() - lift_off);
    f.clearance =
        std::max(f.clearance, std::min(sole_pose(model, data, Side::left).translation().z(),
                                       sole_pose(model, data, Side::right).translation().z()));
  }
  return f;
}

TEST(Flight, IsBallisticWithoutAngularMomentumAndClearOfTheGround) {
  const RobotModel plain = test::biped(), waist = test::biped({.waist = true, .arm_skew = 0.3});
  for (const RobotModel* model : {&plain, &waist}) {
    JumpParameters forward = small_jump(*model);
    forward.forward = 0.03;
    for (const JumpParameters& p : {small_jump(*model), forward}) {
      const Pattern pattern = jump_pattern(*model, p);
      const CommandSeries series = sample(*model, pattern);
      const FlightFigures f = flight_of(*model, series);
      // The momentum of the push is about 0.3 N m s when the trunk stays level.
      EXPECT_LT(f.momentum, 2e-3);
      EXPECT_LT(f.fall, 0.3);
      EXPECT_NEAR(f.rise, p.height, 0.02 * p.height);
      EXPECT_GT(f.clearance, 0.7 * p.height);
      EXPECT_NEAR(series.samples.back().feet[0].translation().x() -
                      series.samples.front().feet[0].translation().x(),
                  p.forward, 1e-9);
    }
  }
}

TEST(Flight, ALevelTrunkWouldCarryMomentumIntoIt) {
  const RobotModel model = test::biped();
  Pattern pattern = jump_pattern(model, small_jump(model));
  pattern.keyframes.front().torso = Vector3d::Zero();
  EXPECT_GT(flight_of(model, sample(model, pattern)).momentum, 0.05);
}

TEST(Flight, OnTheGroundTheSolesStandAndTheZmpIsAsAsked) {
  const RobotModel model = test::biped();
  JumpParameters p = small_jump(model);
  p.times = 3;
  const CommandSeries series = sample(model, jump_pattern(model, p));
  RobotData data(model);
  int flights = 0;
  for (size_t k = 1; k < series.samples.size(); ++k) {
    const CommandSample& s = series.samples[k];
    flights += s.support == Support::none && series.samples[k - 1].support != Support::none;
    update_positions(model, s.state, data);
    for (const Side side : {Side::left, Side::right}) {
      const Eigen::Isometry3d& planned = s.feet[static_cast<size_t>(side)];
      EXPECT_LT((sole_pose(model, data, side).translation() - planned.translation()).norm(), 1e-9);
      if (s.support == Support::both) {
        EXPECT_NEAR(planned.translation().z(), 0, 1e-12);
      }
    }
    if (s.support == Support::none) continue;
    // The error is the moment about the commanded ZMP divided by the weight: near lift-off there is
    // little force.
    const GroundReaction full = full_model_reaction(model, s, data);
    const double share = std::min(1.0, full.force.z() / (model.mass() * kGravity));
    EXPECT_LT(share * (full.zmp - s.zmp).norm(), 0.002) << k;
  }
  EXPECT_EQ(flights, 3);
}

TEST(Flight, TrunkIsLevelAtBothEnds) {
  const RobotModel model = test::biped();
  const CommandSeries series = sample(model, jump_pattern(model, small_jump(model)));
  for (const CommandSample* s : {&series.samples.front(), &series.samples.back()})
    EXPECT_NEAR(s->state.base.attitude.angularDistance(Eigen::Quaterniond::Identity()), 0, 1e-9);
}

TEST(Flight, KeysOnTheWayAreTheAuthors) {
  const RobotModel model = test::biped();
  Pattern pattern = jump_pattern(model, small_jump(model));
  const double begin = pattern.phases[0].until, end = pattern.phases[1].until;
  Keyframe key;
  key.t = 0.5 * (begin + end);
  key.cog_height = *pattern.keyframes[2].cog_height + 0.01;
  for (Keyframe& k : pattern.keyframes) k.cog_x = 0.0, k.cog_y = 0.0;
  key.cog_x = key.cog_y = 0.0;
  pattern.keyframes.insert(pattern.keyframes.begin() + 3, key);
  EXPECT_GT(flight_of(model, sample(model, pattern)).fall, 1.0);
}

// During a flight, a hand moves from one place beside the trunk to another: between both it is on
// its way, the trunk turns in the opposite direction, and the COG falls freely.
TEST(Flight, AHandFollowsItsTargetInTheAir) {
  const RobotModel& model = test::hoap1();
  const Pattern plain = jump_pattern(model, small_jump(model));
  const double begin = plain.phases[0].until, end = plain.phases[1].until;
  ASSERT_EQ(plain.phases[1].support, Support::none);
  const int hand = hand_body(model, Side::left);
  RobotData data(model);
  const auto in_trunk = [&](const RobotState& state) -> Vector3d {
    update_positions(model, state, data);
    return data.pose(model.trunk_body()).inverse() * (data.pose(hand) * limb_point(model, hand));
  };
  RobotState posed = model.rest_state();
  const Vector3d from = in_trunk(posed);
  for (const int dof : limb_dofs(model, hand)) posed.theta[dof] += 0.3;
  const Vector3d to = in_trunk(posed);
  ASSERT_GT((to - from).norm(), 0.02);
  const auto with_hand = [&](LinkTarget::Frame frame) {
    Pattern pattern = plain;
    const auto key_at = [&](double t) -> Keyframe& {
      auto key = std::find_if(pattern.keyframes.begin(), pattern.keyframes.end(),
                              [&](const Keyframe& k) { return k.t > t - 1e-9; });
      if (key == pattern.keyframes.end() || key->t > t + 1e-9) {
        Keyframe made;
        made.t = t;
        made.place.inside = "/keyframes";
        key = pattern.keyframes.insert(key, made);
      }
      return *key;
    };
    key_at(begin).hands["left"] = {frame, from, {}};
    key_at(end).hands["left"] = {frame, to, {}};
    return pattern;
  };
  const CommandSeries series = sample(model, with_hand(LinkTarget::Frame::trunk));
  const CommandSeries without = sample(model, plain);
  int in_flight = 0;
  for (size_t k = 0; k < series.samples.size(); ++k) {
    const double t = series.dt * static_cast<double>(k);
    if (t < begin || t > end) continue;
    ++in_flight;
    const double u = (t - begin) / (end - begin);
    const double share = u * u * u * (10 - 15 * u + 6 * u * u);  // share of a minimum-jerk motion
    EXPECT_LT((in_trunk(series.samples[k].state) - (from + share * (to - from))).norm(), 1e-4) << t;
  }
  EXPECT_GT(in_flight, 50);
  const FlightFigures f = flight_of(model, series), still = flight_of(model, without);
  EXPECT_LT(f.momentum, still.momentum + 2e-3);
  EXPECT_LT(f.fall, still.fall + 0.1);
  EXPECT_NEAR(f.rise, still.rise, 1e-4);
  try {
    sample(model, with_hand(LinkTarget::Frame::world));
    ADD_FAILURE() << "a place in the world leads a hand in the air";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_pattern);
    EXPECT_NE(std::string(error.what()).find("\"frame\": \"trunk\""), std::string::npos)
        << error.what();
  }
}

std::string refused(const JumpParameters& p) {
  try {
    jump_pattern(test::biped(), p);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    return error.what();
  }
  return "";
}

TEST(JumpPattern, RefusesWhatIsOutOfRange) {
  JumpParameters p = small_jump(test::biped());
  p.height = -0.01;
  EXPECT_NE(refused(p).find("jump: height -0.01 m is out of range"), std::string::npos);
  p = small_jump(test::biped());
  p.times = 0;
  EXPECT_NE(refused(p).find("times 0"), std::string::npos);
  p.times = 1;
  p.stoop = 1;
  EXPECT_NE(refused(p).find("stoop 1 m"), std::string::npos);
}

TEST(JumpPattern, TheFlightLastsAsLongAsTheHeightNeeds) {
  const RobotModel model = test::biped();
  for (const double height : {0.01, 0.02, 0.04}) {
    JumpParameters p = small_jump(model);
    p.height = height;
    const Pattern pattern = jump_pattern(model, p);
    const double flight = pattern.phases[1].until - pattern.phases[0].until;
    EXPECT_NEAR(kGravity * flight * flight / 8, height, 0.02 * height);
    EXPECT_EQ(pattern.phases[1].support, Support::none);
  }
}

}  // namespace
}  // namespace ayumi
