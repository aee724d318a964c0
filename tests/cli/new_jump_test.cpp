// `ayumi new jump`: the stoop that it finds, the profile that it writes, and its message if there
// is neither.

#include <nlohmann/json.hpp>
#include <regex>

#include "tests/cli/program.hpp"
#include "tests/support/urdf_biped.hpp"

namespace ayumi::test {
namespace {

TEST(NewJump, WhatItWritesPassesWithTheProfileItNames) {
  Folder folder;
  const Output made =
      run_program({"new", "-q", "jump", "--height", "0.025", "-o", "j.json"}, folder.path());
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const std::string text = contents(folder.path() / "j.json");
  EXPECT_NE(text.find("\"profile\": \"hoap1-strong\""), std::string::npos);
  EXPECT_EQ(run_program({"check", "-q", "j.json"}, folder.path()).exit_code, 0);
}

TEST(NewJump, AHeightBeyondEveryProfileIsSaid) {
  Folder folder;
  const Output made =
      run_program({"new", "-q", "jump", "--height", "0.045", "-o", "j.json"}, folder.path());
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_NE(made.out.find("no actuator profile of hoap1 is strong enough for a jump of 0.045 m"),
            std::string::npos)
      << made.out;
  EXPECT_EQ(contents(folder.path() / "j.json").find("\"profile\""), std::string::npos);
}

// Motors that turn slowly do not jump, and the message says what is in the way of a low jump.
TEST(NewJump, WhatIsInTheWayOfALowJumpIsSaid) {
  Folder folder;
  write(folder / "slow.urdf", UrdfBiped{.speed = 1}.text());
  const Output made =
      run_program({"new", "jump", "--robot", "slow.urdf", "-o", "jump.json"}, folder.path());
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_NE(made.out.find("No jump of 1 mm or more passes the check"), std::string::npos)
      << made.out;
  EXPECT_TRUE(std::regex_search(
      made.out, std::regex("A jump of [0-9.]+ mm with the default stoop and COG height fails: "
                           "joint_speed of ")))
      << made.out;
}

}  // namespace
}  // namespace ayumi::test
