// Mistakes that people make, planted into sound patterns of two robots: the first likely cause that
// the check reports names the place in the file and the intended value.

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <numbers>
#include <regex>
#include <set>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/check/consistency.hpp"
#include "ayumi/check/likely_mistakes.hpp"
#include "ayumi/check/mistake_hypotheses.hpp"
#include "ayumi/check/mistake_search.hpp"
#include "ayumi/plan/sample.hpp"
#include "tests/support/biped.hpp"
#include "tests/support/robot_motions.hpp"

namespace ayumi::test {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

const RobotModel& small() { return bundled_robot("hoap1"); }
const RobotModel& tall() { return bundled_robot("humanoid30"); }

Pattern walk(const RobotModel& robot) {
  WalkParameters steps = walk_defaults(robot);
  steps.steps = 3;
  return walk_pattern(robot, steps);
}

Keyframe& key_at(Pattern& pattern, double t) {
  pattern.keyframes.emplace_back();
  pattern.keyframes.back().t = t;
  return pattern.keyframes.back();
}

/// A quarter turn to the left: the left foot leads by 30 deg in each of three pairs of steps, and
/// the right foot follows. The robot stands on both feet for `both` [s] between the steps.
Pattern quarter_turn(double both = 0.3) {
  Pattern pattern;
  pattern.degrees = true;
  pattern.phases.push_back({.until = 1.1, .swing = {}});
  key_at(pattern, 0.5).zmp = ZmpKey{ZmpKey::Place::center};
  double t = 1.1;
  for (int step = 0; step < 6; ++step) {
    const Side foot = step % 2 == 0 ? Side::left : Side::right;
    const auto under = foot == Side::left ? ZmpKey::Place::right : ZmpKey::Place::left;
    const RelativeStep to =
        foot == Side::left ? RelativeStep{.side = 0.01, .turn = 30 * kDegree} : RelativeStep{};
    key_at(pattern, t).zmp = ZmpKey{under};
    key_at(pattern, t += 0.6).zmp = ZmpKey{under};
    pattern.phases.push_back({.until = t,
                              .support = foot == Side::left ? Support::right : Support::left,
                              .swing = Swing{.foot = foot, .to = {}, .lift = 0.015, .step = to}});
    pattern.phases.push_back({.until = t += both, .swing = {}});
  }
  pattern.phases.back().until = t + 0.8;
  key_at(pattern, t + 0.3).zmp = ZmpKey{ZmpKey::Place::center};
  return pattern;
}

/// A kick to the right with a foot that turns with its leg.
Pattern side_kick() {
  Pattern pattern;
  pattern.degrees = true;
  pattern.phases = {{.until = 1.5, .swing = {}},
                    {.until = 3.5, .support = Support::left, .swing = {}},
                    {.until = 5, .swing = {}}};
  key_at(pattern, 0.5).zmp = ZmpKey{ZmpKey::Place::center};
  pattern.keyframes.back().cog_height = 0.6;
  key_at(pattern, 1.4).zmp = ZmpKey{ZmpKey::Place::left};
  key_at(pattern, 1.5).feet[1] = Foothold{{0, -0.095, 0}};
  key_at(pattern, 2.1).feet[1] = Foothold{{0, -0.15, 0.1}};
  key_at(pattern, 2.5).feet[1] = Foothold{{0, -0.25, 0.12}, {-16 * kDegree, 0, 0}};
  key_at(pattern, 3.5).feet[1] = Foothold{{0, -0.095, 0}};
  pattern.keyframes.back().zmp = ZmpKey{ZmpKey::Place::left};
  key_at(pattern, 4.3).zmp = ZmpKey{ZmpKey::Place::center};
  pattern.keyframes.back().cog_height = 0.6;
  for (size_t k = 2; k < 6; ++k)  // the directions away from the leg
    pattern.keyframes[k].joints["r_shoulder_roll"] = (k == 2 || k == 5 ? -10 : -45) * kDegree;
  return pattern;
}

struct Mistaken {
  const char* name;
  const RobotModel& robot;
  const Pattern& sound;
  std::function<void(Pattern&)> plant;
  const char* named;  ///< a regular expression that the first likely cause matches
};

Swing& swing(Pattern& p, size_t phase) { return *p.phases[phase].swing; }

std::vector<Mistaken> make_list() {
  std::vector<Mistaken> all;
  const auto add = [&](const char* name, const RobotModel& robot, const Pattern& sound,
                       const char* named, std::function<void(Pattern&)> plant) {
    all.push_back({name, robot, sound, std::move(plant), named});
  };
  static const Pattern steps = walk(small()), strides = walk(tall());
  static const Pattern squat = squat_pattern(small(), squat_defaults(small()));
  static const Pattern sway = sway_pattern(tall(), sway_defaults(tall()));
  static const Pattern bow = bow_pattern(small(), bow_defaults(small()));
  static const Pattern wave = wave_pattern(small(), wave_defaults(small()));
  KickParameters low = kick_defaults(small());
  low.cog_height = 0.238;
  static const Pattern kick = kick_pattern(small(), low);
  static const Pattern wide_kick = kick_pattern(tall(), kick_defaults(tall()));
  static const Pattern turn = quarter_turn(), side = side_kick();
  static const Pattern jump = [] {
    Pattern pattern = jump_pattern(small(), jump_defaults(small()));
    pattern.profile = "hoap1-strong";
    return pattern;
  }();
  add("foothold of 0.6 m", small(), steps, "/phases/3: the left foot's x is 0.6 m.*\\(0.06 m\\)",
      [](Pattern& p) { swing(p, 3).to.position.x() = 0.6; });
  add("footholds exchanged", small(), steps, "/phases/3: .*/phases/5 were perhaps exchanged",
      [](Pattern& p) { std::swap(swing(p, 3).to, swing(p, 5).to); });
  add("missing swing", small(), steps, "/phases/3: .*Perhaps a swing of the .* foot is missing",
      [](Pattern& p) { p.phases[3].swing.reset(); });
  add("degrees as radians", small(), wave, "/units: .*\"angle\": \"deg\"", [](Pattern& p) {
    p.degrees = false;
    for (Keyframe& key : p.keyframes)
      for (auto& entry : key.joints) entry.second /= kDegree;
  });
  add("radians as degrees", small(), wave, "/units: .*\"angle\": \"rad\"", [](Pattern& p) {
    for (Keyframe& key : p.keyframes)
      for (auto& entry : key.joints) entry.second *= kDegree;
  });
  add("COG height of 2.15 m", small(), squat,
      "/keyframes/2: the COG height is 2.15 m.*\\(0.215 m\\)",
      [](Pattern& p) { p.keyframes[2].cog_height = 2.15; });
  add("a COG height of 600 mm", tall(), strides, "/defaults/cog_height: .*in mm \\(0.6 m\\)",
      [](Pattern& p) { p.cog_height = 600; });
  add("a ZMP key under the wrong foot", small(), steps,
      "/phases/3: the robot stands on the right foot, but /keyframes/4 puts the ZMP under the left",
      [](Pattern& p) { p.keyframes[4].zmp->place = ZmpKey::Place::left; });
  add("the ZMP in the middle while one foot stands", small(), kick,
      "/phases/1: the robot stands on the left foot.*at \"center\"", [](Pattern& p) {
        for (Keyframe& key : p.keyframes)
          if (key.zmp) key.zmp->place = ZmpKey::Place::center;
      });
  add("a time with a digit too many", small(), wave, "/keyframes/4: t is .* With t = 2.3 s",
      [](Pattern& p) { p.keyframes[4].t = 2.03; });
  add("a leg key", small(), steps, "/keyframes/3: l_knee is a joint of a leg",
      [](Pattern& p) { p.keyframes[3].joints["l_knee"] = 1; });
  add("a foot key 30 mm up", small(), kick,
      "/keyframes/3: the right foot('s z is 0.03 m| is lifted by 30 mm)", [](Pattern& p) {
        p.cog_height = 0;
        p.keyframes.erase(p.keyframes.begin() + 3);
        p.keyframes[3].t = 2.08;
        p.keyframes[3].feet[1] = Foothold{{0, -0.039, 0.03}};
      });
  add("legs too straight for a lifted foot", small(), kick,
      "/(defaults/cog_height: .*nearly straight|keyframes/[34]: the right foot is lifted by .* mm)",
      [](Pattern& p) { p.cog_height = 0; });
  add("knees nearly straight at lift-off", small(), jump,
      "/keyframes/2: the COG height is 0.262 m.* With straight legs, the COG height is 0.2",
      [](Pattern& p) { p.keyframes[2].cog_height = p.keyframes[3].cog_height = 0.262; });
  add("a segment too long for its stoop", small(), jump, "/keyframes/1: t is 1.1 s, so .* lasts",
      [](Pattern& p) { p.keyframes[1].t = 1.1; });
  add("the foot on the wrong side", small(), steps,
      "/phases/3: the left foot's y is -0.039 m. With 0.039 m .perhaps .*exchanged",
      [](Pattern& p) { swing(p, 3).to.position.y() *= -1; });
  add("a phase that names the wrong foot", small(), steps,
      "/phases/3: the phase has .support.: .left. .*exchanged. With .support.: .right.",
      [](Pattern& p) {
        p.phases[3].support = Support::left;
        swing(p, 3).foot = Side::right;
      });
  add("a foothold in mm", small(), steps, "/phases/3: the left foot is at \\(60, 39.*read in mm",
      [](Pattern& p) { swing(p, 3).to.position *= 1000; });
  add("a lift of 0.9 m", tall(), strides, "/phases/3: the lift of the swing is 0.9 m",
      [](Pattern& p) { swing(p, 3).lift = 0.9; });
  add("an elbow with the wrong sign", small(), wave,
      "/keyframes/3: r_elbow is .*With the other sign",
      [](Pattern& p) { p.keyframes[3].joints["r_elbow"] *= -1; });
  add("the joints of the other arm", small(), wave, "/keyframes/2: .*left and right",
      [](Pattern& p) {
        std::map<std::string, double> other;
        for (const auto& [joint, angle] : p.keyframes[2].joints)
          other["l" + joint.substr(1)] = angle;
        p.keyframes[2].joints = other;
      });
  add("a trunk too far ahead", small(), bow,
      "/keyframes/2: the pitch of the trunk is 75 deg.*of at most", [](Pattern& p) {
        for (const size_t k : {size_t(2), size_t(3)}) p.keyframes[k].torso->y() = 75 * kDegree;
      });
  add("the trunk's degrees as radians", small(), bow, "/units: .*\"angle\": \"deg\"",
      [](Pattern& p) {
        p.degrees = false;
        for (Keyframe& key : p.keyframes)
          if (key.torso) *key.torso /= kDegree;
      });
  add("a squat too deep", small(), squat,
      "/keyframes/2: the COG height is 0.115 m.*of at least 0.1",
      [](Pattern& p) { p.keyframes[2].cog_height = 0.115; });
  add("a sway in mm", tall(), sway, "/keyframes/2: the COG's y is .*read in mm",
      [](Pattern& p) { *p.keyframes[2].cog_y *= 1000; });
  add("a sway ten times too far", tall(), sway, "/keyframes/3: the COG's y is .*decimal point",
      [](Pattern& p) { *p.keyframes[3].cog_y *= 10; });
  for (const auto& [robot, sound] : {std::pair(&small(), &steps), std::pair(&tall(), &strides)})
    add("a COG that stays behind", *robot, *sound,
        "/keyframes/\\d+: the COG's x is 0 m, but the middle of the standing feet .* consistent",
        [](Pattern& p) { p.keyframes.front().cog_x = p.keyframes.back().cog_x = 0; });
  add("slippery ground", small(), steps, "/world/friction: .*0.05. With .*0.1",
      [](Pattern& p) { p.world.friction = 0.05; });
  add("a force in kg", small(), steps, "/keyframes/2: f_z is 6 N",
      [](Pattern& p) { p.keyframes[2].fz = 6; });
  add("a phase that ends too early", small(), steps,
      "/phases/3: the phase ends at .*while similar phases last",
      [](Pattern& p) { p.phases[3].until = p.phases[2].until + 0.05; });
  add("a foot under the ground", small(), kick, "/keyframes/4: the right foot's z is -0.03 m",
      [](Pattern& p) { p.keyframes[4].feet[1]->position.z() *= -1; });
  add("a foothold in the air", small(), steps, "/phases/3: the left foot's z is 0.05 m",
      [](Pattern& p) { swing(p, 3).to.position.z() = 0.05; });
  add("feet exchanged at the start", small(), steps, "/start: .*exchanged", [](Pattern& p) {
    p.start_feet = {Foothold{{0, -0.039, 0}}, Foothold{{0, 0.039, 0}}};
  });
  add("a key that jumps", small(), wave, "/keyframes/3: interpolation \"hold\"",
      [](Pattern& p) { p.keyframes[3].interpolation = Interpolation::hold; });
  add("a yaw of 60 deg", tall(), strides, "/phases/3: the left foot's yaw is 90 deg",
      [](Pattern& p) { swing(p, 3).to.rpy.z() = 90 * kDegree; });
  add("a key of the foot that stands", small(), kick, "/keyframes/4: the key moves the left foot",
      [](Pattern& p) { std::swap(p.keyframes[4].feet[0], p.keyframes[4].feet[1]); });
  add("a kick to the wrong side", small(), kick,
      "/keyframes/4: the right foot's y is 0.039 m. With -0.039 m .perhaps",
      [](Pattern& p) { p.keyframes[4].feet[1]->position.y() *= -1; });
  add("a missing double support", small(), steps, "/phases/4: .*\"both\" is missing",
      [](Pattern& p) { p.phases.erase(p.phases.begin() + 4); });
  add("all ZMP keys under the other foot", small(), steps,
      "/keyframes: the keys put the ZMP under the foot that does not .*exchanged in all ZMP keys",
      [](Pattern& p) {
        for (Keyframe& key : p.keyframes)
          if (key.zmp && key.zmp->place != ZmpKey::Place::center)
            key.zmp->place =
                key.zmp->place == ZmpKey::Place::left ? ZmpKey::Place::right : ZmpKey::Place::left;
      });
  add("no ZMP key under a foot", small(), steps,
      "/phases/1: the robot stands on the left foot, .*at \"center\". The ZMP is wrong in the same "
      "manner in 4 phases",
      [](Pattern& p) {
        for (Keyframe& key : p.keyframes)
          if (key.zmp) key.zmp->place = ZmpKey::Place::center;
      });
  add("longer phases with the keyframes left", small(), steps,
      "/keyframes: the times of the keyframes do not fit .*multiplied by 1.5", [](Pattern& p) {
        for (Phase& phase : p.phases) phase.until *= 1.5;
      });
  add("a point of the ZMP in mm", small(), kick, "/keyframes/.: the ZMP is at \\(7, 35\\) m.*in mm",
      [](Pattern& p) {
        for (Keyframe& key : p.keyframes)
          if (key.zmp && key.zmp->place == ZmpKey::Place::left) {
            *key.zmp = {ZmpKey::Place::point, {7, 35}};
            return;
          }
      });
  add("a foot that stays up", small(), kick, "/keyframes/.: the right foot's z is 0.02 m",
      [](Pattern& p) {
        for (size_t k = p.keyframes.size(); k-- > 0;)
          if (p.keyframes[k].feet[1]) {
            p.keyframes[k].feet[1]->position.z() = 0.02;
            return;
          }
      });
  add("a kick farther than the leg", tall(), wide_kick,
      "/keyframes/4: the right foot's x is 0.72 m. With the decimal point one place further left",
      [](Pattern& p) { p.keyframes[4].feet[1]->position.x() = 0.72; });
  add("a bow within 60 ms", small(), bow,
      "/keyframes/2: t is .*, so the segment before this key lasts 0.06",
      [](Pattern& p) { p.keyframes[2].t = p.keyframes[1].t + 0.06; });
  add("a swing too short, and all after it", tall(), strides,
      "/phases/3: the phase ends .*all times after this phase .* later", [](Pattern& p) {
        const double until = p.phases[3].until, cut = until - p.phases[2].until - 0.1;
        for (size_t i = 3; i < p.phases.size(); ++i) p.phases[i].until -= cut;
        for (Keyframe& key : p.keyframes)
          if (key.t >= until - 1e-9) key.t -= cut;
      });
  add("a turn of both feet", small(), turn,
      "/phases/3: the right foot's step turns by 30 deg after the left foot .* turn the robot by "
      "180 deg. With \"turn\" 0 in the 3 steps",
      [](Pattern& p) {
        for (Phase& phase : p.phases)
          if (phase.swing) phase.swing->step->turn = 30 * kDegree;
      });
  add("a level foot of a leg that leans", tall(), side,
      "/keyframes/4: the right foot stays level while its leg leans by 30 deg to the side. "
      ".*\"rpy\": \\[-30, 0, -5\\]",  // its yaw stays
      [](Pattern& p) {
        p.keyframes[4].feet[1]->rpy = {0, 0, -5 * kDegree};
      });
  return all;
}

const std::vector<Mistaken>& list() {
  static const std::vector<Mistaken> all = make_list();
  return all;
}

CheckOptions options_of(const Pattern& pattern) {
  CheckOptions options;
  options.profile = pattern.profile;
  options.friction = pattern.world.friction;
  return options;
}

TEST(PlantedMistakes, AreNamed) {
  for (const Mistaken& mistaken : list()) {
    Pattern pattern = mistaken.sound;
    mistaken.plant(pattern);
    const std::vector<Mistake> found =
        likely_mistakes(mistaken.robot, pattern, options_of(pattern));
    ASSERT_FALSE(found.empty()) << mistaken.name;
    EXPECT_TRUE(std::regex_search(found.front().text(), std::regex(mistaken.named)))
        << mistaken.name << ": " << found.front().text();
  }
}

// A reach of the left hand in three keys. In an earlier version, other units of targets were not
// tried.
TEST(PlantedMistakes, TargetsOfHandsInAnotherUnitAreNamed) {
  for (const auto& [robot, size] : {std::pair(&small(), 1.0), {&tall(), 2.4}}) {
    Pattern reach;
    reach.phases = {{.until = 6.5, .swing = {}}};
    key_at(reach, 0).zmp = ZmpKey{ZmpKey::Place::center};
    for (const auto& [t, place] : {std::pair(1.5, Eigen::Vector3d(0.12, 0.14, 0.05)),
                                   {2.5, {0.14, 0.1, 0.08}},
                                   {3.5, {0.12, 0.14, 0.05}}})
      key_at(reach, t).hands["left"] = {LinkTarget::Frame::trunk, size * place, std::nullopt};
    const auto first_cause = [&robot = *robot](const Pattern& pattern) {
      const std::vector<Mistake> found = likely_mistakes(robot, pattern, options_of(pattern));
      return found.empty() ? "" : found.front().text();
    };
    const auto position = [](Pattern& pattern, size_t key) -> Eigen::Vector3d& {
      return *pattern.keyframes[key].hands["left"].position;
    };
    for (const auto& [unit, factor] : {std::pair("mm", 1e3), std::pair("cm", 1e2)}) {
      Pattern all = reach, one = reach;
      for (const size_t key : {1, 2, 3}) position(all, key) *= factor;
      position(one, 2) *= factor;
      EXPECT_TRUE(std::regex_search(
          first_cause(all), std::regex(std::string("^/keyframes/1/hands/left: the left hand is .*"
                                                   "and there are 2 more targets .* read in ") +
                                       unit + ", the pattern would be consistent$")))
          << first_cause(all);
      EXPECT_TRUE(std::regex_search(
          first_cause(one), std::regex(std::string("^/keyframes/2/hands/left: the left hand is .*"
                                                   "With these numbers read in ") +
                                       unit + ", .* the pattern would be consistent$")))
          << first_cause(one);
    }
  }
}

// The y of all footholds is counted to the right, or the words left and right are exchanged
// throughout. In an earlier version, the height of the COG was named, and then one foothold after
// the other.
TEST(PlantedMistakes, SidesThatAreAllExchangedAreNamed) {
  for (const RobotModel* robot : {&small(), &tall()}) {
    Pattern sides = walk(*robot), words = sides;
    for (Phase& phase : sides.phases)
      if (phase.swing) phase.swing->to.position.y() *= -1;
    for (Phase& phase : words.phases) {
      if (!phase.swing) continue;
      phase.support = phase.support == Support::left ? Support::right : Support::left;
      phase.swing->foot = other(phase.swing->foot);
    }
    for (Keyframe& key : words.keyframes) {
      if (!key.zmp) continue;
      const auto place = key.zmp->place;
      if (place == ZmpKey::Place::left) key.zmp->place = ZmpKey::Place::right;
      if (place == ZmpKey::Place::right) key.zmp->place = ZmpKey::Place::left;
    }
    for (const Pattern& pattern : {sides, words}) {
      const std::vector<Mistake> found = likely_mistakes(*robot, pattern, options_of(pattern));
      ASSERT_FALSE(found.empty());
      EXPECT_TRUE(std::regex_search(
          found.front().text(),
          std::regex("^/phases/1: . of . footholds lie on the side of the other foot .* the "
                     "pattern would be consistent$")))
          << found.front().text();
    }
  }
}

// Neither of two mistakes is enough alone; both are named, one after the other.
TEST(PlantedMistakes, TwoAreNamedInTurn) {
  Pattern pattern = walk(small());
  pattern.keyframes[2].zmp->place = pattern.keyframes[3].zmp->place = ZmpKey::Place::right;
  swing(pattern, 5).to.position.y() *= -1;
  std::string found;
  for (const Mistake& mistake : likely_mistakes(small(), pattern, options_of(pattern)))
    found += mistake.text() + "\n";
  EXPECT_NE(found.find("/phases/5: the right foot's y is 0.039 m"), std::string::npos) << found;
  EXPECT_NE(found.find("/phases/1: the robot stands on the left foot, but "), std::string::npos)
      << found;
}

// Two mistakes of one joint: the speed at the beginning counts as a consequence of the angle, so
// neither change leaves fewer errors.
TEST(PlantedMistakes, TwoOfOneJointAreNamedInTurn) {
  Pattern pattern = squat_pattern(small(), squat_defaults(small()));
  pattern.keyframes.clear();
  for (const auto& [t, angle] : {std::pair(0.1, 0.0), {1.5, 60.0}, {3.0, -25.0}}) {
    Keyframe key;
    key.t = t;
    key.joints["l_elbow"] = angle * kDegree;
    pattern.keyframes.push_back(key);
  }
  std::string found;
  for (const Mistake& mistake : likely_mistakes(small(), pattern, options_of(pattern)))
    found += mistake.text() + "\n";
  EXPECT_NE(found.find("/keyframes/1: l_elbow is "), std::string::npos) << found;
  EXPECT_NE(found.find("/keyframes/0: l_elbow is 0 "), std::string::npos) << found;
  EXPECT_NE(found.find("the pattern would be consistent (together"), std::string::npos) << found;
}

// If neither trial leaves fewer errors, the missing shift of the weight is named nevertheless.
TEST(PlantedMistakes, AWeightThatIsNotShiftedIsNamed) {
  Pattern pattern = kick_pattern(small(), kick_defaults(small()));
  for (Keyframe& key : pattern.keyframes)
    if (key.zmp) key.zmp->place = ZmpKey::Place::center;
  std::string found;
  for (const Mistake& mistake : impossible_values(small(), pattern)) found += mistake.text() + "\n";
  EXPECT_TRUE(std::regex_search(found, std::regex("the robot stands on the left foot, but .* put "
                                                  "the ZMP at \"center\", between both feet")))
      << found;
}

// Steps to places in the world that land too far apart, while one foot is turned: with nearer
// footholds and less of a turn, the pattern is consistent, and no key of the ZMP moves into a
// swing.
TEST(PlantedMistakes, FootholdsTooFarApartAreNamed) {
  Pattern pattern = quarter_turn(0.25);
  const std::vector<Foothold> places = {{{0, 0.055, 0}, {0, 0, 45 * kDegree}},
                                        {{0.055, 0, 0}, {0, 0, 45 * kDegree}},
                                        {{-0.02, 0.075, 0}, {0, 0, 90 * kDegree}},
                                        {{0.058, 0.075, 0}, {0, 0, 90 * kDegree}}};
  pattern.phases.resize(9);
  pattern.phases.back().until += 1;
  pattern.keyframes.resize(9);
  key_at(pattern, pattern.phases.back().until - 0.5).zmp = ZmpKey{ZmpKey::Place::center};
  for (size_t step = 0; step < places.size(); ++step) {
    swing(pattern, 2 * step + 1).step.reset();
    swing(pattern, 2 * step + 1).to = places[step];
  }
  const std::vector<Mistake> found = likely_mistakes(small(), pattern, options_of(pattern));
  ASSERT_FALSE(found.empty());
  EXPECT_NE(found.front().text().find("/phases/5: the left foot lands 106 mm from the right foot. "
                                      "At the beginning of the motion, the feet are 78 mm apart. "
                                      "With \"to\" = ["),
            std::string::npos)
      << found.front().text();
  EXPECT_TRUE(found.back().explains_all) << found.back().text();
  for (const Mistake& mistake : found)
    EXPECT_EQ(mistake.text().find("/keyframes/"), std::string::npos) << mistake.text();
}

// A motion that is only too fast at the servo's period, at which the table for the robot is judged.
TEST(PlantedMistakes, WhatOnlyTheTableShowsIsNamed) {
  Pattern pattern = squat_pattern(small(), squat_defaults(small()));
  pattern.keyframes.clear();
  for (const auto& [t, angle] : {std::pair(0.2, 10.0), {0.5, 0.0}, {0.8, 10.0}}) {
    Keyframe key;
    key.t = t;
    key.joints["l_shoulder_roll"] = angle * kDegree;
    pattern.keyframes.push_back(key);
  }
  const std::vector<Mistake> found = likely_mistakes(small(), pattern, options_of(pattern));
  ASSERT_FALSE(found.empty()) << "the servo target leads beyond the range";
  EXPECT_EQ(found.front().place, "/keyframes/1");
}

TEST(PlantedMistakes, SoundPatternsHaveNone) {
  std::set<const Pattern*> seen;  // many mistakes are planted into the same pattern
  for (const Mistaken& mistaken : list()) {
    const Pattern& sound = mistaken.sound;
    if (!seen.insert(&sound).second) continue;
    EXPECT_TRUE(find_explanations(mistaken.robot, sound, options_of(sound), {}).found.empty())
        << mistaken.name;
    EXPECT_TRUE(doubtful_values(mistaken.robot, sound).empty()) << mistaken.name;
  }
  EXPECT_EQ(seen.size(), 11u);
}

// A torque that is a little too large, at one step or at every step, is not caused by exchanged
// sides, a typing error or a tiny change of a number; the search for its cause is short.
TEST(PlantedMistakes, SlightErrorsHaveNoGrossCause) {
  const std::regex gross("exchanged|decimal point|other sign|read in|missing");
  WalkParameters inwards = walk_defaults(small());  // keys of the ZMP are points on the soles
  inwards.steps = 3;
  inwards.zmp_inwards = 0.005;
  const std::vector<std::pair<const RobotModel*, Pattern>> walks = {
      {&small(), walk(small())},
      {&tall(), walk(tall())},
      {&small(), walk_pattern(small(), inwards)}};
  for (const auto& [robot, pattern] : walks) {
    CheckOptions options = options_of(pattern);
    const double most = check_consistency(*robot, sample(*robot, pattern), options)
                            .summary[FindingKind::joint_torque];
    for (const double share : {0.99, 0.93}) {
      options.tolerances["joint_torque"] = share * most;
      ASSERT_FALSE(check_consistency(*robot, sample(*robot, pattern), options).consistent);
      const Explanations search = find_explanations(*robot, pattern, options, {});
      EXPECT_LE(search.trials, kMostTrials / 2) << robot->name() << ", " << share;
      for (const Explanation& e : search.found) {
        const std::string words = e.written + ". " + e.instead;
        EXPECT_FALSE(std::regex_search(words, gross)) << e.place << ": " << words;
        // The value differs from the one that would pass.
        std::smatch is, would;
        const bool both = std::regex_search(e.written, is, std::regex(" is (-?[0-9.]+ [a-z]+)")) &&
                          std::regex_search(e.instead, would,
                                            std::regex("value of at (most) (-?[0-9.]+ [a-z]+)"));
        EXPECT_FALSE(both && is[1] == would[2]) << e.place << ": " << words;
      }
    }
  }
}

/// A hop with a flight from 1.5 to 1.65 s and these keys of the COG height (time, height).
Pattern hop_with(const std::vector<std::pair<double, double>>& heights) {
  Pattern hop;
  hop.robot = "hoap1";
  hop.profile = "hoap1-strong";
  for (const auto& [until, support] :
       {std::pair(1.5, Support::both), {1.65, Support::none}, {3.5, Support::both}}) {
    Phase phase;
    phase.until = until;
    phase.support = support;
    hop.phases.push_back(phase);
  }
  for (const auto& [t, height] : heights) key_at(hop, t).cog_height = height;
  return hop;
}

// A value that is very wrong is named although most errors remain.
TEST(PlantedMistakes, AStoopFarTooDeepIsNamed) {
  const Pattern hop =
      hop_with({{0.5, 0.245}, {1.2, 0.19}, {1.5, 0.235}, {1.65, 0.235}, {1.9, 0.19}, {2.7, 0.245}});
  const std::vector<Mistake> found = likely_mistakes(small(), hop, options_of(hop));
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found.front().words.rfind("the COG height is 0.19 m", 0), 0u) << found.front().text();
}

// A hop whose flight is longer than its author thought: the COG sinks below the key of the stoop,
// and is not at its lowest where the author wrote it.
TEST(PlantedMistakes, ACogThatSinksBelowItsStoopIsNamed) {
  const Pattern hop =
      hop_with({{0.5, 0.245}, {1.2, 0.2}, {1.5, 0.22}, {1.65, 0.22}, {1.75, 0.2}, {2.8, 0.245}});
  const std::vector<Mistake> found = likely_mistakes(small(), hop, options_of(hop));
  ASSERT_FALSE(found.empty());
  EXPECT_TRUE(std::regex_search(
      found.front().text(),
      std::regex(
          "^/keyframes/1: t is 1.2 s, so the segment from this key to the lift-off lasts 0.3 s. "
          "The flight .* COG speed of 0.74 m/s at its beginning. With this speed, the "
          "segment is so long that the COG sinks .* mm below the height of this key. With t = ")))
      << found.front().text();
}

// A kick with a level foot: the pose of the foot is named for every key at which its leg is
// inclined, and with all the named changes the pattern is consistent.
TEST(PlantedMistakes, EveryKeyOfALevelFootIsNamed) {
  Pattern kick;
  kick.robot = "hoap1";
  kick.degrees = true;
  kick.cog_height = 0.235;
  kick.phases = {{.until = 1.5, .swing = {}},
                 {.until = 3.2, .support = Support::right, .swing = {}},
                 {.until = 5, .swing = {}}};
  key_at(kick, 0.5).zmp = ZmpKey{ZmpKey::Place::center};
  key_at(kick, 1.3).zmp = ZmpKey{ZmpKey::Place::right};
  key_at(kick, 1.5).feet[0] = Foothold{{0, 0.039, 0}};
  key_at(kick, 2.0).feet[0] = Foothold{{-0.04, 0.039, 0.03}};
  key_at(kick, 2.3).feet[0] = Foothold{{0.07, 0.039, 0.05}};
  key_at(kick, 3.2).feet[0] = Foothold{{0, 0.039, 0}};
  key_at(kick, 3.4).zmp = ZmpKey{ZmpKey::Place::right};
  key_at(kick, 4.2).zmp = ZmpKey{ZmpKey::Place::center};
  std::string found;
  for (const Mistake& mistake : likely_mistakes(small(), kick, options_of(kick)))
    found += mistake.text() + "\n";
  std::smatch lean;
  ASSERT_TRUE(std::regex_search(
      found, lean,
      std::regex(
          "\"position\": \\[0.07, 0.039, ([0-9.]+)\\], \"rpy\": \\[0, (-[0-9]+), 0\\]\\}; in "
          "/keyframes/3, \"left\": \\{\"position\": \\[-0.04, 0.039, 0.03\\], \"rpy\": \\[0, "
          "([0-9]+), 0\\]\\}. With these changes, the pattern would be consistent")))
      << found;
  kick.keyframes[4].feet[0]->position.z() = std::stod(lean[1]);
  kick.keyframes[4].feet[0]->rpy.y() = std::stod(lean[2]) * kDegree;
  kick.keyframes[3].feet[0]->rpy.y() = std::stod(lean[3]) * kDegree;
  EXPECT_TRUE(check_consistency(small(), sample(small(), kick), options_of(kick)).consistent)
      << found;
}

std::string texts_of(const std::vector<Mistake>& mistakes) {
  std::string all;
  for (const Mistake& mistake : mistakes) all += mistake.text() + "\n";
  return all;
}

CheckOptions strong_options(const Pattern& pattern) {
  CheckOptions options = options_of(pattern);
  options.profile = pattern.profile;
  return options;
}

bool is_consistent(const Pattern& pattern, const CheckOptions& options) {
  return check_consistency(small(), sample(small(), pattern), options).consistent;
}

/// Shortens the flight and makes everything after it earlier, by the values in a message.
void shorten_flight(Pattern& pattern, const std::smatch& says) {
  const double earlier = std::stod(says[2]), end = pattern.phases[1].until;
  EXPECT_NEAR(end - pattern.phases[0].until - std::stod(says[1]), earlier, 1e-9);
  for (Keyframe& key : pattern.keyframes)
    if (key.t > end - 1e-9) key.t -= earlier;
  for (Phase& phase : pattern.phases)
    if (phase.until > end - 1e-9) phase.until -= earlier;
}

const std::regex& flight_words() {
  static const std::regex words(
      "/phases/1: the flight lasts 0.1[56] s, in which the robot rises by [0-9]+ mm. With a flight "
      "of ([0-9.]+) s, and everything after the flight ([0-9.]+) s earlier, the pattern would be "
      "consistent");
  return words;
}

TEST(PlantedMistakes, AShorterFlightIsNamedForAHopThatIsTooHigh) {
  Pattern pattern = hop_with(
      {{0.5, 0.245}, {1.15, 0.195}, {1.4, 0.23}, {1.56, 0.23}, {1.75, 0.195}, {2.6, 0.245}});
  pattern.phases[0].until = 1.4;
  pattern.phases[1].until = 1.56;
  pattern.phases[2].until = 3.2;
  const CheckOptions options = strong_options(pattern);
  const std::string found = texts_of(likely_mistakes(small(), pattern, options));
  std::smatch flight;
  ASSERT_TRUE(std::regex_search(found, flight, flight_words())) << found;
  shorten_flight(pattern, flight);
  EXPECT_TRUE(is_consistent(pattern, options)) << found;
}

// The motors of this robot have 0.3 times their speed. A shorter flight alone, or a lower lift-off
// alone, is not enough.
TEST(PlantedMistakes, ASmallerHopIsNamedForARobotWithSlowMotors) {
  RobotDescription description = small().description();
  for (ActuatorProfile& profile : description.profiles)
    for (auto& [joint, speed] : profile.speed) speed *= 0.3;
  const RobotModel slow(description);
  Pattern pattern =
      hop_with({{0.5, 0.245}, {1.3, 0.2}, {1.5, 0.23}, {1.62, 0.23}, {1.82, 0.2}, {2.6, 0.245}});
  pattern.phases[1].until = 1.62;
  const CheckOptions options = strong_options(pattern);
  const std::string found = texts_of(likely_mistakes(slow, pattern, options));
  std::smatch hop;
  ASSERT_TRUE(std::regex_search(
      found, hop,
      std::regex(
          "^/keyframes/2: the flight lasts 0.12 s, in which the robot rises by 18 mm. Make the "
          "hop smaller: let the flight last ([0-9.]+) s .*. Let the COG height be ([0-9.]+) m at "
          "the lift-off and ([0-9.]+) m at the landing. Let the COG be at its lowest place "
          "([0-9.]+) s before the lift-off \\(/keyframes/1\\) and ([0-9.]+) s after the landing "
          "\\(/keyframes/4\\). With these changes, the pattern would be consistent")))
      << found;
  const double lands = 1.5 + std::stod(hop[1]), earlier = 1.62 - lands;
  pattern.phases[1].until = lands;
  pattern.phases[2].until -= earlier;
  pattern.keyframes[1].t = 1.5 - std::stod(hop[4]);
  pattern.keyframes[2].cog_height = std::stod(hop[2]);
  pattern.keyframes[3].t = lands;
  pattern.keyframes[3].cog_height = std::stod(hop[3]);
  pattern.keyframes[4].t = lands + std::stod(hop[5]);
  pattern.keyframes[5].t -= earlier;
  EXPECT_TRUE(check_consistency(slow, sample(slow, pattern), options).consistent) << found;
}

TEST(PlantedMistakes, AMissingHeightAtAnEndOfAFlightIsNamed) {
  for (const size_t phase : {0u, 1u}) {
    Pattern pattern = jump_pattern(small(), jump_defaults(small()));
    pattern.profile = "hoap1-strong";
    const double end = pattern.phases[phase].until;
    std::erase_if(pattern.keyframes, [&](const Keyframe& k) { return std::abs(k.t - end) < 1e-9; });
    const std::string found = texts_of(likely_mistakes(small(), pattern, strong_options(pattern)));
    EXPECT_TRUE(std::regex_search(
        found,
        std::regex("^/phases/1: no keyframe gives the COG height at the " +
                   std::string(phase == 0 ? "lift-off" : "landing") +
                   ".*With a key of the same height there, the pattern would be consistent")))
        << found;
  }
}

// Legs without ankle roll do not reach the ZMP in the middle of a sole, so the middle is no remedy.
TEST(PlantedMistakes, PointsOfTheZmpWithTheWrongSignAreNamed) {
  RobotDescription robot = biped_description();
  for (JointDescription& joint : robot.joints)
    if (joint.name.ends_with("ankle_roll")) joint.type = JointType::fixed;
  const RobotModel model(robot);
  Pattern pattern = walk_pattern(model, {.steps = 4,
                                         .stride = 0.01,
                                         .period = 0.5,
                                         .double_support = 0.25,
                                         .lift = 0.01,
                                         .zmp_inwards = 0.02});
  ASSERT_TRUE(check_consistency(model, sample(model, pattern)).consistent);
  size_t step = 3;
  while (pattern.phases[step].support != Support::right) ++step;
  const double begin = pattern.phases[step - 1].until, until = pattern.phases[step].until;
  for (Keyframe& key : pattern.keyframes)
    if (key.zmp && key.t > begin - 1e-9 && key.t < until + 1e-9) key.zmp->point.y() *= -1;
  const std::string found = texts_of(likely_mistakes(model, pattern, options_of(pattern)));
  EXPECT_TRUE(std::regex_search(
      found, std::regex("^/phases/" + std::to_string(step) +
                        ": the robot stands on the right foot, .*With the other sign of y in these "
                        "keyframes .*, the pattern would be consistent")))
      << found;
}

// The legs are too straight at both ends of the flight, and nothing else is wrong. A shorter flight
// would help, too, but the robot would not jump as high.
TEST(PlantedMistakes, LegsThatAreStraightAtALiftOffAreNamed) {
  Pattern pattern = hop_with(
      {{0.5, 0.245}, {1.32, 0.19}, {1.5, 0.235}, {1.65, 0.235}, {1.83, 0.19}, {2.7, 0.245}});
  const CheckOptions options = strong_options(pattern);
  const std::string found = texts_of(likely_mistakes(small(), pattern, options));
  std::smatch heights;
  ASSERT_TRUE(std::regex_search(
      found, heights,
      std::regex(
          "/keyframes/2: the COG height is 0.235 m at the lift-off, where the knees are bent "
          "by only about [0-9]+ deg. .*With ([0-9.]+) m at the lift-off and ([0-9.]+) m at "
          "the landing, the pattern would be consistent")))
      << found;
  pattern.keyframes[2].cog_height = std::stod(heights[1]);
  pattern.keyframes[3].cog_height = std::stod(heights[2]);
  EXPECT_TRUE(is_consistent(pattern, options)) << found;
}

// The weight is shifted to one foot until the very end, or at once at the beginning.
TEST(PlantedMistakes, AMotionWithoutARestAtItsEndsIsNamed) {
  for (const bool at_end : {true, false}) {
    Pattern pattern = quarter_turn();
    if (at_end) {
      pattern.keyframes.back().t -= 0.3;
      pattern.phases.back().until = pattern.keyframes.back().t;
      pattern.keyframes.back().zmp = ZmpKey{ZmpKey::Place::right};  // from the left foot
    } else {
      for (Phase& phase : pattern.phases) phase.until -= 0.8;
      for (Keyframe& key : pattern.keyframes) key.t = std::max(0.0, key.t - 0.8);
      pattern.keyframes.front().zmp = ZmpKey{ZmpKey::Place::left};  // to the right foot
    }
    const CheckOptions options = options_of(pattern);
    const std::string found = texts_of(likely_mistakes(small(), pattern, options));
    std::smatch more;
    ASSERT_TRUE(std::regex_search(
        found, more,
        std::regex(
            at_end ? "With a last phase that is ([0-9.]+) s longer, the pattern would be consistent"
                   : "With all times ([0-9.]+) s later, the pattern would be consistent")))
        << found;
    const double later = std::stod(more[1]);
    for (Phase& phase : pattern.phases)
      if (!at_end || &phase == &pattern.phases.back()) phase.until += later;
    for (Keyframe& key : pattern.keyframes)
      if (!at_end) key.t += later;
    EXPECT_TRUE(is_consistent(pattern, options)) << found;
  }
}

// A millimetre less to the side is enough, which is less than other mistakes change. To halve the
// turn is not what the author wants.
TEST(PlantedMistakes, ASlightChangeThatIsEnoughComesFirst) {
  Pattern pattern = quarter_turn();
  for (Phase& phase : pattern.phases)
    if (phase.swing && phase.swing->foot == Side::left)
      phase.swing->step = RelativeStep{.side = 0.0152, .turn = 30 * kDegree};
  const std::vector<Mistake> found = likely_mistakes(small(), pattern, options_of(pattern));
  ASSERT_FALSE(found.empty());
  EXPECT_NE(found.front().words.find("\"side\" of the left foot's step is 0.0152 m"),
            std::string::npos)
      << texts_of(found);
}

// The stoop is slow, and the legs are too straight at both ends of the flight. With exactly the
// values that the message names, the pattern is consistent.
TEST(PlantedMistakes, AllThatIsNamedForAHopIsEnough) {
  Pattern pattern =
      hop_with({{0.5, 0.245}, {1.2, 0.2}, {1.5, 0.235}, {1.65, 0.235}, {1.85, 0.2}, {2.8, 0.245}});
  const CheckOptions options = strong_options(pattern);
  const std::string found = texts_of(likely_mistakes(small(), pattern, options));
  std::smatch stoop, height, flight;
  ASSERT_TRUE(std::regex_search(found, stoop, std::regex("/keyframes/1: .*With t = ([0-9.]+) s")))
      << found;
  pattern.keyframes[1].t = std::stod(stoop[1]);
  ASSERT_TRUE(std::regex_search(
      found, height,
      std::regex(
          "/keyframes/2: the COG height is 0.235 m. With a value from [0-9.]+ m to ([0-9.]+) "
          "m here and in /keyframes/3, ")))
      << found;
  double low = std::stod(height[1]);
  const std::regex lower("With a value from [0-9.]+ m to ([0-9.]+) m here and in /keyframes/3");
  for (std::sregex_iterator it(found.begin(), found.end(), lower), end; it != end; ++it)
    low = std::min(low, std::stod((*it)[1]));
  pattern.keyframes[2].cog_height = pattern.keyframes[3].cog_height = low;
  if (std::regex_search(found, flight, flight_words())) shorten_flight(pattern, flight);
  EXPECT_TRUE(is_consistent(pattern, options)) << found;
}

// Each value gets one advice, although a second change of the same time or height would leave fewer
// errors, and every change but the first says which other changes it needs.
TEST(PlantedMistakes, AValueIsChangedOnlyOnce) {
  for (const double stoop : {1.2, 1.1})
    for (const double height : {0.235, 0.23}) {
      const Pattern pattern = hop_with(
          {{0.5, 0.245}, {stoop, 0.2}, {1.5, height}, {1.65, height}, {1.85, 0.2}, {2.8, 0.245}});
      std::set<std::string> values;
      for (const Mistake& mistake : likely_mistakes(small(), pattern, strong_options(pattern))) {
        const std::string text = mistake.text();
        EXPECT_TRUE(values.insert(text.substr(0, text.find(" is ") + 4)).second) << text;
        EXPECT_EQ(mistake.round > 0,
                  text.find("(together with the first change for /") != std::string::npos)
            << text;
      }
    }
}

// The stoop is too low. The range of its height begins with the smaller value, although the larger
// one is nearer to the height that the COG would have without the key.
TEST(PlantedMistakes, ARangeBeginsWithItsSmallerEnd) {
  const Pattern pattern =
      hop_with({{0.5, 0.245}, {1.2, 0.17}, {1.5, 0.22}, {1.65, 0.22}, {1.85, 0.17}, {2.8, 0.245}});
  const std::string found = texts_of(likely_mistakes(small(), pattern, strong_options(pattern)));
  const std::regex range("With a value from ([0-9.]+) m to ([0-9.]+) m");
  int ranges = 0;
  for (std::sregex_iterator it(found.begin(), found.end(), range), end; it != end; ++it, ++ranges)
    EXPECT_LT(std::stod((*it)[1]), std::stod((*it)[2])) << found;
  EXPECT_GT(ranges, 0) << found;
}

// The named change of a hop passes quick trials, but cannot be sampled at the servo's period.
TEST(PlantedMistakes, AChangeThatCannotBeSampledIsNotNamed) {
  Pattern pattern = hop_with(
      {{0.5, 0.245}, {1.28, 0.203}, {1.5, 0.23}, {1.65, 0.239}, {1.756, 0.2}, {2.8, 0.245}});
  pattern.keyframes.front().zmp = ZmpKey{ZmpKey::Place::center};
  pattern.phases[2].until = 3.2;
  const std::string found = texts_of(likely_mistakes(small(), pattern, strong_options(pattern)));
  // A motion that cannot be sampled counts as this number of errors.
  EXPECT_EQ(found.find("2147483647"), std::string::npos) << found;
  // The next best changes are named in its place.
  std::smatch flight, height;
  ASSERT_TRUE(std::regex_search(
      found, flight,
      std::regex("/phases/1: .*With a flight of ([0-9.]+) s, and everything after the flight "
                 "([0-9.]+) s ")))
      << found;
  ASSERT_TRUE(std::regex_search(
      found, height,
      std::regex(
          "/keyframes/3: the COG height is 0.239 m. With a value of at most ([0-9.]+) m, the "
          "pattern would be consistent")))
      << found;
  shorten_flight(pattern, flight);
  pattern.keyframes[3].cog_height = std::stod(height[1]);
  EXPECT_TRUE(is_consistent(pattern, strong_options(pattern))) << found;
}

/// A kick of HOAP-1 with the right foot, with these keys of the foot in the air.
Pattern right_kick(double cog_height, const std::vector<std::pair<double, Foothold>>& keys) {
  Pattern kick;
  kick.robot = "hoap1";
  kick.degrees = true;
  kick.cog_height = cog_height;
  kick.phases = {{.until = 1.4, .swing = {}},
                 {.until = 3.2, .support = Support::left, .swing = {}},
                 {.until = 4.8, .swing = {}}};
  key_at(kick, 0.6).zmp = ZmpKey{ZmpKey::Place::center};
  key_at(kick, 1.3).zmp = ZmpKey{ZmpKey::Place::left};
  key_at(kick, 1.4).feet[1] = Foothold{{0, -0.039, 0}};
  for (const auto& [t, foot] : keys) key_at(kick, t).feet[1] = foot;
  key_at(kick, 3.2).feet[1] = Foothold{{0, -0.039, 0}};
  key_at(kick, 3.3).zmp = ZmpKey{ZmpKey::Place::left};
  key_at(kick, 4.0).zmp = ZmpKey{ZmpKey::Place::center};
  return kick;
}

/// Turns the foot in the keys that a message names, as the message says it.
void turn_foot(Pattern& kick, const std::string& says) {
  const std::regex pose(
      "(?:^/keyframes/([0-9]+): |; in /keyframes/([0-9]+), |)[^;{}]*\"right\": "
      "\\{\"position\": \\[[-0-9., ]*\\], \"rpy\": \\[(-?[0-9.]+), (-?[0-9.]+), 0\\]\\}");
  for (std::sregex_iterator it(says.begin(), says.end(), pose), end; it != end; ++it) {
    const std::smatch& m = *it;
    const size_t key = std::stoul(m[1].matched ? m[1].str() : m[2].str());
    kick.keyframes[key].feet[1]->rpy = {std::stod(m[3]) * kDegree, std::stod(m[4]) * kDegree, 0};
  }
}

// The hip of a leg that kicks moves with the COG, above the other foot, so the leg leans by more
// than the way of its foot shows.
TEST(PlantedMistakes, AFootIsTurnedByTheWholeLeanOfItsLeg) {
  Pattern kick =
      right_kick(0.235, {{2.0, Foothold{{0, -0.08, 0.03}}}, {2.4, Foothold{{0.03, -0.09, 0.04}}}});
  const std::vector<Mistake> found = likely_mistakes(small(), kick, options_of(kick));
  ASSERT_EQ(found.size(), 1u) << texts_of(found);
  EXPECT_TRUE(found.front().text().ends_with("the pattern would be consistent")) << texts_of(found);
  turn_foot(kick, found.front().text());
  EXPECT_TRUE(is_consistent(kick, options_of(kick))) << texts_of(found);
}

// A leg that leans back and, because of the other foot, also to the side.
TEST(PlantedMistakes, AFootIsTurnedAboutBothAxes) {
  Pattern kick = right_kick(
      0.235, {{1.9, Foothold{{-0.05, -0.039, 0.04}}}, {2.4, Foothold{{-0.11, -0.039, 0.06}}}});
  for (Keyframe& key : kick.keyframes) key.cog_height = 0.235;
  const std::vector<Mistake> found = likely_mistakes(small(), kick, options_of(kick));
  ASSERT_EQ(found.size(), 1u) << texts_of(found);
  EXPECT_NE(found.front().text().find("deg to the side and "), std::string::npos)
      << texts_of(found);
  turn_foot(kick, found.front().text());
  EXPECT_TRUE(is_consistent(kick, options_of(kick))) << texts_of(found);
}

// The robot with shoulders that are nearer to each other.
RobotModel narrow(double by) {
  RobotDescription description = small().description();
  for (JointDescription& joint : description.joints)
    if (joint.name.ends_with("_shoulder_pitch"))
      joint.origin.translation().y() += joint.name.starts_with("l") ? -by : by;
  return RobotModel(description);
}

// A forearm meets the thigh of a kick, although every value of the pattern is possible. Either the
// arms or the legs can make room.
TEST(PlantedMistakes, RoomForBodiesThatMeetIsNamed) {
  const RobotModel robot = narrow(0.035);
  const Pattern kick = right_kick(
      0.24, {{2.0, Foothold{{-0.02, -0.039, 0.02}}}, {2.4, Foothold{{0.03, -0.039, 0.02}}}});
  const CheckOptions options = options_of(kick);
  const auto is_possible = [&](const Pattern& pattern) {
    return check_consistency(robot, sample(robot, pattern), options).consistent;
  };
  EXPECT_FALSE(is_possible(kick));
  const std::string found = texts_of(likely_mistakes(robot, kick, options));
  std::smatch arms, zmp;
  ASSERT_TRUE(std::regex_search(
      found, arms,
      std::regex(
          "/keyframes/0: bodies meet while the arms are held as in the posture 'home'. With "
          "the arms farther outwards \\(\"joints\": \\{\"r_shoulder_roll\": (-[0-9.]+), "
          "\"l_shoulder_roll\": ([0-9.]+)\\} in this key\\), the pattern would be consistent")))
      << found;
  Pattern outwards = kick;
  outwards.keyframes[0].joints = {{"r_shoulder_roll", std::stod(arms[1]) * kDegree},
                                  {"l_shoulder_roll", std::stod(arms[2]) * kDegree}};
  EXPECT_TRUE(is_possible(outwards)) << found;
  ASSERT_TRUE(std::regex_search(
      found, zmp,
      std::regex(
          "/keyframes/1: bodies meet while the ZMP is in the middle of one sole. With the "
          "ZMP [0-9.]+ mm nearer to the other foot \\(\"zmp\": \\[([0-9.]+), "
          "([0-9.]+)\\] in /keyframes/1, \"zmp\": .* in /keyframes/6\\), the pattern would be "
          "consistent")))
      << found;
  Pattern nearer = kick;
  for (const size_t key : {1u, 6u})
    nearer.keyframes[key].zmp =
        ZmpKey{ZmpKey::Place::point, {std::stod(zmp[1]), std::stod(zmp[2])}};
  EXPECT_TRUE(is_possible(nearer)) << found;
}

// A foot key is too far out, and without this mistake bodies meet: both changes are named.
TEST(PlantedMistakes, RoomIsNamedTogetherWithAMistake) {
  const RobotModel robot = narrow(0.035);
  const Pattern kick = right_kick(
      0.24, {{2.0, Foothold{{-0.02, -0.039, 0.02}}}, {2.4, Foothold{{0.5, -0.039, 0.02}}}});
  const std::string found = texts_of(likely_mistakes(robot, kick, options_of(kick)));
  EXPECT_NE(found.find("/keyframes/4: the right foot's x is 0.5 m"), std::string::npos) << found;
  EXPECT_NE(found.find("bodies meet"), std::string::npos) << found;
  EXPECT_NE(found.find("the pattern would be consistent (together with the first change for "),
            std::string::npos)
      << found;
}

// The trials of ways out count as well, and the bound is that of all trials. A way out does not
// hide that the search for mistakes was cut short.
TEST(PlantedMistakes, TrialsOfRoomCount) {
  const RobotModel robot = narrow(0.035);
  const Pattern kick = right_kick(
      0.24, {{2.0, Foothold{{-0.02, -0.039, 0.02}}}, {2.4, Foothold{{0.03, -0.039, 0.02}}}});
  const auto ways_of = [](const Explanations& search) {
    return std::count_if(search.found.begin(), search.found.end(),
                         [](const Explanation& e) { return e.is_way_out; });
  };
  const Explanations whole = find_explanations(robot, kick, options_of(kick), {});
  EXPECT_GT(ways_of(whole), 0);
  EXPECT_LE(whole.trials, kMostTrials);
  const Explanations none = find_explanations(robot, kick, options_of(kick), {}, 0);
  EXPECT_EQ(none.trials, 0);
  EXPECT_EQ(ways_of(none), 0);
  EXPECT_FALSE(none.complete);
  for (int most = 1; most < whole.trials; most += std::max(1, whole.trials / 5)) {
    const Explanations part = find_explanations(robot, kick, options_of(kick), {}, most);
    EXPECT_LE(part.trials, most);
    EXPECT_FALSE(part.complete) << most;
  }
}

// Ways to make room come only after mistakes: a wrong value that is enough is named alone.
TEST(PlantedMistakes, RoomDoesNotDisplaceAWrongValue) {
  const RobotModel robot = narrow(0.02);
  Pattern kick = right_kick(
      0.24, {{2.0, Foothold{{-0.02, -0.039, 0.02}}}, {2.4, Foothold{{0.03, -0.039, 0.02}}}});
  const CheckOptions options = options_of(kick);
  ASSERT_TRUE(check_consistency(robot, sample(robot, kick), options).consistent);
  kick.keyframes[3].joints["r_shoulder_twist"] = -80 * kDegree;
  ASSERT_FALSE(check_consistency(robot, sample(robot, kick), options).consistent);
  const std::string found = texts_of(likely_mistakes(robot, kick, options));
  EXPECT_NE(found.find("/keyframes/3: r_shoulder_twist"), std::string::npos) << found;
  EXPECT_EQ(found.find("bodies meet"), std::string::npos) << found;
}

// Room is proposed only where it can help, and from the posture that the pattern has.
TEST(PlantedMistakes, RoomIsThatOfTheBodiesThatMeet) {
  const RobotModel& robot = small();
  const auto body = [&](const std::string& joint) {
    return robot.dofs()[static_cast<size_t>(robot.find_dof(joint))].body;
  };
  const auto room = [&](const Pattern& pattern, const std::string& a, const std::string& b) {
    TrialOutcome outcome;
    outcome.errors = outcome.findings = 1;
    outcome.meeting = {{body(a), body(b)}};
    std::string words;
    for (const Hypothesis& h : Hypotheses(robot, pattern, outcome).of(Hypotheses::Kind::room))
      words += h.says.place + ": " + h.says.written + "; " + h.says.instead + "\n";
    return words;
  };
  Pattern kick = right_kick(0.24, {{2.0, Foothold{{0, -0.039, 0.02}}}});
  EXPECT_NE(room(kick, "l_elbow", "l_hip_pitch").find("\"r_shoulder_roll\": -20"),
            std::string::npos)
      << room(kick, "l_elbow", "l_hip_pitch");
  EXPECT_NE(room(kick, "l_elbow", "l_hip_pitch").find("nearer to the other foot"),
            std::string::npos);
  // Two feet that meet need no arms.
  EXPECT_EQ(room(kick, "l_ankle_roll", "r_ankle_roll").find("arms"), std::string::npos);
  EXPECT_EQ(room(kick, "l_elbow", "r_elbow").find("ZMP"), std::string::npos);
  kick.postures["wide"] = {{"r_shoulder_roll", -15 * kDegree}, {"l_shoulder_roll", 15 * kDegree}};
  kick.default_posture = "wide";
  EXPECT_NE(room(kick, "l_elbow", "l_hip_pitch")
                .find("posture 'wide'; with the arms farther outwards (\"joints\": "
                      "{\"r_shoulder_roll\": -25, \"l_shoulder_roll\": 25}"),
            std::string::npos)
      << room(kick, "l_elbow", "l_hip_pitch");
  // A foot in the air has no ZMP key that could move.
  kick.keyframes[3].zmp = ZmpKey{ZmpKey::Place::right};
  EXPECT_EQ(room(kick, "l_ankle_roll", "r_ankle_roll").find("/keyframes/3"), std::string::npos);
  kick.keyframes[4].joints["r_elbow"] = -0.5;
  EXPECT_EQ(room(kick, "l_elbow", "l_hip_pitch").find("arms"), std::string::npos);
  // Of many keys, few are listed.
  WalkParameters steps = walk_defaults(robot);
  steps.steps = 9;
  const std::string walk = room(walk_pattern(robot, steps), "l_knee", "r_knee");
  EXPECT_NE(walk.find(", and the same distance in "), std::string::npos) << walk;
  EXPECT_LT(walk.find('\n'), 400u) << walk;
}

// Two keys are too far out, so that no single one of them is enough.
TEST(PlantedMistakes, AllKeysOfASwingAreNamedTogether) {
  Pattern kick = right_kick(0.235, {{2.0, Foothold{{0, -0.12, 0.03}, {-30 * kDegree, 0, 0}}},
                                    {2.4, Foothold{{0.03, -0.125, 0.03}, {-32 * kDegree, 0, 0}}}});
  for (Keyframe& key : kick.keyframes) key.cog_height = 0.235;
  const std::string found = texts_of(likely_mistakes(small(), kick, options_of(kick)));
  EXPECT_NE(found.find("Move the right foot nearer to its place on the ground"), std::string::npos)
      << found;
  const std::regex place("\\[(-?[0-9.]+), (-?[0-9.]+), (-?[0-9.]+)\\] in /keyframes/([34])");
  int places = 0;
  for (std::sregex_iterator it(found.begin(), found.end(), place), end; it != end; ++it, ++places)
    kick.keyframes[std::stoul((*it)[4])].feet[1]->position = {
        std::stod((*it)[1]), std::stod((*it)[2]), std::stod((*it)[3])};
  EXPECT_EQ(places, 2) << found;
  EXPECT_TRUE(is_consistent(kick, options_of(kick))) << found;
}

// Of a swing with many keys, three are named with their places, and the others with the rule.
TEST(PlantedMistakes, ASwingWithManyKeysIsNamedInFewWords) {
  std::vector<std::pair<double, Foothold>> keys;
  for (int i = 0; i < 12; ++i) keys.push_back({1.6 + 0.1 * i, Foothold{{0.02, -0.1, -0.03}}});
  const Pattern kick = right_kick(0.235, keys);
  const TrialOutcome unsampled;
  const Hypotheses hypotheses(small(), kick, unsampled);
  const std::vector<Hypothesis> found = hypotheses.of(Hypotheses::Kind::small_swings);
  ASSERT_FALSE(found.empty());
  for (const Hypothesis& each : found) {
    EXPECT_EQ(each.says.written,
              "the right foot moves up to 64 mm away from its place on the ground and up to 30 mm "
              "down");
    EXPECT_LT(each.says.instead.size(), 400u) << each.says.instead;
  }
  const std::string says = found.front().says.instead;
  EXPECT_TRUE(
      says.starts_with("move the right foot nearer to its place on the ground and higher in all "
                       "keys of this swing: to ["))
      << says;
  EXPECT_TRUE(
      says.ends_with("] in /keyframes/5. In the later keys, reduce the distance of "
                     "the foot from the line between its two places on the ground to 85 %. With "
                     "these changes"))
      << says;
}

// Two keys have the same value, and the two values that the track would have without them differ. A
// change that is named for both keys is enough if both get the named value.
TEST(PlantedMistakes, WhatIsNamedForTwoKeysWasTriedForBoth) {
  Pattern pattern;
  pattern.robot = "hoap1";
  pattern.degrees = true;
  pattern.phases = {{.until = 4, .swing = {}}};
  for (const auto& [t, angle] :
       {std::pair(0.0, 7.0), {1.0, 7.0}, {1.57, 135.0}, {1.98, 135.0}, {2.12, -78.0}})
    key_at(pattern, t).joints["l_shoulder_pitch"] = angle * kDegree;
  pattern.keyframes.front().zmp = ZmpKey{ZmpKey::Place::center};
  const CheckOptions options = options_of(pattern);
  const std::string found = texts_of(likely_mistakes(small(), pattern, options));
  // Without both keys, the angle at the time of the first one would be -36.26 deg.
  std::smatch value;
  if (!std::regex_search(
          found, value,
          std::regex(
              "With a value of at (?:most|least) (-?[0-9.]+) deg here and in /keyframes/3, the "
              "pattern would be consistent")))
    return;
  for (const size_t key : {2, 3})
    pattern.keyframes[key].joints["l_shoulder_pitch"] = std::stod(value[1]) * kDegree;
  EXPECT_TRUE(is_consistent(pattern, options)) << found;
}

// The table for the robot limits the range of this value. With the end of the range as it is
// printed, the pattern is consistent.
TEST(PlantedMistakes, TheEndOfARangeIsEnoughToTheLetter) {
  Pattern pattern = hop_with(
      {{0.5, 0.245}, {1.35, 0.2}, {1.5, 0.229}, {1.65, 0.235}, {1.732, 0.2}, {2.8, 0.245}});
  const CheckOptions options = strong_options(pattern);
  const std::string found = texts_of(likely_mistakes(small(), pattern, options));
  std::smatch range;
  ASSERT_TRUE(std::regex_search(
      found, range,
      std::regex("^/keyframes/3: the COG height is 0.235 m. With a value from ([0-9.]+) m to "
                 "([0-9.]+) m, the pattern would be consistent\n$")))
      << found;
  for (const int end : {1, 2}) {
    pattern.keyframes[3].cog_height = std::stod(range[end]);
    EXPECT_TRUE(is_consistent(pattern, options)) << found;
  }
}

// Two keys have the same value. A change of the value concerns both keys, and the message says so.
TEST(PlantedMistakes, EveryKeyThatAChangeConcernsIsNamed) {
  Pattern bow;
  bow.robot = "hoap1";
  bow.degrees = true;
  bow.phases = {{.until = 5, .swing = {}}};
  for (const auto& [t, pitch] : {std::pair(0.4, 0), {1.6, 45}, {2.6, 45}, {4.0, 0}}) {
    key_at(bow, t).torso = Eigen::Vector3d(0, pitch * kDegree, 0);
    bow.keyframes.back().zmp = ZmpKey{ZmpKey::Place::center};
  }
  const std::string found = texts_of(likely_mistakes(small(), bow, options_of(bow)));
  std::smatch pitch;
  ASSERT_TRUE(std::regex_search(
      found, pitch,
      std::regex(
          "/keyframes/1: the pitch of the trunk is 45 deg. With a value of at most ([0-9.]+) "
          "deg here and in /keyframes/2, the pattern would be consistent")))
      << found;
  bow.keyframes[1].torso->y() = bow.keyframes[2].torso->y() = std::stod(pitch[1]) * kDegree;
  EXPECT_TRUE(is_consistent(bow, options_of(bow))) << found;
}

// Steps to the right with a quarter turn, a little too far to the side. If the step to the side is
// removed, the feet collide. If most of the turn is removed, the steps are possible, too.
TEST(PlantedMistakes, TheLeastChangeOfTwoValuesIsNamed) {
  Pattern pattern = quarter_turn(0.25);
  for (Phase& phase : pattern.phases) {
    if (!phase.swing) continue;
    const bool right = phase.swing->foot == Side::left;
    phase.support = right ? Support::left : Support::right;
    phase.swing->foot = right ? Side::right : Side::left;
    if (right) phase.swing->step = RelativeStep{.side = -0.02, .turn = -30 * kDegree};
  }
  for (Keyframe& key : pattern.keyframes)
    if (key.zmp->place != ZmpKey::Place::center)
      key.zmp->place =
          key.zmp->place == ZmpKey::Place::left ? ZmpKey::Place::right : ZmpKey::Place::left;
  const std::vector<Mistake> found = likely_mistakes(small(), pattern, options_of(pattern));
  ASSERT_FALSE(found.empty());
  EXPECT_NE(found.front().words.find("\"side\" of the right foot's step is -0.02 m"),
            std::string::npos)
      << found.front().text();
}

// The first key of an arm has the angle of home, as it should; the fault is in the next key.
TEST(PlantedMistakes, AKeyThatHoldsTheHomePostureIsNotNamed) {
  Pattern raise;
  raise.robot = "hoap1";
  Phase phase;
  phase.until = 7;
  raise.phases.push_back(phase);
  for (const auto& [t, angle] : {std::pair(0.5, 90), {1.5, -60}, {4.0, -60}, {5.5, 90}})
    key_at(raise, t).joints["r_shoulder_pitch"] = angle * kDegree;
  const std::vector<Mistake> found = likely_mistakes(small(), raise, options_of(raise));
  ASSERT_FALSE(found.empty());
  for (const Mistake& mistake : found) EXPECT_NE(mistake.place, "/keyframes/0") << mistake.text();
}

// The numbers of a pattern in radians are small. With all of them read as degrees, the robot hardly
// moves, which is always consistent and never meant.
TEST(PlantedMistakes, SmallNumbersInRadiansAreNoDegrees) {
  Pattern bow;
  bow.phases = {{.until = 4, .swing = {}}};
  key_at(bow, 0.5).zmp = ZmpKey{ZmpKey::Place::center};
  for (const double t : {1.0, 2.0, 3.0})
    key_at(bow, t).torso = Eigen::Vector3d(0, t == 2 ? 1.4 : 0, 0);
  const std::vector<Mistake> found = likely_mistakes(small(), bow, options_of(bow));
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found.front().place, "/keyframes/2") << found.front().text();
}

// A key of the trunk has the yaw 0 in the world, so after a turn it turns the trunk back.
TEST(PlantedMistakes, ATrunkThatLooksBackAfterATurnIsNamed) {
  Pattern pattern = quarter_turn();
  const double end = pattern.phases.back().until;
  pattern.phases.push_back({.until = end + 2, .swing = {}});
  for (const double after : {0.0, 0.8, 1.6})
    key_at(pattern, end + after).torso = Eigen::Vector3d(0, after == 0.8 ? 0.1 : 0, 0);
  const std::vector<Mistake> found = likely_mistakes(tall(), pattern, options_of(pattern));
  ASSERT_FALSE(found.empty());
  const std::string first = found.front().text();
  EXPECT_NE(first.find("the yaw 0 here"), std::string::npos) << first;
  EXPECT_NE(first.find("\"yaw\": 90 deg"), std::string::npos) << first;
  EXPECT_NE(first.find("the pattern would be consistent"), std::string::npos) << first;
}

// The rounds of a block are one line in the file, whatever the value of its counter is.
TEST(PlantedMistakes, ALineOfABlockIsNamedOnce) {
  for (const double stride : {0.12, 0.4}) {
    Pattern pattern = quarter_turn();
    int round = 0;
    for (size_t i = 0; i < pattern.phases.size(); ++i) {
      Phase& one = pattern.phases[i];
      if (!one.swing) continue;
      const bool left = one.swing->foot == Side::left;
      one.swing->step.reset();
      one.swing->to = {{stride * (++round - 0.5), left ? 0.039 : -0.039, 0}, {}};
      one.pointer = left ? "/phases/1/phases/0" : "/phases/1/phases/2";
    }
    std::map<std::string, int> places;
    for (const Mistake& mistake : likely_mistakes(small(), pattern, options_of(pattern)))
      EXPECT_EQ(++places[mistake.place], 1) << mistake.text();
    places.clear();
    for (const Mistake& mistake : impossible_values(small(), pattern))
      EXPECT_EQ(++places[mistake.place], 1) << mistake.text();
  }
}

// Footholds in good order are not called exchanged, whatever is wrong.
TEST(PlantedMistakes, FootholdsInOrderAreNotCalledExchanged) {
  Pattern pattern = walk(small());
  for (Phase& phase : pattern.phases) phase.until *= 0.7;
  for (Keyframe& key : pattern.keyframes) key.t *= 0.7;
  for (const Mistake& mistake : likely_mistakes(small(), pattern, options_of(pattern)))
    EXPECT_EQ(mistake.text().find("exchanged"), std::string::npos) << mistake.text();
}

// The number of trials is bounded over all rounds, for any bound; everything that was found until
// then is reported.
TEST(PlantedMistakes, TheSearchIsBounded) {
  Pattern pattern = walk(small());
  pattern.keyframes[2].zmp->place = pattern.keyframes[3].zmp->place = ZmpKey::Place::right;
  swing(pattern, 5).to.position.y() *= -1;
  const CheckOptions options = options_of(pattern);
  const Explanations whole = find_explanations(small(), pattern, options, {});
  EXPECT_TRUE(whole.complete);
  EXPECT_LE(whole.trials, kMostTrials);
  for (const int most : {0, 7, whole.trials / 2}) {
    const Explanations part = find_explanations(small(), pattern, options, {}, most);
    EXPECT_EQ(part.trials, most);
    EXPECT_FALSE(part.complete) << most;
    EXPECT_LE(part.found.size(), whole.found.size());
  }
}

// The pattern is consistent if its foot stays on the ground, but nobody means this.
TEST(PlantedMistakes, AMissingSwingOfAConsistentPatternIsDoubted) {
  Pattern pattern = walk(tall());
  pattern.phases[3].swing.reset();
  const std::vector<Mistake> doubts = doubtful_values(tall(), pattern);
  ASSERT_EQ(doubts.size(), 1u);
  EXPECT_EQ(doubts.front().place, "/phases/3");
}

// Values that the check does not use, or that are too good to be true.
TEST(PlantedMistakes, ValuesOfTheWorldThatNobodyMeansAreDoubted) {
  const auto doubt = [](const std::function<void(Pattern&)>& plant) {
    Pattern pattern = walk(tall());
    plant(pattern);
    const std::vector<Mistake> doubts = doubtful_values(tall(), pattern);
    EXPECT_LE(doubts.size(), 1u);
    return doubts.empty() ? "" : doubts.front().text();
  };
  const auto push = [](double at, PushKind kind, double size, double duration) {
    Disturbance d;
    d.at = at;
    d.duration = duration;
    d.what = Push{.kind = kind, .magnitude = size};
    return d;
  };
  EXPECT_EQ(doubt([](Pattern& p) { p.world.friction = 1.2; }), "");
  const std::string rough = doubt([](Pattern& p) { p.world.friction = 80; });
  EXPECT_TRUE(rough.starts_with("/world/friction: ")) << rough;
  EXPECT_NE(rough.find("percentage, write 0.8"), std::string::npos) << rough;
  // The robot has 35 kg, so that 10 N s are 0.3 m/s.
  EXPECT_EQ(doubt([&](Pattern& p) { p.scenario = {push(1, PushKind::impulse, 10, 0.02)}; }), "");
  const std::string hard =
      doubt([&](Pattern& p) { p.scenario = {push(1, PushKind::impulse, 10'000, 0.02)}; });
  EXPECT_TRUE(hard.starts_with("/scenario/0: the impulse is ")) << hard;
  EXPECT_NE(hard.find("If this number is in mN s, write 10"), std::string::npos) << hard;
  EXPECT_EQ(doubt([&](Pattern& p) { p.scenario = {push(1, PushKind::force, 500, 0.02)}; }), "");
  EXPECT_NE(doubt([&](Pattern& p) { p.scenario = {push(1, PushKind::force, 500, 1)}; }), "");
  const std::string late =
      doubt([&](Pattern& p) { p.scenario = {push(99, PushKind::impulse, 10, 0.02)}; });
  EXPECT_NE(late.find("/scenario/0: the disturbance begins at 99 s, but the motion ends at "),
            std::string::npos)
      << late;
  EXPECT_EQ(doubt([&](Pattern& p) {
              p.scenario = {push(p.duration() + 0.5, PushKind::impulse, 10, 0.02)};
            }),
            "");
}

// Nobody means a motion that continues for ten times as long without anything in it.
TEST(PlantedMistakes, AKeyBehindTheEndIsNoReasonForALongMotion) {
  Pattern pattern = walk(tall());
  pattern.keyframes.back().t = pattern.duration() + 0.3;
  for (const Mistake& mistake : likely_mistakes(tall(), pattern, options_of(pattern)))
    EXPECT_EQ(mistake.text().find("With an end at"), std::string::npos) << mistake.text();
}

}  // namespace
}  // namespace ayumi::test
