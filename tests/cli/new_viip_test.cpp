// `ayumi new viip`: motions that the robot can do are written, and others are refused in one line.

#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

namespace ayumi::test {
namespace {

class NewViip : public testing::Test {
 protected:
  Output make(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"new", "viip", "-o", "v.json", "-q", "--force"});
    return run_program(arguments, folder.path());
  }
  Folder folder;
};

TEST_F(NewViip, RefusesWhatTheRobotCannotReach) {
  struct Case {
    std::vector<std::string> arguments;
    int exit_code;
    const char* words;
  };
  for (const Case& c :
       {Case{{"--cog", "0.2,0,0"}, 3, "outside the support of the feet"},
        Case{{"--cog", "0,0,-0.1"}, 3, "is possible"},
        Case{{"--cog", "nan,0,0"}, 2, "not a finite"},
        Case{{"--cog-velocity", "0.06,0,0"}, 3, "is possible"},
        Case{{"--cog-velocity", "0.06,0,0", "--duration", "0"}, 2, "--duration"},
        Case{{"--cog-velocity", "0.01,0,0", "--steps", "2"}, 2, "give exactly one of"},
        Case{{"--steps", "6", "--velocity", "0.5"}, 3, "The largest step is"},
        Case{{"--steps", "6", "--turn", "300"}, 3, "deg/s"},
        Case{{"--steps", "1", "--velocity", "0.1"}, 2, "--steps 2"},
        Case{{"--steps", "6", "--velocity", "inf"}, 2, "not a finite"}}) {
    const Output output = make(c.arguments);
    EXPECT_EQ(output.exit_code, c.exit_code) << output.err;
    EXPECT_NE(output.err.find(c.words), std::string::npos) << output.err;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "v.json"));
  }
}

TEST_F(NewViip, LongStepsHoldTheCogLowerAndNameTheirActuators) {
  const Output output = make({"--steps", "6", "--velocity", "0.25"});
  ASSERT_EQ(output.exit_code, 0) << output.err;
  const std::string text = contents(folder.path() / "v.json");
  EXPECT_NE(text.find("\"profile\": \"hoap1-strong\""), std::string::npos) << text;
  EXPECT_NE(text.find("\"cog_height\": 0.238"), std::string::npos) << text;
  ASSERT_EQ(make({"--cog-velocity", "0,0.02,-0.01", "--duration", "1.5"}).exit_code, 0);
  EXPECT_NE(contents(folder.path() / "v.json").find("\"cog_velocity\": [0, 0.02, -0.01]"),
            std::string::npos);
  ASSERT_EQ(make({"--cog", "0.03,0,-0.01"}).exit_code, 0);
  EXPECT_NE(contents(folder.path() / "v.json").find("\"profile\": \"hoap1\""), std::string::npos);
}

// A goal that no profile can reach is no finding of the motion.
TEST_F(NewViip, GoalsThatAreTooStrongForEveryProfileAreRefused) {
  std::string profiles;
  for (const char* name : {"hoap1", "hoap1-soft", "hoap1-strong", "hoap1-strong-soft"})
    profiles += std::string(profiles.empty() ? "" : ", ") + R"({ "name": ")" + name +
                R"(", "limits": [{ "joints": ["*"], "speed": 0.8 }] })";
  write(folder / "slow.json", R"({ "format": "ayumi.robot/1", "base": "hoap1", "name": "slow",
    "profiles": [)" + profiles + "] }");
  const Output refused = make({"--robot", "slow.json", "--steps", "6", "--velocity", "0.3"});
  EXPECT_EQ(refused.exit_code, 1) << refused.out << refused.err;
  EXPECT_NE(refused.out.find("other profile is strong enough"), std::string::npos) << refused.out;
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "v.json"));
  const Output written =
      make({"--robot", "slow.json", "--steps", "6", "--velocity", "0.3", "--allow-inconsistent"});
  EXPECT_EQ(written.exit_code, 0) << written.out << written.err;
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "v.json"));
}

}  // namespace
}  // namespace ayumi::test
