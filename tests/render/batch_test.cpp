// `ayumi preview` of many runs, its further formats, and its messages for mistakes.

#include <gtest/gtest.h>

#include "tests/render/standing_run.hpp"
#include "tests/support/json.hpp"

namespace ayumi::test {
namespace {

using Json = nlohmann::json;

class Batch : public OnARun {
 protected:
  void SetUp() override {
    OnARun::SetUp();
    for (const char* name : {"b", "c"}) fs::copy(folder / "run", folder / name);
  }
};

TEST_F(Batch, ManyRunsBecomeAFolderOfClips) {
  const std::vector<std::string> command = {"preview",   "run",     "b",       "c",      "-o",
                                            "clips",     "--sheet", "all.png", "--size", "64x36",
                                            "--columns", "2",       "--json"};
  const Output made = ayumi(command);
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const Json json = json_of(made.out);
  EXPECT_EQ(json.at("runs").size(), 3u);
  EXPECT_TRUE(json.at("failures").empty());
  for (const char* name : {"run.mp4", "b.mp4", "c.mp4"})
    EXPECT_GT(contents(folder / "clips" / name).size(), 500u) << name;
  EXPECT_EQ(contents(folder / "all.png").substr(1, 3), "PNG");
  const auto before = fs::last_write_time(folder / "clips" / "b.mp4");
  fs::remove(folder / "clips" / "c.mp4");
  const Output again = ayumi({"preview", "run", "b", "c", "-o", "clips", "--size", "64x36"});
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_NE(again.out.find("3 of 3 runs drawn; 2 clips existed already"), std::string::npos)
      << again.out;
  EXPECT_TRUE(fs::exists(folder / "clips" / "c.mp4"));
  EXPECT_EQ(fs::last_write_time(folder / "clips" / "b.mp4"), before) << "not drawn again";
}

TEST_F(Batch, AFailureDoesNotStopTheOthers) {
  write(folder / "b" / "run.json", "{");
  const Output made =
      ayumi({"preview", "run", "b", "c", "-o", "p", "--format", "png", "--size", "64x36"});
  EXPECT_EQ(made.exit_code, 3);
  EXPECT_TRUE(fs::exists(folder / "p" / "run.png") && fs::exists(folder / "p" / "c.png"));
  EXPECT_FALSE(fs::exists(folder / "p" / "b.png"));
  EXPECT_NE(made.out.find("2 of 3 runs"), std::string::npos) << made.out;
  EXPECT_NE(made.out.find("failed: b: "), std::string::npos) << made.out;
}

TEST_F(Batch, TwoRunsOfOneNameAreRefused) {
  fs::create_directories(folder / "other");
  fs::copy(folder / "run", folder / "other" / "run");
  const Output made = ayumi({"preview", "run", "other/run", "-o", "p"});
  EXPECT_EQ(made.exit_code, 2);
  EXPECT_NE(made.err.find("both clips would be written to p/run.mp4"), std::string::npos)
      << made.err;
}

TEST_F(Batch, FurtherFormats) {
  for (const char* name : {"a.apng", "a.webm", "a.gif", "a.glb"}) {
    const Output made =
        ayumi({"preview", "run", "-o", name, "--size", "64x36", "--ghost", "command"});
    EXPECT_EQ(made.exit_code, 0) << name << made.err;
    EXPECT_GT(contents(folder / name).size(), 500u) << name;
  }
  EXPECT_NE(contents(folder / "a.apng").find("acTL"), std::string::npos) << "an animated PNG";
  EXPECT_EQ(contents(folder / "a.glb").substr(0, 4), "glTF");
  const Output strip = ayumi({"preview", "run", "-o", "s.png", "--size", "64x36", "--strip", "3",
                              "--columns", "3", "--json"});
  EXPECT_EQ(json_of(strip.out).at("size").at(0), 192);
  EXPECT_GT(json_of(strip.out).at("size").at(1), 36) << "with a title and a legend";
  EXPECT_EQ(json_of(strip.out).at("frames"), 3) << "snapshots";
  const Output many = ayumi(
      {"preview", "run", "-o", "e.png", "--size", "64x36", "--exposures", "3", "--show", "heat"});
  EXPECT_EQ(many.exit_code, 0) << many.err;
  EXPECT_EQ(ayumi({"preview", "run", "-o", "e.mp4", "--exposures", "3"}).exit_code, 2);
}

TEST_F(Batch, NothingHalfIsLeftBehind) {
  const auto files = folder.files();
  const auto fails = [&](const std::vector<std::string>& words, int code, const std::string& says) {
    const Output made = ayumi(words);
    EXPECT_EQ(made.exit_code, code) << says;
    EXPECT_NE(made.err.find(says), std::string::npos) << made.err;
  };
  fails({"preview", "run", "-o", "a.mp4", "--size", "0x0"}, 2, "each edge must be 1 to 4096");
  fails({"preview", "run", "-o", "a.mp4", "--size", "wide"}, 2, "WIDTHxHEIGHT");
  fails({"preview", "run", "-o", "a.mp4", "--size", "65x33"}, 2, "needs an even width and height");
  fails({"preview", "run", "-o", "nowhere/a.mp4", "--size", "64x36"}, 3, "nowhere");
  fails({"preview", "run", "-o", "nowhere/a.png", "--size", "64x36"}, 3, "nowhere");
  fails({"preview", "run", "-o", "/dev/full/a.mp4", "--size", "64x36"}, 3, "/dev/full");
  fails({"preview", "run", "-o", "a.avi", "--size", "64x36"}, 2, "is not possible; give .mp4");
  fails({"preview", "run", "-o", "a.mp4", "--ghost", "nobody"}, 3, "nobody");
  fails({"preview", "run", "-o", "a.mp4", "--hide", "heet"}, 2, "did you mean 'heat'");
  EXPECT_EQ(folder.files(), files);
}

}  // namespace
}  // namespace ayumi::test
