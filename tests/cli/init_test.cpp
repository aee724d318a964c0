// `ayumi init`: from a bare URDF to a consistent motion in three commands.

#include "tests/cli/program.hpp"
#include "tests/support/urdf_biped.hpp"

namespace ayumi::test {
namespace {

Output ayumi(const Folder& folder, std::vector<std::string> words) {
  words.insert(words.begin() + 1, "-q");
  return run_program(words, folder.path());
}

void expect_walks_in_three_commands(UrdfBiped kind) {
  Folder folder;
  write(folder / "robot.urdf", kind.text());
  const Output init = ayumi(folder, {"init", "robot.urdf", "-o", "robot/"});
  ASSERT_EQ(init.exit_code, 0) << init.err;
  EXPECT_NE(init.out.find("Next: ayumi new walk --robot robot -o walk.json"), std::string::npos);
  const Output made = ayumi(folder, {"new", "walk", "--robot", "robot", "-o", "walk.json"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const Output check = ayumi(folder, {"check", "walk.json"});
  EXPECT_EQ(check.exit_code, 0) << check.out << made.out;
}

TEST(Init, ThreeCommandsToAWalk) {
  expect_walks_in_three_commands({.name = "plain"});
  expect_walks_in_three_commands({.name = "turned", .facing = -std::numbers::pi / 2});
  expect_walks_in_three_commands({.name = "opposed", .opposed = true, .placeholders = true});
}

TEST(Init, WritesThreeFilesOrNone) {
  Folder folder;
  write(folder / "robot.urdf", UrdfBiped{}.text());
  ASSERT_EQ(ayumi(folder, {"init", "robot.urdf", "-o", "new/robot"}).exit_code, 0);
  const std::vector<std::string> all = {
      "new",       "new/robot", "new/robot/TODO.md", "new/robot/robot.json", "new/robot/robot.png",
      "robot.urdf"};
  EXPECT_EQ(folder.files(), all);
  write(folder / "new/robot/robot.json", "mine");
  const Output again = ayumi(folder, {"init", "robot.urdf", "-o", "new/robot"});
  EXPECT_EQ(again.exit_code, 3);
  EXPECT_NE(again.err.find("robot.json"), std::string::npos) << again.err;
  EXPECT_EQ(contents(folder / "new/robot/robot.json"), "mine");
  const Output forced = ayumi(folder, {"init", "robot.urdf", "-o", "new/robot", "--force"});
  EXPECT_EQ(forced.exit_code, 0) << forced.err;
  EXPECT_NE(contents(folder / "new/robot/robot.json").find("ayumi.robot/1"), std::string::npos);
  write(folder / "broken.urdf", "<robot");
  EXPECT_EQ(ayumi(folder, {"init", "broken.urdf", "-o", "broken"}).exit_code, 3);
  EXPECT_EQ(folder.files(), [&] {
    auto files = all;
    files.insert(files.begin(), "broken.urdf");
    return files;
  }());
}

}  // namespace
}  // namespace ayumi::test
