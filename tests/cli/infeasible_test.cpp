// What prevents a repair, and which values would pass: every reported value has to be true.

#include <chrono>
#include <csignal>
#include <thread>

#include "tests/cli/program.hpp"
#include "tests/support/json.hpp"

namespace ayumi::test {
namespace {

using Json = nlohmann::json;

class Infeasible : public testing::Test {
 protected:
  Output ayumi(const std::vector<std::string>& arguments) {
    return run_program(arguments, folder.path());
  }

  Folder folder;
};

// Two arms are each too quick because of a parameter of their own: changing one of them is not
// enough.
TEST_F(Infeasible, ValuesAndPacesToldPass) {
  write(folder / "two.json", R"({ "format": "ayumi.pattern/1", "robot": "hoap1",
    "units": { "angle": "deg" }, "parameters": { "left": 0.2, "right": 0.2 },
    "phases": [{ "until": "0.9 + ${left} + ${right}", "support": "both" }],
    "keyframes": [
      { "t": 0, "zmp": "center", "posture": "home" },
      { "t": 0.4, "posture": "home" },
      { "t": "0.4 + ${left}", "posture": { "l_shoulder_pitch": 10 } },
      { "t": "0.5 + ${left}", "posture": { "r_shoulder_pitch": 68 } },
      { "t": "0.5 + ${left} + ${right}", "posture": { "r_shoulder_pitch": 10 } },
      { "t": "0.9 + ${left} + ${right}", "zmp": "center" }] })");
  const Output failed =
      ayumi({"repair", "two.json", "-o", "out.json", "--lock", "0.4..0.95", "--json"});
  EXPECT_EQ(failed.exit_code, 4) << failed.err;
  const Json json = json_of(failed.out);
  EXPECT_EQ(json["status"], "infeasible");
  EXPECT_TRUE(json["parameters"].empty());
  ASSERT_EQ(json["parameters_together"].size(), 2u);
  std::vector<std::string> both = {"check", "two.json"};
  for (const Json& value : json["parameters_together"])
    both.insert(both.end(), {"--set", std::string(value["name"]) + "=" + value["passes"].dump()});
  EXPECT_EQ(ayumi(both).exit_code, 0);
  EXPECT_EQ(ayumi({both.begin(), both.begin() + 4}).exit_code, 1) << "one of them alone";
  const Json slower = json["slower"];
  EXPECT_EQ(slower["windows_s"].size(), 2u);
  EXPECT_GT(double(slower["factor"]), 2);
  const std::string whole = slower["whole"].dump();
  EXPECT_EQ(ayumi({"edit", "retime", "two.json", "--scale", whole, "-o", "slow.json"}).exit_code,
            0);
  EXPECT_EQ(ayumi({"edit", "retime", "two.json", "--scale",
                   std::to_string(0.95 * double(slower["whole"])), "-o", "quick.json"})
                .exit_code,
            1);
}

// The left foot lands on the right one: the foothold is named, as by check, and no repair is
// computed.
TEST_F(Infeasible, AFootholdOnTheOtherFootIsNamed) {
  std::string walk = contents(fs::path(AYUMI_SOURCE_DIR) / "patterns/hoap1_walk.json");
  const std::string good = "\"to\": [0.06, 0.039]";
  walk.replace(walk.find(good), good.size(), "\"to\": [0.03, -0.02]");
  write(folder / "walk.json", walk);
  const Output failed = ayumi({"repair", "walk.json", "-o", "out.json"});
  EXPECT_EQ(failed.exit_code, 4) << failed.err;
  EXPECT_NE(failed.out.find("reason: the left foot is planned to stand on the right foot"),
            std::string::npos)
      << failed.out;
  EXPECT_NE(failed.out.find("likely cause: /phases/3: the left foot's"), std::string::npos)
      << failed.out;
  EXPECT_NE(failed.out.find(" 0 iterations"), std::string::npos) << failed.out;
  EXPECT_FALSE(fs::exists(folder / "out.json"));
}

// A motion that is reported to need 5.2 times as long passes if it gets that time.
TEST_F(Infeasible, AWindowFarTooShortIsStillAMatterOfTime) {
  write(folder / "slap.json", R"({ "format": "ayumi.pattern/1", "robot": "hoap1",
    "units": { "angle": "deg" }, "parameters": { "time": 0.2 },
    "phases": [{ "until": "1.4 + ${time}", "support": "both" }],
    "keyframes": [
      { "t": 0, "zmp": "center", "posture": "home" },
      { "t": 0.6, "posture": "home" },
      { "t": "0.6 + ${time}", "posture": { "l_shoulder_pitch": -60 } },
      { "t": "1.4 + ${time}", "zmp": "center" }] })");
  const Output failed =
      ayumi({"repair", "slap.json", "-o", "out.json", "--lock", "0.6..0.8", "--json"});
  EXPECT_EQ(failed.exit_code, 4) << failed.err;
  const Json json = json_of(failed.out);
  EXPECT_NEAR(json["obstacles"][0]["time_factor"], 5.16, 0.02);
  ASSERT_EQ(json["parameters"].size(), 1u);
  EXPECT_NEAR(json["parameters"][0]["passes"], 1.04, 0.02);
  const std::string time = "time=" + json["parameters"][0]["passes"].dump();
  EXPECT_EQ(ayumi({"check", "slap.json", "--set", time}).exit_code, 0);
  const double whole = json["slower"]["whole"];
  EXPECT_NEAR(whole, 5.16, 0.1);
  EXPECT_EQ(ayumi({"edit", "retime", "slap.json", "--scale", std::to_string(whole), "-o", "s.json"})
                .exit_code,
            0);
}

// A foot out of reach cannot even be sampled; the error names the stride that would pass.
TEST_F(Infeasible, AFootOutOfReachNamesTheStrideThatPasses) {
  write(folder / "step.json", R"({ "format": "ayumi.pattern/1", "robot": "hoap1",
    "units": { "angle": "deg" }, "parameters": { "stride": 0.2 },
    "phases": [
      { "until": 1.2, "support": "both" },
      { "until": 1.8, "support": "left",
        "swing": { "foot": "right", "to": ["${stride}", -0.039], "lift": 0.015 } },
      { "until": 3.2, "support": "both" }],
    "keyframes": [
      { "t": 0, "zmp": "center" }, { "t": 0.7, "zmp": "center" }, { "t": 1.2, "zmp": "left" },
      { "t": 1.8, "zmp": "left" }, { "t": 2.4, "zmp": "center" }] })");
  const Output failed = ayumi({"repair", "step.json", "-o", "out.json"});
  EXPECT_EQ(failed.exit_code, 3);
  EXPECT_NE(failed.err.find("out of reach"), std::string::npos) << failed.err;
  const size_t at = failed.err.find("if stride = ");
  ASSERT_NE(at, std::string::npos) << failed.err;
  const std::string value = failed.err.substr(at + 12, failed.err.find(' ', at + 12) - at - 12);
  EXPECT_EQ(ayumi({"check", "step.json", "--set", "stride=" + value}).exit_code, 0) << value;
}

// For a walk on ice, the repair works for a long time. It says what it works on even with quiet
// output, and on Ctrl-C it says what is left.
TEST_F(Infeasible, ALongRepairSaysWhatItStrugglesWith) {
  ASSERT_EQ(ayumi({"new", "walk", "--steps", "30", "-o", "ice.json"}).exit_code, 0);
  std::string text = contents(folder / "ice.json");
  const std::string key = R"("friction": 0.8)";
  ASSERT_NE(text.find(key), std::string::npos) << text;
  write(folder / "ice.json", text.replace(text.find(key), key.size(), R"("friction": 0.05)"));
  const fs::path err = folder / "err";
  const pid_t child = ::fork();
  if (child == 0) {
    const int file = ::open(err.c_str(), O_WRONLY | O_CREAT, 0600);
    if (::chdir(folder.path().c_str()) != 0 || ::dup2(file, 2) < 0) ::_exit(126);
    ::execl(AYUMI_PROGRAM, AYUMI_PROGRAM, "repair", "ice.json", "-o", "out.json", "-q", nullptr);
    ::_exit(127);
  }
  for (int i = 0; i < 600 && contents(err).empty(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_NE(contents(err).find(" takes a while. These errors are left: "), std::string::npos)
      << contents(err);
  EXPECT_NE(contents(err).find(" friction"), std::string::npos) << contents(err);
  ::kill(child, SIGINT);
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 130);
  EXPECT_NE(contents(err).find("These errors are left: "), std::string::npos) << contents(err);
  EXPECT_FALSE(fs::exists(folder / "out.json"));
}

}  // namespace
}  // namespace ayumi::test
