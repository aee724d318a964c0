// Mistakes of an author are reported with file, place and remedy.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/plan/sample.hpp"
#include "tests/support/biped.hpp"
#include "tests/support/error_message.hpp"

namespace ayumi {
namespace {

// The message with which sample() fails after `change`, or "" if it does not fail.
std::string message_of(const std::function<void(Pattern&)>& change) {
  const RobotModel model = test::biped();
  WalkParameters p;
  p.steps = 1;
  Pattern pattern = walk_pattern(model, p);
  pattern.file = "walk.json";
  for (Keyframe& key : pattern.keyframes) key.place.file = "walk.json";
  change(pattern);
  try {
    sample(model, pattern, {.dt = 0.005});
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_pattern) << error.what();
    return error.what();
  }
  return "";
}

void expect_words(const std::string& message, const std::vector<std::string>& words) {
  for (const std::string& word : words)
    EXPECT_NE(message.find(word), std::string::npos)
        << "'" << message << "' lacks '" << word << "'";
}

TEST(SampleErrors, UnchangedIsFine) {
  EXPECT_EQ(message_of([](Pattern&) {}), "");
}

TEST(SampleErrors, UnknownJoint) {
  expect_words(message_of([](Pattern& p) { p.keyframes[1].joints["l_shouldr"] = 0.1; }),
               {"walk.json: /keyframes/1", "l_shouldr", "did you mean 'l_shoulder'"});
}

// A place is a JSON pointer, in which a slash within a name is "~1".
TEST(SampleErrors, PostureWithASlashInItsName) {
  expect_words(message_of([](Pattern& p) {
                 p.postures["low/left"]["l_shouldr"] = 0.1;
                 p.keyframes[1].posture = "low/left";
               }),
               {"walk.json: /postures/low~1left/l_shouldr: "});
}

TEST(SampleErrors, JointThatDoesNotMove) {
  expect_words(message_of([](Pattern& p) { p.keyframes[1].joints["waist"] = 0.1; }),
               {"/keyframes/1", "waist", "does not move"});
}

TEST(SampleErrors, MimicJoint) {
  RobotDescription robot = test::biped_description();
  for (JointDescription& joint : robot.joints)
    if (joint.name == "r_shoulder") joint.mimic = "l_shoulder";
  const RobotModel model(robot);
  Pattern pattern = stand_pattern(model, 1);
  pattern.keyframes[0].joints["r_shoulder"] = 0.1;
  try {
    sample(model, pattern);
    FAIL();
  } catch (const Error& error) {
    expect_words(error.what(), {"keyframes/0", "r_shoulder", "follows 'l_shoulder'"});
  }
}

TEST(SampleErrors, UnknownPosture) {
  expect_words(message_of([](Pattern& p) { p.keyframes[0].posture = "squatt"; }),
               {"/keyframes/0", "squatt", "did you mean 'squat'", "known:"});
  expect_words(message_of([](Pattern& p) { p.default_posture = "hme"; }),
               {"walk.json: /defaults/posture", "hme"});
}

TEST(SampleErrors, TimesOutOfOrder) {
  expect_words(message_of([](Pattern& p) { p.keyframes[2].t = p.keyframes[1].t; }),
               {"/keyframes/2", "Key times must increase"});
  expect_words(message_of([](Pattern& p) { p.phases[2].until = p.phases[1].until; }),
               {"walk.json: /phases/2", "give a later \"until\""});
}

TEST(SampleErrors, KeysBeyondTheEnd) {
  expect_words(message_of([](Pattern& p) { p.keyframes.back().t = 99; }),
               {"/keyframes/", "99 s", "after the end of the last phase"});
}

TEST(SampleErrors, NotANumber) {
  expect_words(message_of([](Pattern& p) { p.keyframes[1].joints["l_shoulder"] = NAN; }),
               {"/keyframes/1", "not a finite number"});
  expect_words(message_of([](Pattern& p) { p.phases[1].swing->to.position.x() = INFINITY; }),
               {"phases/1", "not finite"});
}

TEST(SampleErrors, SwingOfASupportingFoot) {
  expect_words(message_of([](Pattern& p) { p.phases[1].support = Support::both; }),
               {"phases/1", "right foot swings while it carries"});
}

TEST(SampleErrors, FlightNeedsMore) {
  expect_words(
      message_of([](Pattern& p) { p.phases[2].support = Support::none; }),
      {"phases/2", "flight", "Give a key of the COG height at the lift-off and another key"});
  expect_words(message_of([](Pattern& p) { p.phases[0].support = Support::none; }),
               {"phases/0", "a phase on the ground before and after"});
}

TEST(SampleErrors, FootOutOfReach) {
  const std::string message =
      message_of([](Pattern& p) { p.phases[1].swing->to.position.x() = 0.35; });
  expect_words(message, {"walk.json: /phases/", "t = ", "foot is out of reach by", " mm",
                         "Lower the COG height"});
}

// The COG is half a metre in front of feet that stand: a shorter stride or another height of the
// COG would not help.
TEST(SampleErrors, CogBesideTheFeet) {
  const std::string message = message_of([](Pattern& p) {
    p.phases.resize(1);
    p.keyframes.resize(1);
    p.keyframes[0].t = 0;
    p.keyframes[0].zmp.reset();
    p.keyframes[0].cog_x = 0.5;
    p.keyframes[0].cog_y = 0;
  });
  expect_words(message, {"walk.json: /phases/0", "out of reach by", "Move the COG over the feet"});
  EXPECT_EQ(message.find("stride"), std::string::npos) << message;
}

TEST(SampleErrors, CogTooHigh) {
  expect_words(message_of([](Pattern& p) { p.cog_height = 0.5; }),
               {"phases/0", "t = 0.000 s", "out of reach"});
}

TEST(SampleErrors, FootKeysThatDragASupportingFoot) {
  expect_words(message_of([](Pattern& p) {
                 for (Phase& phase : p.phases) phase.swing.reset();
                 Foothold foot;
                 foot.position = {0.05, 0.05, 0};
                 p.keyframes[1].feet[0] = foot;
               }),
               {"phases/0", "left foot", "because it carries the robot", "The key /keyframes/1 at ",
                "is at [0.05, 0.05, 0] m, 50 mm away", "the place where the foot stands"});
  // A place that differs by rounding only is not another place.
  EXPECT_EQ(message_of([](Pattern& p) {
              for (Phase& phase : p.phases) phase = {phase.until, Support::both, {}};
              Foothold foot;
              foot.position = {0, 0.05, 0};
              foot.rpy = {0, 0, 3e-7};
              p.keyframes[1].feet[0] = foot;
              for (Keyframe& key : p.keyframes) key.zmp.reset();
            }),
            "");
  // A key is missing where the foot leaves the ground: the foot moves before that.
  expect_words(message_of([](Pattern& p) {
                 for (Phase& phase : p.phases) phase.swing.reset();
                 Foothold foot;
                 foot.position = {0.02, -0.05, 0.02};
                 p.phases[1].support = Support::left;
                 p.keyframes.push_back(p.keyframes.back());
                 p.keyframes.back().t = p.phases[1].until - 0.01;
                 p.keyframes.back().feet[1] = foot;
                 std::sort(p.keyframes.begin(), p.keyframes.end(),
                           [](const Keyframe& a, const Keyframe& b) { return a.t < b.t; });
               }),
               {"phases/0", "right foot stands at [0, -0.05, 0] m until ", " mm away",
                "Give the foot a key at ", " s at the place where it stands"});
}

// The message for a walk with a table of one arm, with 10 ms between its rows.
std::string message_of_table(const std::function<void(DenseTable&)>& change) {
  return message_of([&](Pattern& p) {
    for (Keyframe& key : p.keyframes) key.joints.clear();
    DenseTable& table = p.table.emplace();
    table.file = "arm.csv";
    table.dt = 0.01;
    table.joints = {"l_shoulder"};
    table.theta = Eigen::MatrixXd::Constant(20, 1, 0.1);
    change(table);
  });
}

TEST(SampleErrors, Tables) {
  EXPECT_EQ(message_of_table([](DenseTable&) {}), "");
  expect_words(message_of_table([](DenseTable& t) { t.theta.conservativeResize(1, 1); }),
               {"walk.json: table arm.csv", "fewer than two rows"});
  expect_words(message_of_table([](DenseTable& t) { t.dt = 0; }), {"time step is not above 0"});
  expect_words(message_of_table([](DenseTable& t) { t.theta(3, 0) = NAN; }),
               {"a joint angle is not a finite number"});
  expect_words(message_of_table([](DenseTable& t) { t.dt = 10; }),
               {"the table ends at 190 s, after the last phase", "Extend the phases"});
  expect_words(message_of_table([](DenseTable& t) { t.joints.push_back("r_shoulder"); }),
               {"has 1 joint columns, but 2 joint names"});
  expect_words(message_of_table([](DenseTable& t) { t.joints = {"l_shouldr"}; }),
               {"table arm.csv", "l_shouldr", "did you mean 'l_shoulder'"});
  expect_words(message_of_table([](DenseTable& t) { t.fz.resize(3); }),
               {"the columns differ in length"});
  expect_words(message_of([](Pattern& p) {
                 for (Keyframe& key : p.keyframes) key.joints = {{"l_shoulder", 0.1}};
                 DenseTable& table = p.table.emplace();
                 table.file = "arm.csv";
                 table.dt = 0.01;
                 table.joints = {"l_shoulder"};
                 table.theta = Eigen::MatrixXd::Constant(20, 1, 0.1);
               }),
               {"'l_shoulder' has a column and also keys"});
}

TEST(SampleErrors, TimesAndWeightsOfKeys) {
  expect_words(message_of([](Pattern& p) { p.keyframes[0].t = -0.5; }),
               {"/keyframes/0", "the key is at -0.5 s, but key times begin at 0 s"});
  for (const double weight : {0.0, -1.0, static_cast<double>(INFINITY), static_cast<double>(NAN)})
    expect_words(message_of([&](Pattern& p) { p.keyframes[1].weights["l_shoulder"] = weight; }),
                 {"/keyframes/1", "weight of l_shoulder must be above 0"});
}

TEST(SampleErrors, SamplingStep) {
  const RobotModel model = test::biped();
  const Pattern pattern = stand_pattern(model, 1);
  for (const double dt : {0.0, -0.005, static_cast<double>(NAN)}) {
    try {
      sample(model, pattern, {.dt = dt});
      ADD_FAILURE() << dt;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::usage);
      expect_words(error.what(), {"sampling step", "must be above 0"});
    }
  }
  expect_words(message_of([](Pattern& p) { p.phases.back().until = 1e9; }),
               {"phases", "but 5 to 4e6 steps are possible"});
}

TEST(SampleErrors, NumbersThatAreNotFinite) {
  const double nan = std::nan("");
  expect_words(message_of([&](Pattern& p) {
                 for (Phase& phase : p.phases)
                   if (phase.swing) phase.swing->lift = nan;
               }),
               {"walk.json: /phases/", "/swing", "not finite, or the lift is below 0"});
  expect_words(message_of([&](Pattern& p) {
                 for (Phase& phase : p.phases)
                   if (phase.swing) phase.swing->lift = -0.01;
               }),
               {"/swing", "the lift is below 0"});
}

TEST(SampleErrors, StepsThatDoNotFitTheMotion) {
  const RobotModel model = test::biped();
  const Pattern pattern = stand_pattern(model, 1);
  const auto refused = [&](double dt, ErrorCode code) {
    return test::error_message([&] { sample(model, pattern, {.dt = dt}); }, code);
  };
  EXPECT_EQ(refused(0, ErrorCode::usage), "sampling step 0 s must be above 0");
  EXPECT_EQ(refused(std::nan(""), ErrorCode::usage), "sampling step nan s must be above 0");
  EXPECT_EQ(refused(0.2, ErrorCode::bad_pattern), "no error");
  for (const double dt : {0.3, 2e-7})
    expect_words(
        refused(dt, ErrorCode::bad_pattern),
        {"phases", "a motion of 1 s with a sampling step of", "but 5 to 4e6 steps are possible"});
}

}  // namespace
}  // namespace ayumi
