// Mistakes that contradict another part of the same pattern: blocks that do not fit each other,
// times at which only a phase or only a key ends, keys of two quantities of which one follows from
// the other, feet above the ground, and joints that are no mirror images. The first likely cause
// names them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <regex>
#include <string>
#include <vector>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/check/block_hypotheses.hpp"
#include "ayumi/check/consistency.hpp"
#include "ayumi/check/likely_mistakes.hpp"
#include "ayumi/check/mistake_hypotheses.hpp"
#include "ayumi/check/mistake_search.hpp"
#include "ayumi/check/mistake_trials.hpp"
#include "ayumi/plan/sample.hpp"
#include "tests/support/robot_motions.hpp"

namespace ayumi::test::contradictions {
namespace {

using Under = ZmpKey::Place;

const RobotModel& small() { return bundled_robot("hoap1"); }
const RobotModel& tall() { return bundled_robot("humanoid30"); }

CheckOptions options_of(const Pattern& pattern) {
  CheckOptions options;
  options.profile = pattern.profile;
  options.friction = pattern.world.friction;
  return options;
}

bool is_consistent(const RobotModel& robot, const Pattern& pattern) {
  return check_consistency(robot, sample(robot, pattern, {.dt = robot.description().servo_period}),
                           options_of(pattern))
      .consistent;
}

std::string first_cause(const RobotModel& robot, const Pattern& pattern) {
  const std::vector<Mistake> found = likely_mistakes(robot, pattern, options_of(pattern));
  return found.empty() ? "" : found.front().text();
}

void expect_named(const RobotModel& robot, const Pattern& sound,
                  const std::function<void(Pattern&)>& plant, const std::string& named) {
  ASSERT_TRUE(is_consistent(robot, sound)) << named;
  Pattern pattern = sound;
  plant(pattern);
  const std::string first = first_cause(robot, pattern);
  EXPECT_TRUE(std::regex_search(first, std::regex("^" + named))) << first;
}

void add_key(Pattern& pattern, double t, Under zmp, const std::string& pointer = "") {
  pattern.keyframes.emplace_back();
  pattern.keyframes.back().t = t;
  pattern.keyframes.back().zmp = ZmpKey{zmp};
  pattern.keyframes.back().pointer = pointer;
}

struct Steps {
  int phase_rounds = 3, key_rounds = 3;
  double first_swing = 0.48;  // duration of the first swing of a round of the phases [s]
  double late = 0;            // delay of the keyframes [s]
};

// A walk whose steps repeat in a block of phases and in a block of keyframes.
Pattern steps_in_blocks(const Steps& steps) {
  constexpr double kSwing = 0.48, kBoth = 0.12;
  Pattern p;
  p.cog_height = 0.24;
  double until = 1.2;
  const auto phase = [&](double lasts, Support support, const std::string& pointer) {
    until += lasts;
    Phase added{.until = until, .support = support, .swing = {}, .pointer = pointer};
    if (support != Support::both)
      added.swing = Swing{.foot = support == Support::left ? Side::right : Side::left,
                          .to = {},
                          .lift = 0.016,
                          .step = RelativeStep{.forward = pointer == "/phases/2" ? 0 : 0.028}};
    p.phases.push_back(added);
  };
  phase(0, Support::both, "/phases/0");
  for (int round = 0; round < steps.phase_rounds; ++round) {
    phase(steps.first_swing, Support::left, "/phases/1/phases/0");
    phase(kBoth, Support::both, "/phases/1/phases/1");
    phase(kSwing, Support::right, "/phases/1/phases/2");
    phase(kBoth, Support::both, "/phases/1/phases/3");
  }
  phase(kSwing, Support::left, "/phases/2");
  phase(1.3, Support::both, "/phases/3");
  add_key(p, 0, Under::center, "/keyframes/0");
  add_key(p, 0.7, Under::center, "/keyframes/1");
  double t = 1.2 + steps.late;
  for (int round = 0; round < steps.key_rounds; ++round) {
    add_key(p, t, Under::left, "/keyframes/2/keyframes/0");
    add_key(p, t += kSwing, Under::left, "/keyframes/2/keyframes/1");
    add_key(p, t += kBoth, Under::right, "/keyframes/2/keyframes/2");
    add_key(p, t += kSwing, Under::right, "/keyframes/2/keyframes/3");
    t += kBoth;
  }
  add_key(p, t, Under::left, "/keyframes/3");
  add_key(p, t += kSwing, Under::left, "/keyframes/4");
  add_key(p, t + 0.5, Under::center, "/keyframes/5");
  return p;
}

TEST(Contradictions, AnotherNumberOfRoundsIsNamed) {
  expect_named(
      small(), steps_in_blocks({}), [](Pattern& p) { p = steps_in_blocks({.key_rounds = 2}); },
      "/keyframes/2: the block of keyframes repeats 2 times, but the block of phases /phases/1 "
      "repeats 3 "
      "times. With \"repeat\": 3 here, the pattern would be consistent");
}

TEST(Contradictions, AWrongDurationInABlockIsNamed) {
  expect_named(
      small(), steps_in_blocks({}), [](Pattern& p) { p = steps_in_blocks({.first_swing = 0.048}); },
      "/phases/1/phases/0: the phase lasts 0.048 s. .* With a duration of 0.48 s, the pattern "
      "would "
      "be consistent");
}

TEST(Contradictions, KeyframesThatAreOneRoundLateAreNamed) {
  expect_named(
      small(), steps_in_blocks({}), [](Pattern& p) { p = steps_in_blocks({.late = 1.2}); },
      "/keyframes/2: the repeated keyframes begin at 2.4 s, but the repeated phases begin at 1.2 "
      "s. "
      ".* keyframes 1.2 s earlier, the pattern would be consistent");
}

TEST(Contradictions, MissingKeysOfTheZmpAreNamed) {
  expect_named(
      small(), steps_in_blocks({}),
      [](Pattern& p) {
        std::erase_if(p.keyframes, [](const Keyframe& key) {
          return key.pointer == "/keyframes/3" || key.pointer == "/keyframes/4";
        });
      },
      "/phases/2: the robot stands on the left foot from 4.8 s to 5.28 s, but no keyframe puts the "
      "ZMP under this foot. ");
}

// Two steps to the side, with a key of the ZMP at each end of a swing.
Pattern side_steps() {
  Pattern p;
  p.cog_height = 0.238;
  const auto phase = [&](double until, Support support, double y) {
    Phase added{.until = until, .support = support, .swing = {}};
    if (support != Support::both)
      added.swing = Swing{.foot = support == Support::left ? Side::right : Side::left,
                          .to = {.position = {0, y, 0}},
                          .lift = 0.015};
    p.phases.push_back(added);
  };
  phase(1.2, Support::both, 0);
  phase(1.8, Support::right, 0.049);
  phase(2.0, Support::both, 0);
  phase(2.6, Support::left, -0.029);
  phase(4.0, Support::both, 0);
  add_key(p, 0.6, Under::center);
  add_key(p, 1.2, Under::right);
  add_key(p, 1.8, Under::right);
  add_key(p, 2.0, Under::left);
  add_key(p, 2.6, Under::left);
  add_key(p, 3.2, Under::center);
  return p;
}

TEST(Contradictions, AKeyThatIsNotAtTheEndOfItsPhaseIsNamed) {
  expect_named(
      small(), side_steps(), [](Pattern& p) { p.keyframes[3].t = 2.5; },
      "/keyframes/3: t is 2.5 s, .* With t = 2 s, the pattern would be consistent");
}

// The first swing lasts 0.06 s in place of 0.6 s, so all later phases come too early.
void expect_short_phase_named(const Pattern& walk) {
  expect_named(
      small(), walk,
      [](Pattern& p) {
        for (size_t i = 1; i < p.phases.size(); ++i) p.phases[i].until -= 0.54;
      },
      "/phases/1: the phase lasts 0.06 s, .* With a duration of 0.6 s .* the pattern would "
      "be consistent");
}

TEST(Contradictions, ADurationThatMovesAllLaterPhasesIsNamed) {
  expect_short_phase_named(side_steps());
}

// The same mistakes 20 s later: times are compared by their difference, not by a share of it.
Pattern late_side_steps() {
  Pattern p = side_steps();
  for (Phase& phase : p.phases) phase.until += 20;
  for (Keyframe& key : p.keyframes) key.t += 20;
  return p;
}

TEST(Contradictions, AKeyLateInAWalkThatIsNotAtTheEndOfItsPhaseIsNamed) {
  expect_named(
      small(), late_side_steps(), [](Pattern& p) { p.keyframes[3].t = 22.5; },
      "/keyframes/3: t is 22.5 s, .* With t = 22 s, the pattern would be consistent");
}

TEST(Contradictions, ADurationLateInAWalkIsNamed) { expect_short_phase_named(late_side_steps()); }

TEST(Contradictions, KeysOfTheZmpBesideThoseOfTheCogAreNamed) {
  Pattern sway;
  sway.cog_height = 0.24;
  sway.phases = {{.until = 5, .swing = {}}};
  for (const auto& [t, y] : {std::pair(0.5, 0.0), {1.5, 0.02}, {3.5, -0.02}, {4.5, 0.0}}) {
    sway.keyframes.emplace_back();
    sway.keyframes.back().t = t;
    sway.keyframes.back().cog_x = 0.007;
    sway.keyframes.back().cog_y = y;
  }
  expect_named(
      small(), sway, [](Pattern& p) { p.keyframes[1].zmp = ZmpKey{Under::left}; },
      "/keyframes/1: both the COG \\(/keyframes/0\\) and the ZMP \\(/keyframes/1\\) have keys, .* "
      "Without keys of the ZMP, the pattern would be consistent");
}

Pattern strong_jump() {
  Pattern pattern = jump_pattern(small(), jump_defaults(small()));
  pattern.profile = "hoap1-strong";
  return pattern;
}

TEST(Contradictions, AKeyOfTheForceIsNamed) {
  expect_named(
      small(), strong_jump(), [](Pattern& p) { p.keyframes.front().fz = 32; },
      "/keyframes/0: f_z is 32 N, .* Without keys of f_z, the pattern would be consistent");
}

TEST(Contradictions, AKeyOfTheCogInsideAFlightIsNamed) {
  const Pattern jump = strong_jump();
  double begin = 0;
  size_t flight = 0;
  while (jump.phases[flight].support != Support::none) begin = jump.phases[flight++].until;
  const double middle = 0.5 * (begin + jump.phases[flight].until);
  expect_named(
      small(), jump,
      [&](Pattern& p) {
        Keyframe apex;
        apex.t = middle;
        apex.cog_height = 0.27;
        const auto after = std::find_if(p.keyframes.begin(), p.keyframes.end(),
                                        [&](const Keyframe& key) { return key.t > middle; });
        p.keyframes.insert(after, apex);
      },
      "/keyframes/[0-9]+: the COG has a key at .* inside a flight, .* Without keys of the COG "
      "inside the flight, the pattern would be consistent");
}

// A sole in the air in double support is consistent with its plan, but not with the ground.
TEST(Contradictions, AFootAboveTheGroundIsDoubted) {
  Pattern pattern = side_steps();
  EXPECT_TRUE(doubtful_values(small(), pattern).empty());
  pattern.phases[3].swing->to.position.z() = 0.009;
  std::vector<Mistake> doubts = doubtful_values(small(), pattern);
  ASSERT_EQ(doubts.size(), 1u);
  EXPECT_EQ(doubts.front().text(),
            "/phases/3: the right foot's z is 0.009 m, but the ground there is at z = 0 m");
  pattern.world.blocks = {{.low = {-0.1, -0.1}, .high = {0.1, -0.01}, .height = 0.009}};
  doubts = doubtful_values(small(), pattern);
  EXPECT_TRUE(doubts.empty()) << doubts.front().text();
}

TEST(Contradictions, AKickThatEndsAboveTheGroundIsNamed) {
  KickParameters low = kick_defaults(small());
  low.cog_height = 0.238;
  const Pattern kick = kick_pattern(small(), low);
  size_t last = 0;
  for (size_t i = 0; i < kick.keyframes.size(); ++i)
    if (kick.keyframes[i].feet[1]) last = i;
  expect_named(
      small(), kick, [&](Pattern& p) { p.keyframes[last].feet[1]->position.z() = 0.012; },
      "/keyframes/" + std::to_string(last) +
          ": the right foot's z is 0.012 m, but the ground there is at z = 0 m");
}

TEST(Contradictions, AKickThatStaysInTheAirIsNamed) {
  KickParameters low = kick_defaults(small());
  low.cog_height = 0.238;
  const Pattern kick = kick_pattern(small(), low);
  size_t last = 0;
  for (size_t i = 0; i < kick.keyframes.size(); ++i)
    if (kick.keyframes[i].feet[1]) last = i;
  expect_named(
      small(), kick, [&](Pattern& p) { p.keyframes[last].feet[1].reset(); },
      "/keyframes/[0-9]+: the right foot carries the robot from .* s on, but its last key before "
      "this time puts the foot at z = .* m. The ground there is at z = 0 m. With one more key "
      "at .* "
      "s that puts the foot back to its old place, the pattern would be consistent");
}

TEST(Contradictions, FootholdsWithXAndYExchangedAreNamed) {
  expect_named(
      small(), side_steps(),
      [](Pattern& p) {
        std::swap(p.phases[1].swing->to.position.x(), p.phases[1].swing->to.position.y());
      },
      "/phases/1: the foothold of the left foot is at x = 0.049 m and y = 0 m. .* With the two "
      "numbers exchanged, the pattern would be consistent");
}

TEST(Contradictions, AJointThatIsNoMirrorImageIsNamed) {
  constexpr double kDegree = EIGEN_PI / 180;
  Pattern p;
  p.phases = {{.until = 6, .swing = {}}};
  for (const double side : {1, -1})
    for (const auto& [joint, angle] : {std::pair("hip_pitch", -40.0),
                                       {"knee", 80.0},
                                       {"ankle_pitch", -40.0},
                                       {"shoulder_pitch", -30.0}})
      p.postures["low"][(side > 0 ? "l_" : "r_") + std::string(joint)] = angle * kDegree;
  for (const auto& [t, posture] : {std::pair(0.5, "home"), {2.5, "low"}, {5.0, "home"}}) {
    p.keyframes.emplace_back();
    p.keyframes.back().t = t;
    p.keyframes.back().posture = posture;
  }
  expect_named(
      tall(), p, [&](Pattern& wrong) { wrong.postures["low"]["l_knee"] = 8 * kDegree; },
      "/postures/low: l_knee .8 deg. and r_knee .80 deg. are not mirror images. .* With l_knee at "
      "80 deg, the pattern would be consistent");
}

// Two knee bends, whose keyframes repeat in a block.
TEST(Contradictions, ATimeSinceTheKeyframeBeforeIsNamed) {
  const auto bends = [](double up) {
    Pattern p;
    p.phases = {{.until = 8, .swing = {}}};
    double t = 0.5;
    const auto key = [&](double height, int place) {
      p.keyframes.emplace_back();
      p.keyframes.back().t = t;
      p.keyframes.back().cog_height = height;
      p.keyframes.back().pointer =
          place < 0 ? "/keyframes/0" : "/keyframes/1/keyframes/" + std::to_string(place);
    };
    key(0.6, -1);
    for (int round = 0; round < 2; ++round) {
      t += 1.5;
      key(0.5, 0);
      t += 0.3;
      key(0.5, 1);
      t += up;
      key(0.6, 2);
    }
    return p;
  };
  expect_named(
      tall(), bends(1.2), [&](Pattern& p) { p = bends(0.12); },
      "/keyframes/1/keyframes/2: the keyframe comes 0.12 s after the keyframe before it. With 1.2 "
      "s "
      "between these two keyframes, the pattern would be consistent");
}

// The times make the written motion a thousand times as long as the one that is meant. A file may
// hold no motion that is longer than this one.
TEST(Contradictions, AWalkWithTimesInMillisecondsIsNamed) {
  WalkParameters steps = walk_defaults(small());
  steps.steps = 1;
  expect_named(
      small(), walk_pattern(small(), steps),
      [](Pattern& p) {
        for (Phase& phase : p.phases) phase.until *= 1000;
        for (Keyframe& key : p.keyframes) key.t *= 1000;
      },
      "/phases: .*read as ms, the pattern would be consistent");
}

Pattern walk_of(int steps) {
  WalkParameters parameters = walk_defaults(small());
  parameters.steps = steps;
  return walk_pattern(small(), parameters);
}

// The rounds of the inner block also have the pointer of the outer one.
TEST(Contradictions, BlocksInBlocksAreNotCounted) {
  Pattern p = steps_in_blocks({.phase_rounds = 6, .key_rounds = 2});
  EXPECT_FALSE(block_hypotheses(p).empty());
  for (Phase& phase : p.phases)
    if (const size_t in = phase.pointer.find("/phases/", 1); in != std::string::npos)
      phase.pointer.insert(in, "/phases/0");
  EXPECT_TRUE(block_hypotheses(p).empty());
}

// Stairs that are not declared raise the foot of each step, but are one contradiction. They must
// not keep the search from other mistakes.
TEST(Contradictions, FeetOnUndeclaredStairsAreTriedTogether) {
  constexpr size_t kFew = 5;
  Pattern p = walk_of(70);
  double height = 0;
  for (Phase& phase : p.phases)
    if (phase.swing) phase.swing->to.position.z() = height += 0.005;
  const Hypotheses possible(small(), p, {});
  size_t of_feet = 0;
  for (const Hypothesis& h : possible.of(Hypotheses::Kind::times)) {
    if (h.rank != Rank::geometry || h.says.written.find("foot's z") == std::string::npos) continue;
    ++of_feet;
    if (h.says.instead != "with all these heights on the declared ground") continue;
    Pattern level = p;
    h.mend(level);
    for (const Phase& phase : level.phases)
      if (phase.swing) {
        EXPECT_NEAR(phase.swing->to.position.z(), 0, 1e-9);
      }
  }
  EXPECT_EQ(of_feet, kFew);
}

// A phase that is nearly as long as usual may still end beside its key.
TEST(Contradictions, AnEndBesideItsKeyIsTriedAlsoNearTheUsualDuration) {
  Pattern p = walk_of(8);
  const double meant = p.phases[3].until;
  p.phases[3].until += 0.05;
  const Hypotheses possible(small(), p, {});
  const std::vector<Hypothesis> times = possible.of(Hypotheses::Kind::times);
  EXPECT_TRUE(std::any_of(times.begin(), times.end(), [&](const Hypothesis& h) {
    Pattern mended = p;
    h.mend(mended);
    return h.says.place == "/phases/3" && std::abs(mended.phases[3].until - meant) < 1e-9 &&
           mended.phases[4].until == p.phases[4].until;
  }));
}

// A change that makes the motion too long for the trials that are left does not keep shorter ones
// from being tried.
TEST(Contradictions, AChangeThatIsTooCostlyDoesNotEndTheSearch) {
  const Pattern sound = side_steps();
  Trials trials(small(), sound, options_of(sound), {}, 2);
  const std::vector<TrialOutcome> outcomes =
      trials.after(sound, {[](Pattern& p) { p.phases.back().until += 20; }, [](Pattern&) {}});
  EXPECT_EQ(outcomes[0].errors, kUnsampled);
  EXPECT_TRUE(outcomes[1].good());
  EXPECT_TRUE(trials.ended());
}

// More mistakes than the search names, in a motion that may have more than it tries of one kind.
TEST(Contradictions, ASearchThatLeavesOutChangesIsNotComplete) {
  constexpr int kAmple = 100'000;
  Pattern p = walk_of(24);
  for (Phase& phase : p.phases)
    if (phase.swing) phase.swing->to.position.y() += phase.swing->foot == Side::left ? 0.5 : -0.5;
  const Explanations search = find_explanations(small(), p, options_of(p), {}, kAmple);
  EXPECT_FALSE(search.complete);
}

}  // namespace
}  // namespace ayumi::test::contradictions
