// `ayumi new walk`: the profile that it writes, and its message if no profile is enough. Other
// kinds are tested with robots from public files.

#include <filesystem>

#include "tests/cli/program.hpp"

namespace ayumi::test {
namespace {

Output made(const Folder& folder, std::vector<std::string> options) {
  options.insert(options.begin(), {"new", "-q", "walk", "-o", "w.json", "--force"});
  return run_program(options, folder.path());
}

// Writes the first sidecar of Open Duck into the folder; false if its file is missing.
bool has_duck(const Folder& folder) {
  const std::filesystem::path robot =
      AYUMI_SOURCE_DIR "/../shared/data/open_duck_mini_v2/open_duck_mini_v2.xml";
  return std::filesystem::exists(robot) &&
         run_program({"init", "-q", robot.string(), "-o", "duck"}, folder.path()).exit_code == 0;
}

TEST(NewWalk, StairsAreWrittenForTheProfileThatClimbsThem) {
  Folder folder;
  const Output out = made(folder, {"--rise", "0.01", "--steps", "2"});
  ASSERT_EQ(out.exit_code, 0) << out.err;
  EXPECT_NE(
      out.out.find("the pattern names the profile hoap1-strong, because profile hoap1 is too weak"),
      std::string::npos)
      << out.out;
  EXPECT_NE(contents(folder.path() / "w.json").find("\"profile\": \"hoap1-strong\""),
            std::string::npos);
  // The pattern passes with the motors that it asks for, and a table for the robot as it is would
  // be refused.
  const Output check = run_program({"check", "-q", "w.json"}, folder.path());
  EXPECT_EQ(check.exit_code, 0);
  EXPECT_NE(
      check.out.find("with the robot's own motors, profile hoap1 is too weak: the motion needs "),
      std::string::npos)
      << check.out;
  EXPECT_NE(check.out.find("(`export --format hoap` judges by these motors)"), std::string::npos);
}

TEST(NewWalk, LegsWithoutMotorsAreNamed) {
  Folder folder;
  write(folder.path() / "limp" / "robot.json", R"({"format": "ayumi.robot/1", "base": "hoap1",
    "servos": [{"joints": ["l_knee", "r_knee"], "kp": 0, "kd": 0}]})");
  const Output out = made(folder, {"--robot", "limp", "--steps", "2"});
  EXPECT_NE(out.out.find("profile hoap1 is too weak: the motion needs "), std::string::npos)
      << out.out << out.err;
  // The soft profiles state servos of their own.
  const Output check = run_program({"check", "-q", "--profile", "hoap1", "w.json"}, folder.path());
  EXPECT_EQ(check.exit_code, 1) << check.err;
  EXPECT_NE(check.out.find("_knee, but this joint has none (kp of its servo is 0)"),
            std::string::npos)
      << check.out;
}

// With weak hips, no combination of the listed heights, lengths and times passes. The ZMP must stay
// farther inwards, and no list contains this value.
TEST(NewWalk, TheSearchGoesOnFromTheNearestTrial) {
  Folder folder;
  std::string profiles;
  for (const char* name : {"hoap1", "hoap1-strong", "hoap1-soft", "hoap1-strong-soft"})
    profiles += (profiles.empty() ? "" : ", ") + std::string(R"({"name": ")") + name +
                R"(", "limits": [{"joints": ["l_hip_roll", "r_hip_roll"], "peak_torque": 2.4,
                                  "continuous_torque": 2.4}]})";
  write(folder.path() / "weak" / "robot.json",
        R"({"format": "ayumi.robot/1", "base": "hoap1", "profiles": [)" + profiles + "]}");
  const Output out = made(folder, {"--robot", "weak", "--steps", "2"});
  EXPECT_EQ(out.exit_code, 0) << out.err;
  EXPECT_NE(out.out.find(" trials, these values were found: "), std::string::npos) << out.out;
  EXPECT_NE(out.out.find("--zmp-inwards "), std::string::npos) << out.out;
  const Output check = run_program({"check", "-q", "w.json"}, folder.path());
  EXPECT_EQ(check.exit_code, 0) << check.out;
}

TEST(NewWalk, OnTheLevelItIsTheRobotsOwn) {
  Folder folder;
  EXPECT_EQ(made(folder, {"--steps", "2"}).out.find("profile"), std::string::npos);
  EXPECT_EQ(contents(folder.path() / "w.json").find("\"profile\""), std::string::npos);
  EXPECT_EQ(
      run_program({"check", "-q", "w.json"}, folder.path()).out.find("the robot's own motors"),
      std::string::npos);
}

TEST(NewWalk, WhatNoProfileMendsIsSaid) {
  Folder folder;
  const Output out = made(folder, {"--steps", "2", "--turn", "25"});
  EXPECT_EQ(out.exit_code, 1) << out.err;
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "w.json"));
  EXPECT_NE(out.out.find(
                "the check finds the new pattern inconsistent: self_collision of r_foot - l_foot"),
            std::string::npos)
      << out.out;
  EXPECT_NE(out.out.find(" is the most that the legs can reach"), std::string::npos) << out.out;
  const Output anyway = made(folder, {"--steps", "2", "--turn", "25", "--allow-inconsistent"});
  EXPECT_EQ(anyway.exit_code, 0) << anyway.err;
  EXPECT_EQ(run_program({"check", "-q", "w.json"}, folder.path()).exit_code, 1);
}

// A sway to the side that asks too much of the ankles, or is out of reach, is reported with the one
// that fits.
TEST(NewWalk, AsideNoFartherThanTheLegsCan) {
  Folder folder;
  const Output far = made(folder, {"--steps", "2", "--stride", "0", "--side", "0.04"});
  EXPECT_EQ(far.exit_code, 1) << far.err;
  const size_t at = far.out.find("--side 0.0");
  ASSERT_NE(at, std::string::npos) << far.out;
  const std::string fits = far.out.substr(at + 7, far.out.find(' ', at + 7) - at - 7);
  EXPECT_LT(std::stod(fits), 0.04);
  EXPECT_GT(std::stod(fits), 0.01);
  made(folder, {"--steps", "2", "--stride", "0", "--side", fits});
  EXPECT_EQ(run_program({"check", "-q", "w.json"}, folder.path()).exit_code, 0);
  const Output beyond = made(folder, {"--steps", "2", "--stride", "0", "--side", "0.07"});
  EXPECT_EQ(beyond.exit_code, 3) << beyond.out;
  EXPECT_NE(beyond.err.find(". --side " + fits + " is the most that the legs can reach"),
            std::string::npos)
      << beyond.err;
}

class NewKinds : public testing::TestWithParam<const char*> {};

// The robots have an elbow at its limit at home (SR1), arms that are not raised beside the head
// (mighty), legs that must bend for a turn (mighty), and shins that meet in a turn (DARwIn-OP).
TEST_P(NewKinds, ATurnAndAWaveAreConsistent) {
  const std::filesystem::path robot =
      std::filesystem::path(AYUMI_SOURCE_DIR "/../shared/data") / GetParam();
  if (!std::filesystem::exists(robot)) GTEST_SKIP() << "no file " << robot;
  Folder folder;
  const Output made = run_program({"init", robot.string(), "-o", "robot"}, folder.path());
  ASSERT_EQ(made.exit_code, 0) << made.err;
  for (const std::string kind : {"turn", "wave"}) {
    const std::string file = kind + ".json";
    const Output out =
        run_program({"new", "-q", kind, "--robot", "./robot", "-o", file}, folder.path());
    ASSERT_EQ(out.exit_code, 0) << kind << ": " << out.err;
    const Output check = run_program({"check", "-q", file}, folder.path());
    EXPECT_EQ(check.exit_code, 0) << kind << ": " << out.out << check.out;
  }
}

// The soles are 19 mm wide, and the rotors of the knees need most of their torque for the lift. A
// walk passes only with the lowest lift and with other values in a narrow range.
TEST(NewWalk, ANarrowRangeOfValuesIsFound) {
  Folder folder;
  if (!has_duck(folder)) GTEST_SKIP() << "no file of the robot";
  for (const std::string kind : {"walk", "turn", "march"}) {
    const std::string file = kind + ".json";
    const Output out =
        run_program({"new", "-q", kind, "--robot", "./duck", "-o", file, "--force"}, folder.path());
    EXPECT_EQ(out.exit_code, 0) << kind << ": " << out.out << out.err;
    EXPECT_NE(out.out.find("--lift 0.0033 m"), std::string::npos) << out.out;
    EXPECT_EQ(run_program({"check", "-q", file}, folder.path()).exit_code, 0) << kind;
    const Output run = run_program({"simulate", "-q", "--json", file}, folder.path());
    EXPECT_NE(run.out.find("\"outcome\": \"stands\""), std::string::npos) << kind << run.out;
  }
}

// If no walk is found, the message names the one that comes nearest and its limit. A message that
// the legs do not reach a place would not tell the user which option to change.
TEST(NewWalk, TheWalkThatComesNearestIsNamed) {
  Folder folder;
  if (!has_duck(folder)) GTEST_SKIP() << "no file of the robot";
  const Output out = made(folder, {"--robot", "./duck", "--lift", "0.01"});
  EXPECT_EQ(out.exit_code, 3);
  EXPECT_NE(out.out.find("The combination that comes nearest has --period"), std::string::npos)
      << out.out;
  EXPECT_NE(out.out.find("Its limit is joint_torque of "), std::string::npos) << out.out;
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "w.json"));
}

INSTANTIATE_TEST_SUITE_P(Robots, NewKinds,
                         testing::Values("choreonoid/SR1/SR1.urdf", "roki/mighty.ztk",
                                         "darwin_op/urdf/darwin.urdf"),
                         [](const auto& info) {
                           return std::filesystem::path(info.param).stem().string();
                         });

}  // namespace
}  // namespace ayumi::test
