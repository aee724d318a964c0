// `ayumi replay` and `ayumi export --sign-test`: tables as the robot receives them.

#include <filesystem>

#include "tests/cli/program.hpp"
#include "tests/support/json.hpp"

namespace ayumi::test {
namespace {

using Json = nlohmann::json;

const char* const kBow = R"({
  "format": "ayumi.pattern/1", "name": "arm up", "robot": "hoap1", "units": { "angle": "deg" },
  "phases": [{ "until": 1.5, "support": "both" }],
  "keyframes": [{ "t": 0, "posture": "home" },
                { "t": 1.0, "posture": { "l_shoulder_pitch": 60, "r_shoulder_pitch": 60 } }]
})";

class Replay : public testing::Test {
 protected:
  Output ayumi(const std::vector<std::string>& arguments) {
    return run_program(arguments, folder.path());
  }
  void export_bow(const std::string& format, const std::string& file) {
    write(folder / "p.json", kBow);
    const Output out =
        ayumi({"export", "p.json", "--format", format, "-o", file, "-q", "--ramp", "0.5"});
    ASSERT_EQ(out.exit_code, 0) << out.err << out.out;
  }
  /// Writes the sign tests of HOAP-1 into the folder signs. Returns their list in the JSON output.
  Json sign_tests(const std::string& format) {
    const Output out = ayumi(
        {"export", "hoap1", "--sign-test", "--format", format, "-o", "signs", "--json", "-q"});
    EXPECT_EQ(out.exit_code, 0) << out.err;
    return out.exit_code == 0 ? json_of(out.out).at("tests") : Json::array();
  }
  /// The largest distance of an angle between two tables of the same length [rad].
  double distance(const std::string& a, const std::string& b) {
    const auto angles = [&](const std::string& file) {
      std::istringstream lines(contents(folder / file));
      std::vector<double> values;
      std::vector<bool> theta;
      for (std::string line; std::getline(lines, line);) {
        if (line.starts_with('#')) continue;
        std::istringstream cells(line);
        const bool head = theta.empty();
        size_t i = 0;
        for (std::string cell; std::getline(cells, cell, ','); ++i) {
          if (head)
            theta.push_back(cell.starts_with("theta."));
          else if (theta.at(i))
            values.push_back(std::stod(cell));
        }
      }
      return values;
    };
    const std::vector<double> x = angles(a), y = angles(b);
    EXPECT_GT(x.size(), 20U) << a;
    EXPECT_EQ(x.size(), y.size()) << a << " " << b;
    double largest = 0;
    for (size_t i = 0; i < std::min(x.size(), y.size()); ++i)
      largest = std::max(largest, std::abs(x[i] - y[i]));
    return largest;
  }
  Folder folder;
};

// Each plant of the program judges an exported table: the robot stands, and no value is clamped.
TEST_F(Replay, WhatWasExportedStands) {
  export_bow("hoap", "h.csv");
  export_bow("csv", "t.csv");
  export_bow("json", "t.json");
  for (const std::string file : {"h.csv", "t.csv", "t.json"}) {
    std::vector<std::string> words = {"replay", file, "--json", "-q", "--robot", "hoap1"};
    if (file != "h.csv") words.resize(4);  // the head of the table names the robot
    const Output out = ayumi(words);
    ASSERT_EQ(out.exit_code, 0) << file << out.err << out.out;
    const Json json = json_of(out.out);
    EXPECT_EQ(json.at("verdict"), "stands");
    EXPECT_EQ(json.at("clamps").size(), 0u) << out.out;
    for (const auto& [plant, run] : json.at("plants").items()) {
      EXPECT_EQ(run.at("outcome"), "stands") << plant;
      EXPECT_LT(run.at("tracking").at("mean_rad"), 0.02);
    }
  }
}

// A jump is clamped to 57 counts per millisecond; with a bow that is too deep, the robot falls.
// The motor boards have a tick of 1 ms, whatever the servo period of the robot is. In an earlier
// version, the log of such a replay was refused.
TEST_F(Replay, TheRunOfASlowRobotIsRead) {
  fs::create_directories(folder / "robots/slow");
  write(folder / "robots/slow/robot.json",
        R"({"format": "ayumi.robot/1", "base": "hoap1", "name": "slow", "servo_period": 0.008})");
  export_bow("csv", "t.csv");
  ASSERT_EQ(ayumi({"replay", "t.csv", "--robot", "slow", "--robot-path", "robots", "-o", "r", "-q"})
                .exit_code,
            0);
  const Output out =
      ayumi({"export", "r", "--robot-path", "robots", "--format", "csv", "-o", "again.csv", "-q"});
  EXPECT_EQ(out.exit_code, 0) << out.err << out.out;
}

TEST_F(Replay, JumpsAreClampedAndFallsAreFound) {
  const int home[20] = {0, 0, 3607,  9107,  -5500, 0, 18810,  -2090, 0, 5225,
                        0, 0, -3607, -9107, 5500,  0, -18810, 2090,  0, -5225};
  const auto rows = [&](int motor, int other, int change) {
    std::string text;
    for (int k = 0; k < 600; ++k) {
      text += "2,2";
      for (int i = 0; i < 20; ++i)
        text += "," + std::to_string(home[i] + (k < 200      ? 0
                                                : i == motor ? change
                                                : i == other ? -change
                                                             : 0));
      text += ",R,R,R\n";
    }
    return text;
  };
  write(folder / "jump.csv", rows(6, 16, -1000));
  const Output jump =
      ayumi({"replay", "jump.csv", "--robot", "hoap1", "--plant", "ayumi", "--json"});
  ASSERT_EQ(jump.exit_code, 0) << jump.err << jump.out;
  const Json clamp = json_of(jump.out).at("clamps").at(0);
  EXPECT_EQ(clamp.at("kind"), "speed");
  EXPECT_NEAR(clamp.at("change_rad"), 943 / 209.0 * 3.14159265 / 180, 1e-6);
  write(folder / "lean.csv", rows(4, 14, 4500));  // both ankles are turned by 21 degrees
  const Output lean = ayumi({"replay", "lean.csv", "--robot", "hoap1", "-o", "out", "--json"});
  EXPECT_EQ(lean.exit_code, 1) << lean.err << lean.out;
  EXPECT_EQ(json_of(lean.out).at("plants").at("ayumi").at("outcome"), "fell");
  EXPECT_TRUE(fs::exists(folder / "out/run.json"));
  EXPECT_TRUE(fs::exists(folder / "out/log_ayumi.bin"));
}

TEST_F(Replay, BadTablesLeaveNothing) {
  export_bow("hoap", "h.csv");
  const std::string good = contents(folder / "h.csv");
  const std::vector<std::pair<std::string, std::string>> cases = {
      {good.substr(0, good.size() / 2 - 20), "columns, but each row before it has 25"},
      {"", "ayumi"},
      {"1,2,nan" + good.substr(5), "is not a whole number from -32768 to 32767"},
      {"{\"format\": \"ayumi.pattern/1\", \"robot\": \"hoap1\"}", "this is a pattern"},
      {"t[s],no_joint[rad]\n0,0\n1,0\n", "no_joint"}};
  for (const auto& [bytes, words] : cases) {
    write(folder / "bad.csv", bytes);
    const Output out = ayumi({"replay", "bad.csv", "--robot", "hoap1", "-o", "out"});
    EXPECT_EQ(out.exit_code, 3) << words << out.out;
    EXPECT_NE(out.err.find(words), std::string::npos) << out.err;
    EXPECT_EQ(line_count(out.err), 1) << out.err;
    EXPECT_FALSE(fs::exists(folder / "out"));
  }
  EXPECT_EQ(ayumi({"replay", "h.csv"}).exit_code, 2);  // a sequence does not name its robot
  EXPECT_EQ(ayumi({"replay", "h.csv", "--robot", "hoap1", "--plant", "bullet"}).exit_code, 2);
}

// There are one file and one picture per joint; only this joint moves, by 5 degrees. Every test
// begins with all encoders at 0, because a joint with a wrong sign would otherwise jump.
TEST_F(Replay, TheSignTestMovesOneJointAtATime) {
  const Json tests = sign_tests("hoap");
  ASSERT_EQ(tests.size(), 20u);
  // The folder, the tables, the pictures and the sheet.
  EXPECT_EQ(folder.files().size(), 1 + 20u + 20 + 1);
  for (size_t i = 0; i < 20; ++i) {
    const std::string text = contents(folder / ("signs/" + std::string(tests[i].at("file"))));
    std::vector<int> first, most(20, 0);
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      std::istringstream row(line);
      std::vector<int> now;
      for (std::string cell; std::getline(row, cell, ',') && cell != "R";)
        now.push_back(std::stoi(cell));
      ASSERT_EQ(now.size(), 22u);
      if (first.empty()) {
        first = now;
        EXPECT_EQ(std::count(now.begin() + 2, now.end(), 0), 20) << line;
      }
      for (size_t m = 0; m < 20; ++m)
        if (std::abs(now[m + 2] - first[m + 2]) > std::abs(most[m]))
          most[m] = now[m + 2] - first[m + 2];
    }
    for (size_t m = 0; m < 20; ++m)
      EXPECT_NEAR(std::abs(most[m]), m == i ? 1045 : 0, 1) << tests[i].dump();
  }
  EXPECT_EQ(ayumi({"export", "hoap1", "--sign-test", "--format", "hoap", "-o", "signs"}).exit_code,
            3);
  // Positive angles turn a foot about an axis to the left, upward or forward.
  const std::string sheet = contents(folder / "signs/sheet.html");
  for (const char* words :
       {"r_knee: 0.0 deg to 5.0 deg,<br>clockwise seen from the right",
        "l_knee: 0.0 deg to 5.0 deg,<br>counterclockwise seen from the left",
        "l_hip_yaw: 0.0 deg to 5.0 deg,<br>counterclockwise seen from above",
        "r_elbow: 0.0 deg to -5.0 deg,<br>counterclockwise seen from the right",
        "l_hip_roll: 0.0 deg to 5.0 deg,<br>counterclockwise seen from the front",
        // Inwards, the right foot would meet the left one.
        "r_hip_roll: 0.0 deg to -5.0 deg,<br>clockwise seen from the front"})
    EXPECT_NE(sheet.find(words), std::string::npos) << words << sheet;
  // The sheet warns if a test begins elsewhere.
  EXPECT_EQ(contents(folder / "signs/sheet.html").find("Caution"), std::string::npos);
  const Output home = ayumi(
      {"export", "hoap1", "--sign-test", "--format", "hoap", "-o", "home", "--posture", "home"});
  EXPECT_NE(home.out.find("Caution: these joints do not begin at 0: r_hip_pitch (-17.3 deg)"),
            std::string::npos)
      << home.out;
}

// From the right, the right arm and leg would hide the joints of the left side.
TEST_F(Replay, TheSignTestShowsEachJointFromItsOwnSide) {
  const Json tests = sign_tests("csv");
  ASSERT_EQ(tests.size(), 20u);
  for (const Json& test : tests) {
    const std::string joint = test.at("joint"), seen = test.at("seen_from"),
                      side = joint[0] == 'l' ? "left" : "right";
    EXPECT_TRUE(seen == "front" || seen.ends_with(side)) << test.dump();
  }
}

// The mark of a sequence is in the note beside it. It stays with the motion when the sequence is
// imported, and the replay says it, too.
TEST_F(Replay, TheNoteBesideASequenceIsRead) {
  export_bow("hoap", "h.csv");
  write(folder / "h.csv.txt",
        "About the joint table beside this file, by ayumi export\n"
        "disturbances: 0.5 N s on cog at 1 s\nunfit: the run fell at 2 s\n");
  const Output replayed = ayumi({"replay", "h.csv", "--robot", "hoap1", "--plant", "ayumi"});
  EXPECT_NE(replayed.out.find("not for a robot, because the run fell at 2 s"), std::string::npos)
      << replayed.out;
  EXPECT_NE(replayed.out.find("reactions of the robot to disturbances: 0.5 N s on cog at 1 s"),
            std::string::npos);
  const Output imported = ayumi({"import", "h.csv", "--robot", "hoap1", "-o", "i.json"});
  ASSERT_EQ(imported.exit_code, 0) << imported.err;
  EXPECT_NE(imported.out.find("the run fell at 2 s"), std::string::npos) << imported.out;
  const Output refused = ayumi({"export", "i.json", "--format", "hoap", "-o", "again.csv"});
  EXPECT_EQ(refused.exit_code, 1) << refused.out;
  EXPECT_NE(refused.out.find("the run fell at 2 s"), std::string::npos) << refused.out;
  EXPECT_FALSE(fs::exists(folder.path() / "again.csv"));
  // If the note cannot be written, the table is not written either.
  fs::create_directory(folder / "again.UNSAFE.csv.txt");
  const Output lost = ayumi({"export", "i.json", "--format", "hoap", "-o", "again.csv",
                             "--force-unsafe", "--pushed", "--force"});
  EXPECT_EQ(lost.exit_code, 3) << lost.out << lost.err;
  EXPECT_FALSE(fs::exists(folder / "again.UNSAFE.csv"));
  // Another text beside a table is no note.
  write(folder / "h.csv.txt", "unfit: for a walk\n");
  EXPECT_EQ(ayumi({"replay", "h.csv", "--robot", "hoap1", "--plant", "ayumi"})
                .out.find("not for a robot"),
            std::string::npos);
}

// The run folder of a replay keeps the cautions of its table.
TEST_F(Replay, TheRunOfAReplayKeepsTheCautionsOfItsTable) {
  export_bow("hoap", "h.csv");
  write(folder / "h.csv.txt",
        "About the joint table beside this file, by ayumi export\n"
        "disturbances: 0.5 N s on cog at 1 s\n");
  ASSERT_EQ(
      ayumi({"replay", "h.csv", "--robot", "hoap1", "--plant", "ayumi", "-o", "out"}).exit_code, 0);
  for (const std::vector<std::string>& log : {std::vector<std::string>(), {"--log", "ayumi"}}) {
    std::vector<std::string> words = {"export", "out",       "--format", "hoap",
                                      "-o",     "again.csv", "--force"};
    words.insert(words.end(), log.begin(), log.end());
    const Output refused = ayumi(words);
    EXPECT_EQ(refused.exit_code, 1) << refused.out << refused.err;
    EXPECT_NE(refused.out.find("0.5 N s on cog at 1 s"), std::string::npos) << refused.out;
    EXPECT_FALSE(fs::exists(folder / "again.csv"));
    words.push_back("--pushed");
    const Output written = ayumi(words);
    EXPECT_EQ(written.exit_code, 0) << written.out << written.err;
    EXPECT_NE(contents(folder / "again.csv.txt").find("disturbances: 0.5 N s on cog at 1 s"),
              std::string::npos);
    fs::remove(folder / "again.csv");
  }
  write(folder / "h.csv.txt",
        "About the joint table beside this file, by ayumi export\nunfit: the run fell at 2 s\n");
  ASSERT_EQ(
      ayumi({"replay", "h.csv", "--robot", "hoap1", "--plant", "ayumi", "-o", "out", "--force"})
          .exit_code,
      0);
  const Output fell = ayumi({"export", "out", "--format", "hoap", "-o", "third.csv"});
  EXPECT_EQ(fell.exit_code, 1) << fell.out << fell.err;
  EXPECT_NE(fell.out.find("the run fell at 2 s"), std::string::npos) << fell.out;
}

// Motions of other programs in JSON have no head with cautions.
TEST_F(Replay, AForeignMotionInJsonIsPlayed) {
  export_bow("poppy-move", "wave.move");
  const Output out = ayumi({"replay", "wave.move", "--robot", "hoap1", "--plant", "ayumi"});
  EXPECT_EQ(out.exit_code, 0) << out.out << out.err;
  EXPECT_NE(out.out.find("poppy-move"), std::string::npos) << out.out;
  const Output nameless = ayumi({"replay", "wave.move"});
  EXPECT_EQ(nameless.exit_code, 2) << nameless.err;
  EXPECT_NE(nameless.err.find("Give --robot ROBOT"), std::string::npos) << nameless.err;
}

// Standard input has no note, even if there is a file with the name that its note would have.
TEST_F(Replay, StandardInputHasNoNote) {
  export_bow("hoap", "h.csv");
  write(folder / "-.txt",
        "About the joint table beside this file, by ayumi export\nunfit: the run fell at 2 s\n");
  for (const std::string words :
       {"replay - --robot hoap1 --plant ayumi", "import - --robot hoap1 -o i.json"}) {
    const Output out = run_program({"-c", "'" + program_under_test() + "' " + words + " < h.csv"},
                                   folder.path(), "/bin/sh");
    EXPECT_EQ(out.exit_code, 0) << out.err;
    EXPECT_EQ(out.out.find("the run fell"), std::string::npos) << out.out;
  }
}

// A file for the program of another robot has no head either, so it gets a note as well.
TEST_F(Replay, EveryFileThatARobotPlaysHasItsNote) {
  std::string pushed = kBow;
  pushed.insert(pushed.rfind('}'),
                ", \"scenario\": [{ \"type\": \"impulse\", \"at\": 1, \"duration\": 0.02, "
                "\"direction\": [1, 0, 0], \"impulse\": 0.1 }]");
  write(folder / "q.json", pushed);
  ASSERT_EQ(ayumi({"run", "q.json", "-o", "run", "--no-pictures", "-q"}).exit_code, 0);
  const Output out =
      ayumi({"export", "run", "--format", "ros-trajectory", "--pushed", "-o", "t.yaml"});
  ASSERT_EQ(out.exit_code, 0) << out.out << out.err;
  EXPECT_NE(contents(folder / "t.yaml.txt").find("disturbances: 0.1 N s"), std::string::npos)
      << out.out;
}

// Two units of one type have different zeros of their encoders. Every table for a unit contains its
// zeros, and is read back with them: a sequence that is exported, imported and exported again keeps
// its bytes, and a table is the same motion for the unit for which it was made.
TEST_F(Replay, TablesHoldTheZerosOfTheUnit) {
  write(folder / "unit.json", R"({
    "format": "ayumi.robot/1", "base": "hoap1", "name": "unit 7",
    "servos": [{ "joints": ["l_knee"], "offset_deg": 0.4 },
               { "joints": ["r_ankle_roll"], "offset_deg": -0.3 }]
  })");
  write(folder / "p.json", kBow);
  std::string text = kBow;
  text.replace(text.find("\"hoap1\""), 7, "\"unit.json\"");
  write(folder / "u.json", text);
  const auto first_row = [&](const std::string& file) {
    std::istringstream cells(contents(folder / file));
    std::vector<int> values;
    for (std::string cell; std::getline(cells, cell, ',') && cell != "R";)
      values.push_back(std::stoi(cell));
    return values;
  };
  for (const std::string name : {"p", "u"})
    ASSERT_EQ(
        ayumi({"export", name + ".json", "--format", "hoap", "-o", name + ".csv", "-q"}).exit_code,
        0);
  // 209 counts per degree: the devices 14 (l_knee, reversed) and 6 (r_ankle_roll, reversed).
  const std::vector<int> plain = first_row("p.csv"), unit = first_row("u.csv");
  // Each of the two counts is rounded.
  for (size_t i = 2; i < plain.size(); ++i)
    EXPECT_NEAR(unit[i] - plain[i], i == 2 + 13 ? 83.6 : i == 2 + 5 ? -62.7 : 0, 1.01) << i;
  ASSERT_EQ(ayumi({"import", "u.csv", "--robot", "unit.json", "-o", "i.json"}).exit_code, 0);
  const Output again = ayumi({"export", "i.json", "--format", "hoap", "-o", "again.csv"});
  ASSERT_EQ(again.exit_code, 0) << again.out << again.err;
  EXPECT_EQ(contents(folder / "again.csv"), contents(folder / "u.csv"));
  // For a unit with other offsets, the copy of the sequence is of no use.
  const Output other =
      ayumi({"export", "i.json", "--format", "hoap", "--robot", "hoap1", "-o", "other.csv"});
  ASSERT_EQ(other.exit_code, 0) << other.out << other.err;
  const std::vector<int> compensated = first_row("other.csv");
  ASSERT_EQ(compensated.size(), unit.size());
  for (size_t i = 2; i < unit.size(); ++i)
    EXPECT_NEAR(unit[i] - compensated[i], i == 2 + 13 ? 83.6 : i == 2 + 5 ? -62.7 : 0, 1.01) << i;
  // The imported motion is that of the pattern.
  ASSERT_EQ(ayumi({"import", "p.csv", "--robot", "hoap1", "-o", "j.json"}).exit_code, 0);
  EXPECT_LT(distance("i.csv", "j.csv"), 3e-4);
}

// What programs of robots play are angles of encoders in every format: the files of two units
// differ, and each unit reads its own file as the same motion.
TEST_F(Replay, EveryPlayedFormatHoldsTheZerosOfTheUnit) {
  write(folder / "unit.json", R"({
    "format": "ayumi.robot/1", "base": "hoap1", "name": "unit 7",
    "servos": [{ "joints": ["l_knee"], "offset_deg": 0.4 }]
  })");
  write(folder / "p.json", kBow);
  std::string text = kBow;
  text.replace(text.find("\"hoap1\""), 7, "\"unit.json\"");
  write(folder / "u.json", text);
  for (const std::string format :
       {"op3-action", "qianim", "poppy-move", "play-motion2", "ros-trajectory"}) {
    for (const std::string name : {"p", "u"}) {
      std::vector<std::string> words = {"export", name + ".json", "--format", format,
                                        "-o",     name + ".bin",  "--force"};
      if (format == "op3-action") words.insert(words.end(), {"--interval", "8"});
      const Output out = ayumi(words);
      ASSERT_EQ(out.exit_code, 0) << format << out.out << out.err;
      const Output in =
          ayumi({"import", name + ".bin", "--robot", name == "p" ? "hoap1" : "unit.json", "-o",
                 name + "_in.json", "--force", "--unit", "rad"});
      ASSERT_EQ(in.exit_code, 0) << format << in.out << in.err;
    }
    EXPECT_NE(contents(folder / "p.bin"), contents(folder / "u.bin")) << format;
    // op3-action rounds angles to 1/4096 of a turn.
    EXPECT_LT(distance("p_in.csv", "u_in.csv"), format == "op3-action" ? 1.6e-3 : 2e-4) << format;
  }
}

// A recorded walk of a real HOAP-3, replayed as it was sent: the encoders agree within 0.05 degrees
// on average and within 0.2 degrees at every time, and the load is shared between the feet as in
// the recording. The data are not part of this program.
TEST(RecordedReplay, ARecordedWalkOfARealRobot) {
  const std::string data = AYUMI_SOURCE_DIR "/../shared/data/hoap3";
  if (!std::filesystem::exists(data + "/recordings"))
    GTEST_SKIP() << "no recordings of HOAP-3 at " << data;
  const Folder folder;
  const std::string robot = AYUMI_SOURCE_DIR "/examples/hoap3/recorded.json";
  const Output replayed =
      run_program({"replay", data + "/motions/walk_m03_fujitsu_sample_pulses_1ms.csv", "--robot",
                   robot, "--robot-path", data + "/hoap3_description", "-o", "out", "-q"},
                  folder.path());
  ASSERT_EQ(replayed.exit_code, 0) << replayed.out << replayed.err;
  for (const std::string plant : {"ayumi", "mujoco"}) {
    if (!std::filesystem::exists(folder / ("out/log_" + plant + ".bin"))) continue;
    const Output compared = run_program(
        {"compare", "out", data + "/recordings/walk_m03_measured_encoder_pulses_1ms.csv",
         data + "/recordings/walk_m03_measured_sensors_adc_1ms.csv", "--log", plant, "--robot",
         robot, "--robot-path", data + "/hoap3_description", "--json", "-q"},
        folder.path());
    ASSERT_EQ(compared.exit_code, 0) << compared.err;
    const Json json = json_of(compared.out);
    EXPECT_LT(json.at("joint_mean_rad"), 0.05 * M_PI / 180) << plant;
    EXPECT_LT(json.at("joint_max_rad"), 0.2 * M_PI / 180) << plant;
    EXPECT_GT(json.at("end_s"), 17.8) << plant;
    for (const Json& note : json.at("notes"))
      EXPECT_EQ(note.get<std::string>().find("sensors: the load cells of the "), 0u) << note;
    EXPECT_GT(json.at("loads").at(2).at("correlation"), 0.96) << plant;
    EXPECT_GE(json.at("landings").size(), 12u) << plant;
    // The zeros of recorded.json were found from the first half of these landings, in Ayumi's
    // plant.
    int near = 0;
    for (const Json& landing : json.at("landings"))
      near += std::abs(landing.at("simulated_s").get<double>() -
                       landing.at("measured_s").get<double>()) < 0.015 + 1e-9;
    EXPECT_GE(near, plant == "ayumi" ? 10 : 5) << plant;
  }
}

}  // namespace
}  // namespace ayumi::test
