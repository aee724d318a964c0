#include <algorithm>

#include "ayumi/base/file.hpp"
#include "tests/io/pattern_texts.hpp"
#include "tests/support/json.hpp"
#include "tests/support/json_schema.hpp"
#include "tests/support/random_pattern.hpp"

namespace ayumi::test {
namespace {

class PatternSchema : public PatternFolder {};

std::vector<std::string> keys_of(const nlohmann::json& schema) {
  std::vector<std::string> keys;
  for (const auto& entry : schema.at("properties").items()) keys.push_back(entry.key());
  return keys;
}

TEST_F(PatternSchema, KnowsExactlyTheKeysOfTheReader) {
  const std::string folder = AYUMI_SOURCE_DIR "/docs/schemas/";
  const auto pattern = json_of(read_file(folder + "pattern-1.schema.json"));
  const auto postures = json_of(read_file(folder + "postures-1.schema.json"));
  const auto study = json_of(read_file(folder + "study-1.schema.json"));
  for (const auto& [kind, keys] : pattern_keys()) {
    SCOPED_TRACE(kind);
    const nlohmann::json& schema = kind == "pattern"         ? pattern
                                   : kind == "study"         ? study
                                   : kind == "postures_file" ? postures
                                                             : pattern.at("$defs").at(kind);
    std::vector<std::string> sorted = keys;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(keys_of(schema), sorted);
    EXPECT_EQ(schema.at("additionalProperties"), false);
  }
  for (const auto& [name, schema] : pattern.at("$defs").items())
    if (schema.contains("properties")) {
      EXPECT_TRUE(pattern_keys().contains(name)) << name;
    }
  EXPECT_EQ(postures.at("$defs").at("units").at("properties"),
            pattern.at("$defs").at("units").at("properties"));
}

// The reader accepts every value of an enumeration in the schema, and no similar word.
TEST_F(PatternSchema, SchemaEnumerationsAreTheReaders) {
  const auto schema = json_of(read_file(AYUMI_SOURCE_DIR "/docs/schemas/pattern-1.schema.json"));
  const auto& defs = schema.at("$defs");
  const auto expect_accepted = [&](const nlohmann::json& values, const std::string& key,
                                   const std::string& before, const std::string& after) {
    for (const auto& value : values)
      EXPECT_EQ(message(with(key, before + value.dump() + after)), "no error") << value;
  };
  expect_accepted(defs.at("interpolation").at("enum"), "keyframes",
                  R"([{"t": 1, "interpolation": )", "}]");
  expect_accepted(defs.at("phase").at("properties").at("support").at("enum"), "phases",
                  R"([{"until": 1, "support": )", "}]");
  expect_accepted(defs.at("controller").at("properties").at("type").at("enum"), "controller",
                  R"({"type": )", "}");
  expect_accepted(defs.at("units").at("properties").at("angle").at("enum"), "units",
                  R"({"angle": )", "}");
  expect_accepted(defs.at("defaults").at("properties").at("cog_model").at("enum"), "defaults",
                  R"({"cog_model": )", "}");
}

nlohmann::json with_comments(const std::string& text) { return json_of(text, true); }

// Schema and reader agree: written files fit the schema, and files that the reader refuses for
// their form do not.
TEST_F(PatternSchema, SchemaAndReaderAgree) {
  const JsonSchema schema(
      json_of(read_file(AYUMI_SOURCE_DIR "/docs/schemas/pattern-1.schema.json")));
  EXPECT_TRUE(schema.accepts(with_comments(kTwoSteps)));
  for (unsigned seed = 0; seed < 60; ++seed)
    EXPECT_TRUE(schema.accepts(with_comments(pattern_text(random_pattern(seed))))) << seed;
  // Some rules are beyond a schema: order of times, meaning of names and expressions, other files,
  // lengths of vectors.
  const std::vector<std::string> beyond = {"give a later time",
                                           "carries the robot",
                                           "is already set",
                                           "appears twice",
                                           "unknown parameter",
                                           "write a parameter as",
                                           "no such file",
                                           "but a file is needed",
                                           "the vector has no direction",
                                           "the velocity must be at most 10 m/s, but it is",
                                           "a point needs a link",
                                           "a payload needs a link",
                                           "needs a duration above",
                                           "does not move",
                                           "a bump needs",
                                           "1.5 is too large",
                                           "joint friction needs",
                                           "the range is empty",
                                           "only a sine",
                                           "'frequency' is missing",
                                           "'base.y[m]' is missing",
                                           "the window must end after",
                                           "99 is not the number of a keyframe"};
  int judged = 0;
  for (const Broken& each : mistakes()) {
    const std::string reason = message(with(each.key, each.value));
    const auto part_of_reason = [&](const std::string& part) {
      return reason.find(part) != std::string::npos;
    };
    if (std::any_of(beyond.begin(), beyond.end(), part_of_reason)) continue;
    const auto document = json_or_nothing(with(each.key, each.value));
    if (document.is_discarded()) continue;  // the text is not even JSON
    EXPECT_FALSE(schema.accepts(document)) << each.key << ": " << each.value;
    ++judged;
  }
  EXPECT_GT(judged, 40);
}

TEST_F(PatternSchema, BundledPatternsFitTheSchema) {
  const JsonSchema schema(
      json_of(read_file(AYUMI_SOURCE_DIR "/docs/schemas/pattern-1.schema.json")));
  const fs::path folder = AYUMI_SOURCE_DIR "/patterns";
  if (!fs::exists(folder)) GTEST_SKIP() << "no patterns yet";
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".json") {
      EXPECT_TRUE(schema.accepts(with_comments(read_file(entry.path())))) << entry.path();
      EXPECT_NO_THROW(read_pattern(entry.path())) << entry.path();
    }
}

TEST_F(PatternSchema, ExampleOfTheDocumentationIsReadable) {
  const std::string page = read_file(AYUMI_SOURCE_DIR "/docs/formats.md");
  const size_t begin = page.find("```jsonc\n") + 9;
  const Pattern p = read(page.substr(begin, page.find("```", begin) - begin));
  EXPECT_EQ(p.phases.size(), 3u);
  EXPECT_EQ(p.scenario.size(), 1u);
  // Every key of the format is named on the page.
  for (const auto& [kind, keys] : pattern_keys())
    for (const std::string& key : keys)
      EXPECT_NE(page.find(key), std::string::npos) << kind << "." << key;
}

}  // namespace
}  // namespace ayumi::test
