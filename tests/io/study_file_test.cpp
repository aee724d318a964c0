#include "ayumi/io/pattern/study_file.hpp"

#include <gtest/gtest.h>

#include "ayumi/base/file.hpp"
#include "ayumi/io/pattern/assumed_study.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "tests/support/error_message.hpp"
#include "tests/support/hoap1.hpp"
#include "tests/support/json.hpp"
#include "tests/support/json_schema.hpp"

namespace ayumi::test {
namespace {

namespace fs = std::filesystem;

std::string study_with(const std::string& members) {
  return R"({ // comments are allowed
    "format": "ayumi.study/1", "units": {"angle": "deg"}, "uncertainty": {)" +
         members + "}}";
}

std::string quantity_with(const std::string& members) {
  return study_with(R"("quantities": [{)" + members + "}]");
}

std::string complaint(const std::string& text) {
  return error_message([&] { study_of_text(text, "s.json"); }, ErrorCode::bad_pattern);
}

TEST(StudyFile, ReadsEveryKindOfDistribution) {
  const Uncertainty u = study_of_text(study_with(R"(
    "factors": [{"name": "heat", "source": "motor test"}],
    "quantities": [
      {"what": "friction", "uniform": [0.4, 1], "source": "measured"},
      {"what": "servo_kp", "on": "*_knee", "each": true, "normal": [1, 0.1], "factor": "heat",
       "correlation": 0.5, "source": "assumed: test"},
      {"what": "backlash", "truncated": [0.1, 0.05, 0, 0.2], "source": "data sheet"},
      {"what": "payload", "on": "torso", "point": [0, 0, 0.1], "choice": [0, 0.2],
       "weights": [3, 1], "source": "the demonstration"}],
    "pushes": [{"unit": "N s", "size": {"uniform": [0, 1], "source": "x"}, "direction": 90,
       "time": "phases", "on": {"choice": ["cog", "torso"], "source": "y"}, "duration": 0.05}])"),
                                      "s.json")
                            .uncertainty;
  ASSERT_EQ(u.quantities.size(), 4u);
  EXPECT_EQ(u.quantities[1].factor, "heat");
  EXPECT_TRUE(u.quantities[1].each);
  EXPECT_NEAR(u.quantities[2].distribution.mean, 0.1 * EIGEN_PI / 180, 1e-15);
  EXPECT_EQ(quantile(u.quantities[3].distribution, 0.74), 0);
  EXPECT_EQ(quantile(u.quantities[3].distribution, 0.76), 0.2);
  EXPECT_TRUE(is_assumed(u.quantities[1].source));
  EXPECT_FALSE(is_assumed(u.quantities[0].source));
  ASSERT_EQ(u.pushes.size(), 1u);
  EXPECT_TRUE(u.pushes[0].phases);
  EXPECT_FALSE(u.pushes[0].bounds);
  EXPECT_EQ(u.pushes[0].links, (std::vector<std::string>{"cog", "torso"}));
  EXPECT_NEAR(u.pushes[0].direction.distribution.values[0], EIGEN_PI / 2, 1e-15);
}

TEST(StudyFile, SaysWhatIsWrongAndWhere) {
  EXPECT_EQ(complaint(quantity_with(R"("what": "friction", "uniform": [0.4, 1])")),
            "s.json: /uncertainty/quantities/0: the source of these numbers is missing; add "
            "\"source\", which names a paper, a data sheet or a measurement, or begins with "
            "\"assumed:\" and states the reason");
  const auto expect = [](const std::string& members, const std::string& part) {
    const std::string text = complaint(quantity_with(members + R"(, "source": "t")"));
    EXPECT_NE(text.find(part), std::string::npos) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos);
  };
  expect(R"("what": "frictoin", "uniform": [0, 1])", "friction");
  expect(R"("what": "friction")", "expected one distribution");
  expect(R"("what": "friction", "uniform": [0, 1], "normal": [0, 1])", "uniform and normal");
  expect(R"("what": "friction", "uniform": [1, 0])", "the range is empty");
  expect(R"("what": "friction", "normal": [1, 0])", "must be above 0");
  expect(R"("what": "friction", "choice": [])", "the choice is empty");
  expect(R"("what": "friction", "choice": [1, 2], "weights": [1])", "1 weights");
  expect(R"("what": "friction", "on": "torso", "uniform": [0, 1])", "belongs to no link or joint");
  expect(R"("what": "cog", "uniform": [0, 1])", "axis");
  expect(R"("what": "mass", "axis": "x", "uniform": [0, 1])", "has no axis");
  expect(R"("what": "payload", "uniform": [0, 1])", "a payload needs a link");
  expect(R"("what": "mass", "uniform": [0, 1], "factor": "heat", "correlation": 1)",
         "there is no factor 'heat'");
  expect(R"("what": "mass", "uniform": [0, 1], "correlation": 1)", "needs a factor");
  EXPECT_NE(complaint(R"({"format": "ayumi.study/2", "uncertainty": {}})").find("ayumi.study/1"),
            std::string::npos);
  const std::string twice = R"({"what": "friction", "uniform": [0, 1], "source": "t"})";
  EXPECT_NE(complaint(study_with(R"("quantities": [)" + twice + "," + twice + "]"))
                .find("the name 'friction' appears twice"),
            std::string::npos);
}

// The part of a normal distribution above its mean is the mirror image of the part below. This also
// holds far away from the mean, where it is close to an exponential distribution.
TEST(StudyFile, TruncatedTailsAreMirrorImages) {
  for (const double far : {0.0, 3.0, 9.0, 20.0, 29.0}) {
    Distribution above = {.kind = Distribution::Kind::truncated,
                          .low = 1 + 0.01 * far,
                          .high = 1 + 0.01 * far + 0.1,
                          .mean = 1,
                          .deviation = 0.01};
    Distribution below = above;
    below.low = 2 - above.high;
    below.high = 2 - above.low;
    for (const double u : {1e-6, 0.1, 0.5, 0.9, 0.999})
      EXPECT_NEAR(quantile(above, u) - 1, 1 - quantile(below, 1 - u), 1e-12) << far << " " << u;
    // P(z > a + x) / P(z > a) is close to exp(-a x).
    if (far > 5) {
      EXPECT_NEAR((quantile(above, 0.5) - above.low) / 0.01, std::log(2) / far, 0.02 / far);
    }
  }
  const std::string refused = complaint(
      quantity_with(R"("what": "mass", "truncated": [1, 0.01, 1.5, 1.6], "source": "t")"));
  EXPECT_NE(refused.find("the range is 50 standard deviations away from the mean, but at most 30"),
            std::string::npos)
      << refused;
}

TEST(StudyFile, APatternKeepsItsUncertainty) {
  const std::string uncertainty = R"(, "uncertainty": {
    "factors": [{"name": "heat", "source": "motor test"}],
    "quantities": [
      {"what": "slope", "axis": "y", "truncated": [0, 1, -2, 2], "source": "assumed: t"},
      {"what": "servo_kp", "each": true, "on": "*_knee", "normal": [1, 0.1], "factor": "heat",
       "correlation": 0.5, "source": "m"},
      {"what": "payload", "on": "torso", "point": [0, 0, 0.1], "choice": [0, 0.2],
       "weights": [3, 1], "source": "d"}],
    "pushes": [{"unit": "B", "size": 0.5, "direction": {"choice": [0, 90], "source": "x"},
       "time": 3, "on": {"choice": ["cog", "torso"], "weights": [1, 2], "source": "y"}}]}})";
  std::string text = read_file(AYUMI_SOURCE_DIR "/patterns/hoap1_walk.json");
  text = text.substr(0, text.rfind('}')) + uncertainty;
  const Pattern first = pattern_of_text(text, "p.json");
  const std::string once = pattern_text(first);
  const Pattern second = pattern_of_text(once, "p.json");
  EXPECT_EQ(once, pattern_text(second));
  ASSERT_EQ(second.uncertainty.quantities.size(), 3u);
  EXPECT_EQ(second.uncertainty.quantities[0].distribution.high,
            first.uncertainty.quantities[0].distribution.high);
  EXPECT_EQ(second.uncertainty.quantities[1].correlation, 0.5);
  EXPECT_EQ(second.uncertainty.quantities[2].point, first.uncertainty.quantities[2].point);
  EXPECT_EQ(second.uncertainty.pushes[0].links, first.uncertainty.pushes[0].links);
  EXPECT_TRUE(second.uncertainty.pushes[0].bounds);
  const JsonSchema schema(
      json_of(read_file(AYUMI_SOURCE_DIR "/docs/schemas/pattern-1.schema.json")));
  EXPECT_TRUE(schema.accepts(json_of(once, true)));
}

// The schema of studies refers to the schema of patterns.
TEST(StudyFile, BundledStudiesFitTheSchemaAndHaveSources) {
  auto schema = json_of(read_file(AYUMI_SOURCE_DIR "/docs/schemas/study-1.schema.json"));
  const auto patterns = json_of(read_file(AYUMI_SOURCE_DIR "/docs/schemas/pattern-1.schema.json"));
  for (auto& [key, value] : schema.at("properties").items())
    if (value.contains("$ref")) {
      const std::string reference = value.at("$ref");
      value["$ref"] = reference.substr(reference.find('#'));
    }
  schema["$defs"] = patterns.at("$defs");
  const JsonSchema judge(schema);
  int studies = 0;
  for (const char* file : {"/robots/hoap1/uncertainty.json", "/robots/humanoid30/uncertainty.json",
                           "/examples/certify/pushed_walk.json"}) {
    const fs::path path = std::string(AYUMI_SOURCE_DIR) + file;
    EXPECT_TRUE(judge.accepts(json_of(read_file(path), true))) << path;
    const Study study = read_study(path);
    EXPECT_FALSE(study.uncertainty.empty());
    for (const UncertainQuantity& q : study.uncertainty.quantities) EXPECT_NE(q.source, "");
    ++studies;
  }
  EXPECT_EQ(studies, 3);
  EXPECT_FALSE(judge.accepts(json_of(
      R"({"format": "ayumi.study/1", "uncertainty": {"quantities": [{"what": "mass"}]}})")));
}

// The kinds of the schema are those of the reader.
TEST(StudyFile, SchemaListsTheKinds) {
  const auto patterns = json_of(read_file(AYUMI_SOURCE_DIR "/docs/schemas/pattern-1.schema.json"));
  std::vector<std::string> kinds;
  for (const UncertainKindInfo& kind : uncertain_kinds()) kinds.push_back(kind.name);
  EXPECT_EQ(patterns.at("$defs").at("quantity").at("properties").at("what").at("enum"), kinds);
}

TEST(AssumedStudy, IsAStudyOfWhatTheRobotHasAndSaysThatItIsAssumed) {
  const RobotModel biped = load_robot(AYUMI_SOURCE_DIR "/examples/biped/biped.urdf");
  const Study study = assumed_study(biped);
  EXPECT_NE(study.file.find("assumed"), std::string::npos);
  ASSERT_FALSE(study.uncertainty.quantities.empty());
  for (const UncertainQuantity& quantity : study.uncertainty.quantities)
    EXPECT_TRUE(is_assumed(quantity.source)) << quantity.name;
  // After it is written, it is the same study.
  EXPECT_EQ(study_of_text(assumed_study_text(biped), "again").sha256, study.sha256);
  // The COG is displaced by a fraction of the height of the robot: 5 mm for HOAP-1.
  const Study hoap = assumed_study(test::hoap1());
  const auto cog =
      std::find_if(hoap.uncertainty.quantities.begin(), hoap.uncertainty.quantities.end(),
                   [](const UncertainQuantity& q) { return q.kind == UncertainKind::cog; });
  ASSERT_NE(cog, hoap.uncertainty.quantities.end());
  EXPECT_NEAR(cog->distribution.high, 0.005, 2e-4);
}

}  // namespace
}  // namespace ayumi::test
