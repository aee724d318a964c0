#include "ayumi/io/json/json_reader.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>

#include "ayumi/io/json/document_format.hpp"
#include "ayumi/io/json/json_depth.hpp"
#include "ayumi/io/json/json_slip.hpp"
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
  EXPECT_EQ(parse_error("{\n  \"a\": 1,\n  \"b\": }\n"),
            "f.json:3:7: the value of the name \"b\" is missing after its colon");
  EXPECT_EQ(parse_error(" \n"), "f.json: the file is empty, but JSON is needed");
  EXPECT_TRUE(parse_error("{\"a\": NaN}").starts_with("f.json:1:"));
  EXPECT_NE(parse_error("{\"a\": 1e999}").find("f.json"), std::string::npos);
  EXPECT_EQ(parse_error("{\"a\": {\"b\": 1, \"b\": 2}}"),
            "f.json: the key 'b' appears twice in one object; keep one");
}

// A file name or a message would end there.
TEST(JsonReader, TheCharacterZeroIsRefused) {
  for (const std::string text : {"{\"a\":\n \"b\\u0000c\"}", "{\n  \"a\\u0000\": 1}"})
    EXPECT_NE(parse_error(text).find("this text has the character U+0000"), std::string::npos)
        << text;
  EXPECT_TRUE(parse_error("{\"a\":\n \"b\\u0000c\"}").starts_with("f.json:2:"));
  EXPECT_TRUE(parse_error("{\"\\\\u0000\": 1,\n \"b\": \"\\u0000\"}").starts_with("f.json:2:"));
}

// Typing errors of an author, and the message about each: the line and column where the text must
// be corrected, and what is missing or too much there.
TEST(JsonReader, NamesASlipInWordsAboutTheText) {
  const std::vector<std::pair<std::string, std::string>> slips = {
      {"{\n \"t\": 0.5\n \"zmp\": 1}", "f.json:2:10: a comma is missing after 0.5"},
      {"{\n \"zmp\": \"left\" // a\n \"t\": 1}", "f.json:2:15: a comma is missing after \"left\""},
      {"{\"t\": 0.5,\n}", "f.json:1:10: this comma is followed by a }; remove the comma"},
      {"[1,, 2]", "f.json:1:4: there are two commas in a row; remove one"},
      {"{\"a\": 1; \"b\": 2}", "f.json:1:8: a comma is meant here, not a semicolon"},
      {"{t: 0.5}", "f.json:1:2: the name t needs quotation marks: \"t\""},
      {"{\"zmp\": left}", "f.json:1:9: the word left needs quotation marks: \"left\""},
      {"{\"zmp\": \"left }\n", "f.json:1:15: a quotation mark is missing at the end of \"left"},
      {"{\"t: 0.5, \"zmp\": 1}", "f.json:1:4: a quotation mark is missing at the end of \"t"},
      {"{\"zmp\": left\"}", "f.json:1:9: a quotation mark is missing before left"},
      {"{'t': 1}", "f.json:1:2: names and words need straight quotation marks"},
      {"{\"t\" 0.5}", "f.json:1:5: a colon is missing after the name \"t\""},
      {"{\"t\" = 0.5}", "f.json:1:6: write a colon after the name \"t\", not ="},
      {"{\"a\": , \"b\": 1}", "f.json:1:6: the value of the name \"a\" is missing"},
      {"{\"left\", \"right\"}", "f.json:1:8: the name \"left\" has no value"},
      {"{\"t\": .5}", "f.json:1:7: a number needs a digit before its decimal point: write 0.5"},
      {"{\"t\": 5.}", "f.json:1:7: a number needs a digit after its decimal point: write 5 or 5.0"},
      {"{\"t\": +5}", "f.json:1:7: a number must not begin with +: write 5"},
      {"{\"t\": 0,5}", "f.json:1:8: a number has a decimal point, not a comma"},
      {"{\"at\": [-0,042]}", "f.json:1:11: a number has a decimal point, not a comma"},
      {"{\"a\": 1, \u540d\u524d\u540d\u524d\u540d\u524d\u540d\u524d\u540d: 1}",
       "f.json:1:10: the name \u540d\u524d\u540d\u524d\u540d\u524d\u540d\u524d... needs"},
      {"{\"\x95\": \"\x95\x5c\"}", "f.json:1:3: the text is not UTF-8 here"},
      {"{\"t\": \x1b 5}", "f.json:1:7: there is an invisible character here; remove it"},
      {std::string("{\"t\": \0 5}", 10),
       "f.json:1:7: there is an invisible character here; remove it"},
      {"{\"t\": 30deg}", "f.json:1:7: '30deg' is not a number: write 30 without deg"},
      {"{\"t\": 2*0.5}", "f.json:1:8: an expression needs quotation marks"},
      {"{\"t\": ${a}}", "f.json:1:7: an expression needs quotation marks: \"${a}\""},
      {"{\"a\": True}", "f.json:1:7: True is written as true"},
      {"# c\n{}", "f.json:1:1: a comment begins with //, not with #"},
      {"{\"a\": (1, 2)}", "f.json:1:7: a list is written in [ ], not in ( )"},
      {"{\"a\": \"C:\\q\"}",
       "f.json:1:10: in a text between quotation marks, write each backslash twice"},
      {"[{\"a\": 1, {\"a\": 2}]", "f.json:1:9: the { of line 1 is not closed: a } is missing"},
      {"[{\"a\": 1\n {\"a\": 2}]", "f.json:1:9: the { of line 1 is not closed: a } and a comma"},
      {"{\"a\": [\n1\n\"b\": 2}", "f.json:2:2: the [ of line 1 is not closed: a ] and a comma"},
      {"{\"a\": [1}", "f.json:1:9: the [ of line 1 is not closed before this }"},
      {"{\"a\": 1}}",
       "f.json:1:9: this } closes nothing, because all brackets are closed; remove this bracket"},
      {"{\n  \"a\": {\n  \"b\": 1\n}", "f.json:2:8: the text ends too early: a } is missing"},
      {"{\"a\": [\n1",
       "f.json:2:2: the text ends too early; missing: ] for the [ of line 1, then }"},
      {"/* x", "f.json:1:1: this comment has no end: */ is missing"},
      {"{\"a\": \"\xff\"}", "f.json:1:8: the text is not UTF-8 here"},
      {std::string("\xff\xfe{\0}\0", 6), "f.json: the file is UTF-16 text; save the file as UTF-8"},
      {std::string("\xfe\xff\0{\0}", 6), "f.json: the file is UTF-16 text; save the file as UTF-8"},
  };
  for (const auto& [text, words] : slips)
    EXPECT_TRUE(parse_error(text).starts_with(words)) << text << "\n" << parse_error(text);
}

// A character is left out of a pattern: the message names its line. For a bracket, only the
// author knows the right line, so the message may name another slip.
TEST(JsonReader, NamesTheLineOfAnyCharacterThatIsLeftOut) {
  const std::string text = R"({
  "name": "kick", // a comment, with "quotes"
  "defaults": { "interpolation": "cubic" },
  "phases": [
    { "until": 1.3, "support": "both" },
    { "until": 2.9, "support": "left", "swing": { "foot": "right", "to": [0.1, -0.04] } }
  ],
  "keyframes": [
    { "t": 0, "zmp": "center" },
    { "t": "${up} + 0.1", "joints": { "l_knee": -3e1, "r_knee": 20 } }
  ]
})";
  const auto line_of = [](const std::string& words, size_t at) {
    return std::count(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(at), '\n');
  };
  for (size_t i = 0; i < text.size(); ++i) {
    if (std::string(",:\"[]{}").find(text[i]) == std::string::npos) continue;
    std::string broken = text;
    broken.erase(i, 1);
    const std::optional<JsonSlip> slip = find_json_slip(broken);
    if (Json::accept(broken, true)) {
      EXPECT_FALSE(slip) << slip->words;
      continue;
    }
    ASSERT_TRUE(slip) << "without the character " << i;
    if (std::string(",:\"").find(text[i]) != std::string::npos) {
      EXPECT_EQ(line_of(broken, slip->at), line_of(text, i)) << i << ": " << slip->words;
    }
  }
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

// Brackets inside of strings and comments do not count. shallow_json() has the same rule.
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

// In an earlier version, 100,000 members took minutes, because each member was visited again for
// every other one.
TEST(JsonReader, TakesTimeThatIsLinearInTheNumberOfMembers) {
  std::string text = "{\"p0\": {\"a\": 1}";
  for (int i = 1; i < 100'000; ++i) text += ", \"p" + std::to_string(i) + "\": {\"a\": [1, 2]}";
  const std::clock_t begin = std::clock();
  const Json document = parse_json(text + "}", "f.json", ErrorCode::bad_pattern);
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, 10.0);
  EXPECT_EQ(document.size(), 100'000u);
  EXPECT_EQ(document["p99999"]["a"][1], 2);
}

// The slip is at the end of a long line, which may have any number of brackets.
TEST(JsonReader, FindsASlipInTimeThatIsLinearInTheText) {
  std::string text = "[";
  for (int i = 0; i < 300'000; ++i) text += "[{\"a\": 1}], ";
  const std::clock_t begin = std::clock();
  EXPECT_NE(parse_error(text + "x]").find("the word x needs quotation marks"), std::string::npos);
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, 5.0);
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

// A file of Ayumi that was given to the wrong command is named, with the command that reads it.
TEST(DocumentFormat, SaysWhatTheFileIs) {
  const auto message = [](const std::string& format, const std::string& wanted) {
    const Json document = {{"format", format}};
    return test::error_message(
        [&] { require_format(root_of(document, "mine.json", ErrorCode::bad_file), wanted); },
        ErrorCode::bad_file);
  };
  EXPECT_EQ(message("ayumi.postures/1", "ayumi.robot/1"),
            "mine.json: /format: this file is a library of postures, which `ayumi posture list "
            "FILE` reads; a robot is needed here");
  EXPECT_EQ(message("ayumi.robot/1", "ayumi.pattern/1"),
            "mine.json: /format: this file is a robot, which `ayumi inspect FILE` reads; a pattern "
            "is needed here");
  EXPECT_EQ(message("ayumi.pattern/2", "ayumi.pattern/1"),
            "mine.json: /format: 'ayumi.pattern/2' cannot be read; this version of Ayumi reads "
            "'ayumi.pattern/1'");
}

}  // namespace
}  // namespace ayumi
