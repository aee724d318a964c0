// A user's own robot is named by a path: the files that the commands write still find it.

#include "tests/cli/program.hpp"

namespace ayumi::test {
namespace {

TEST(RobotPath, HoldsFromTheWorkingFolderWhereverThePatternIsWritten) {
  Folder folder;
  fs::create_directories(folder / "patterns");
  fs::create_directories(folder / "mine");
  fs::copy(AYUMI_SOURCE_DIR "/robots/hoap1", folder / "mine", fs::copy_options::recursive);
  const auto ayumi = [&](const std::vector<std::string>& arguments) {
    const Output output = run_program(arguments, folder.path());
    EXPECT_EQ(output.exit_code, 0) << output.err;
    return output;
  };
  ayumi({"new", "stand", "--robot", "mine", "--duration", "0.5", "-o", "patterns/stand.json"});
  const std::string pattern = contents(folder / "patterns/stand.json");
  EXPECT_NE(pattern.find("\"robot\": \"../mine\""), std::string::npos) << pattern;
  ayumi({"check", "patterns/stand.json"});
  ayumi({"simulate", "patterns/stand.json", "-o", "run"});
  ayumi({"plot", "run", "-o", "loci.svg"});
  ayumi({"preview", "run", "--size", "64x48", "-o", "a.png"});

  const Output lost =
      run_program({"preview", "../run", "--size", "64x48", "-o", "b.png"}, folder / "mine");
  EXPECT_EQ(lost.exit_code, 3) << "seen from here, patterns/../mine is not there";
  EXPECT_NE(lost.err.find("name the robot with --robot"), std::string::npos) << lost.err;
  EXPECT_EQ(run_program({"preview", "../run", "--robot", ".", "--size", "64x48", "-o", "b.png"},
                        folder / "mine")
                .exit_code,
            0);
}

TEST(RobotPath, ABrokenRobotDoesNotHideTheOthers) {
  Folder folder;
  write(folder / "robots/half/robot.json", R"({"format": "ayumi.robot/1"})");
  const Output out = run_program({"robots", "--robot-path", "robots"}, folder.path());
  EXPECT_EQ(out.exit_code, 3);
  EXPECT_NE(out.out.find("hoap1 "), std::string::npos) << out.out;
  EXPECT_EQ(out.out.find("half"), std::string::npos) << out.out;
  EXPECT_TRUE(out.err.starts_with("ayumi: robot 'half' is left out: robots/half/robot.json"))
      << out.err;
  EXPECT_EQ(line_count(out.err), 1) << out.err;
  std::error_code refused;
  fs::rename(folder / "robots/half", folder / "robots/half\xff", refused);
  if (refused) GTEST_SKIP() << "the file system refuses names that are not UTF-8";
  const Output json = run_program({"robots", "--robot-path", "robots", "--json"}, folder.path());
  EXPECT_EQ(json.exit_code, 3) << json.err;
  EXPECT_NE(json.out.find("\"failures\": [\n    {\n      \"robot\": \"half\xEF\xBF\xBD\""),
            std::string::npos)
      << json.out;
}

}  // namespace
}  // namespace ayumi::test
