#include "ayumi/io/pattern/sweep_file.hpp"

#include <gtest/gtest.h>

#include <set>

#include "ayumi/base/file.hpp"
#include "tests/support/error_message.hpp"
#include "tests/support/json.hpp"
#include "tests/support/json_schema.hpp"

namespace ayumi::test {
namespace {

std::string sweep_text(const std::string& sweep) {
  return R"({ // comments are allowed
    "format": "ayumi.study/1", "units": {"angle": "deg"}, "sweep": {)" +
         sweep + "}}";
}

SweepStudy sweep_of(const std::string& sweep) { return {sweep_text(sweep), "s.json"}; }

std::string sweep_complaint(const std::string& sweep) {
  const std::string text = error_message([&] { sweep_of(sweep); }, ErrorCode::bad_pattern);
  EXPECT_EQ(text.find('\n'), std::string::npos);
  return text;
}

std::string words(const SweepStudy& s, long number) {
  std::string text;
  for (const auto& [name, value] : s.settings(number))
    text += name + "=" + setting_text(value) + " ";
  return text;
}

TEST(SweepFile, CombinesProductsAndLists) {
  const SweepStudy s = sweep_of(R"(
    "settings": {"pattern": "p.json", "noise": true},
    "cases": {"product": [
      {"controller": ["none", "dtad"]},
      {"list": [{"seed": {"from": 1, "to": 3, "count": 3}}, {"seed": 7, "gain.ka": 0.5}]}]})");
  ASSERT_EQ(s.size(), 8);
  EXPECT_EQ(words(s, 0), "controller=none noise=1 pattern=p.json seed=1 ");
  EXPECT_EQ(words(s, 2), "controller=none noise=1 pattern=p.json seed=3 ");
  EXPECT_EQ(words(s, 3), "controller=none gain.ka=0.5 noise=1 pattern=p.json seed=7 ");
  EXPECT_EQ(words(s, 4), "controller=dtad noise=1 pattern=p.json seed=1 ");
  EXPECT_EQ(s.axes(), (std::vector<std::string>{"controller", "gain.ka", "seed"}));
  std::set<std::string> all;
  for (long i = 0; i < s.size(); ++i) all.insert(words(s, i));
  EXPECT_EQ(all.size(), 8u);
}

// Each range is divided into equal parts, and every part has one sample. A range of whole numbers
// gives whole numbers.
TEST(SweepFile, LatinHypercubeHasOneSampleInEachPart) {
  const SweepStudy s = sweep_of(R"("settings": {"pattern": "p.json", "world": "floor"},
    "cases": {"latin_hypercube": {"samples": 50, "seed": 3,
      "ranges": {"value.mu": [0.2, 1.2], "set.stride": [-0.1, 0.4]}}},
    "worlds": {"floor": {"friction": "${mu}"}})");
  ASSERT_EQ(s.size(), 50);
  for (const auto& [name, low, width] :
       {std::tuple{"value.mu", 0.2, 1.0}, std::tuple{"set.stride", -0.1, 0.5}}) {
    std::set<int> parts;
    for (long i = 0; i < 50; ++i)
      parts.insert(static_cast<int>((number_of(s.settings(i), name, -9) - low) / width * 50));
    EXPECT_EQ(parts.size(), 50u) << name;
    EXPECT_EQ(*parts.begin(), 0);
    EXPECT_EQ(*parts.rbegin(), 49);
  }
  EXPECT_EQ(s.world(s.settings(4))->friction, number_of(s.settings(4), "value.mu", 0));
}

TEST(SweepFile, WorldsAndDisturbancesUseTheValuesOfTheCase) {
  const SweepStudy s = sweep_of(R"x("settings": {"pattern": "p.json"},
    "cases": {"disturbances": ["push", "none"], "value.angle": [0, 90]},
    "disturbances": {"push": [{"type": "impulse", "at": 1, "duration": 0.02, "impulse": 0.5,
      "direction": ["cos(${angle}*pi/180)", "sin(${angle}*pi/180)", 0]}]
})x");
  ASSERT_EQ(s.size(), 4);
  const auto push = s.disturbances(s.settings(1));
  ASSERT_EQ(push->size(), 1u);
  EXPECT_NEAR(std::get<Push>(push->front().what).direction.y(), 1, 1e-15);
  EXPECT_TRUE(s.disturbances(s.settings(2))->empty());
  EXPECT_FALSE(s.world(s.settings(0)).has_value());
}

TEST(SweepFile, SaysWhatIsWrongAndWhere) {
  const auto expect = [](const std::string& sweep, const std::string& part) {
    EXPECT_NE(sweep_complaint(sweep).find(part), std::string::npos) << sweep_complaint(sweep);
  };
  const std::string pattern = R"("settings": {"pattern": "p.json"}, )";
  expect(R"("cases": {"seed": 1})", "the cases have no pattern");
  expect(pattern + R"("cases": {"sed": 1})", "worlds and disturbances); did you mean 'seed'?");
  expect(pattern + R"("cases": {"seed": []})", "/sweep/cases/seed: the list is empty");
  expect(pattern + R"("cases": {"seed": 1.5})", "expected a whole number of at least 0, found 1.5");
  expect(pattern + R"("cases": {"seed": -1})", "-1");
  expect(pattern + R"("cases": {"controller": ["dtadd"]})", "dtad");
  expect(pattern + R"("cases": {"controller": {"from": 1, "to": 2, "count": 2}})", "has no range");
  expect(pattern + R"("cases": {"product": [{"seed": 1}, {"seed": 2}]})",
         "the setting 'seed' is in two factors of the product");
  expect(pattern + R"("cases": {"product": []})", "the product is empty");
  expect(pattern + R"("cases": {"world": ["ice"]})", "'ice' is not declared in \"worlds\"");
  expect(pattern + R"("cases": {"seed": 1}, "worlds": {"ice": {}})", "no case uses 'ice'");
  expect(pattern + R"("cases": {"value.mu": [1, 2]})",
         "s.json: /sweep/cases/value.mu: nothing uses the setting 'value.mu'");
  expect(pattern + R"("cases": {"seed": 1}, "measure": ["verdcit"])", "verdict");
  expect(pattern + R"("cases": {"seed": 1}, "measure": ["verdict", "verdict"])", "appears twice");
  expect(pattern + R"("cases": {"seed": 1}, "thresholds": {"step": 0.1})", "are not measured");
  expect(pattern + R"("cases": {"seed": 1}, "cses": 1)", "did you mean 'cases'?");
  expect(pattern + R"("cases": {"seed": {"from": 0, "to": 99999, "count": 100000},
                                 "draw": {"from": 0, "to": 99999, "count": 100000}})",
         "the largest number allowed is 100000000");
  expect(pattern + R"("cases": {"latin_hypercube": {"samples": 3, "ranges": {"set.a": [1, 1]}}})",
         "low below high");
  EXPECT_NE(error_message([] { SweepStudy(R"({"format": "ayumi.study/1"})", "s.json"); },
                          ErrorCode::bad_pattern)
                .find("neither \"uncertainty\" nor \"sweep\""),
            std::string::npos);
}

TEST(SweepFile, BundledStudyFitsTheSchema) {
  auto schema = json_of(read_file(AYUMI_SOURCE_DIR "/docs/schemas/study-1.schema.json"));
  const auto patterns = json_of(read_file(AYUMI_SOURCE_DIR "/docs/schemas/pattern-1.schema.json"));
  for (auto& [key, value] : schema.at("properties").items())
    if (value.contains("$ref")) {
      const std::string reference = value.at("$ref");
      value["$ref"] = reference.substr(reference.find('#'));
    }
  schema["$defs"] = patterns.at("$defs");
  const JsonSchema judge(schema);
  const std::string path = AYUMI_SOURCE_DIR "/examples/sweep/friction.json";
  const std::string text = read_file(path);
  EXPECT_TRUE(judge.accepts(json_of(text, true)));
  EXPECT_EQ(SweepStudy(text, path).size(), 64);
  EXPECT_FALSE(judge.accepts(
      json_of(R"({"format": "ayumi.study/1", "sweep": {"cases": {}, "measure": ["verdcit"]}})")));
  EXPECT_FALSE(judge.accepts(json_of(R"({"format": "ayumi.study/1"})")));
}

}  // namespace
}  // namespace ayumi::test
