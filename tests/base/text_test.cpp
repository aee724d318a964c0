#include "ayumi/base/text.hpp"

#include <gtest/gtest.h>

#include "ayumi/base/significant.hpp"
#include "ayumi/base/utf8.hpp"

namespace ayumi {
namespace {

TEST(Text, FirstItemsOfAList) {
  EXPECT_EQ(text::join_first({}, 2), "");
  EXPECT_EQ(text::join_first({"a", "b"}, 2), "a, b");
  EXPECT_EQ(text::join_first({"a", "b", "c", "d"}, 2), "a, b and 2 more");
}

TEST(Text, SignificantDigitsHaveNoExponent) {
  EXPECT_EQ(text::significant(114213, 3), "114000");
  EXPECT_EQ(text::significant(-999.6, 3), "-1000");
  EXPECT_EQ(text::significant(99.96, 3), "100");
  EXPECT_EQ(text::significant(0.012345, 3), "0.0123");
  EXPECT_EQ(text::significant(0, 3), "0");
}

TEST(Text, LettersThatWereExchangedAreOneSlip) {
  EXPECT_EQ(text::suggestion("sni", {"pi", "sin", "cos"}), "; did you mean 'sin'?");
  EXPECT_EQ(text::suggestion("wlak", {"talk", "walk"}), "; did you mean 'walk'?");
  EXPECT_EQ(text::suggestion("x", {"walk"}), "");
  EXPECT_EQ(text::suggestion("ed", {"new", "edit", "send"}), "; did you mean 'edit'?")
      << "all have the distance 2";
  // A word of megabytes, in a broken file, must not be compared letter by letter.
  const std::vector<std::string> many(5000, std::string(50, 'x'));
  EXPECT_EQ(text::suggestion(std::string(5'000'000, 'x'), many), "");
}

TEST(Text, AnAbbreviationIsNearerThanEveryOtherWord) {
  EXPECT_EQ(text::suggestion("--tol", {"--all", "--tolerances", "--tolerance", "--log"}),
            "; did you mean '--tolerance'?");
  EXPECT_EQ(text::suggestion("max", {"map", "max-iterations"}), "; did you mean 'max-iterations'?");
  EXPECT_EQ(text::suggestion("--a", {"--all", "--against-controller"}), "; did you mean '--all'?")
      << "too short for an abbreviation";
  EXPECT_EQ(text::suggestion("--t", {"--threads-of-the-program"}), "");
}

TEST(PrintableText, KeepsWordsLinesAndTabsOfAnyLanguage) {
  for (const std::string text : {"", "a walk\n\tof 4.3 s, 0.5°", "歩み", "z̈ ≤ g, 𝜃"})
    EXPECT_EQ(text::printable(text), text);
}

TEST(PrintableText, WritesOutWhatSteersATerminal) {
  EXPECT_EQ(text::printable("a\x1b[2Jb"), "a\\x1b[2Jb");
  EXPECT_EQ(text::printable("over\rwritten"), "over\\x0dwritten");
  EXPECT_EQ(text::printable("\a\b\x7f"), "\\x07\\x08\\x7f");
  EXPECT_EQ(text::printable("\xc2\x9b"
                            "31m"),
            "\\x9b31m")
      << "the control sequence introducer of Latin-1";
  EXPECT_EQ(text::printable("\u202egnp.\u202c"), "\\u202egnp.\\u202c") << "right-to-left override";
  EXPECT_EQ(text::printable("\u2066x\u2069\u200f"), "\\u2066x\\u2069\\u200f");
  EXPECT_EQ(text::printable(std::string("a\0b", 3)), "a\\x00b");
}

TEST(PrintableText, WritesOutBytesThatAreNotUtf8) {
  EXPECT_EQ(text::printable("caf\xe9"), "caf\\xe9") << "cut off at the end";
  EXPECT_EQ(text::printable("caf\xe9 au lait"), "caf\\xe9 au lait");
  EXPECT_EQ(text::printable("\xc0\x9b"), "\\xc0\\x9b") << "an overlong form of escape";
  EXPECT_EQ(text::printable("\xe0\x82\x9b"), "\\xe0\\x82\\x9b") << "an overlong form";
  EXPECT_EQ(text::printable("\xed\xa0\x80"), "\\xed\\xa0\\x80") << "half of a surrogate pair";
  EXPECT_EQ(text::printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80") << "above U+10FFFF";
  EXPECT_EQ(text::printable("\x80\xff"), "\\x80\\xff");
}

// Whatever the bytes are, no control characters for a terminal are left, and a second pass changes
// nothing.
TEST(PrintableText, IsPrintableForAnyBytes) {
  unsigned state = 12345;
  for (int trial = 0; trial < 2000; ++trial) {
    std::string bytes;
    for (int i = 0; i < 12; ++i) {
      state = state * 1664525u + 1013904223u;
      bytes += static_cast<char>(state >> 24);
    }
    const std::string shown = text::printable(bytes);
    for (const unsigned char c : shown) {
      EXPECT_TRUE((c >= 0x20 && c != 0x7f) || c == '\n' || c == '\t') << int{c};
    }
    EXPECT_EQ(text::printable(shown), shown);
  }
}

TEST(WideEncoding, IsKnownByItsMarkOrByItsZeros) {
  const auto wide = [](const std::string& text, size_t width, size_t place) {
    std::string bytes;
    for (const char c : text) {
      std::string character(width, '\0');
      character[place] = c;
      bytes += character;
    }
    return text::wide_encoding(bytes);
  };
  for (const std::string text : {"0.1, 2\n", "{\"t\": 1}"}) {
    EXPECT_EQ(wide(text, 2, 0), "UTF-16");
    EXPECT_EQ(wide(text, 2, 1), "UTF-16");
    EXPECT_EQ(wide(text, 4, 0), "UTF-32");
    EXPECT_EQ(wide(text, 4, 3), "UTF-32");
    EXPECT_EQ(wide(text, 1, 0), "");
    EXPECT_EQ(wide(text, 3, 0), "");
  }
  EXPECT_EQ(text::wide_encoding(std::string("\xFF\xFE\0\0", 4)), "UTF-32");
  EXPECT_EQ(text::wide_encoding(std::string("\0\0\xFE\xFF", 4)), "UTF-32");
  EXPECT_EQ(text::wide_encoding("\xFF\xFE"), "UTF-16");
  EXPECT_EQ(text::wide_encoding("\xFE\xFFx"), "UTF-16");
  EXPECT_EQ(text::wide_encoding(""), "");
  EXPECT_EQ(text::wide_encoding(std::string(8, '\0')), "");
  EXPECT_EQ(text::wide_encoding(std::string("a\0b", 3)), "") << "a character and a half";
}

}  // namespace
}  // namespace ayumi
