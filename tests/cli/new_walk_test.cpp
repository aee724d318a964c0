// `ayumi new walk`: the profile it writes, and what it says where none is enough.

#include "tests/cli/program.hpp"

namespace ayumi::test {
namespace {

Output made(const Folder& folder, std::vector<std::string> options) {
  options.insert(options.begin(), {"new", "-q", "walk", "-o", "w.json", "--force"});
  return run_program(options, folder.path());
}

TEST(NewWalk, StairsAreWrittenForTheProfileThatClimbsThem) {
  Folder folder;
  const Output out = made(folder, {"--rise", "0.01", "--steps", "2"});
  ASSERT_EQ(out.exit_code, 0) << out.err;
  EXPECT_NE(out.out.find("profile hoap1-strong is written: profile hoap1 is not enough"),
            std::string::npos)
      << out.out;
  EXPECT_NE(contents(folder.path() / "w.json").find("\"profile\": \"hoap1-strong\""),
            std::string::npos);
  EXPECT_EQ(run_program({"check", "-q", "w.json"}, folder.path()).exit_code, 0);
}

TEST(NewWalk, OnTheLevelItIsTheRobotsOwn) {
  Folder folder;
  EXPECT_EQ(made(folder, {"--steps", "2"}).out.find("profile"), std::string::npos);
  EXPECT_EQ(contents(folder.path() / "w.json").find("\"profile\""), std::string::npos);
}

TEST(NewWalk, WhatNoProfileMendsIsSaid) {
  Folder folder;
  const Output out = made(folder, {"--steps", "2", "--turn", "25"});
  EXPECT_EQ(out.exit_code, 0) << out.err;
  EXPECT_NE(out.out.find("`ayumi check` finds it inconsistent: self_collision r_foot - l_foot"),
            std::string::npos)
      << out.out;
}

}  // namespace
}  // namespace ayumi::test
