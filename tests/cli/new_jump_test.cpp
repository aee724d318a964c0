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
  EXPECT_EQ(made.exit_code, 1) << made.err;
  EXPECT_NE(made.out.find("no actuator profile of hoap1 is strong enough for a jump of 0.045 m"),
            std::string::npos)
      << made.out;
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "j.json"));
}

// Servos whose constants are guessed do not prevent a jump for which speed and torque suffice.
TEST(NewJump, ARobotThatOnlyHasAUrdfJumps) {
  Folder folder;
  write(
      folder / "quick.urdf",
      UrdfBiped{.size = 2, .mass = 4, .effort = [](const std::string&) { return 100; }, .speed = 12}
          .text());
  const Output made =
      run_program({"new", "jump", "--robot", "quick.urdf", "-o", "jump.json"}, folder.path());
  ASSERT_EQ(made.exit_code, 0) << made.out << made.err;
  EXPECT_EQ(run_program({"check", "-q", "jump.json"}, folder.path()).exit_code, 0) << made.out;
}

// Motors that turn slowly do not jump, and the message says what limits the jump that comes
// nearest.
TEST(NewJump, WhatLimitsTheNearestJumpIsSaid) {
  Folder folder;
  write(folder / "slow.urdf", UrdfBiped{.speed = 1}.text());
  const Output made =
      run_program({"new", "jump", "--robot", "slow.urdf", "-o", "jump.json"}, folder.path());
  EXPECT_EQ(made.exit_code, 1) << made.err;
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "jump.json"));
  EXPECT_NE(made.out.find("No jump of 1 mm or more passes the check"), std::string::npos)
      << made.out;
  EXPECT_TRUE(std::regex_search(
      made.out,
      std::regex("The jump that comes nearest rises by 1 mm from a COG height of [0-9.]+ m "
                 "with a stoop of [0-9.]+ mm, with the actuators [a-z]+. Its limit is "
                 "(joint_speed|table_step) of ")))
      << made.out;
}

}  // namespace
}  // namespace ayumi::test
