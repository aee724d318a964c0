// Durations, steps relative to the other foot, blocks that repeat, and functions in expressions.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "ayumi/author/edit/edit.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/io/pattern/expression.hpp"
#include "ayumi/io/pattern/pattern_edit.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/plan/foot_plan.hpp"

namespace ayumi::test {
namespace {

using Eigen::Vector3d;

const RobotModel& hoap1() {
  static const RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1");
  return model;
}

Pattern few_words(const std::string& rest) {
  return pattern_of_text(
      R"({"format": "ayumi.pattern/1", "robot": "hoap1", "units": {"angle": "deg"}, )" + rest + "}",
      "few.json", {});
}

Pattern with_phases(const std::string& phases) {
  return few_words(R"("keyframes": [{"t": 0, "zmp": "center"}], "phases": [)" + phases + "]");
}

std::string said(const std::string& rest) {
  try {
    few_words(rest);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_pattern);
    return error.what();
  }
  return "no error";
}

double value_of(const std::string& text) {
  return evaluate_expression(text, {{"x", 0.3}}, {"here"});
}

TEST(PatternInFewWords, ExpressionsKnowFunctions) {
  EXPECT_DOUBLE_EQ(value_of("pi"), std::numbers::pi);
  EXPECT_DOUBLE_EQ(value_of("2*sin(pi/6) + ${x}"), 2 * std::sin(std::numbers::pi / 6) + 0.3);
  EXPECT_DOUBLE_EQ(value_of("cos(${x})"), std::cos(0.3));
  EXPECT_DOUBLE_EQ(value_of("-sqrt( 2 )"), -std::sqrt(2));
  EXPECT_DOUBLE_EQ(value_of("atan2(-1, ${x} - 1)"), std::atan2(-1, 0.3 - 1));
  EXPECT_DOUBLE_EQ(value_of("max(min(${x}, 0.2), abs(-0.1))"), 0.2);
  EXPECT_TRUE(is_expression("pi/2"));
  EXPECT_TRUE(is_expression("1+sin(0)"));
  for (const char* const words : {"0.04 m", "pike", "sine", "sin", "left", "tip"})
    EXPECT_FALSE(is_expression(words)) << words;
  const auto fails = [](const std::string& text) -> std::string {
    try {
      value_of(text);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_NE(fails("sqrt(-1)").find("the result is not a finite number"), std::string::npos);
  EXPECT_NE(fails("sin(1, 2)").find("sin takes one number"), std::string::npos);
  EXPECT_NE(fails("atan2(1)").find("atan2 takes two numbers"), std::string::npos);
  EXPECT_NE(fails("max(1, 2, 3)").find("max takes two numbers"), std::string::npos);
  EXPECT_NE(fails("sin 1 + pi").find("'(' is missing after sin"), std::string::npos);
  EXPECT_NE(fails("sinn(1)").find("; did you mean 'sin'?"), std::string::npos) << fails("sinn(1)");
  EXPECT_NE(fails("2*stride + pi").find("write a parameter as ${stride}"), std::string::npos);
}

TEST(PatternInFewWords, DurationsAddUp) {
  const Pattern p = few_words(R"("phases": [{"duration": 0.3, "support": "both"},
      {"until": 0.5, "support": "both"}, {"duration": 0.1, "support": "both"}],
      "keyframes": [{"after": 0.1, "zmp": "center"}, {"t": 0.2, "zmp": "left"},
                    {"after": 0.1, "zmp": "center"}])");
  ASSERT_EQ(p.phases.size(), 3u);
  EXPECT_EQ(p.phases[2].until, 0.6);  // 0.5 + 0.1, as it would be written
  EXPECT_EQ(p.keyframes[0].t, 0.1);
  EXPECT_EQ(p.keyframes[2].t, 0.3);
  EXPECT_NE(said(R"("phases": [{"support": "both"}])")
                .find("/phases/0: \"until\" and \"duration\" are both missing"),
            std::string::npos);
  EXPECT_NE(said(R"("phases": [{"until": 1, "duration": 1, "support": "both"}])")
                .find("\"until\" and \"duration\" are both given; keep one of them"),
            std::string::npos);
  EXPECT_NE(said(R"("phases": [{"duration": 0, "support": "both"}])")
                .find("/phases/0/duration: this phase begins at 0 s and ends at 0 s"),
            std::string::npos);
  EXPECT_NE(said(R"("phases": [{"until": 2, "support": "both"}, {"duration": 3599, "support":
      "both"}])")
                .find("this time is 3601 s after the beginning of the motion, but a pattern lasts "
                      "at most 3600 s"),
            std::string::npos);
}

// A block gives the same numbers in the same order as the text without it.
TEST(PatternInFewWords, RepeatedBlocksAreWrittenOut) {
  const Pattern few = few_words(R"~("parameters": {"T": 0.5},
      "phases": [{"until": 1, "support": "both"},
        {"repeat": 2, "count": "i", "phases": [
          {"repeat": 3, "count": "j", "phases": [{"duration": "${T}", "support": "both"}]},
          {"until": "1 + 2*(${i} + 1)", "support": "left",
           "swing": {
  "foot" : "right", "to" : [ "0.01*(${i} + 1)", -0.039 ]}}]
}],
      "keyframes": [{"t": 0, "zmp": "center"},
        {"repeat": 2, "count": "i", "keyframes": [
          {"after": "${T}*(1 + ${i})", "joints": {"l_elbow": "10*${i}"}}]}])~");
  ASSERT_EQ(few.phases.size(), 9u);
  const std::vector<double> ends = {1, 1.5, 2, 2.5, 3, 3.5, 4, 4.5, 5};
  for (size_t i = 0; i < ends.size(); ++i) EXPECT_DOUBLE_EQ(few.phases[i].until, ends[i]);
  EXPECT_DOUBLE_EQ(few.phases[4].swing->to.position.x(), 0.01);
  EXPECT_DOUBLE_EQ(few.phases[8].swing->to.position.x(), 0.02);
  EXPECT_EQ(few.phases[7].pointer, "/phases/1/phases/0/phases/0");
  EXPECT_EQ(few.phases[8].pointer, "/phases/1/phases/1");
  ASSERT_EQ(few.keyframes.size(), 3u);
  EXPECT_DOUBLE_EQ(few.keyframes[1].t, 0.5);
  EXPECT_DOUBLE_EQ(few.keyframes[2].t, 1.5);
  EXPECT_DOUBLE_EQ(few.keyframes[2].joints.at("l_elbow"), 10 * M_PI / 180);
  // The counters of blocks are not parameters.
  EXPECT_EQ(few.parameters, (std::map<std::string, double>{{"T", 0.5}}));
}

TEST(PatternInFewWords, MistakesInBlocksAreNamed) {
  const auto block = [](const std::string& inside) {
    return said(R"("parameters": {"T": 0.5}, "keyframes": [{"t": 0, "zmp": "center"}],
                   "phases": [{)" +
                inside + "}]");
  };
  const std::string step = R"("phases": [{"duration": 1, "support": "both"}])";
  EXPECT_NE(block("\"repeat\": 1.5, " + step).find("/phases/0/repeat: expected a whole number"),
            std::string::npos);
  EXPECT_NE(block("\"repeat\": 0, " + step).find("/phases/0/repeat: 0 is too small"),
            std::string::npos);
  EXPECT_NE(block("\"repeat\": 20000, " + step).find("20000 is too large"), std::string::npos);
  EXPECT_NE(block(R"("repeat": 2, "phases": [])").find("there is nothing to repeat"),
            std::string::npos);
  EXPECT_NE(block(R"("repeat": 2)").find("phases"), std::string::npos);
  EXPECT_NE(block("\"repeat\": 2, \"count\": \"T\", " + step).find("choose another name"),
            std::string::npos);
  EXPECT_NE(block("\"repeat\": 2, \"count\": \"a{\", " + step).find("must not contain"),
            std::string::npos);
  EXPECT_NE(block("\"repeat\": 2, \"until\": 3, " + step).find("until"), std::string::npos);
  // The round is named, because the place alone does not identify it.
  EXPECT_NE(block(R"("repeat": 3, "count": "i", "phases": [{"until": "2 - ${i}",
                     "support": "both"}])")
                .find("this phase begins at 2 s and ends at 1 s; give a later time. If the 1 s are "
                      "counted from the beginning of this phase, write \"duration\" in place of "
                      "\"until\" (round 2 of "
                      "3)"),
            std::string::npos);
  // A count is only known inside its block.
  EXPECT_NE(said(R"("keyframes": [{"t": "${i}", "zmp": "center"}], "phases": [{"repeat": 2,
                    "count": "i", )" +
                 step + "}]")
                .find("unknown parameter 'i'"),
            std::string::npos);
  std::string deep = R"({"duration": 0.1, "support": "both"})";
  for (int i = 0; i < 9; ++i) deep = R"({"repeat": 2, "phases": [)" + deep + "]}";
  EXPECT_NE(said("\"phases\": [" + deep + "]").find("at most 8 repeated blocks may be nested"),
            std::string::npos);
  std::string many = R"({"duration": 0.000001, "support": "both"})";
  for (int i = 0; i < 3; ++i) many = R"({"repeat": 9999, "phases": [)" + many + "]}";
  EXPECT_NE(said("\"phases\": [" + many + "]").find("more than 100000 items"), std::string::npos);
}

// The poses are computed by hand: a turn and a displacement in the frame of the other sole.
TEST(PatternInFewWords, StepsAreSeenFromTheOtherFoot) {
  const Pattern p = with_phases(R"({"until": 1, "support": "both"},
      {"until": 1.5, "support": "left", "swing": {"foot": "right",
        "step": {"forward": 0.03, "side": -0.005, "turn": -20}}},
      {"until": 2, "support": "right", "swing": {"foot": "left", "step": {}}},
      {"until": 2.5, "support": "left", "swing": {"foot": "right", "step": {"up": 0.01}}})");
  const FootPlan plan(hoap1(), p);
  const double width =
      plan.pose(Side::left, 0).translation().y() - plan.pose(Side::right, 0).translation().y();
  const Vector3d left = plan.pose(Side::left, 0).translation();
  const Vector3d right = plan.pose(Side::right, 1.6).translation();
  EXPECT_LT((right - (left + Vector3d(0.03, -width - 0.005, 0))).norm(), 1e-12);
  const double turn = -20 * M_PI / 180;
  const Vector3d leftwards(-std::sin(turn), std::cos(turn), 0);
  EXPECT_LT((plan.pose(Side::left, 2.1).translation() - (right + width * leftwards)).norm(), 1e-12);
  EXPECT_NEAR(matrix_to_rpy(plan.pose(Side::left, 2.1).linear()).z(), turn, 1e-12);
  const Vector3d last = plan.pose(Side::right, 2.5).translation();
  EXPECT_NEAR((last - right - Vector3d(0, 0, 0.01)).norm(), 0, 1e-12);
  EXPECT_NE(
      said(R"("phases": [{"until": 1, "support": "left", "swing": {"foot": "right"}}])")
          .find("Give the foothold as \"to\", or a step relative to the other foot as \"step\""),
      std::string::npos);
  EXPECT_NE(said(R"("phases": [{"until": 1, "support": "left", "swing": {"foot": "right",
                    "to": [0, 0], "step": {}}}])")
                .find("both say where the foot lands"),
            std::string::npos);
}

// 36 pairs of steps of 10 degrees are a full turn.
TEST(PatternInFewWords, StepsThatTurnComeBack) {
  const Pattern p = with_phases(R"({"until": 1, "support": "both"}, {"repeat": 36, "phases": [
      {"duration": 0.5, "support": "right", "swing": {"foot": "left", "step": {"turn": 10}}},
      {"duration": 0.5, "support": "left", "swing": {"foot": "right", "step": {}}}]})");
  const FootPlan plan(hoap1(), p);
  for (const Side side : {Side::left, Side::right})
    EXPECT_TRUE(plan.pose(side, 0).linear().isApprox(plan.pose(side, 37).linear(), 1e-9));
  const auto middle = [&](double t) {
    return Vector3d(
        0.5 * (plan.pose(Side::left, t).translation() + plan.pose(Side::right, t).translation()));
  };
  EXPECT_LT((middle(37) - middle(0)).norm(), 1e-9);
}

TEST(PatternInFewWords, WrittenAndMirroredStepsStay) {
  const Pattern p = with_phases(R"({"until": 1, "support": "both"},
      {"until": 1.5, "support": "left", "swing": {"foot": "right",
        "step": {"forward": 0.03, "side": -0.005, "up": 0.001, "turn": -20}}})");
  const Pattern again = pattern_of_text(pattern_text(p), "again.json", {});
  ASSERT_TRUE(again.phases[1].swing && again.phases[1].swing->step);
  const RelativeStep &a = *p.phases[1].swing->step, &b = *again.phases[1].swing->step;
  EXPECT_EQ(a.forward, b.forward);
  EXPECT_EQ(a.side, b.side);
  EXPECT_EQ(a.up, b.up);
  EXPECT_NEAR(a.turn, b.turn, 1e-15);
  const FootPlan plan(hoap1(), p), image(hoap1(), mirrored(hoap1(), p));
  const Eigen::Isometry3d there = plan.pose(Side::right, 1.5), here = image.pose(Side::left, 1.5);
  EXPECT_LT((there.translation().cwiseProduct(Vector3d(1, -1, 1)) - here.translation()).norm(),
            1e-9);
  EXPECT_NEAR(matrix_to_rpy(there.linear()).z(), -matrix_to_rpy(here.linear()).z(), 1e-9);
}

// A value in a block is edited: only the last number of its expression changes.
TEST(PatternInFewWords, ValuesInBlocksAreEdited) {
  const std::string text = R"({ "parameters": { "w": 0.04 },
  "phases": [ { "repeat": 3, "count": "i", "phases": [
    { "duration": 1, "swing": { "to": ["0.01*${i} + 0.02", "-${w}"] } } ] } ] })";
  const std::string x = "/phases/0/phases/0/swing/to/0", y = "/phases/0/phases/0/swing/to/1";
  EXPECT_DOUBLE_EQ(value_in_text(text, x), 0.02);
  EXPECT_DOUBLE_EQ(value_in_text(text, y), -0.04);
  const std::string edited = edited_text(
      text, {{PatternEdit::Kind::set, x, "0.025"}, {PatternEdit::Kind::set, y, "-0.045"}});
  EXPECT_NE(edited.find(R"(["0.01*${i} + 0.025", "-${w} - 0.005"])"), std::string::npos) << edited;
  EXPECT_THROW(value_in_text(text, "/phases/0/count/0"), std::exception);
}

// If an expression is shifted, a parameter that is set from outside has that value.
TEST(PatternInFewWords, ExpressionsAreEditedWithTheParametersThatAreSet) {
  const std::string text = R"({ "parameters": { "w": 0.04, "t": 1 }, "x": "2*${w}", "y": "${t}" })";
  EXPECT_DOUBLE_EQ(value_in_text(text, "/x", {{"w", 0.05}}), 0.1);
  EXPECT_EQ(
      edited_text(text,
                  {{PatternEdit::Kind::set, "/x", "0.12"}, {PatternEdit::Kind::set, "/y", "0.9"}},
                  {{"w", 0.05}}),
      R"({ "parameters": { "w": 0.04, "t": 1 }, "x": "2*${w} + 0.02", "y": "${t} - 0.1" })");
}

TEST(PatternInFewWords, ShiftedExpressionsKeepTheSpacesOfTheirAuthor) {
  EXPECT_EQ(shifted_expression("${t}+0.7", 0.013), "${t}+0.713");
  EXPECT_EQ(shifted_expression("${t}  -  0.1", 0.3), "${t}  +  0.2");
  EXPECT_EQ(shifted_expression("${t}+0.7", -0.7), "${t}");
  EXPECT_EQ(shifted_expression("${t}", -0.1), "${t} - 0.1");
}

}  // namespace
}  // namespace ayumi::test
