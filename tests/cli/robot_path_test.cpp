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

}  // namespace
}  // namespace ayumi::test
