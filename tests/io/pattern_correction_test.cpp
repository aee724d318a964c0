#include <gtest/gtest.h>

#include <filesystem>

#include "ayumi/base/file.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "tests/support/error_message.hpp"

namespace ayumi {
namespace {

CorrectionTrack small_track(double value) {
  CorrectionTrack track;
  track.begin = 0.1;
  track.spacing = 0.05;
  track.joints = {"l_knee"};
  track.coefficients.setZero(7, 7);
  track.coefficients(3, 6) = value;
  return track;
}

Pattern read_text(const std::string& text) {
  const auto file = std::filesystem::path(testing::TempDir()) / "ayumi_with_correction.json";
  write_file(file, text);
  return read_pattern(file);
}

const char* const kText = R"(// "correction": a comment, not a member
{
  "format": "ayumi.pattern/1", /* } */
  "name": "a \"correction\": 1 } in a name",
  "robot": "hoap1",
  "parameters": { "end": 1.5 },
  "phases": [ { "until": "${end}", "support": "both" } ],
  "keyframes": [ { "t": 0, "zmp": "center" } ]   // the last member
}
)";

TEST(WithCorrection, AddsTheMemberAndKeepsEverythingElse) {
  const std::string text = with_correction(kText, small_track(0.25));
  const Pattern pattern = read_text(text);
  ASSERT_TRUE(pattern.correction.has_value());
  EXPECT_EQ(pattern.correction->coefficients(3, 6), 0.25);
  EXPECT_EQ(pattern.correction->joints, std::vector<std::string>{"l_knee"});
  EXPECT_EQ(pattern.duration(), 1.5);
  for (const char* kept : {"// \"correction\": a comment", "/* } */", "${end}",
                           "\"center\" } ],   // the last member\n"})
    EXPECT_NE(text.find(kept), std::string::npos) << kept << "\n" << text;
}

TEST(WithCorrection, WindowsAreInOrderAndDoNotOverlap) {
  CorrectionTrack track = small_track(0.25);
  track.smooth = {{0.2, 0.5, 0.05}, {0.5, 0.9, 0.04}};
  const CorrectionTrack read = *read_text(with_correction(kText, track)).correction;
  ASSERT_EQ(read.smooth.size(), 2u);
  EXPECT_EQ(read.smooth[1].begin, 0.5);
  EXPECT_EQ(read.smooth[1].spacing, 0.04);
  for (const SmoothWindow& bad : {SmoothWindow{0.4, 0.9, 0.05}, SmoothWindow{0.1, 0.15, 0.05}}) {
    track.smooth[1] = bad;
    const std::string message =
        test::error_message([&] { read_text(with_correction(kText, track)); });
    EXPECT_NE(message.find("/correction/smooth/1"), std::string::npos) << message;
    EXPECT_NE(message.find("but the window before it ends later (at 0.5 s)"), std::string::npos)
        << message;
  }
}

TEST(WithCorrection, ReplacesAnOlderOne) {
  const std::string once = with_correction(kText, small_track(0.25));
  EXPECT_EQ(with_correction(once, small_track(0.25)), once);
  const std::string twice = with_correction(once, small_track(0.5));
  EXPECT_EQ(read_text(twice).correction->coefficients(3, 6), 0.5);
  EXPECT_EQ(with_correction(twice, small_track(0.25)), once);
}

TEST(WithCorrection, ReplacesOneInTheMiddle) {
  const std::string text = with_correction(
      R"({"format":"ayumi.pattern/1","correction":{"begin":0,"spacing":1,"columns":[],)"
      R"("coefficients":[]},"robot":"hoap1","phases":[{"until":1,"support":"both"}],)"
      R"("keyframes":[{"t":0,"zmp":"center"}]})",
      small_track(0.125));
  const Pattern pattern = read_text(text);
  EXPECT_EQ(pattern.correction->coefficients(3, 6), 0.125);
  EXPECT_EQ(pattern.robot, "hoap1");
}

}  // namespace
}  // namespace ayumi
