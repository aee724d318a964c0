// Edits of a pattern's text change no byte that they are not about.
#include "ayumi/io/pattern/pattern_edit.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/io/json/json_text.hpp"

namespace ayumi::test {
namespace {

namespace fs = std::filesystem;
using Document = nlohmann::ordered_json;
using Kind = PatternEdit::Kind;

const std::string kAuthored = R"({
  // The stride is tried out.
  "format": "ayumi.pattern/1", /* spaced   oddly */ "robot" : "hoap1",
  "include": "postures.json",
  "parameters": { "stride": 3e-2, "lift_off": 1.120 },
	"units": {"angle":"deg"},
  "phases": [
    { "until": "${lift_off}", "support": "both" },   // stands
    { "until": "${lift_off} + 0.45", "support": "left",
      "swing": { "foot": "right", "to": ["${stride}*2", -0.0390] } },

    // the end
    { "until": 4, "support": "both" }
  ],
  "keyframes": [
    {"t":0,"zmp":"center"},{"t":"${lift_off}","zmp":"left"}, // two on one line
    { "t": 2.50,
      "joints": { "l_elbow": -30, "r_elbow": "-10*${stride}" },
      "cog": {} },
    { "t": 3, "feet": { "left": [0.10, 0.039] } }
  ],
  "repair": { "lock": [] }
}
)";

std::string with_crlf(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '\n' ? std::string("\r\n") : std::string(1, c);
  return out;
}

std::string on_one_line(const std::string& text) {
  return Document::parse(text, nullptr, true, true).dump();
}

// The bundled patterns, and texts in the style of authors.
std::vector<std::string> texts() {
  std::vector<std::string> all = {kAuthored, with_crlf(kAuthored), on_one_line(kAuthored)};
  std::vector<fs::path> files;
  for (const char* const folder : {"/patterns", "/examples", "/docs"})
    for (const auto& entry :
         fs::recursive_directory_iterator(AYUMI_SOURCE_DIR + std::string(folder)))
      if (entry.path().extension() == ".json" || entry.path().extension() == ".jsonc")
        files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    const std::string text = read_file(file);
    const Document document = Document::parse(text, nullptr, false, true);
    if (!document.is_object() || document.value("format", "") != "ayumi.pattern/1") continue;
    all.push_back(text);
    all.push_back(with_crlf(text));
  }
  return all;
}

Document document_of(const std::string& text) { return Document::parse(text, nullptr, true, true); }

std::vector<std::string> pointers(const Document& value, const std::string& at = "") {
  std::vector<std::string> all;
  if (!at.empty()) all.push_back(at);
  for (const auto& [key, part] : value.items()) {
    if (!value.is_structured()) break;
    const std::string name = (Document::json_pointer() / key).to_string();
    for (const std::string& one : pointers(part, at + name)) all.push_back(one);
  }
  return all;
}

TEST(PatternEdit, ThereAreTwentyTexts) { EXPECT_GE(texts().size(), 20u); }

TEST(PatternEdit, ASetValueIsTheOnlyChange) {
  for (const std::string& text : texts()) {
    const Document before = document_of(text);
    for (const std::string& pointer : pointers(before)) {
      const Document::json_pointer at(pointer);
      const Document& value = before.at(at);
      if (value.is_structured()) continue;
      const bool words =
          value.is_string() && value.get<std::string>().find("${") == std::string::npos;
      const Document wanted = words ? Document("other") : Document(7.25);
      const std::string after = edited_text(text, {{Kind::set, pointer, wanted.dump()}});
      const auto place = find_value(text, pointer);
      ASSERT_TRUE(place) << pointer;
      EXPECT_EQ(after.substr(0, place->begin), text.substr(0, place->begin)) << pointer;
      const std::string rest = text.substr(place->end);
      ASSERT_GE(after.size(), rest.size());
      EXPECT_EQ(after.substr(after.size() - rest.size()), rest) << pointer;
      if (value.is_string() && !words) continue;  // the next test covers words
      Document expected = before;
      expected.at(at) = wanted;
      EXPECT_EQ(document_of(after), expected) << pointer;
    }
  }
}

TEST(PatternEdit, AnExpressionStaysAnExpression) {
  const auto edited = [](const std::string& pointer, const std::string& value) {
    return document_of(edited_text(kAuthored, {{Kind::set, pointer, value}}))
        .at(Document::json_pointer(pointer))
        .get<std::string>();
  };
  EXPECT_EQ(edited("/phases/0/until", "1.14"), "${lift_off} + 0.02");
  EXPECT_EQ(edited("/phases/1/until", "1.5"), "${lift_off} + 0.38");
  EXPECT_EQ(edited("/phases/1/until", "1.12"), "${lift_off}");
  EXPECT_EQ(edited("/phases/1/until", "1.02"), "${lift_off} - 0.1");
  EXPECT_EQ(edited("/phases/1/swing/to/0", "0.05"), "${stride}*2 - 0.01");
  EXPECT_EQ(edited("/keyframes/2/joints/r_elbow", "-1.3"), "-10*${stride} - 1");
}

TEST(PatternEdit, WhatIsInsertedAndRemovedAgainLeavesTheBytesThatWereThere) {
  for (const std::string& text : texts()) {
    const Document before = document_of(text);
    for (const std::string list : {"/keyframes", "/phases", "/scenario"}) {
      const Document::json_pointer at(list);
      if (!before.contains(at)) continue;
      const size_t size = before.at(at).size();
      for (size_t i = 0; i <= size; ++i) {
        const std::string pointer = list + "/" + std::to_string(i);
        const std::string value = R"({"t":1.5,"zmp":[0.01,-0.02]})";
        const std::string after = edited_text(text, {{Kind::insert, pointer, value}});
        Document expected = before;
        expected.at(at).insert(expected.at(at).begin() + static_cast<long>(i), document_of(value));
        EXPECT_EQ(document_of(after), expected) << pointer;
        EXPECT_EQ(edited_text(after, {{Kind::remove, pointer, ""}}), text) << pointer;
      }
    }
  }
}

TEST(PatternEdit, AMissingMemberIsAddedWithTheObjectsAroundItAndRemovedAgain) {
  for (const std::string& text : texts()) {
    const Document before = document_of(text);
    if (before.contains("start") || before.contains("postures")) continue;
    for (const std::string pointer : {"/start/left", "/postures/a~1b"}) {
      const std::string after = edited_text(text, {{Kind::set, pointer, "[0.5, 1]"}});
      Document expected = before;
      expected[Document::json_pointer(pointer)] = {0.5, 1};
      EXPECT_EQ(document_of(after), expected) << pointer;
      const std::string around = pointer.substr(0, pointer.find('/', 1));
      EXPECT_EQ(edited_text(after, {{Kind::remove, around, ""}}), text);
    }
  }
}

TEST(PatternEdit, EveryValueCanBeRemoved) {
  for (const std::string& text : texts()) {
    const Document before = document_of(text);
    for (const std::string& pointer : pointers(before)) {
      const Document::json_pointer at(pointer);
      Document expected = before;
      Document& around = expected.at(at.parent_pointer());
      if (around.is_array())
        around.erase(static_cast<size_t>(std::stoul(at.back())));
      else
        around.erase(at.back());
      const std::string after = edited_text(text, {{Kind::remove, pointer, ""}});
      ASSERT_TRUE(Document::accept(after, true)) << pointer << "\n" << after;
      EXPECT_EQ(document_of(after), expected) << pointer;
      EXPECT_LT(after.size(), text.size());
    }
  }
}

TEST(PatternEdit, PointersReferToTheTextBeforeTheFirstEdit) {
  const std::string text = R"({ "keyframes": [{ "t": 0 }, { "t": 1 }, { "t": 2 }] })";
  EXPECT_EQ(
      edited_text(text, {{Kind::insert, "/keyframes/1", R"({"t":0.4})"},
                         {Kind::insert, "/keyframes/1", R"({"t":0.6})"},
                         {Kind::set, "/keyframes/2/t", "1.9"},
                         {Kind::remove, "/keyframes/1", ""},
                         {Kind::insert, "/keyframes/-", R"({"t":3})"},
                         {Kind::insert, "/keyframes/-", R"({"t":4})"},
                         {Kind::insert, "/keyframes/-", R"({"t":5})"}}),
      R"({ "keyframes": [{ "t": 0 }, { "t": 0.4 }, { "t": 0.6 }, { "t": 1.9 }, { "t": 3 }, { "t": 4 }, { "t": 5 }] })");
}

TEST(PatternEdit, ItemsBecomeABlockThatRepeatsWithTheirComments) {
  const std::string text =
      "{\n  \"phases\": [\n    { \"until\": 1 }, // stands\n    { \"duration\": 0.5 }, // left\n"
      "    /* then */ { \"duration\": 0.4 }, // right\n    { \"until\": 4 }\n  ]\n}\n";
  const std::vector<PatternEdit> edits = {
      {Kind::repeat, "/phases/1", R"({"items": 2, "repeat": 3, "count": "i"})"},
      {Kind::set, "/phases/3/until", "5.8"},
      {Kind::set, "/phases/2/duration", "0.45"}};
  EXPECT_EQ(edited_text(text, edits),
            "{\n  \"phases\": [\n    { \"until\": 1 }, // stands\n"
            "    { \"repeat\": 3, \"count\": \"i\", \"phases\": [\n"
            "    { \"duration\": 0.5 }, // left\n"
            "    /* then */ { \"duration\": 0.45 }\n    ] }, // right\n    { \"until\": 5.8 }\n"
            "  ]\n}\n");
  const std::string short_text = R"({"keyframes":[{"t":0},{"t":1}]})";
  EXPECT_EQ(
      edited_text(short_text, {{Kind::repeat, "/keyframes/1", R"({"items": 1, "repeat": 2})"}}),
      R"({"keyframes":[{"t":0},{ "repeat": 2, "keyframes": [ {"t":1} ] }]})");
  EXPECT_THROW(
      edited_text(short_text, {{Kind::repeat, "/keyframes/1", R"({"items": 2, "repeat": 2})"}}),
      Error);
}

TEST(PatternEdit, AListThatIsMissingIsMade) {
  EXPECT_EQ(edited_text("{ \"a\": 1 }", {{Kind::insert, "/scenario/-", R"({"at":1})"}}),
            R"({ "a": 1, "scenario": [{ "at": 1 }] })");
  EXPECT_EQ(edited_text("{ \"a\": 1 }", {{Kind::insert, "/scenario/-", R"({"at":1})"},
                                         {Kind::insert, "/scenario/-", R"({"at":2})"},
                                         {Kind::insert, "/scenario/-", R"({"at":3})"}}),
            R"({ "a": 1, "scenario": [{ "at": 1 }, { "at": 2 }, { "at": 3 }] })");
}

TEST(PatternEdit, RefusesWhatIsNotThere) {
  const auto refusal = [](const PatternEdit& edit) {
    try {
      edited_text(kAuthored, {edit});
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  EXPECT_NE(refusal({Kind::remove, "/phases/9", ""}).find("/phases/9"), std::string::npos);
  EXPECT_NE(refusal({Kind::insert, "/phases/9", "{}"}).find("/phases"), std::string::npos);
  EXPECT_NE(refusal({Kind::insert, "/phases/x", "{}"}).find("index"), std::string::npos);
  EXPECT_NE(refusal({Kind::set, "/name", "nonsense"}).find("is not a value"), std::string::npos);
  EXPECT_THROW(edited_text("{", {}), Error);
}

}  // namespace
}  // namespace ayumi::test
