// `ayumi new jump`: the stoop that it finds, the profile that it writes, and its message if there
// is neither.

#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

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

}  // namespace
}  // namespace ayumi::test
