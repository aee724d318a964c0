// An edited pattern is written into the text of its author: what the edit does not change stays as
// it was written.
#include <gtest/gtest.h>

#include "ayumi/author/edit/edit.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/pattern/pattern_rewrite.hpp"
#include "ayumi/plan/sample.hpp"
#include "tests/support/hoap1.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ayumi::test {
namespace {

const std::string kAuthored = R"({
  // A walk with one arm up.
  "format": "ayumi.pattern/1", /* spaced   oddly */ "robot" : "hoap1",
  "parameters": { "stride": 3e-2, "lift_off": 1.120 },
	"units": {"angle":"deg"},
  "postures": { "up": {"l_shoulder_pitch": -60 } },   // tried on the robot
  "phases": [
    { "until": "${lift_off}", "support": "both" },   // stands
    { "duration": 0.45, "support": "left",
      "swing": { "foot": "right", "to": ["${stride}*2", -0.0390] } },

    { "repeat": 2, "count": "i", "phases": [   // two rounds
      { "duration": 0.2, "support": "both" },
      { "duration": 0.45, "support": "right", "swing": { "foot": "left", "step": {"side": "0.002*${i}"} } }
    ] },
    // the end
    { "until": 4, "support": "both" }
  ],
  "keyframes": [
    {"t":0,"zmp":"center"},{"t":"${lift_off}","zmp":"left"}, // two on one line
    { "after": 1.38,   // late
      "joints": { "l_elbow": -30.0, "r_elbow": "-10*${stride}" } },
    { "t": 3, "zmp": [0.01, "${stride}/3"], "joints": { "l_elbow": -10 } }
  ],
  "scenario": [ { "type": "impulse", "at": 2, "duration": 0.02, "on": "cog", "impulse": 0.2, "direction": [0, 2, 0] } ]
}
)";

Pattern read(const std::string& text) { return pattern_of_text(text, "walk.json"); }

RewrittenPattern kept(const Pattern& after, double time_scale = 1) {
  const auto result =
      rewritten(kAuthored, read(kAuthored), after, {.out = "out.json", .time_scale = time_scale});
  if (!result) throw std::runtime_error("the text is not kept");
  return *result;
}

// The text with the given replacements, each of which must be possible.
std::string changed(std::string text,
                    const std::vector<std::pair<std::string, std::string>>& changes) {
  size_t from = 0;
  for (const auto& [before, after] : changes) {
    const size_t at = text.find(before, from);
    if (at == std::string::npos) throw std::runtime_error("the text does not hold " + before);
    text.replace(at, before.size(), after);
    from = at + after.size();
  }
  return text;
}

TEST(KeptText, NothingChangesWithoutAnEdit) {
  EXPECT_EQ(kept(read(kAuthored)).text, kAuthored);
  EXPECT_TRUE(lost_marks(kAuthored, kAuthored).empty());
}

TEST(KeptText, TheMirrorImageExchangesNamesAndSigns) {
  const std::string image =
      changed(kAuthored, {{"\"l_shoulder_pitch\": -60", "\"r_shoulder_pitch\": -60"},
                          {"\"left\"", "\"right\""},
                          {"\"right\"", "\"left\""},
                          {"-0.0390", "0.039"},
                          {"\"right\"", "\"left\""},
                          {"\"left\"", "\"right\""},
                          {"\"0.002*${i}\"", "\"-(0.002*${i})\""},
                          {"\"left\"", "\"right\""},
                          {"\"l_elbow\": -30.0, \"r_elbow\": \"-10*${stride}\"",
                           "\"r_elbow\": -30.0, \"l_elbow\": \"-10*${stride}\""},
                          {"\"${stride}/3\"", "\"-(${stride}/3)\""},
                          {"\"l_elbow\": -10", "\"r_elbow\": -10"},
                          {"[0, 2, 0]", "[0, -2, 0]"}});
  const RewrittenPattern result = kept(mirrored(hoap1(), read(kAuthored)));
  EXPECT_TRUE(lost_marks(kAuthored, result.text).empty());
  EXPECT_EQ(pattern_text(result.pattern), pattern_text(mirrored(hoap1(), read(kAuthored))));
  EXPECT_EQ(result.text, image);
  EXPECT_NE(result.text.find("{ \"duration\": 0.45, \"support\": \"right\",\n      \"swing\": { "
                             "\"foot\": \"left\", \"to\": [\"${stride}*2\", 0.039] } },\n\n"),
            std::string::npos)
      << result.text;
}

// The postures of a library stay as they are, because other patterns include it, too. Where a
// posture is used that is not symmetric, the pattern names the one that is its image, or gets it.
TEST(KeptText, TheMirrorImageKeepsPostureLibraries) {
  const TemporaryFolder folder;
  folder.write("lib.json", R"({"format": "ayumi.postures/1", "units": {"angle": "deg"},
    "postures": {"point_left": {"l_shoulder_pitch": -60}, "point_right": {"r_shoulder_pitch": -60},
                 "lean": {"l_elbow": -20, "r_elbow": -40}, "up": {"l_elbow": -9, "r_elbow": -9}}})");
  const auto text = [](const std::string& uses, const std::string& rest) {
    return R"({ "format": "ayumi.pattern/1", "robot": "hoap1", "units": {"angle": "deg"},
  "include": "lib.json", // of the show
  "phases": [ { "until": 4, "support": "both" } ],
  "keyframes": [ {"t": 0.5, "zmp": "center"},
    {"t": 1, )" +
           uses + R"( }, // raised
    {"t": 2, "joints": {"l_elbow": -10}} ])" +
           rest + "\n}\n";
  };
  const auto mirrored_text = [&](const std::string& given) {
    const Pattern before = pattern_of_text(given, folder.path() / "a.json");
    const auto result =
        rewritten(given, before, mirrored(hoap1(), before), {.out = folder.path() / "b.json"});
    return result ? result->text : "the text is not kept";
  };
  const auto expect_image = [&](const std::string& uses, const std::string& image,
                                const std::string& added = "") {
    const std::string expected =
        changed(text(image, added), {{"\"l_elbow\": -10}", "\"r_elbow\": -10}"}});
    EXPECT_EQ(mirrored_text(text(uses, "")), expected);
    EXPECT_EQ(mirrored_text(expected), text(uses, ""));  // and back again
  };
  expect_image(R"("zmp": "left")", R"("zmp": "right")");
  expect_image(R"("posture": "up")", R"("posture": "up")");
  expect_image(R"("posture": "point_left")", R"("posture": "point_right")");
  expect_image(R"("posture": "lean")", R"("posture": "lean_mirrored")",
               ",\n  \"postures\": { \"lean_mirrored\": { \"l_elbow\": -40, \"r_elbow\": -20 } }");
  // An included posture and its own image exchange their names, in any order of the keys.
  const std::string both = text(R"("posture": "lean" }, {"t": 1.5, "posture": "lean_mirrored")",
                                ",\n  \"postures\": { \"lean_mirrored\": { \"l_elbow\": -40, "
                                "\"r_elbow\": -20 } }");
  EXPECT_EQ(mirrored_text(mirrored_text(both)), both);
}

// Words that name a side stay as they are when a motion is mirrored: those of comments, and the
// names of the pattern, of parameters and of postures. Values and other words do not count.
TEST(KeptText, LinesThatNameASideAreFound) {
  const std::string text = R"({ // the right foot
  "name": "Left kick", "robot": "hoap1", // bright, upright
  "parameters": { "left_lift": 0.02 },
  "postures": { "wave_RIGHT": { "r_elbow": 10 } },
  /* first
     l_knee bends */
  "phases": [ { "until": 1, "support": "left" } ] // knee
})";
  EXPECT_EQ(lines_with_sides(text, {"l_knee"}), (std::vector<int>{1, 2, 3, 4, 6}));
  EXPECT_EQ(lines_with_sides(text, {}), (std::vector<int>{1, 2, 3, 4}));
}

TEST(KeptText, AnotherPaceMultipliesTimes) {
  const RewrittenPattern result = kept(retimed(hoap1(), read(kAuthored), 1.25), 1.25);
  EXPECT_EQ(result.text,
            changed(kAuthored, {{"\"${lift_off}\"", "\"(${lift_off})*1.25\""},
                                {"0.45", "0.5625"},
                                {"0.2", "0.25"},
                                {"0.45", "0.5625"},
                                {"\"until\": 4", "\"until\": 5"},
                                {"\"t\":\"${lift_off}\"", "\"t\":\"(${lift_off})*1.25\""},
                                {"1.38", "1.725"},
                                {"\"t\": 3", "\"t\": 3.75"},
                                {"\"at\": 2", "\"at\": 2.5"}}));
}

// Times of the rounds of a block are rounded in different places.
TEST(KeptText, BlocksStayAtAnyPace) {
  for (const double scale : {1.0 / 3, 0.333333333, 0.87654321, M_PI}) {
    const RewrittenPattern result = kept(retimed(hoap1(), read(kAuthored), scale), scale);
    EXPECT_TRUE(lost_marks(kAuthored, result.text).empty()) << result.text;
    EXPECT_NE(result.text.find("\"(${lift_off})*"), std::string::npos) << result.text;
  }
}

TEST(KeptText, AByteOrderMarkStays) {
  const std::string mark = "\xEF\xBB\xBF";
  const Pattern walk = read(mark + kAuthored);
  const auto result = rewritten(mark + kAuthored, walk, retimed(hoap1(), walk, 1.25),
                                {.out = "out.json", .time_scale = 1.25});
  ASSERT_TRUE(result.has_value());
  EXPECT_EQ(result->text, mark + kept(retimed(hoap1(), read(kAuthored), 1.25), 1.25).text);
  EXPECT_TRUE(lost_marks(mark + kAuthored, result->text).empty());
}

// Marks are compared by their words: new ones do not replace lost ones.
TEST(KeptText, AnotherCommentIsNotTheLostOne) {
  const std::string before = R"({ "phases": [ { "until": 1 } ], // one
    "keyframes": [ {"t": "${a}"}, {"t": "${a}*2"}, {"t": "${b}"} ] })";
  EXPECT_EQ(lost_marks(before, "// Written with the parameters a = 1.\n{}"),
            (std::vector<std::string>{"1 comment", "3 expressions"}));
  const std::string copied = R"x({ // one
    "keyframes": [ {"t": "${a}"}, {"t": "${a}"}, {"t": "-(${b})"} ] })x";
  EXPECT_EQ(lost_marks(before, copied), std::vector<std::string>{"1 expression"});
}

TEST(KeptText, AKeyIsMovedAndCopiedWithItsWords) {
  const Pattern walk = read(kAuthored);
  EXPECT_EQ(kept(with_key_edited(hoap1(), walk, {.at = 3, .to = 3.5})).text,
            changed(kAuthored, {{"\"t\": 3,", "\"t\": 3.5,"}}));
  const std::string key =
      R"({ "t": 3, "zmp": [0.01, "${stride}/3"], "joints": { "l_elbow": -10 } })";
  const std::string later = changed(key, {{"\"t\": 3", "\"t\": 3.4"}});
  EXPECT_EQ(kept(with_key_edited(hoap1(), walk, {.at = 3, .to = 3.4, .copy = true})).text,
            changed(kAuthored, {{key, key + ",\n    " + later}}));
  // The key that follows keeps its time, which is written relative to the one before.
  const std::string early = kept(with_key_edited(hoap1(), walk, {.at = 3, .to = 0.5})).text;
  EXPECT_NE(early.find("{ \"t\": 0.5, \"zmp\": [0.01, \"${stride}/3\"]"), std::string::npos)
      << early;
  EXPECT_NE(early.find("\"after\": 1.38,   // late"), std::string::npos) << early;
  EXPECT_NEAR(read(early).keyframes[3].t, 2.5, 1e-9);
}

const std::string kBow = R"({ "format": "ayumi.pattern/1", "robot": "hoap1",   // a bow
  "phases": [ { "until": 2, "support": "both" } ],
  "keyframes": [ { "t": 0, "zmp": "center", "cog": { "height": 0.22 } },
    { "t": 1, "cog": { "height": 0.21 } }, // low
    { "t": 2, "cog": { "height": 0.22 } } ] })";

TEST(KeptText, AMotionThatFollowsIsAddedAtTheEnd) {
  const Pattern one = read(kBow);
  const CommandSeries series = sample(hoap1(), one);
  const Pattern both = chained(hoap1(), {one, series}, {one, series}, 0);
  const auto result = rewritten(kBow, one, both, {.out = "out.json"});
  ASSERT_TRUE(result.has_value());
  EXPECT_TRUE(lost_marks(kBow, result->text).empty()) << result->text;
  EXPECT_EQ(result->pattern.keyframes.size(), both.keyframes.size());
  EXPECT_EQ(lost_marks(kBow, "{}"), std::vector<std::string>{"2 comments"});
}

TEST(KeptText, ATableTakesTheKeysAway) {
  const Pattern bow = read(kBow);
  const Pattern table = baked(hoap1(), bow, sample(hoap1(), bow), "out.csv");
  const auto result = rewritten(kBow, bow, table, {.out = "out.json"});
  ASSERT_TRUE(result.has_value());
  EXPECT_NE(result->text.find("// a bow"), std::string::npos) << result->text;
  EXPECT_NE(result->text.find("\"table\": \"out.csv\""), std::string::npos) << result->text;
  EXPECT_EQ(lost_marks(kBow, result->text), std::vector<std::string>{"1 comment"});
}

// Two steps in place by keys of a foot, in a block that repeats.
const std::string kSteps = R"({ "format": "ayumi.pattern/1", "robot": "hoap1",
  "parameters": { "lift": 0.012 },
  "phases": [ { "until": 0.8, "support": "both" },
    { "repeat": 2, "phases": [ // two steps
      { "duration": 0.5, "support": "right" }, { "duration": 0.3, "support": "both" } ] },
    { "until": 3.2, "support": "both" } ],
  "keyframes": [ { "t": 0, "zmp": "center", "cog": { "height": 0.235 } },
    { "t": 0.8, "zmp": "right", "feet": { "left": [0, 0.039, 0] } }, // the other one stands
    { "repeat": 2, "keyframes": [
      { "after": 0.25, "feet": { "left": [0, 0.039, "${lift}*2"] } }, // up
      { "after": 0.25, "zmp": "right", "feet": { "left": [0, 0.039, 0] } },
      { "after": 0.3, "zmp": "right", "feet": { "left": [0, 0.039, 0] } } ] },
    { "t": 3.2, "zmp": "center" } ] })";

TEST(KeptText, ParametersBlocksAndKeysOfFeetStayInAChain) {
  const Pattern one = read(kSteps);
  const CommandSeries series = sample(hoap1(), one);
  for (const double over : {0.0, 0.5}) {
    const Pattern both = chained(hoap1(), {one, series}, {one, series}, over);
    const auto result = rewritten(kSteps, one, both, {.out = "out.json"});
    ASSERT_TRUE(result.has_value()) << over;
    EXPECT_TRUE(lost_marks(kSteps, result->text).empty()) << result->text;
    EXPECT_EQ(result->pattern.phases.size(), both.phases.size());
  }
  const Pattern table = baked(hoap1(), one, series, "out.csv");
  const auto result = rewritten(kSteps, one, table, {.out = "out.json"});
  ASSERT_TRUE(result.has_value());
  EXPECT_NE(result->text.find("// two steps"), std::string::npos) << result->text;
  EXPECT_NE(result->text.find("\"parameters\""), std::string::npos) << result->text;
}

// The standing foot rests at the join, whatever interpolation the keys have.
TEST(KeptText, AKeyedFootRestsAtTheJoin) {
  for (const char* const interpolation : {"spline", "cubic", "minimum_jerk"}) {
    Pattern one = read(kSteps);
    one.interpolation = std::string(interpolation) == "spline"  ? Interpolation::spline
                        : std::string(interpolation) == "cubic" ? Interpolation::cubic
                                                                : Interpolation::minimum_jerk;
    // In each step the foot moves by its own keys only.
    for (Keyframe& key : one.keyframes)
      if (key.feet[0] && key.feet[0]->position.z() == 0)
        key.interpolation = Interpolation::minimum_jerk;
    for (const double over : {0.0, 0.5}) {
      const CommandSeries series = sample(hoap1(), one, {.dt = 0.005});
      const Pattern both = chained(hoap1(), {one, series}, {one, series}, over);
      const CommandSeries all = sample(hoap1(), both, {.dt = 0.005});
      for (const CommandSample& sample : all.samples)
        if (supports(sample.support, Side::left)) {
          EXPECT_LT((sample.feet[0].translation() - all.samples[0].feet[0].translation()).norm(),
                    1e-9)
              << interpolation << " " << over;
        }
    }
  }
}

// Rounds of a block that change in different ways have no common text.
TEST(KeptText, RoundsThatDifferAreNotKept) {
  Pattern walk = read(kAuthored);
  walk.phases[3].swing->lift = 0.03;
  EXPECT_FALSE(rewritten(kAuthored, read(kAuthored), walk, {.out = "out.json"}).has_value());
}

}  // namespace
}  // namespace ayumi::test
