#include "ayumi/io/json/json_reader.hpp"

#include <gtest/gtest.h>

#include <ctime>

#include "ayumi/io/json/json_depth.hpp"
#include "tests/support/error_message.hpp"

namespace ayumi {
namespace {

std::string reader_error(const std::function<void()>& action) {
  return test::error_message(action, ErrorCode::bad_pattern);
}

std::string parse_error(const std::string& bytes) {
  return reader_error([&] { parse_json(bytes, "f.json", ErrorCode::bad_pattern); });
}

TEST(JsonReader, NamesLineAndColumnOfASyntaxError) {
  EXPECT_TRUE(parse_error("{\n  \"a\": 1,\n  \"b\": }\n").starts_with("f.json:3:8: "))
      << parse_error("{\n  \"a\": 1,\n  \"b\": }\n");
  EXPECT_EQ(parse_error(" \n"), "f.json: the file is empty; it must hold JSON");
  EXPECT_TRUE(parse_error("{\"a\": NaN}").starts_with("f.json:1:"));
  EXPECT_NE(parse_error("{\"a\": 1e999}").find("f.json"), std::string::npos);
  EXPECT_EQ(parse_error("{\"a\": {\"b\": 1, \"b\": 2}}"),
            "f.json: the key 'b' appears twice in one object; keep one");
}

TEST(JsonReader, RefusesTextThatNestsTooDeeply) {
  const auto nested = [](int depth) {
    return std::string(static_cast<size_t>(depth), '[') +
           std::string(static_cast<size_t>(depth), ']');
  };
  EXPECT_NO_THROW(parse_json(nested(200), "f.json", ErrorCode::bad_pattern));
  EXPECT_EQ(parse_error(nested(300'000)),
            "f.json:1:201: arrays and objects are nested more than 200 levels deep; correct the "
            "brackets");
}

// 100,000 members took minutes, because each of them was visited again after every other.
// Values that are read otherwise than by parse_json.
TEST(JsonReader, DepthIsCountedOutsideOfStringsAndComments) {
  const std::string deep(201, '['), flat(200, '[');
  EXPECT_EQ(nested_too_deep(deep), std::optional<size_t>(200));
  EXPECT_EQ(nested_too_deep(flat), std::nullopt);
  for (const std::string comment : {"// 3\" of rubber\n", "/* 3\" of rubber */"}) {
    EXPECT_EQ(nested_too_deep(comment + deep), std::optional<size_t>(comment.size() + 200));
    EXPECT_TRUE(shallow_json<Json>(comment + deep, true).is_discarded());
  }
  EXPECT_EQ(nested_too_deep("// " + deep + "\n" + flat), std::nullopt);
  EXPECT_EQ(nested_too_deep("[\"\\\"" + deep + "\"]"), std::nullopt);
  EXPECT_TRUE(shallow_json<Json>("[1").is_discarded());
  EXPECT_EQ(shallow_json<Json>("[1]"), Json::array({1}));
}

TEST(JsonReader, TakesTimeThatIsLinearInTheNumberOfMembers) {
  std::string text = "{\"p0\": {\"a\": 1}";
  for (int i = 1; i < 100'000; ++i) text += ", \"p" + std::to_string(i) + "\": {\"a\": [1, 2]}";
  const std::clock_t begin = std::clock();
  const Json document = parse_json(text + "}", "f.json", ErrorCode::bad_pattern);
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, 10.0);
  EXPECT_EQ(document.size(), 100'000u);
  EXPECT_EQ(document["p99999"]["a"][1], 2);
}

TEST(JsonReader, KeepsEveryKindOfValue) {
  const std::string text =
      R"({"a":[null,true,-3,18446744073709551615,0.1,"x",[],{}],"b":{"c":{"d":[[1]]}}})";
  EXPECT_EQ(parse_json(text, "f.json", ErrorCode::bad_pattern).dump(), text);
  EXPECT_EQ(parse_json(" 7 ", "f.json", ErrorCode::bad_pattern), 7);
}

TEST(JsonReader, AllowsComments) {
  const Json document = parse_json("// x\n{\"a\": /* y */ 1}", "f.json", ErrorCode::bad_pattern);
  EXPECT_EQ(document["a"], 1);
}

TEST(JsonReader, NamesThePointerOfAWrongValue) {
  const Json document =
      parse_json(R"({"keys": [{"time": "x", "n": 1.5, "v": [1, 2], "w": [1, null, 3], "a/b": 1}]})",
                 "f.json", ErrorCode::bad_pattern);
  const JsonNode key = root_of(document, "f.json", ErrorCode::bad_pattern).at("keys").items()[0];
  EXPECT_EQ(reader_error([&] { key.at("time").number(); }),
            "f.json: /keys/0/time: expected a number, found a string");
  EXPECT_EQ(reader_error([&] { key.at("n").integer(); }),
            "f.json: /keys/0/n: expected a whole number, found 1.5");
  EXPECT_EQ(reader_error([&] { key.at("v").vector3(); }),
            "f.json: /keys/0/v: expected 3 numbers, found an array of length 2");
  EXPECT_EQ(reader_error([&] { key.at("w").vector3(); }),
            "f.json: /keys/0/w/1: expected a number, found null");
  EXPECT_EQ(reader_error([&] { key.at("tume"); }), "f.json: /keys/0: the key 'tume' is missing");
  EXPECT_EQ(reader_error([&] { key.at("a/b").string(); }),
            "f.json: /keys/0/a~1b: expected a string, found the number 1");
  EXPECT_EQ(reader_error([&] {
              key.only_keys({"tine", "n", "v", "w", "a/b"});
            }),
            "f.json: /keys/0/time: unknown key; did you mean 'tine'?");
  EXPECT_EQ(reader_error([&] { key.at("n").number_within(0, 1); }),
            "f.json: /keys/0/n: 1.5 is too large; the largest allowed value is 1");
}

}  // namespace
}  // namespace ayumi
