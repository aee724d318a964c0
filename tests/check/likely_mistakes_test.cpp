// Each test plants one impossible value into a sound pattern and reads the name that the check
// gives to it.

#include "ayumi/check/likely_mistakes.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/task/task.hpp"
#include "tests/support/hoap1.hpp"

using namespace ayumi;
using namespace ayumi::test;

namespace {

Pattern sound_walk() {
  Pattern pattern = walk_pattern(hoap1(), walk_defaults(hoap1()));
  pattern.file = "walk.json";
  return pattern;
}

std::vector<std::string> impossible(const Pattern& pattern) {
  std::vector<std::string> texts;
  for (const Mistake& mistake : impossible_values(hoap1(), pattern))
    texts.push_back(mistake.text());
  return texts;
}

/// The impossible values that are found in the walk after `plant`.
std::vector<std::string> mistakes_after(const std::function<void(Pattern&)>& plant) {
  Pattern pattern = sound_walk();
  plant(pattern);
  return impossible(pattern);
}

/// Expects that the first message begins with `place` and contains `words`.
void expect_called(const std::vector<std::string>& mistakes, const std::string& place,
                   const std::string& words) {
  ASSERT_FALSE(mistakes.empty());
  EXPECT_EQ(mistakes.front().rfind(place, 0), 0u) << mistakes.front();
  EXPECT_NE(mistakes.front().find(words), std::string::npos) << mistakes.front();
}

size_t nth_swing(const Pattern& pattern, int n) {
  for (size_t i = 0; i < pattern.phases.size(); ++i)
    if (pattern.phases[i].swing && n-- == 0) return i;
  ADD_FAILURE() << "too few swings";
  return 0;
}

}  // namespace

TEST(LikelyMistakes, AHeightThatIsTooLowIsComparedWithTheLowestOne) {
  for (const double height : {-0.2, 0.02})
    expect_called(mistakes_after([&](Pattern& p) { p.keyframes[1].cog_height = height; }),
                  "/keyframes/1",
                  " above the soles in the home posture. The COG height should be at least 0.07");
}

// Changes that a search tried in vain are no cause, and are not listed before known causes.
TEST(LikelyMistakes, ASearchWithoutACauseComesLast) {
  Pattern pattern = sound_walk();
  pattern.file = "a.json";
  const std::vector<Mistake> none = {{.place = "",
                                      .words = "no likely cause was found",
                                      .explains_all = false,
                                      .is_cause = false}};
  const Error error(ErrorCode::bad_pattern, "a.json: /phases/1: out of reach",
                    {"a.json", "/phases/1"}, "/phases/1: out of reach");
  EXPECT_STREQ(with_mistakes(error, pattern, none).what(),
               "a.json: /phases/1: out of reach. No likely cause was found");
  const Error explained = with_mistakes(error, pattern, {{"/units", "in degrees"}});
  EXPECT_STREQ(explained.what(),
               "a.json: likely cause: /units: in degrees. First error: /phases/1: out of reach");
  EXPECT_EQ(explained.words(),
            "likely cause: /units: in degrees. First error: /phases/1: out of reach");
  EXPECT_EQ(explained.place().inside, "/units") << "the place to change";
}

// The changes of one round are alternatives, so "in addition" is only before the first of them.
TEST(LikelyMistakes, AlternativesOfALaterRoundAreJoinedByOr) {
  const Error error(ErrorCode::bad_pattern, "/phases/9: out of reach");
  const auto mistake = [](const char* words, int round) {
    return Mistake{.place = "", .words = words, .round = round};
  };
  const std::vector<Mistake> mistakes = {mistake("a", 0), mistake("b", 0), mistake("c", 1),
                                         mistake("d", 1), mistake("e", 2)};
  EXPECT_EQ(with_mistakes(error, sound_walk(), mistakes).words(),
            "likely cause: a. Or b. In addition, c. Or d. In addition, e. First error: "
            "/phases/9: out of reach");
}

TEST(ImpossibleValues, SoundPatternsHaveNone) {
  for (const Pattern& pattern :
       {sound_walk(), stand_pattern(hoap1(), 1), sway_pattern(hoap1(), sway_defaults(hoap1()))})
    EXPECT_EQ(text::join(impossible(pattern), "\n"), "");
}

TEST(ImpossibleValues, DegreesDeclaredAsRadians) {
  const auto mistakes = mistakes_after([](Pattern& pattern) {
    pattern.degrees = false;
    pattern.keyframes[1].joints["l_elbow"] = -60;
  });
  expect_called(mistakes, "/keyframes/1: l_elbow is at -60 rad", "\"angle\": \"deg\"");
  // In a file in degrees, the same angle is 1 rad.
  EXPECT_TRUE(mistakes_after([](Pattern& pattern) {
                pattern.keyframes[1].joints["l_elbow"] = -1;
              }).empty());
}

TEST(ImpossibleValues, TimesInMilliseconds) {
  const auto mistakes = mistakes_after([](Pattern& pattern) {
    for (Phase& phase : pattern.phases) phase.until *= 100;
    for (Keyframe& key : pattern.keyframes) key.t *= 100;
  });
  expect_called(mistakes, "/phases/1: the swing lasts 45.1 s", "divide them by 1000");
}

TEST(ImpossibleValues, CogHeightInMillimetresAndFarTooHigh) {
  expect_called(mistakes_after([](Pattern& pattern) { pattern.cog_height = 225; }),
                "/defaults/cog_height: the COG height is 225 m", "225 mm are 0.225 m");
  const auto high =
      mistakes_after([](Pattern& pattern) { pattern.keyframes[0].cog_height = 2.05; });
  expect_called(high, "/keyframes/0: the COG height is 2.05 m",
                "0.245 m above the soles in the home posture");
  EXPECT_EQ(high.front().find("mm are"), std::string::npos) << high.front();
}

// The next step of the other foot is as far from this foothold, but it is not the mistake.
TEST(ImpossibleValues, AFootholdThatIsTooFarIsNamedAlone) {
  const Pattern walk = sound_walk();
  const size_t phase = nth_swing(walk, 2);
  const auto mistakes =
      mistakes_after([&](Pattern& pattern) { pattern.phases[phase].swing->to.position.x() = 0.9; });
  EXPECT_EQ(mistakes.size(), 1u);
  expect_called(mistakes, "/phases/" + std::to_string(phase) + ": the right foot lands 0.8",
                "but the legs are 0.237 m long");
}

TEST(ImpossibleValues, FeetThatCross) {
  const Pattern walk = sound_walk();
  const size_t phase = nth_swing(walk, 1);
  const auto mistakes =
      mistakes_after([&](Pattern& pattern) { pattern.phases[phase].swing->to.position.y() *= -1; });
  expect_called(mistakes, "/phases/" + std::to_string(phase), "on the right foot");
  const auto crossed =
      mistakes_after([&](Pattern& pattern) { pattern.phases[phase].swing->to.position.y() *= -3; });
  expect_called(crossed, "/phases/" + std::to_string(phase) + ": the left foot lands 78 mm to the",
                "Perhaps left and right were exchanged");
}

TEST(ImpossibleValues, ZmpUnderTheFootInTheAir) {
  const auto mistakes = mistakes_after([](Pattern& pattern) {
    for (Keyframe& key : pattern.keyframes)
      if (key.zmp && key.zmp->place == ZmpKey::Place::left)
        key.zmp->place = ZmpKey::Place::right;
      else if (key.zmp && key.zmp->place == ZmpKey::Place::right)
        key.zmp->place = ZmpKey::Place::left;
  });
  expect_called(mistakes, "/phases/1: the robot stands on the left foot",
                "put the ZMP under the right foot");
  EXPECT_EQ(mistakes.size(), 2u);
  EXPECT_NE(mistakes.back().find("7 more of this kind"), std::string::npos) << mistakes.back();
}

TEST(ImpossibleValues, AMissingSwing) {
  const Pattern walk = sound_walk();
  const size_t phase = nth_swing(walk, 2);
  expect_called(mistakes_after([&](Pattern& pattern) { pattern.phases[phase].swing.reset(); }),
                "/phases/" + std::to_string(phase), "Perhaps a swing of the right foot is missing");
}

TEST(ImpossibleValues, AKeyOfALegJoint) {
  expect_called(mistakes_after([](Pattern& pattern) { pattern.keyframes[1].joints["l_knee"] = 1; }),
                "/keyframes/1: l_knee is a joint of a leg",
                "Ayumi no longer computes them from the feet");
}

TEST(ImpossibleValues, AFootKeyThatLiftsTheCog) {
  Pattern pattern = stand_pattern(hoap1(), 3);
  pattern.phases.assign(3, {});
  for (int i = 0; i < 3; ++i) pattern.phases[static_cast<size_t>(i)].until = 1 + i;
  pattern.phases[1].support = Support::left;
  pattern.keyframes.clear();
  for (const double height : {0.0, 0.03, 0.0}) {
    Keyframe key;
    key.t = 1 + 0.5 * static_cast<double>(pattern.keyframes.size());
    key.feet[1] = Foothold{{0, -0.039, height}};
    pattern.keyframes.push_back(key);
  }
  const auto mistakes = impossible(pattern);
  expect_called(mistakes, "/keyframes/1: the right foot is lifted by 30 mm",
                "The COG rises by half");
  // Several keys of one kick have one reason, which is named at the highest one.
  Pattern kick = pattern;
  Keyframe lower = kick.keyframes[1];
  lower.t = 1.2;
  lower.feet[1]->position.z() = 0.02;
  kick.keyframes.insert(kick.keyframes.begin() + 1, lower);
  const auto once = impossible(kick);
  ASSERT_EQ(once.size(), 1u);
  EXPECT_TRUE(
      once[0].starts_with("/keyframes/2: the right foot is lifted by 30 mm (it is also lifted in "
                          "/keyframes/1). The COG "
                          "rises"))
      << once[0];
  // If the author has written a key of the height, the height is not doubted.
  pattern.keyframes[0].cog_height = 0.23;
  EXPECT_TRUE(impossible(pattern).empty());
}

// Soles that reach far outwards are wider than the distance of the feet, and do not overlap.
TEST(LikelyMistakes, WideSolesBesideEachOtherAreNotExchanged) {
  RobotDescription description = hoap1().description();
  for (auto& [side, sole] : description.soles)
    for (Eigen::Vector2d& corner : sole.polygon)
      if (corner.y() * (side == "left" ? 1 : -1) > 0) corner.y() += side == "left" ? 0.04 : -0.04;
  const RobotModel wide(description);
  for (const Mistake& mistake : impossible_values(wide, sound_walk()))
    EXPECT_EQ(mistake.words.find("lands on"), std::string::npos) << mistake.text();
}

// The whole motion has millions of samples, and the message must not wait for them.
TEST(LikelyMistakes, AWalkInMillisecondsIsRefusedBeforeItIsSampled) {
  WalkParameters steps = walk_defaults(hoap1());
  steps.steps = 1;
  Pattern pattern = walk_pattern(hoap1(), steps);
  pattern.file = "walk.json";
  for (Phase& phase : pattern.phases) phase.until *= 1000;
  for (Keyframe& key : pattern.keyframes) key.t *= 1000;
  const Progress watch = [](const ProgressEvent& event) { return event.stage != "sampling"; };
  try {
    make_task(pattern, hoap1(), "", watch);
    FAIL() << "a swing of minutes passed";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_pattern) << error.what();
    EXPECT_EQ(error.place().inside, "/phases/1");
    EXPECT_NE(std::string(error.what())
                  .find("With all times read as ms, the pattern would be consistent"),
              std::string::npos)
        << error.what();
  }
}

// A robot may stand for as long as the author wants, so this is only a doubt.
TEST(LikelyMistakes, ALongMotionWithoutSwingsIsOnlyDoubted) {
  Pattern pattern = stand_pattern(hoap1(), 1200);
  std::string caution;
  const Progress watch = [&](const ProgressEvent& event) {
    if (event.stage == "caution") caution = event.detail;
    return event.stage != "sampling";
  };
  EXPECT_THROW(make_task(pattern, hoap1(), "", watch), Interrupted);
  EXPECT_NE(caution.find("divide them by 1000"), std::string::npos) << caution;
}
