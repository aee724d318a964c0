// What edits of patterns refuse, and what they do with tracks that few patterns have.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ayumi/author/edit/edit.hpp"
#include "ayumi/author/edit/gait_cycle.hpp"
#include "ayumi/author/generate/generate.hpp"
#include "ayumi/plan/foot_plan.hpp"
#include "ayumi/plan/sample.hpp"
#include "tests/support/error_message.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi::test {
namespace {

using Eigen::Vector3d;

void expect_part(const std::string& message, const std::string& part) {
  EXPECT_NE(message.find(part), std::string::npos) << message;
}

// A step of the right foot between two stands.
Pattern step_once() {
  Pattern p;
  p.robot = "hoap1";
  Swing swing;
  swing.foot = Side::right;
  swing.to.position = {0.02, -0.039, 0};
  swing.lift = 0.015;
  p.phases = {{0.8, Support::both, {}}, {1.2, Support::left, swing}, {2.0, Support::both, {}}};
  for (const double t : {0.0, 0.8, 1.2, 1.6}) {
    Keyframe key;
    key.t = t;
    key.place.inside = "/keyframes";
    key.zmp = ZmpKey{t == 0.8 || t == 1.2 ? ZmpKey::Place::left : ZmpKey::Place::center};
    p.keyframes.push_back(key);
  }
  return p;
}

TEST(JoinRefuses, MotionsThatDoNotMeet) {
  const RobotModel& model = hoap1();
  const Pattern stand = stand_pattern(model, 0.5);
  const CommandSeries samples = sample(model, stand);
  const auto message = [&](const Pattern& second, const CommandSeries& b, double over) {
    return error_message([&] { joined(model, {stand, samples}, {second, b}, over, "t.csv"); });
  };
  CommandSeries coarse = samples;
  coarse.dt = 0.002;
  expect_part(message(stand, coarse, 0), "motions with sampling steps of 0.001 and 0.002 s");

  Pattern apart = stand;
  apart.start_feet = {Foothold{{0.01, 0.039, 0}, Vector3d::Zero()},
                      Foothold{{-0.01, -0.039, 0}, Vector3d::Zero()}};
  expect_part(message(apart, sample(model, apart), 0.5),
              "deg away from its place at the end of the first motion (limits 1.0 mm");

  Pattern bent = stand;
  // The angle is so small that the base stays in its place.
  bent.keyframes.at(0).joints["l_elbow"] =
      samples.samples.front().state.theta[model.find_dof("l_elbow")] - 5e-4;
  const CommandSeries bent_samples = sample(model, bent);
  expect_part(message(bent, bent_samples, 0), "l_elbow is ");
  EXPECT_EQ(message(bent, bent_samples, 0.5), "no error");

  Pattern low = stand;
  const double height = samples.samples.front().cog.z();
  low.keyframes.at(0).cog_height = height - 0.01;
  expect_part(message(low, sample(model, low), 0), "the base is ");
  expect_part(message(low, sample(model, low), 0), "(limits 0.02 mm and 0.01 deg)");

  // A foot is in the air at the end of the first motion and at the beginning of the second one.
  Pattern lifted = step_once();
  lifted.phases.pop_back();
  lifted.keyframes.pop_back();
  const CommandSeries in_air = [&] {
    CommandSeries series = sample(model, step_once());
    series.samples.resize(1001);
    return series;
  }();
  expect_part(error_message(
                  [&] {
                    joined(model, {lifted, in_air}, {stand, samples}, 0, "t.csv");
                  },
                  ErrorCode::bad_pattern),
              "a foot is in the air here");
}

// The second motion is moved so that it goes on where the first one ends, and so is what happens in
// the world around it.
TEST(Join, DisturbancesMoveWithTheirMotion) {
  const RobotModel& model = hoap1();
  const Pattern stand = stand_pattern(model, 0.5);
  const CommandSeries samples = sample(model, stand);
  constexpr double yaw = 0.4;
  const Eigen::AngleAxisd turn(yaw, Vector3d::UnitZ());
  const Vector3d place(0.3, 0.1, 0);
  Pattern second = stand;
  for (const double y : {0.039, -0.039})
    second.start_feet[y > 0 ? 0 : 1] = Foothold{turn * Vector3d(0, y, 0) + place, {0, 0, yaw}};
  Push in_world, on_link;
  in_world.direction = on_link.direction = turn * Vector3d::UnitX();
  on_link.frame = PushFrame::link;
  Bump bump;
  bump.place = (turn * Vector3d(0.05, 0, 0) + place).head<2>();
  second.scenario = {{0.1, 0.1, in_world}, {0.2, 0.1, on_link}, {0.3, 0.1, bump}};
  const Pattern whole =
      joined(model, {stand, samples}, {second, sample(model, second)}, 0.5, "t.csv");
  ASSERT_EQ(whole.scenario.size(), 3u);
  for (size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(whole.scenario[i].at, second.scenario[i].at + 0.5 + 0.5, 2e-3) << i;
  const double most = 2e-6;
  EXPECT_LE((std::get<Push>(whole.scenario[0].what).direction - Vector3d::UnitX()).norm(), most);
  EXPECT_EQ(std::get<Push>(whole.scenario[1].what).direction, on_link.direction);
  EXPECT_LE((std::get<Bump>(whole.scenario[2].what).place - Eigen::Vector2d(0.05, 0)).norm(), most);
}

TEST(AlternateRefuses, WhatIsNoStep) {
  const RobotModel& model = hoap1();
  const Pattern step = step_once();
  const auto message = [&](const Pattern& p, int times, ErrorCode code) {
    return error_message([&] { alternated(model, p, times); }, code);
  };
  for (const int times : {-1, 1, 1001})
    expect_part(message(step, times, ErrorCode::usage),
                "can follow each other 2 to 1000 times, not " + std::to_string(times));
  const Pattern table = baked(model, step, sample(model, step), "t.csv");
  expect_part(message(table, 2, ErrorCode::bad_pattern), "/table: a pattern with a table");
  Pattern keyed = step;
  keyed.keyframes.at(0).feet[0] = Foothold{{0, 0.039, 0}, Vector3d::Zero()};
  expect_part(message(keyed, 2, ErrorCode::bad_pattern),
              "the feet have keys, but only swings can be repeated");
  // The walk turns, so a key with COG x alone cannot be moved to the next step.
  Pattern turning = step;
  turning.phases.at(1).swing->to.rpy.z() = -0.1;
  turning.keyframes.at(1).zmp.reset();
  turning.keyframes.at(1).cog_x = 0.01;
  expect_part(message(turning, 3, ErrorCode::bad_pattern),
              "in a motion that turns, a key of the COG must have both x and y");
}

// The third step repeats the first one. Its keys have the points in the world of the first step's
// keys, moved ahead by two steps.
TEST(Alternate, PointsOfTheWorldMoveWithTheSteps) {
  const RobotModel& model = hoap1();
  Pattern step = step_once();
  Keyframe& key = step.keyframes.at(1);
  key.zmp = ZmpKey{ZmpKey::Place::point, {0.001, 0.03}};
  key.cog_height = 0.2;
  key.hands["right"] = {LinkTarget::Frame::world, Vector3d(0.1, -0.1, 0.2), Vector3d::UnitX()};
  key.hands["left"] = {LinkTarget::Frame::trunk, Vector3d(0.1, 0.1, 0.1), {}};
  key.gaze = LinkTarget{LinkTarget::Frame::world, Vector3d(1, 0.2, 0.3), {}};
  const Pattern walk = alternated(model, step, 3);
  const FootPlan feet(model, walk);
  // The left foot carries the robot in the first and in the third step.
  const Vector3d ahead =
      feet.pose(Side::left, 4).translation() - feet.pose(Side::left, 0).translation();
  EXPECT_NEAR(ahead.x(), 0.04, 1e-3);
  const auto third = std::find_if(walk.keyframes.begin(), walk.keyframes.end(),
                                  [](const Keyframe& k) { return std::abs(k.t - 4.8) < 1e-9; });
  ASSERT_NE(third, walk.keyframes.end());
  const auto expect_at = [&](const Vector3d& found, const Vector3d& first) {
    EXPECT_LT((found - first - ahead).norm(), 1e-9) << found.transpose();
  };
  expect_at(third->hands.at("right").position.value(), {0.1, -0.1, 0.2});
  EXPECT_LT((third->hands.at("right").direction.value() - Vector3d::UnitX()).norm(), 1e-9);
  EXPECT_EQ(third->hands.at("left").position.value(), Vector3d(0.1, 0.1, 0.1));
  expect_at(third->gaze.value().position.value(), {1, 0.2, 0.3});
  expect_at({third->zmp->point.x(), third->zmp->point.y(), 0}, {0.001, 0.03, 0});
  EXPECT_EQ(third->cog_height, 0.2);
}

// A posture that is not its own mirror image has no named mirror image, so the new key has the
// mirrored angles themselves.
TEST(KeyEdit, TheImageOfAPostureHasItsJoints) {
  Pattern p = stand_pattern(hoap1(), 1.0);
  p.postures["wave"] = {{"l_shoulder_pitch", 0.3}, {"l_elbow", -0.7}};
  p.keyframes.at(0).posture = "wave";
  const Pattern edited =
      with_key_edited(hoap1(), p, {.at = 0, .to = 0.5, .copy = true, .mirror = true});
  ASSERT_EQ(edited.keyframes.size(), p.keyframes.size() + 1);
  const auto image = std::find_if(edited.keyframes.begin(), edited.keyframes.end(),
                                  [](const Keyframe& k) { return k.t == 0.5; });
  ASSERT_NE(image, edited.keyframes.end());
  EXPECT_FALSE(image->posture.has_value());
  const MirrorMap map = mirror_map(hoap1());
  const auto elbow = static_cast<size_t>(hoap1().find_dof("l_elbow"));
  EXPECT_EQ(image->joints.at("r_elbow"), -0.7 * map.sign[elbow]);
  EXPECT_EQ(edited.postures, p.postures);
}

// Another posture of the pattern that is not symmetric does not matter.
TEST(KeyEdit, ASymmetricPostureKeepsItsName) {
  Pattern p = stand_pattern(hoap1(), 1.0);
  p.postures["wave"] = {{"l_shoulder_pitch", 0.3}};
  p.keyframes.at(0).posture = "home";
  const Pattern edited = with_key_edited(hoap1(), p, {.at = 0, .mirror = true});
  EXPECT_EQ(edited.keyframes.at(0).posture, "home");
  EXPECT_TRUE(edited.keyframes.at(0).joints.empty());
}

TEST(CutRefuses, SamplesThatAreNotThere) {
  const RobotModel& model = hoap1();
  const Pattern step = step_once();
  const CommandSeries series = sample(model, step);
  const auto message = [&](long first, long last, ErrorCode code) {
    return error_message([&] { cut(model, {step, series}, first, last, "t.csv"); }, code);
  };
  const auto count = static_cast<long>(series.samples.size());
  for (const auto& [first, last] : {std::pair<long, long>{-1, 100}, {100, 100}, {0, count}})
    expect_part(message(first, last, ErrorCode::usage), "cannot be cut out of a motion");
  expect_part(message(0, 1000, ErrorCode::bad_pattern), "at 1 s, a foot is in the air");
}

// The weights at the beginning of the part come from a key before the part. The times of its pushes
// are relative to the beginning of the part.
TEST(Cut, KeepsWhatHoldsAtItsBeginning) {
  Pattern stand = stand_pattern(hoap1(), 1.0);
  stand.keyframes.at(0).weights = {{"l_knee", 2.0}};
  for (const double at : {0.2, 0.7})
    stand.scenario.push_back(
        {.at = at, .duration = 0.02, .what = Push{.magnitude = 0.5, .direction = {1, 0, 0}}});
  const CommandSeries series = sample(hoap1(), stand);
  const Pattern part = cut(hoap1(), {stand, series}, 500, 900, "t.csv");
  EXPECT_NEAR(part.duration(), 0.4, 1e-9);
  ASSERT_FALSE(part.keyframes.empty());
  EXPECT_EQ(part.keyframes.at(0).t, 0);
  EXPECT_EQ(part.keyframes.at(0).weights.at("l_knee"), 2.0);
  ASSERT_EQ(part.scenario.size(), 1u);
  EXPECT_NEAR(part.scenario.at(0).at, 0.2, 1e-9);
}

}  // namespace
}  // namespace ayumi::test
