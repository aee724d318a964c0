// The commands check and repair on the HOAP-1 walk, both correct and with faults put into its file.

#include <algorithm>
#include <cstdlib>
#include <regex>
#include <sstream>

#include "tests/cli/program.hpp"
#include "tests/support/json.hpp"

namespace ayumi::test {
namespace {

using Json = nlohmann::json;

class CheckRepair : public testing::Test {
 protected:
  Output ayumi(const std::vector<std::string>& arguments) {
    return run_program(arguments, folder.path());
  }

  /// Writes the walk with `from` replaced by `to` as a file of the scratch folder.
  void plant(const std::string& name, const std::string& from, const std::string& to) {
    std::string text = contents(kWalk);
    const size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    write(folder / name, text.replace(at, from.size(), to));
  }

  // Puts the ZMP of the second step on the left foot 10 mm beyond its outer edge.
  void plant_zmp_outside(const std::string& name) {
    const std::string key = R"("zmp": "left" },
    { "t": 2.671, "zmp": "left" })";
    plant(name, key, R"("zmp": [0.067, 0.0805] },
    { "t": 2.671, "zmp": [0.067, 0.0805] })");
  }

  Folder folder;
};

TEST_F(CheckRepair, TheWalkIsConsistent) {
  const Output people = ayumi({"check", kWalk});
  EXPECT_EQ(people.exit_code, 0) << people.out << people.err;
  EXPECT_NE(people.out.find(": consistent"), std::string::npos);
  const Output script = ayumi({"check", kWalk, "--json", "--quiet"});
  EXPECT_EQ(script.exit_code, 0);
  const Json json = json_of(script.out);
  EXPECT_EQ(json["verdict"], "consistent");
  for (const Json& finding : json["findings"]) EXPECT_EQ(finding["severity"], "info");
  EXPECT_GT(double(json["summary"]["min_zmp_margin_m"]), 0.01);
  EXPECT_GT(double(json["wall_s"]), 0);
  EXPECT_TRUE(folder.files().empty());
}

// In an earlier version, the distance of bodies that overlap was reported as a negative distance.
TEST_F(CheckRepair, BodiesThatOverlapAreSaidTo) {
  plant("arm.json", R"({ "t": 0, "zmp": "center" })",
        R"({ "t": 0, "zmp": "center", "joints": { "l_shoulder_roll": -40 } })");
  const Output out = ayumi({"check", "arm.json", "-q"});
  EXPECT_NE(out.out.find("; bodies overlap by "), std::string::npos) << out.out;
}

// The mistake is named first, even if the motion cannot be sampled at all.
TEST_F(CheckRepair, TheMistakeIsNamedFirst) {
  plant("far.json", R"("to": [0.09, -0.039])", R"("to": [0.9, -0.039])");
  const Output far = ayumi({"check", "far.json", "-q"});
  EXPECT_EQ(far.exit_code, 3);
  EXPECT_NE(far.err.find("far.json: likely cause: /phases/5: the right foot's x is 0.9 m. With the "
                         "decimal point one place further left (0.09 m), or with a value of at "
                         "most "),
            std::string::npos)
      << far.err;
  EXPECT_NE(far.err.find("First error: /phases/5: t = "), std::string::npos);
  // For a value that is wrong by a factor of a thousand, the message also states the range of
  // possible values. This range contains the value that is suggested.
  write(folder / "step.json", R"({"format": "ayumi.pattern/1", "robot": "hoap1",
      "phases": [{"duration": 1.2, "support": "both"},
                 {"duration": 0.6, "support": "left",
                  "swing": {"foot": "right", "lift": 0.015, "step": {"forward": 30}}},
                 {"duration": 0.3, "support": "both"}, {"duration": 1, "support": "both"}],
      "keyframes": [{"t": 0, "posture": "home", "zmp": "center"}, {"t": 1, "zmp": "left"},
                    {"t": 1.8, "zmp": "left"}, {"t": 2.4, "zmp": "center"}]})");
  const std::string step = ayumi({"check", "step.json", "-q"}).err;
  EXPECT_NE(
      step.find("step.json: likely cause: /phases/1: \"forward\" of the right foot's step is 30 m. "
                "With the number read in mm (0.03 m), or with a value of at most 0.0"),
      std::string::npos)
      << step;
  // A value that is written once is named once, however often the block is repeated.
  write(folder / "rounds.json", R"({"format": "ayumi.pattern/1", "robot": "hoap1",
      "phases": [{"duration": 1.2, "support": "both"},
                 {"repeat": 2, "phases": [
                   {"duration": 31, "support": "left",
                    "swing": {"foot": "right", "lift": 0.015, "step": {}}},
                   {"duration": 0.3, "support": "both"}]}],
      "keyframes": [{"t": 0, "posture": "home", "zmp": "center"}, {"t": 1, "zmp": "left"}]})");
  const std::string rounds = ayumi({"check", "rounds.json", "-q"}).out;
  const size_t once = rounds.find("the swing lasts 31 s");
  EXPECT_NE(once, std::string::npos) << rounds;
  EXPECT_EQ(rounds.find("the swing lasts 31 s", once + 1), std::string::npos) << rounds;
  EXPECT_EQ(rounds.find("more of this kind"), std::string::npos) << rounds;
  plant("foot.json", R"({ "t": 2.22, "zmp": "left" })", R"({ "t": 2.22, "zmp": "right" })");
  const Output foot = ayumi({"check", "foot.json", "-q"});
  EXPECT_EQ(foot.exit_code, 1);
  const std::string second_line = foot.out.substr(foot.out.find('\n') + 1);
  EXPECT_EQ(second_line.rfind("  likely cause: /phases/5: the robot stands on the left foot, but "
                              "/keyframes/6 puts the ZMP under the right foot",
                              0),
            0u)
      << foot.out;
}

// An unknown name cannot be corrected by another number. So only the name is reported, and no
// search for mistakes is made.
TEST_F(CheckRepair, AnUnknownNameIsSaidAloneAtOnce) {
  const std::string key = R"({ "t": 2.22, "zmp": "left" })";
  const std::vector<std::pair<std::string, std::string>> misspelt = {
      {R"({ "t": 2.22, "zmp": "left", "joints": { "l_elbw": 0.1 } })", "did you mean 'l_elbow'?"},
      {R"({ "t": 2.22, "zmp": "left", "posture": "hom" })", "did you mean 'home'?"},
      {R"({ "t": 2.22, "zmp": "left", "hands": { "l_forarm": [0.1, 0.1, 0.2] } })",
       "did you mean 'l_forearm'?"}};
  for (const auto& [with, meant] : misspelt) {
    plant("name.json", key, with);
    const Output answer = ayumi({"check", "name.json"});
    EXPECT_EQ(answer.exit_code, 3);
    EXPECT_NE(answer.err.find(meant), std::string::npos) << answer.err;
    EXPECT_EQ(answer.err.find("likely cause"), std::string::npos) << answer.err;
    EXPECT_EQ(answer.err.find("looking for the cause"), std::string::npos) << answer.err;
    EXPECT_EQ(answer.err.find("trial"), std::string::npos) << answer.err;
  }
}

// The key of a foot that carries is named, with the place where the foot stands. A change of times
// with which the motion can be sampled is not named.
TEST_F(CheckRepair, AFootThatItsKeysDragIsNamed) {
  EXPECT_EQ(ayumi({"new", "kick", "--robot", "hoap1", "-o", "kick.json", "-q"}).exit_code, 0);
  std::string text = contents(folder / "kick.json");
  const std::string key = R"("right": [0, -0.039])";
  const size_t at = text.find(key);
  ASSERT_NE(at, std::string::npos) << text;
  write(folder / "dragged.json", text.replace(at, key.size(), R"("right": [0, -0.044])"));
  const Output answer = ayumi({"check", "dragged.json", "-q"});
  EXPECT_EQ(answer.exit_code, 3);
  EXPECT_NE(answer.err.find("dragged.json: /phases/0: the right foot stands at [0, -0.039, 0] m"),
            std::string::npos)
      << answer.err;
  EXPECT_NE(answer.err.find("is at [0, -0.044, 0] m, 5 mm away"), std::string::npos) << answer.err;
  EXPECT_EQ(answer.err.find("likely cause"), std::string::npos) << answer.err;
}

// The author knows the load: the motion has to bear it, and the answer says how much mass it bears.
TEST_F(CheckRepair, APayloadOfTheScenarioIsPartOfTheVerdict) {
  plant(
      "load.json",
      R"("type": "impulse", "at": 3, "duration": 0.02, "on": "cog", "direction": [0, 1, 0], "impulse": 1.1)",
      R"("type": "payload", "at": 1, "duration": 3, "on": "r_forearm", "mass": 3)");
  const Output load = ayumi({"check", "load.json", "-q"});
  EXPECT_EQ(load.exit_code, 1);
  const std::regex cause(
      "likely cause: /scenario/0: the payload on r_forearm is 3 kg, which is too heavy for "
      "this motion. The robot can carry up to ([0-9.]+) kg there");
  std::smatch words;
  ASSERT_TRUE(std::regex_search(load.out, words, cause)) << load.out;
  EXPECT_NE(load.out.find(" with 3 kg on r_forearm"), std::string::npos) << load.out;
  plant(
      "light.json",
      R"("type": "impulse", "at": 3, "duration": 0.02, "on": "cog", "direction": [0, 1, 0], "impulse": 1.1)",
      R"("type": "payload", "at": 1, "duration": 3, "on": "r_forearm", "mass": )" + words[1].str());
  const Output light = ayumi({"check", "light.json", "-q"});
  EXPECT_EQ(light.exit_code, 0) << light.out;
}

// `repair` judges as `check` does: a motion that does not bear the load is no repair.
TEST_F(CheckRepair, ARepairHasToBearThePayload) {
  const std::string push =
      R"("type": "impulse", "at": 3, "duration": 0.02, "on": "cog", "direction": [0, 1, 0], "impulse": 1.1)";
  ASSERT_EQ(ayumi({"new", "stand", "--duration", "2", "-o", "stand.json", "-q"}).exit_code, 0);
  std::string text = contents(folder / "stand.json");
  const std::string controller = R"("controller": { "type": "dtad" })";
  text.replace(text.find(controller), controller.size(),
               R"("scenario": [{ "type": "payload", "at": 0.5, "on": "r_forearm", "mass": 60 }])");
  write(folder / "load.json", text);
  const Output heavy = ayumi({"repair", "load.json", "-o", "no.json", "--json", "-q"});
  EXPECT_EQ(heavy.exit_code, 4) << heavy.out << heavy.err;
  EXPECT_FALSE(fs::exists(folder / "no.json"));
  const Json refused = json_of(heavy.out);
  EXPECT_NE(refused["status"], "already_consistent");
  EXPECT_NE(heavy.out.find("the payload on r_forearm is 60 kg"), std::string::npos) << heavy.out;

  // A mass that is just too large: `check` accepts the mass that the answer names.
  plant("little.json", push,
        R"("type": "payload", "at": 1, "duration": 3, "on": "r_forearm", "mass": 1.4)");
  ASSERT_EQ(ayumi({"check", "little.json", "-q"}).exit_code, 1);
  const Output mended = ayumi({"repair", "little.json", "-o", "mended.json", "-q"});
  ASSERT_EQ(mended.exit_code, 0) << mended.out << mended.err;
  const Output checked = ayumi({"check", "mended.json", "-q"});
  EXPECT_EQ(checked.exit_code, 0) << checked.out;

  // A load that the motion bears needs no repair.
  plant("light.json", push,
        R"("type": "payload", "at": 1, "duration": 3, "on": "r_forearm", "mass": 0.5)");
  const Output light = ayumi({"repair", "light.json", "-o", "same.json", "--json", "-q"});
  EXPECT_EQ(light.exit_code, 0) << light.out << light.err;
  EXPECT_EQ(json_of(light.out)["status"], "already_consistent");
}

TEST_F(CheckRepair, AChangeOfFrictionBesideAPayloadIsSaidApart) {
  plant(
      "both.json",
      R"({ "type": "impulse", "at": 3, "duration": 0.02, "on": "cog", "direction": [0, 1, 0], "impulse": 1.1 })",
      R"({ "type": "payload", "at": 1, "duration": 3, "on": "r_forearm", "mass": 3 },
    { "type": "friction", "at": 1, "duration": 2, "friction": 0.6 })");
  const Output both = ayumi({"check", "both.json", "-q"});
  EXPECT_EQ(both.exit_code, 1);
  EXPECT_NE(both.out.find("the verdict does not consider disturbances other than payloads. With "
                          "this disturbance, check finds no other error"),
            std::string::npos)
      << both.out;
}

TEST_F(CheckRepair, JointsAreDrawnAgainstTheirLimits) {
  const Output drawn = ayumi({"check", kWalk, "--plot", "joints.svg", "-q"});
  EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
  EXPECT_NE(drawn.out.find("drawn in joints.svg: "), std::string::npos) << drawn.out;
  const std::string svg = contents(folder / "joints.svg");
  for (const char* words : {"r_knee [deg/s]", "l_hip_roll [N m]", "[deg]", "limit of a joint"})
    EXPECT_NE(svg.find(words), std::string::npos) << words;
  EXPECT_EQ(ayumi({"check", kWalk, "--plot", "joints.svg"}).exit_code, 3);  // the file exists
  EXPECT_EQ(ayumi({"check", kWalk, kWalk, "--plot", "two.svg"}).exit_code, 2);
}

// A pattern without a name has the name of its file in titles.
TEST_F(CheckRepair, APlotOfAPatternWithoutANameHasTheNameOfItsFile) {
  write(folder / "nameless.json", R"({ "format": "ayumi.pattern/1", "robot": "hoap1",
    "phases": [{ "until": 1, "support": "both" }], "keyframes": [{ "t": 0.5, "zmp": "center" }] })");
  ASSERT_EQ(ayumi({"check", "nameless.json", "--plot", "joints.svg", "-q"}).exit_code, 0);
  EXPECT_NE(contents(folder / "joints.svg").find("nameless: joints against their limits"),
            std::string::npos);
}

// Every swing of this walk is too fast for the knees, and each of them has consequences.
TEST_F(CheckRepair, OneEntryForEachCauseAndAllFindingsOnRequest) {
  ASSERT_EQ(ayumi({"edit", "retime", kWalk, "--scale", "0.5", "-o", "fast.json", "-q"}).exit_code,
            1);
  const Output few = ayumi({"check", "fast.json", "-q"});
  EXPECT_EQ(few.exit_code, 1);
  EXPECT_LE(line_count(few.out), 40) << few.out;
  EXPECT_NE(few.out.find("r_knee and l_knee, 18 times "), std::string::npos) << few.out;
  EXPECT_NE(few.out.find("consequences: table_step ("), std::string::npos) << few.out;
  EXPECT_NE(few.out.find("speed 146 % ("), std::string::npos) << few.out;
  const Json json = json_of(ayumi({"check", "fast.json", "-q", "--json"}).out);
  const Output all = ayumi({"check", "fast.json", "-q", "--all"});
  const auto entries = [](const std::string& text) {
    int count = 0;
    for (const char* word : {"\n  error ", "\n  warning ", "\n  info "})
      for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
        ++count;
    return count;
  };
  EXPECT_EQ(entries(all.out), static_cast<int>(json["findings"].size()));
  EXPECT_GT(entries(all.out), 20);
  EXPECT_LE(entries(few.out), 10);
  const Json& place = json["summary_at"]["max_joint_speed_ratio"];
  EXPECT_NE(few.out.find("speed 146 % (" + place["where"].get<std::string>() + " at "),
            std::string::npos);
}

TEST_F(CheckRepair, ErrorsAreJsonWithJson) {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"check", "none.json", "--json"},
        {"--json", "check", "none.json"},
        {"check", "--wrong", "--json"},
        {"--json", "chek"}}) {
    const Output output = ayumi(words);
    const Json json = json_of(output.out);
    EXPECT_EQ(json["exit_code"], output.exit_code);
    EXPECT_EQ(output.err, "ayumi: " + json["error"].get<std::string>() + "\n");
  }
}

TEST_F(CheckRepair, HelpOfACommandIsThatOfItsOption) {
  EXPECT_EQ(ayumi({"help"}).out, ayumi({"--help"}).out);
  EXPECT_EQ(ayumi({"help", "check"}).out, ayumi({"check", "--help"}).out);
  EXPECT_EQ(ayumi({"help", "new", "walk"}).out, ayumi({"new", "walk", "--help"}).out);
  const Output wrong = ayumi({"help", "new", "wlak"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_EQ(wrong.err, "ayumi: help: ayumi new has no command 'wlak'; did you mean 'walk'?\n");
  EXPECT_EQ(ayumi({"help", "retime"}).err,
            "ayumi: help: ayumi has no command 'retime'; did you mean 'edit retime'?\n");
  EXPECT_EQ(ayumi({"help", "mirror"}).err,
            "ayumi: help: ayumi has no command 'mirror'; did you mean 'edit mirror' or 'posture "
            "mirror'?\n");
}

// The rows of an answer on a terminal of 80 columns.
class ChecksOn80Columns : public CheckRepair {
 protected:
  ChecksOn80Columns() { ::setenv("COLUMNS", "80", 1); }
  ~ChecksOn80Columns() override { ::unsetenv("COLUMNS"); }

  static void expect_fits(const std::string& answer, long most) {
    EXPECT_LE(std::count(answer.begin(), answer.end(), '\n'), most) << answer;
    std::istringstream lines(answer);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 80u) << answer;
  }

  // The command above the answer and the prompt below it take two of 24 rows.
  static void expect_one_screen(const std::string& answer) { expect_fits(answer, 22); }
};

// In an earlier version, the answer about a jump with seven kinds of warnings took 60 rows, so that
// the verdict was out of sight.
TEST_F(ChecksOn80Columns, WhatIsConsistentFitsOnOneScreen) {
  std::vector<std::string> patterns;
  for (const auto& entry : fs::directory_iterator(AYUMI_SOURCE_DIR "/patterns"))
    patterns.push_back(entry.path().string());
  for (const std::string robot : {"hoap1", "humanoid30"}) {
    ASSERT_EQ(ayumi({"new", "jump", "--robot", robot, "-o", robot + ".json", "-q"}).exit_code, 0);
    patterns.push_back(robot + ".json");
  }
  for (const std::string& pattern : patterns) {
    SCOPED_TRACE(pattern);
    const Output checked = ayumi({"check", pattern, "-q"});
    EXPECT_EQ(checked.exit_code, 0) << checked.out;
    expect_one_screen(checked.out);
  }
}

TEST_F(ChecksOn80Columns, WhatIsShortenedIsPrintedWithAll) {
  ASSERT_EQ(ayumi({"new", "jump", "-o", "jump.json", "-q"}).exit_code, 0);
  const std::string brief = ayumi({"check", "jump.json", "-q"}).out;
  EXPECT_TRUE(std::regex_search(
      brief, std::regex("  this answer is shortened. `ayumi check --all` prints everything "
                        "\\(\\d+ findings\\)\n$")))
      << brief;
  EXPECT_EQ(brief.find("where each track comes from"), std::string::npos) << brief;
  const std::string all = ayumi({"check", "jump.json", "-q", "--all"}).out;
  EXPECT_EQ(all.find("shortened"), std::string::npos) << all;
  EXPECT_NE(all.find("where each track comes from"), std::string::npos) << all;
  EXPECT_NE(all.find("make the motion of r_knee smoother"), std::string::npos) << all;
  // A line that is not for a terminal is not broken into several.
  ::unsetenv("COLUMNS");
  EXPECT_NE(ayumi({"check", "jump.json", "-q"})
                .out.find(" mm in ZMP and 0.00 N in f_z. The point mass differs"),
            std::string::npos);
}

// There are twenty remarks of one kind, and errors at as many places.
TEST_F(ChecksOn80Columns, ManyDisturbancesDoNotPushTheVerdictOutOfSight) {
  Json late = Json::array(), heavy = Json::array();
  for (int i = 0; i < 20; ++i) {
    late.push_back({{"type", "impulse"},
                    {"at", 20 + i},
                    {"duration", 0.02},
                    {"direction", {1, 0, 0}},
                    {"impulse", 0.1}});
    heavy.push_back({{"type", "payload"}, {"at", 0}, {"mass", 2 + 0.1 * i}, {"on", "l_forearm"}});
  }
  const auto with_scenario = [&](const std::string& name, const Json& scenario) {
    Json pattern = json_of(contents(kWalk), true);
    pattern["scenario"] = scenario;
    write(folder / name, pattern.dump());
  };
  with_scenario("late.json", late);
  const Output consistent = ayumi({"check", "late.json", "-q"});
  EXPECT_EQ(consistent.exit_code, 0) << consistent.out << consistent.err;
  EXPECT_NE(consistent.out.find("worth a look: "), std::string::npos) << consistent.out;
  expect_one_screen(consistent.out);
  with_scenario("heavy.json", heavy);
  const Output wrong = ayumi({"check", "heavy.json", "-q"});
  EXPECT_EQ(wrong.exit_code, 1) << wrong.out << wrong.err;
  expect_fits(wrong.out, 40);
}

TEST_F(ChecksOn80Columns, TheAnswerOfARunFitsOnAScreen) {
  ASSERT_EQ(ayumi({"new", "jump", "-o", "jump.json", "-q"}).exit_code, 0);
  const Output jump = ayumi({"run", "jump.json", "-o", "jump", "--no-pictures", "-q"});
  EXPECT_EQ(jump.exit_code, 0) << jump.out << jump.err;
  expect_fits(jump.out, 22 - 3);  // pictures take three rows
  // Each share names its joint and time.
  EXPECT_TRUE(std::regex_search(jump.out, std::regex("torque\\s+\\d+ %\\s+\\(\\w+\\s+at\\s+\\d")))
      << jump.out;
  Json fast = json_of(R"({"format": "ayumi.pattern/1", "robot": "hoap1", "units": {"angle": "deg"},
      "phases": [{"until": 3.5, "support": "both"}],
      "keyframes": [{"t": 0, "posture": "home"}]})");
  for (int i = 0; i < 24; ++i) {
    Json joints = Json::object();
    for (const char* joint : {"l_shoulder_pitch", "r_shoulder_pitch", "l_elbow", "r_elbow"})
      joints[joint] = i % 2 ? -20 : -80;
    fast["keyframes"].push_back({{"t", 0.4 + 0.12 * i}, {"joints", joints}});
  }
  write(folder / "fast.json", fast.dump());
  const Output wrong = ayumi({"run", "fast.json", "-o", "fast", "--no-pictures", "-q"});
  EXPECT_EQ(wrong.exit_code, 1) << wrong.out << wrong.err;
  expect_fits(wrong.out, 40);
  const Output all = ayumi({"run", "fast.json", "-o", "all", "--no-pictures", "-q", "--all"});
  EXPECT_GT(std::count(all.out.begin(), all.out.end(), '\n'), 60) << all.out;
  EXPECT_EQ(all.out.find("shortened"), std::string::npos) << all.out;
}

// The program `script` provides a terminal; without it, colours are not tested.
TEST_F(CheckRepair, ATerminalHasColoursUnlessTheyAreRefused) {
  if (std::system("command -v script > /dev/null") != 0) GTEST_SKIP() << "no program `script`";
  const auto shown = [&](const std::string& environment, const std::string& pattern = kWalk) {
    const fs::path file = folder / "shown.txt";
    const std::string command = environment + " script -qec '" + program_under_test() +
                                " check -q " + pattern + "' /dev/null > " + file.string() +
                                " < /dev/null";
    EXPECT_EQ(std::system(command.c_str()), 0);
    return contents(file);
  };
  const std::string green = "\x1b[32mconsistent\x1b[0m";
  EXPECT_NE(shown("env -u NO_COLOR TERM=xterm").find(green), std::string::npos);
  EXPECT_EQ(shown("NO_COLOR=1 TERM=xterm").find('\x1b'), std::string::npos);
  EXPECT_EQ(shown("env -u NO_COLOR TERM=dumb").find('\x1b'), std::string::npos);
  EXPECT_EQ(ayumi({"check", kWalk}).out.find('\x1b'), std::string::npos);
  // Colours take no columns: lines are broken at the same words.
  Json pattern = json_of(contents(kWalk), true);
  pattern["scenario"] = {{{"type", "impulse"},
                          {"at", 20},
                          {"duration", 0.02},
                          {"direction", {1, 0, 0}},
                          {"impulse", 0.1}}};
  write(folder / "late.json", pattern.dump());
  const std::string file = folder / "late.json";
  const std::string plain = shown("NO_COLOR=1 COLUMNS=80 TERM=xterm", file);
  const std::string painted = shown("env -u NO_COLOR COLUMNS=80 TERM=xterm", file);
  EXPECT_NE(painted.find("\x1b[33mworth a look:\x1b[0m"), std::string::npos) << painted;
  EXPECT_EQ(std::regex_replace(painted, std::regex("\x1b\\[[0-9;]*m"), ""), plain);
}

TEST_F(CheckRepair, CheckSaysWhereEachTrackComesFrom) {
  const std::string people = ayumi({"check", kWalk, "-q"}).out;
  EXPECT_NE(
      people.find("  where each track comes from\n    joints      legs by inverse kinematics"),
      std::string::npos)
      << people;
  for (const char* track :
       {"    base        computed from feet, torso and COG",
        "    COG         computed from the ZMP keys for the full model", "    ZMP         keys"})
    EXPECT_NE(people.find(track), std::string::npos) << track << "\n" << people;
  const Json json = json_of(ayumi({"check", kWalk, "-q", "--json"}).out);
  EXPECT_EQ(json.at("sampled_from").at("base"), "computed from feet, torso and COG");
  EXPECT_EQ(json.at("sampled_from").at("zmp").get<std::string>().find("keys"), 0u);
}

TEST_F(CheckRepair, ReasonsOfExportAreListed) {
  const Json accepted = json_of(ayumi({"check", kWalk, "-q", "--json"}).out);
  EXPECT_TRUE(accepted.at("export_refuses").empty()) << accepted.dump();
  const std::string goals = AYUMI_SOURCE_DIR "/patterns/hoap1_viip_walk.json";
  const Output checked = ayumi({"check", goals, "-q", "--json"});
  EXPECT_EQ(checked.exit_code, 0);
  const Json json = json_of(checked.out);
  ASSERT_EQ(json.at("export_refuses").size(), 1u) << json.dump();
  const std::string reason = json.at("export_refuses")[0];
  EXPECT_NE(ayumi({"check", goals})
                .out.find("`export` would refuse the table of this pattern: " + reason),
            std::string::npos);
  const Output refused = ayumi({"export", goals, "--format", "hoap", "-o", "t.csv"});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_NE(refused.err.find(reason), std::string::npos) << refused.err;
}

// In an earlier version, repair called such a pattern consistent, and check called it inconsistent.
// The motion around a goal of VIIP only holds a posture, so it is consistent even if the goal is
// impossible. A repair must not call such a pattern consistent when check does not.
TEST_F(CheckRepair, AnImpossibleGoalIsNotCalledConsistent) {
  Json jump = json_of(contents(AYUMI_SOURCE_DIR "/patterns/hoap1_jump.json"), true);
  jump["phases"][1]["viip"]["jump"]["height"] = 0.3;
  write(folder / "high.json", jump.dump());
  EXPECT_EQ(ayumi({"check", "high.json"}).exit_code, 1);
  const Output repaired = ayumi({"repair", "high.json", "-o", "out.json", "--json"});
  EXPECT_EQ(repaired.exit_code, 4) << repaired.out;
  const std::string reason = json_of(repaired.out).at("reasons").at(0);
  EXPECT_NE(reason.find("height 0.3 m is out of range"), std::string::npos) << reason;
  EXPECT_NE(reason.find("A repair does not change the goals"), std::string::npos) << reason;
  EXPECT_EQ(folder.files(), std::vector<std::string>{"high.json"});
}

TEST_F(CheckRepair, AVelocityThatIsNotPossibleIsNotCalledConsistent) {
  std::string text = contents(AYUMI_SOURCE_DIR "/patterns/hoap1_viip_walk.json");
  text = std::regex_replace(text, std::regex("\"velocity\": *\\[[^\\]]*\\]"),
                            "\"velocity\": [0.5, 0]");
  write(folder / "far.json", text);
  EXPECT_EQ(ayumi({"check", "far.json", "-q"}).exit_code, 1);
  const Output repaired = ayumi({"repair", "far.json", "-o", "r.json", "-q"});
  EXPECT_EQ(repaired.exit_code, 4) << repaired.out;
  EXPECT_NE(repaired.out.find("a COG velocity of 0.5 m/s needs steps of"), std::string::npos)
      << repaired.out;
  EXPECT_NE(repaired.out.find("A repair does not change the goals"), std::string::npos)
      << repaired.out;
}

TEST_F(CheckRepair, RepairNamesTheLikelyCauseAsCheckDoes) {
  Json walk = json_of(contents(kWalk), true);
  for (Json& key : walk["keyframes"])
    if (key["t"] == 0) key["zmp"] = {0.5, 0};
  write(folder / "far.json", walk.dump());
  const Output checked = ayumi({"check", "far.json", "-q"});
  EXPECT_EQ(checked.exit_code, 3);
  EXPECT_NE(checked.err.find("likely cause: /keyframes/0"), std::string::npos) << checked.err;
  const Output repaired = ayumi({"repair", "far.json", "-o", "out.json", "-q"});
  EXPECT_EQ(repaired.exit_code, 3);
  EXPECT_EQ(repaired.err, checked.err);
}

TEST_F(CheckRepair, TolerancesAreListedAndSet) {
  const Output people = ayumi({"check", "--tolerances"});
  EXPECT_EQ(people.exit_code, 0);
  const Json listed = json_of(ayumi({"check", "--tolerances", "--json"}).out)["tolerances"];
  EXPECT_EQ(static_cast<size_t>(line_count(people.out)), listed.size());
  EXPECT_GE(listed.size(), 20u);
  const Output strict = ayumi({"check", kWalk, "--tolerance", "joint_speed=0.5", "--json"});
  EXPECT_EQ(strict.exit_code, 1);
  EXPECT_EQ(json_of(strict.out)["findings"][0]["kind"], "joint_speed");
  const Output wrong = ayumi({"check", kWalk, "--tolerance", "joint_sped=0.5"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_NE(wrong.err.find("did you mean 'joint_speed'?"), std::string::npos) << wrong.err;
  EXPECT_EQ(ayumi({"check"}).exit_code, 2);
}

TEST_F(CheckRepair, SeveralInputsGiveOneObject) {
  const Output two = ayumi({"check", kWalk, kWalk, "--json"});
  EXPECT_EQ(two.exit_code, 0) << two.err;
  EXPECT_EQ(json_of(two.out)["checks"].size(), 2u);
}

TEST_F(CheckRepair, AZmpOutsideIsFoundAndRepaired) {
  plant_zmp_outside("outside.json");
  const Output found = ayumi({"check", "outside.json", "--json"});
  EXPECT_EQ(found.exit_code, 1);
  EXPECT_EQ(json_of(found.out)["verdict"], "inconsistent");

  const Output repaired = ayumi({"repair", "outside.json", "-o", "good.json", "--json"});
  ASSERT_EQ(repaired.exit_code, 0) << repaired.out << repaired.err;
  const Json json = json_of(repaired.out);
  EXPECT_EQ(json["status"], "repaired");
  EXPECT_EQ(json["check"]["verdict"], "consistent");
  EXPECT_LE(double(json["constraint_violation"]), 1e-6);
  EXPECT_GT(double(json["moved"]["max_cog_m"]), 0.005);

  // The author's text with one member more; it passes the check as a file.
  const std::string before = contents(folder / "outside.json"),
                    after = contents(folder / "good.json");
  const size_t end = before.rfind(']');
  EXPECT_EQ(after.substr(0, end), before.substr(0, end));
  EXPECT_EQ(ayumi({"check", "good.json"}).exit_code, 0);

  // Doing it once more changes nothing, not even a byte.
  const Output again = ayumi({"repair", "good.json", "-o", "again.json", "--json"});
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_EQ(json_of(again.out)["status"], "already_consistent");
  EXPECT_EQ(contents(folder / "again.json"), after);
}

TEST_F(CheckRepair, WhatCannotBeRepairedWritesNothing) {
  // The first posture itself is out of limits, and the joint may not move.
  plant("bad.json", R"({ "t": 0, "zmp": "center" })",
        R"({ "t": 0, "zmp": "center", "posture": { "l_elbow": -95 } })");
  const Output failed =
      ayumi({"repair", "bad.json", "-o", "out.json", "--lock", "l_elbow", "--json"});
  EXPECT_EQ(failed.exit_code, 4) << failed.out << failed.err;
  const Json json = json_of(failed.out);
  EXPECT_NE(json["status"], "repaired");
  ASSERT_FALSE(json["reasons"].empty());
  EXPECT_NE(std::string(json["reasons"][0]).find("l_elbow"), std::string::npos);
  EXPECT_EQ(folder.files(), std::vector<std::string>{"bad.json"});
}

// The motion is too fast between two keys that must stay. The message tells the reason, the time
// that is needed, and a value of the parameter with which the pattern passes, near the smallest
// such value.
TEST_F(CheckRepair, TheParameterThatWouldDoIsNamed) {
  write(folder / "lift.json", R"({ "format": "ayumi.pattern/1", "robot": "hoap1",
    "units": { "angle": "deg" }, "parameters": { "time": 0.2 },
    "phases": [{ "until": "0.8 + ${time}", "support": "both" }],
    "keyframes": [
      { "t": 0, "zmp": "center", "posture": "home" },
      { "t": 0.4, "posture": "home" },
      { "t": "0.4 + ${time}", "posture": { "l_shoulder_pitch": 10 } },
      { "t": "0.8 + ${time}", "zmp": "center" }] })");
  const Output failed = ayumi({"repair", "lift.json", "-o", "out.json", "--lock", "keyframe:1",
                               "--lock", "keyframe:2", "--json"});
  EXPECT_EQ(failed.exit_code, 4) << failed.out << failed.err;
  const Json json = json_of(failed.out);
  EXPECT_EQ(json["status"], "infeasible");
  ASSERT_FALSE(json["reasons"].empty());
  const std::string reason = json["reasons"][0];
  EXPECT_NE(reason.find("the speed of l_shoulder_pitch reaches"), std::string::npos) << reason;
  EXPECT_NE(reason.find("times its length"), std::string::npos) << reason;
  ASSERT_EQ(json["parameters"].size(), 1u);
  EXPECT_EQ(json["parameters"][0]["name"], "time");
  const double passes = json["parameters"][0]["passes"];
  const std::string set = "time=" + std::to_string(passes),
                    less = "time=" + std::to_string(0.9 * passes);
  EXPECT_EQ(ayumi({"check", "lift.json", "--set", set}).exit_code, 0);
  EXPECT_EQ(ayumi({"check", "lift.json", "--set", less}).exit_code, 1);
}

TEST_F(CheckRepair, StandardInputIsAPattern) {
  const std::string words = std::string(AYUMI_PROGRAM) + " check - --json < " AYUMI_SOURCE_DIR
                                                         "/patterns/hoap1_walk.json";
  const Output out = run_program({"-c", words}, folder.path(), "/bin/sh");
  EXPECT_EQ(out.exit_code, 0) << out.err;
  EXPECT_EQ(json_of(out.out)["verdict"], "consistent");
  EXPECT_EQ(ayumi({"repair", "-", "-o", "out.json"}).exit_code, 2);
}

TEST_F(CheckRepair, DiffTellsWhatMoved) {
  plant_zmp_outside("outside.json");
  ASSERT_EQ(ayumi({"repair", "outside.json", "-o", "good.json", "--plot", "moved.svg"}).exit_code,
            0);
  EXPECT_NE(contents(folder / "moved.svg").find("before"), std::string::npos);
  EXPECT_NE(contents(folder / "moved.svg").find("[deg]"), std::string::npos);
  EXPECT_EQ(ayumi({"preview", "good.json", "--ghost", "outside.json", "--strip", "2", "--size",
                   "96x72", "-o", "moved.png"})
                .exit_code,
            0);
  EXPECT_EQ(contents(folder / "moved.png").substr(1, 3), "PNG");
  const Output words = ayumi({"diff", "outside.json", "good.json"});
  EXPECT_EQ(words.exit_code, 0) << words.err;
  EXPECT_NE(words.out.find("outside.json: inconsistent"), std::string::npos) << words.out;
  EXPECT_NE(words.out.find("good.json: consistent"), std::string::npos) << words.out;
  EXPECT_NE(words.out.find(" deg (at "), std::string::npos) << words.out;
  const Json json = json_of(ayumi({"diff", "outside.json", "good.json", "--json"}).out);
  EXPECT_FALSE(json["same"]);
  EXPECT_GT(double(json["max"]["joint_rad"]), 0.01);
  EXPECT_FALSE(json["moved"]["joints"].empty());
  EXPECT_GT(double(json["moved"]["joints"][0]["at_s"]), 1.5);
  EXPECT_LT(double(json["a"]["min_zmp_margin_m"]), 0);
  EXPECT_GT(double(json["b"]["min_zmp_margin_m"]), 0.001);
  EXPECT_TRUE(json_of(ayumi({"diff", kWalk, kWalk, "--json"}).out)["same"]);
}

TEST_F(CheckRepair, BakedAndTakenToAnotherFolder) {
  plant_zmp_outside("outside.json");
  ASSERT_EQ(ayumi({"repair", "outside.json", "-o", "dense.json", "--baked"}).exit_code, 0);
  EXPECT_EQ(contents(folder / "dense.json").find("keyframes"), std::string::npos);
  EXPECT_EQ(ayumi({"check", "dense.json"}).exit_code, 0);
  // A consistent pattern keeps its bytes, and the table that it names.
  std::filesystem::create_directory(folder / "away");
  const Output copied = ayumi({"repair", "dense.json", "-o", "away/copy.json"});
  ASSERT_EQ(copied.exit_code, 0) << copied.err;
  EXPECT_EQ(contents(folder / "away/copy.json"), contents(folder / "dense.json"));
  EXPECT_EQ(contents(folder / "away/dense.csv"), contents(folder / "dense.csv"));
  EXPECT_EQ(ayumi({"check", "away/copy.json"}).exit_code, 0);
}

// The preferences for a repair in the file are kept, in the correction and in the table in another
// folder; the command line adds to them.
TEST_F(CheckRepair, WishesOfTheFile) {
  plant_zmp_outside("plain.json");
  std::string text = contents(folder / "plain.json");
  const size_t end = text.rfind('}');
  auto with_wishes = [&](const std::string& wishes) {
    std::string changed = text;
    const size_t last = text.find_last_not_of(" \n", end - 1);
    write(folder / "outside.json",
          changed.replace(last + 1, end - last - 1, ",\n  \"repair\": " + wishes + "\n"));
  };
  with_wishes(R"({ "lock": { "joints": ["l_shoulder_roll"], "windows": [[0.5, 1.2]] } })");
  std::filesystem::create_directory(folder / "away");
  for (const std::vector<std::string>& form :
       {std::vector<std::string>{}, std::vector<std::string>{"--baked"}}) {
    std::vector<std::string> call = {"repair", "outside.json", "-o",      "away/r.json",
                                     "--lock", "r_elbow",      "--force", "--json"};
    call.insert(call.end(), form.begin(), form.end());
    const Output repaired = ayumi(call);
    ASSERT_EQ(repaired.exit_code, 0) << repaired.err;
    const Json cost = json_of(repaired.out)["weighted_change"];
    EXPECT_GT(double(cost["change"]), 0);
    EXPECT_EQ(ayumi({"check", "away/r.json"}).exit_code, 0);
    const Json diff = json_of(ayumi({"diff", "outside.json", "away/r.json", "--json"}).out);
    EXPECT_NEAR(diff["weighted_change"]["change"], cost["change"], 1e-3 * double(cost["change"]));
    EXPECT_GT(diff["moved"]["joints"].size(), 5u);
    for (const Json& joint : diff["moved"]["joints"]) {
      EXPECT_NE(joint["joint"], "l_shoulder_roll");
      EXPECT_NE(joint["joint"], "r_elbow");
    }
  }
  for (const auto& [wishes, message] : std::vector<std::pair<std::string, std::string>>{
           {R"({"lock": {"joints": ["l_kne"]}})", "/repair/lock/joints/0: the robot 'hoap1'"},
           {R"({"lock": {"windows": [[90, 91]]}})", "after the end of the motion at"},
           {R"({"lock": {"keyframes": [21]}})",
            "21 is not the number of a keyframe; keyframes are numbered from 0 to 20"},
           {R"({"weights": {"l_kne": 2}})", "/repair/weights/l_kne: the robot"},
           {R"({"weights": {"l/kne": 2}})", "/repair/weights/l~1kne: the robot"}}) {
    with_wishes(wishes);
    const Output wrong = ayumi({"repair", "outside.json", "-o", "out.json"});
    EXPECT_EQ(wrong.exit_code, 3) << wishes;
    EXPECT_NE(wrong.err.find(message), std::string::npos) << wrong.err;
  }
}

TEST_F(CheckRepair, LocksInWords) {
  plant_zmp_outside("outside.json");
  for (const auto& [lock, message] : std::vector<std::pair<std::string, std::string>>{
           {"foot:middle", "foot:left and foot:right"},
           {"keyframe:99", "numbered 0 to 20"},
           {"3..2", "the window must end after it begins"},
           {"a..b", "BEGIN..END in seconds"},
           {"l_kne", "did you mean 'l_knee'?"}}) {
    const Output wrong = ayumi({"repair", "outside.json", "-o", "out.json", "--lock", lock});
    EXPECT_EQ(wrong.exit_code, 2) << lock;
    EXPECT_NE(wrong.err.find(message), std::string::npos) << wrong.err;
  }
  const Output weight = ayumi({"repair", "outside.json", "-o", "out.json", "--weight", "l_knee"});
  EXPECT_EQ(weight.exit_code, 2);
  // The step that is wrong is locked: the message names what prevents the repair.
  const Output locked =
      ayumi({"repair", "outside.json", "-o", "out.json", "--lock", "2..2.9", "--json"});
  EXPECT_EQ(locked.exit_code, 4) << locked.out << locked.err;
  const Json json = json_of(locked.out);
  ASSERT_FALSE(json["obstacles"].empty());
  EXPECT_TRUE(std::any_of(json["obstacles"].begin(), json["obstacles"].end(),
                          [](const Json& o) { return o["kind"] == "support_margin"; }));
  EXPECT_NE(std::string(json["reasons"][0]).find("This window is locked"), std::string::npos);
  EXPECT_EQ(folder.files(), std::vector<std::string>{"outside.json"});
}

TEST_F(CheckRepair, MistakesOfTheCall) {
  const Output joint = ayumi({"repair", kWalk, "-o", "out.json", "--lock", "l_kne"});
  EXPECT_EQ(joint.exit_code, 2) << joint.out << joint.err;
  EXPECT_NE(joint.err.find("did you mean 'l_knee'?"), std::string::npos) << joint.err;
  EXPECT_EQ(ayumi({"repair", kWalk}).exit_code, 2);
  EXPECT_EQ(ayumi({"check", "missing.json"}).exit_code, 3);
  write(folder / "there.json", "{}");
  EXPECT_EQ(ayumi({"repair", kWalk, "-o", "there.json"}).exit_code, 3);
  EXPECT_EQ(contents(folder / "there.json"), "{}");
}

}  // namespace
}  // namespace ayumi::test
