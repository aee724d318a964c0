// Every number of a pattern is found at its place, is the one that a change of it changes, and has
// the neutral value that its track has without it.
#include "ayumi/check/written_values.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ayumi/model/gravity.hpp"
#include "ayumi/plan/foot_plan.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi {
namespace {

using test::hoap1;

// A pattern with a number of every kind. Times are those of a slow step with each foot.
Pattern with_every_number() {
  Pattern p;
  p.cog_height = 0.23;
  p.world.friction = 0.6;
  p.start_feet[0] = Foothold{.position = {0.01, 0.045, 0}};
  p.start_feet[1] = Foothold{.position = {0.01, -0.045, 0}};
  p.postures["wave"] = {{"r_elbow", 0.5}};
  Swing left{.foot = Side::left, .to = {{0.03, 0.05, 0}, {0, 0, 0.1}}, .lift = 0.03};
  Swing right{.foot = Side::right, .to = {}, .lift = 0.03};
  right.step = RelativeStep{.forward = 0.02};
  p.phases = {{.until = 1, .support = Support::both, .swing = {}},
              {.until = 1.5, .support = Support::right, .swing = left},
              {.until = 2, .support = Support::both, .swing = {}},
              {.until = 2.5, .support = Support::left, .swing = right},
              {.until = 3, .support = Support::both, .swing = {}}};
  p.keyframes.resize(3);
  p.keyframes[0].t = 0.5;
  p.keyframes[0].cog_x = 0.012;
  p.keyframes[0].cog_y = 0.02;
  p.keyframes[0].cog_height = 0.22;
  p.keyframes[0].joints = {{"l_elbow", 0.2}, {"no_joint", 1}};
  p.keyframes[1].t = 1;
  p.keyframes[1].zmp = ZmpKey{.point = {0.02, -0.03}};
  p.keyframes[1].torso = Eigen::Vector3d(0.01, 0.02, 0.03);
  p.keyframes[1].fz = 70;
  p.keyframes[2].t = 2;
  p.keyframes[2].joints = {{"l_elbow", 0.4}};
  return p;
}

const WrittenValue* find(const std::vector<WrittenValue>& values, const std::string& place,
                         const std::string& words) {
  const auto found = std::find_if(values.begin(), values.end(), [&](const WrittenValue& value) {
    return value.place == place && value.words == words;
  });
  return found == values.end() ? nullptr : &*found;
}

TEST(WrittenValues, AreFoundAtTheirPlaces) {
  const Pattern pattern = with_every_number();
  ASSERT_NO_THROW(FootPlan(hoap1(), pattern));
  const std::vector<WrittenValue> values = written_values(hoap1(), pattern);
  const double home = hoap1().rest_state().theta[hoap1().find_dof("r_elbow")];
  struct Expected {
    const char *place, *words;
    double value;
    const char* text;
    double neutral;  // NaN: not compared
  };
  const double any = std::numeric_limits<double>::quiet_NaN();
  for (const Expected& e : {
           Expected{"/world/friction", "the friction of the ground", 0.6, "0.6", 0.8},
           {"/defaults/cog_height", "the COG height", 0.23, "0.23 m", any},
           {"/start/left", "the left foot's y", 0.045, "0.045 m", any},
           {"/start/right", "the right foot's x", 0.01, "0.01 m", any},
           {"/phases/1", "the left foot's x", 0.03, "0.03 m", 0.01},
           {"/phases/1", "the left foot's y", 0.05, "0.05 m", 0.045},
           {"/phases/1", "the left foot's yaw", 0.1, "5.73 deg", 0},
           {"/phases/3", "\"forward\" of the right foot's step", 0.02, "0.02 m", 0},
           {"/phases/1", "the lift of the swing", 0.03, "0.03 m", 0.02},
           {"/keyframes/0", "the COG's x", 0.012, "0.012 m", any},
           {"/keyframes/0", "the COG's y", 0.02, "0.02 m", 0},
           {"/keyframes/0", "the COG height", 0.22, "0.22 m", 0.23},
           {"/keyframes/1", "the ZMP's x", 0.02, "0.02 m", any},
           {"/keyframes/1", "the ZMP's y", -0.03, "-0.03 m", 0},
           {"/keyframes/1", "the roll of the trunk", 0.01, "0.573 deg", 0},
           {"/keyframes/1", "the yaw of the trunk", 0.03, "1.719 deg", 0},
           {"/keyframes/1", "f_z", 70, "70 N", hoap1().mass() * kGravity},
           {"/keyframes/2", "l_elbow", 0.4, "22.92 deg", 0.2},
           {"/postures/wave", "r_elbow", 0.5, "28.65 deg", home},
       }) {
    const WrittenValue* found = find(values, e.place, e.words);
    ASSERT_TRUE(found) << e.place << " " << e.words;
    EXPECT_EQ(found->numbers.front().value, e.value) << e.place << " " << e.words;
    EXPECT_EQ(found->text(pattern, e.value), e.text);
    if (std::isnan(e.neutral)) continue;
    EXPECT_NEAR(found->numbers.front().neutral, e.neutral, 1e-9) << e.words;
  }
  Pattern plain = pattern;
  plain.start_feet = {};
  EXPECT_FALSE(find(written_values(hoap1(), plain), "/start/left", "the left foot's y"));
}

// Only what is named changes, by a factor or to a share of the way from the neutral value.
TEST(WrittenValues, ChangeTheirOwnNumbers) {
  const Pattern pattern = with_every_number();
  const std::vector<WrittenValue> values = written_values(hoap1(), pattern);
  EXPECT_GT(values.size(), 20u);
  for (const WrittenValue& value : values) {
    SCOPED_TRACE(value.place + " " + value.words);
    const auto numbers = [&](Pattern& p) {
      std::vector<double> found;
      for (const WrittenNumber& number : value.numbers) found.push_back(number.in(p));
      return found;
    };
    Pattern changed = pattern;
    value.scale(changed, 3);
    for (size_t i = 0; i < value.numbers.size(); ++i)
      EXPECT_EQ(numbers(changed)[i], 3 * value.numbers[i].value);
    value.pull(changed, 1);
    for (const double number : numbers(changed)) EXPECT_NEAR(number, value.numbers[0].value, 1e-15);
    value.pull(changed, 0);
    EXPECT_NEAR(numbers(changed)[0], value.numbers[0].neutral, 1e-15);
    value.leave_out(changed);
    for (size_t i = 0; i < value.numbers.size(); ++i)
      EXPECT_EQ(numbers(changed)[i], value.numbers[i].neutral);
  }
}

// The places of the other numbers of a value are listed as long as they are few.
TEST(WrittenValues, NameTheOtherPlaces) {
  const auto elsewhere = [](size_t count) {
    Pattern p;
    p.phases = {{.until = 9, .support = Support::both, .swing = {}}};
    p.keyframes.resize(count);
    for (size_t i = 0; i < count; ++i) {
      p.keyframes[i].t = 1.0 + static_cast<double>(i);
      p.keyframes[i].cog_height = 0.21;
    }
    const std::vector<WrittenValue> values = written_values(hoap1(), p);
    const WrittenValue* height = find(values, "/keyframes/0", "the COG height");
    return height ? height->elsewhere() : "not found";
  };
  EXPECT_EQ(elsewhere(1), "");
  EXPECT_EQ(elsewhere(2), " here and in /keyframes/1");
  EXPECT_EQ(elsewhere(4), " here and in /keyframes/1, /keyframes/2, /keyframes/3");
  EXPECT_EQ(elsewhere(5), " here and in the 4 other places that have this value");
}

TEST(WrittenValues, AreMeasuredByLegsRadiansAndTheWeight) {
  const std::vector<WrittenValue> values = written_values(hoap1(), with_every_number());
  ASSERT_TRUE(find(values, "/phases/1", "the left foot's x"));
  const auto& force = *find(values, "/keyframes/1", "f_z");
  const double weight = hoap1().mass() * kGravity;
  EXPECT_NEAR(force.suspicion(hoap1()), std::abs(70 - weight) / weight, 1e-12);
  EXPECT_FALSE(force.has_sign(hoap1()));
  const auto& joint = *find(values, "/keyframes/2", "l_elbow");
  EXPECT_NEAR(joint.suspicion(hoap1()), 0.2, 1e-12);
  EXPECT_TRUE(joint.has_sign(hoap1()));
  const auto& foot = *find(values, "/phases/1", "the left foot's x");
  EXPECT_GT(foot.suspicion(hoap1()), 0.02 / 0.3);
  EXPECT_LT(foot.suspicion(hoap1()), 0.02 / 0.1);
  EXPECT_FALSE(find(values, "/world/friction", "the friction of the ground")->has_sign(hoap1()));
}

TEST(WrittenValues, TheSameNumberOfBothFeetIsOneValue) {
  Pattern p = with_every_number();
  p.keyframes[1].feet = p.start_feet;  // the feet stand there until the flight begins
  p.keyframes[2].feet[0].emplace().position = {0.3, 0.05, 0};
  p.keyframes[2].feet[1].emplace().position = {0.3, -0.05, 0};
  p.phases = {{.until = 1, .support = Support::both, .swing = {}},
              {.until = 2, .support = Support::none, .swing = {}},
              {.until = 3, .support = Support::both, .swing = {}}};
  const std::vector<WrittenValue> values = written_values(hoap1(), p);
  const WrittenValue* both = find(values, "/keyframes/2", "the feet's x");
  ASSERT_TRUE(both);
  ASSERT_EQ(both->numbers.size(), 2u);
  both->scale(p, 0.1);
  EXPECT_DOUBLE_EQ(p.keyframes[2].feet[0]->position.x(), 0.03);
  EXPECT_DOUBLE_EQ(p.keyframes[2].feet[1]->position.x(), 0.03);
  EXPECT_FALSE(find(values, "/keyframes/2", "the feet's y"));
}

}  // namespace
}  // namespace ayumi
