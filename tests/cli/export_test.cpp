// `ayumi export` as a person or a script uses it.

#include "tests/cli/program.hpp"
#include "tests/support/json.hpp"

namespace ayumi::test {
namespace {

const char* const kArmUp = R"({
  "format": "ayumi.pattern/1", "name": "arm up", "robot": "hoap1", "units": { "angle": "deg" },
  "parameters": { "lifted": 60 },
  "phases": [{ "until": 2, "support": "both" }],
  "keyframes": [
    { "t": 0, "posture": "home" },
    { "t": 1.5, "posture": { "l_shoulder_pitch": "${lifted}" } }
  ]
})";

class Export : public testing::Test {
 protected:
  void SetUp() override { write(folder.path() / "p.json", kArmUp); }
  Output ayumi(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"export", "-q"});
    return run_program(arguments, folder.path());
  }
  std::vector<std::string> lines(const std::string& file) {
    std::vector<std::string> result;
    std::istringstream stream(contents(folder.path() / file));
    for (std::string line; std::getline(stream, line);) result.push_back(line);
    return result;
  }
  static std::vector<std::string> cells(const std::string& line) {
    std::vector<std::string> result;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) result.push_back(cell);
    return result;
  }
  Folder folder;
};

TEST_F(Export, HoapSequenceKeepsTheSpeedCapFromHomeToHold) {
  const Output output = ayumi({"p.json", "--format", "hoap", "-o", "h.csv", "--json"});
  ASSERT_EQ(output.exit_code, 0) << output.err;
  const auto json = json_of(output.out);
  const auto rows = lines("h.csv");
  EXPECT_EQ(json.at("format"), "hoap");
  EXPECT_EQ(json.at("rows"), rows.size());
  EXPECT_EQ(json.at("rate_hz"), 1000);
  EXPECT_EQ(json.at("joints").size(), 20u);
  EXPECT_EQ(json.at("safety").at("safe"), true);
  EXPECT_EQ(json.at("safety").at("ramp_s"), 2);
  EXPECT_EQ(json.at("safety").at("hold_s"), 0.5);
  EXPECT_EQ(rows.size(), 2000u + 2001 + 500);
  std::vector<std::string> before = cells(rows.front());
  int largest = 0;
  for (const std::string& row : rows) {
    const std::vector<std::string> now = cells(row);
    ASSERT_EQ(now.size(), 25u);
    for (size_t i = 2; i < 22; ++i)
      largest = std::max(largest, std::abs(std::stoi(now[i]) - std::stoi(before[i])));
    before = now;
  }
  EXPECT_GT(largest, 0);
  EXPECT_LE(largest, 57);
  for (size_t k = rows.size() - 500; k < rows.size(); ++k) EXPECT_EQ(rows[k], rows.back());
}

TEST_F(Export, TablesOfTablesAgree) {
  ASSERT_EQ(ayumi({"p.json", "--format", "csv", "-o", "a.csv", "--ramp", "0"}).exit_code, 0);
  ASSERT_EQ(
      ayumi({"a.csv", "--format", "json", "-o", "a.json", "--ramp", "0", "--hold", "0"}).exit_code,
      0);
  ASSERT_EQ(ayumi({"a.json", "--format", "hoap", "-o", "a.hoap", "--hold", "0"}).exit_code, 0);
  ASSERT_EQ(ayumi({"a.csv", "--format", "hoap", "-o", "b.hoap", "--hold", "0"}).exit_code, 0);
  EXPECT_EQ(lines("a.hoap"), lines("b.hoap"));
}

TEST_F(Export, SameBytesForAnyNumberOfThreads) {
  ASSERT_EQ(ayumi({"p.json", "--format", "csv", "-o", "a.csv", "--threads", "1"}).exit_code, 0);
  ASSERT_EQ(ayumi({"p.json", "--format", "csv", "-o", "b.csv", "--threads", "2"}).exit_code, 0);
  EXPECT_EQ(contents(folder.path() / "a.csv"), contents(folder.path() / "b.csv"));
}

TEST_F(Export, UnsafeTablesAreRefused) {
  ASSERT_EQ(ayumi({"p.json", "--format", "csv", "-o", "a.csv", "--ramp", "0"}).exit_code, 0);
  std::string text;
  for (const std::string& line : lines("a.csv"))  // r_hip_yaw jumps by 0.1 rad at 0.5 s
    text +=
        line.starts_with("0.5,") ? "0.5,0.1" + line.substr(line.find(',', 4)) + "\n" : line + "\n";
  write(folder.path() / "bad.csv", text);
  const Output refused = ayumi({"bad.csv", "--format", "hoap", "-o", "h.csv", "--json"});
  EXPECT_EQ(refused.exit_code, 1) << refused.err;
  EXPECT_FALSE(fs::exists(folder.path() / "h.csv"));
  const auto violation = json_of(refused.out).at("safety").at("violations").at(0);
  EXPECT_EQ(violation.at("kind"), "step");
  EXPECT_EQ(violation.at("joint"), "r_hip_yaw");
  EXPECT_NEAR(violation.at("at_s").get<double>(), 2.5, 1e-9);
  EXPECT_EQ(violation.at("limit"), 57);
  const Output forced = ayumi({"bad.csv", "--format", "hoap", "-o", "h.csv", "--force-unsafe"});
  EXPECT_EQ(forced.exit_code, 0);
  EXPECT_NE(forced.out.find("unsafe: r_hip_yaw at 2.500 s (0.500 s of the pattern)"),
            std::string::npos)
      << forced.out;
  EXPECT_FALSE(fs::exists(folder.path() / "h.csv"));
  EXPECT_TRUE(fs::exists(folder.path() / "h.UNSAFE.csv"));
  EXPECT_TRUE(fs::exists(folder.path() / "h.UNSAFE.csv.txt"));
}

// A HOAP-1 whose servos take a target every 2 ms.
TEST_F(Export, TablesAreAtTheServoPeriodOfTheRobot) {
  fs::copy(AYUMI_SOURCE_DIR "/robots/hoap1", folder.path() / "slow", fs::copy_options::recursive);
  const fs::path sidecar = folder.path() / "slow/robot.json";
  std::string text = contents(sidecar);
  const std::string period = "\"servo_period\": 0.001";
  text.replace(text.find(period), period.size(), "\"servo_period\": 0.002");
  write(sidecar, text);
  const Output made = run_program(
      {"new", "stand", "--robot", "slow", "--duration", "0.501", "-o", "s.json", "--json"},
      folder.path());
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_NEAR(json_of(made.out).at("duration_s").get<double>(), 0.502, 1e-9);
  const Output output = ayumi({"s.json", "--format", "hoap", "-o", "h.csv", "--json"});
  ASSERT_EQ(output.exit_code, 0) << output.err << output.out;
  EXPECT_EQ(json_of(output.out).at("rate_hz"), 500);
  EXPECT_EQ(cells(lines("h.csv").front()).front(), "2");
}

// A HOAP sequence states a whole number of milliseconds. A robot whose servos take a target every
// 12.5 ms is simulated in all the same.
// The layout of HOAP-1 allows 1, 2 and 10 ms; `run` once wrote a table at 4 ms, which `export`
// refuses.
TEST_F(Export, ARunIsWholeWithoutATableThatItsFormatCannotHold) {
  for (const auto& [given, reason] :
       {std::pair("0.0125", "in a HOAP sequence, the time between two rows is a whole "),
        std::pair("0.004", "the table has a row every 4 ms, but the layout 'HOAP-1' of ")}) {
    const Folder folder;
    fs::copy(AYUMI_SOURCE_DIR "/robots/hoap1", folder.path() / "odd", fs::copy_options::recursive);
    const fs::path sidecar = folder.path() / "odd/robot.json";
    std::string text = contents(sidecar);
    const std::string period = "\"servo_period\": 0.001";
    text.replace(text.find(period), period.size(), std::string("\"servo_period\": ") + given);
    write(sidecar, text);
    const Output made = run_program(
        {"new", "stand", "--robot", "odd", "--duration", "0.5", "-o", "s.json"}, folder.path());
    ASSERT_EQ(made.exit_code, 0) << made.err;
    const Output run = run_program({"run", "s.json", "-o", "run", "--no-pictures"}, folder.path());
    EXPECT_EQ(run.exit_code, 0) << run.err << run.out;
    EXPECT_NE((run.out + run.err).find(std::string("hoap.csv is not written: ") + reason),
              std::string::npos)
        << run.out << run.err;
    EXPECT_FALSE(fs::exists(folder.path() / "run/hoap.csv"));
    const Output table =
        run_program({"export", "run", "--format", "csv", "-o", "t.csv"}, folder.path());
    EXPECT_EQ(table.exit_code, 0) << table.err;
    EXPECT_FALSE(json_of(contents(folder.path() / "run/run.json"))["files"].contains("hoap.csv"));
  }
}

// The elbow moves at 87 % of its speed limit: consistent unless the pattern asks for more.
TEST_F(Export, APatternIsJudgedByItsOwnTolerances) {
  ASSERT_EQ(ayumi({"p.json", "--format", "csv", "-o", "a.csv"}).exit_code, 0);
  std::string strict = kArmUp;
  strict.insert(strict.find("\"parameters\""), "\"tolerances\": { \"joint_speed\": 0.01 }, ");
  write(folder.path() / "strict.json", strict);
  const Output refused = ayumi({"strict.json", "--format", "csv", "-o", "b.csv", "--json"});
  EXPECT_EQ(refused.exit_code, 1) << refused.out << refused.err;
  const std::string reason = json_of(refused.out).at("refused").at(0);
  EXPECT_EQ(reason.find("the pattern is inconsistent: joint_speed"), 0u) << reason;
  EXPECT_FALSE(fs::exists(folder.path() / "b.csv"));
}

TEST_F(Export, GoalsOfViipHaveNoTableUntilTheyAreRun) {
  write(folder.path() / "v.json", R"({ "format": "ayumi.pattern/1", "name": "v", "robot": "hoap1",
    "phases": [{ "until": 1, "viip": { "cog": [0.01, 0, 0] } }],
    "controller": { "type": "viip" } })");
  const Output output = ayumi({"v.json", "--format", "hoap", "-o", "v.csv"});
  EXPECT_EQ(output.exit_code, 3);
  EXPECT_NE(output.err.find("v.json: /phases: the pattern has VIIP goals"), std::string::npos)
      << output.err;
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "v.csv"));
}

TEST_F(Export, ParametersAndExistingFiles) {
  ASSERT_EQ(ayumi({"p.json", "--format", "csv", "-o", "a.csv", "--set", "lifted=70"}).exit_code, 0);
  const Output again = ayumi({"p.json", "--format", "csv", "-o", "a.csv"});
  EXPECT_EQ(again.exit_code, 3);
  EXPECT_NE(
      again.err.find("this already exists; choose another name, or overwrite it with --force"),
      std::string::npos);
  EXPECT_EQ(ayumi({"p.json", "--format", "csv", "-o", "a.csv", "--force"}).exit_code, 0);
  const Output typo = ayumi({"p.json", "--format", "csv", "-o", "b.csv", "--set", "lift=1"});
  EXPECT_EQ(typo.exit_code, 2);
  EXPECT_NE(typo.err.find("did you mean 'lifted'?"), std::string::npos) << typo.err;
}

TEST_F(Export, BrokenPatternsAreOneLineAndExit3) {
  struct Case {
    std::string from, to, complaint;
  };
  for (const Case& each : std::vector<Case>{
           {"\"deg\"", "\"grad\"",
            "/units/angle: 'grad' is not allowed; the allowed values are deg, rad"},
           {"1.5", "0",
            "/keyframes/1/t: this keyframe is at 0 s, but the keyframe before it is at 0 s; give a "
            "later time"},
           {"1.5", "NaN", "bad.json:7:"},
           {"1.5", "1e999", "bad.json"},
           {"l_shoulder_pitch", "l_shoulder", "l_shoulder"},
           {"\"hoap1\"", "\"hoap9\"", "hoap9"},
           {"keyframes", "keyframe", "did you mean 'keyframes'?"},
           {"\"both\"", "\"none\"", "none"},
           {"pattern/1", "pattern/2", "this version of Ayumi reads 'ayumi.pattern/1'"},
           {"${lifted}", "${lift}", "unknown parameter 'lift'; did you mean 'lifted'?"}}) {
    std::string text = kArmUp;
    text.replace(text.find(each.from), each.from.size(), each.to);
    write(folder.path() / "bad.json", text);
    const Output output = ayumi({"bad.json", "--format", "csv", "-o", "x.csv"});
    EXPECT_EQ(output.exit_code, 3) << each.to << "\n" << output.err;
    EXPECT_EQ(line_count(output.err), 1) << output.err;
    EXPECT_NE(output.err.find(each.complaint), std::string::npos) << output.err;
    EXPECT_EQ(output.out, "");
    EXPECT_FALSE(fs::exists(folder.path() / "x.csv"));
  }
}

TEST_F(Export, HoapNamesTheTorqueBeyondTheRobotsOwnMotors) {
  ASSERT_EQ(
      run_program({"new", "jump", "--height", "0.02", "-o", "j.json"}, folder.path()).exit_code, 0);
  const Output output = ayumi({"j.json", "--format", "hoap", "-o", "j.csv", "--json"});
  EXPECT_EQ(output.exit_code, 1);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "j.csv"));
  const auto json = json_of(output.out);
  EXPECT_EQ(json.at("profile"), "hoap1");
  bool named = false;
  for (const auto& v : json.at("safety").at("violations"))
    named = named || (v.at("kind") == "torque" && v.at("joint") == "r_knee" &&
                      v.at("limit") == 4.5 && v.at("value") > 4.5 && v.at("at_s") > 2);
  EXPECT_TRUE(named) << output.out;
}

// A sequence of HOAP-1 around its home posture. `tail` comes after the motors, and `end` ends the
// lines. The left elbow turns by one count every `slowness` rows.
std::string sequence(const std::string& interval, const std::string& tail, const std::string& end,
                     int rows = 60, bool waist = false, double slowness = 10) {
  const int home[20] = {0, 0, 3607,  9107,  -5500, 0, 18810,  -2090, 0, 5225,
                        0, 0, -3607, -9107, 5500,  0, -18810, 2090,  0, -5225};
  std::string text;
  for (int k = 0; k < rows; ++k) {
    text += interval + ",2";
    for (int i = 0; i < 20; ++i)
      text += i == 0 && k % 2 == 1
                  ? ",-0"
                  : "," + std::to_string(home[i] + (i == 19 ? static_cast<int>(k / slowness) : 0));
    text += (waist ? ",418" : "") + tail + end;
    if (k == 30 && interval == "2") text += "2,3,7,A,12" + end;
  }
  return text;
}

// If the result of importing a sequence is exported unchanged, every byte is that of the sequence.
TEST_F(Export, ImportedSequencesComeBackToTheByte) {
  struct Case {
    const char* name;
    std::string bytes;
  };
  std::string mixed = sequence("1", ",R,R,R", "\r\n");
  mixed.replace(mixed.find("\r\n"), 2, "\n");
  const std::string uneven = sequence("1", ",R,R,R", "\n") + sequence("10", ",R,R,R", "\n", 1);
  const std::vector<Case> cases = {
      {"1 ms", sequence("1", ",R,R,R", "\n")},
      {"2 ms, CRLF, a general command", sequence("2", ",R,R,R", "\r\n")},
      {"10 ms", sequence("10", ",R,R,R", "\n")},
      {"blanks around R", sequence("1", ", R ,R ,R", "\n")},
      {"columns of HOAP-2, R as its word", sequence("1", ",R,R,R,R", "\n", 60, true)},
      {"columns of HOAP-3", sequence("2", ",75,60,R,R,R,R", "\r\n", 60, true)},
      {"line ends of two kinds", mixed},
      {"intervals that change", uneven},
      {"no end of the last line",
       sequence("1", ",R,R,R", "\n") + "1,2" + sequence("1", ",R,R,R", "", 1).substr(3)},
      {"moving at its ends", sequence("1", ",R,R,R", "\n", 60, false, 0.2)},
      {"five rows", sequence("1", ",R,R,R", "\n", 5)}};
  for (const Case& c : cases)
    for (const bool commands : {false, true}) {
      write(folder.path() / "s.csv", c.bytes);
      std::vector<std::string> words = {"import", "s.csv",  "--robot", "hoap1",
                                        "-o",     "i.json", "-q",      "--force"};
      if (commands) words.emplace_back("--commands");
      const Output imported = run_program(words, folder.path());
      ASSERT_EQ(imported.exit_code, 0) << c.name << imported.err;
      const fs::path safe = folder.path() / "b.csv", unsafe = folder.path() / "b.UNSAFE.csv";
      fs::remove(safe);
      fs::remove(unsafe);
      const Output output =
          ayumi({"i.json", "--format", "hoap", "-o", "b.csv", "--force-unsafe", "--force"});
      EXPECT_TRUE(contents(fs::exists(unsafe) ? unsafe : safe) == c.bytes)
          << c.name << output.err << output.out;
    }
}

/// An action file as the editor of ROBOTIS writes it, with content that a table does not have: two
/// motions, speeds, pauses, exits, gains, bytes of unused fields, and a page without steps.
std::string action_file() {
  std::string bytes(256 * 512, '\0');
  const auto set = [&](size_t at, int value) { bytes[at] = static_cast<char>(value); };
  const auto page = [&](size_t number, const std::string& name, int steps, int next) {
    const size_t begin = 512 * number;
    bytes.replace(begin, name.size(), name);
    set(begin + 14, 7);  // a field that is not used
    set(begin + 15, 2);  // number of repetitions
    set(begin + 20, steps);
    set(begin + 22, 40);  // the speed of the page
    set(begin + 24, 17);
    set(begin + 25, next);
    set(begin + 26, 200);  // the exit page
    for (size_t i = 0; i < 31; ++i) set(begin + 32 + i, static_cast<int>(0x40 + i));
    for (int s = 0; s < 7; ++s) {
      const size_t step = begin + 64 * static_cast<size_t>(s + 1);
      for (size_t id = 0; id < 31; ++id) {
        const int value = id == 0 || id > 20 ? 0x4000 : 2048 + 5 * s * static_cast<int>(id % 3);
        set(step + 2 * id, value & 0xff);
        set(step + 2 * id + 1, value >> 8);
      }
      set(step + 62, s == 2 ? 30 : 0);
      set(step + 63, 60 + s);
    }
    int sum = 0;
    for (size_t i = 0; i < 512; ++i)
      if (i != 31) sum += static_cast<unsigned char>(bytes[begin + i]);
    set(begin + 31, 0xff - (sum & 0xff));
  };
  page(1, "walkready", 4, 2);
  page(2, "", 3, 0);
  page(15, "sit down", 7, 0);
  page(16, "one", 1, 0);
  page(200, "no steps", 0, 0);
  return bytes;
}

// Whichever motion of the file is read, the written file is the whole file.
TEST_F(Export, ImportedActionFilesComeBackToTheByte) {
  const std::string bytes = action_file();
  write(folder.path() / "motion_4095.bin", bytes);
  const auto written = [&](const std::vector<std::string>& more) {
    const fs::path unsafe = folder.path() / "b.UNSAFE.bin", safe = folder.path() / "b.bin";
    fs::remove(unsafe);
    fs::remove(safe);
    std::vector<std::string> words = {"i.json", "--format", "op3-action",    "-o",
                                      "b.bin",  "--force",  "--force-unsafe"};
    words.insert(words.end(), more.begin(), more.end());
    const Output output = ayumi(words);
    EXPECT_EQ(output.exit_code, 0) << output.err << output.out;
    return contents(fs::exists(unsafe) ? unsafe : safe);
  };
  for (const char* const motion : {"1", "sit down", "one"}) {
    const Output imported = run_program({"import", "motion_4095.bin", "--robot", "hoap1",
                                         "--motion", motion, "-o", "i.json", "--force"},
                                        folder.path());
    ASSERT_EQ(imported.exit_code, 0) << motion << imported.err;
    EXPECT_NE(imported.out.find("i.sequence.bin"), std::string::npos) << imported.out;
    EXPECT_TRUE(written({}) == bytes) << motion;
  }
  // At another rate, the steps are computed anew.
  EXPECT_TRUE(written({"--interval", "40"}) != bytes);
  write(folder.path() / "i.sequence.bin", bytes + "x");
  EXPECT_EQ(ayumi({"i.json", "--format", "op3-action", "-o", "c.bin"}).exit_code, 3);
}

// With a ramp and a hold, the rows around those of the file have its columns and interval.
TEST_F(Export, RampAndHoldAroundAnImportedSequence) {
  const std::string bytes = sequence("2", ",R,R,R", "\r\n");
  write(folder.path() / "s.csv", bytes);
  ASSERT_EQ(
      run_program({"import", "s.csv", "--robot", "hoap1", "-o", "i.json"}, folder.path()).exit_code,
      0);
  const Output output = ayumi(
      {"i.json", "--format", "hoap", "-o", "b.csv", "--ramp", "1", "--hold", "0.1", "--json"});
  ASSERT_EQ(output.exit_code, 0) << output.out << output.err;
  const auto json = json_of(output.out);
  EXPECT_EQ(json.at("interval_ms"), 2);
  EXPECT_EQ(json.at("imported_rows_unchanged"), true);
  const std::string made = contents(folder.path() / "b.csv");
  const size_t at = made.find(bytes);
  ASSERT_NE(at, std::string::npos);
  EXPECT_EQ(line_count(made.substr(0, at)), 500);
  EXPECT_EQ(line_count(made.substr(at + bytes.size())), 50);
  for (const std::string& line : lines("b.csv")) EXPECT_TRUE(line.ends_with('\r')) << line;
}

// A changed motion has rows of its own, in the columns of the robot.
TEST_F(Export, AChangedImportedSequenceIsComputed) {
  write(folder.path() / "s.csv", sequence("2", ",75,60,R,R,R,R", "\n", 60, true));
  ASSERT_EQ(
      run_program({"import", "s.csv", "--robot", "hoap1", "-o", "i.json"}, folder.path()).exit_code,
      0);
  std::string table = contents(folder.path() / "i.csv");
  const size_t angle = table.find(',', table.rfind('\n', table.size() - 2)) + 1;
  // The angle of r_hip_yaw in the last row is changed.
  table.replace(angle, table.find(',', angle) - angle, "0.01");
  write(folder.path() / "i.csv", table);
  const Output output =
      ayumi({"i.json", "--format", "hoap", "-o", "b.csv", "--force-unsafe", "--json"});
  const auto json = json_of(output.out);
  EXPECT_EQ(json.at("imported_rows_unchanged"), false);
  EXPECT_EQ(json.at("interval_ms"), 2);
  write(folder.path() / "i.sequence.csv", "1,2\n");
  EXPECT_EQ(
      run_program({"import", "s.csv", "--robot", "hoap1", "-o", "i.json"}, folder.path()).exit_code,
      3);  // it would overwrite a file
}

TEST_F(Export, AKeptSequenceThatWasChangedIsRefused) {
  write(folder.path() / "s.csv", sequence("1", ",R,R,R", "\n"));
  ASSERT_EQ(
      run_program({"import", "s.csv", "--robot", "hoap1", "-o", "i.json"}, folder.path()).exit_code,
      0);
  write(folder.path() / "i.sequence.csv", sequence("1", ",R,R,R", "\n", 59));
  const Output output = ayumi({"i.json", "--format", "hoap", "-o", "b.csv"});
  EXPECT_EQ(output.exit_code, 3);
  EXPECT_NE(output.err.find("this file has changed since the import"), std::string::npos)
      << output.err;
  EXPECT_FALSE(fs::exists(folder.path() / "b.csv"));
}

// HOAP takes a row every 1, 2 or 10 ms; other tables have any rate. Both clocks are named.
TEST_F(Export, RatesAndClocks) {
  const Output two = ayumi({"p.json", "--format", "hoap", "-o", "two.csv", "--interval", "2"});
  ASSERT_EQ(two.exit_code, 0) << two.err << two.out;
  EXPECT_NE(two.out.find("The pattern begins at 2 s of the table"), std::string::npos) << two.out;
  EXPECT_NE(two.out.find(" s of the pattern)"), std::string::npos) << two.out;
  const auto rows = lines("two.csv");
  EXPECT_EQ(rows.size(), 1000u + 1001 + 250);
  ASSERT_EQ(ayumi({"p.json", "--format", "hoap", "-o", "one.csv"}).exit_code, 0);
  const auto fine = lines("one.csv");
  for (size_t k = 1000; k < 2001; ++k)  // the motion consists of every second row
    EXPECT_EQ(rows[k].substr(1), fine[2 * k].substr(1));
  const Output ten = ayumi({"p.json", "--format", "hoap", "-o", "t.csv", "--rate", "100"});
  EXPECT_EQ(ten.exit_code, 0) << ten.err;
  EXPECT_EQ(cells(lines("t.csv").front()).front(), "10");
  const Output odd = ayumi({"p.json", "--format", "hoap", "-o", "o.csv", "--interval", "5"});
  EXPECT_EQ(odd.exit_code, 3);
  EXPECT_NE(odd.err.find("the layout 'HOAP-1' of 'hoap1' allows only 1, 2, 10 ms"),
            std::string::npos)
      << odd.err;
  EXPECT_EQ(ayumi({"p.json", "--format", "csv", "-o", "o.csv", "--interval", "5"}).exit_code, 0);
  EXPECT_EQ(ayumi({"p.json", "--format", "hoap", "-o", "x.csv", "--interval", "0"}).exit_code, 2);
  EXPECT_EQ(ayumi({"p.json", "--format", "hoap", "-o", "x.csv", "--layout", "HOAP1"}).exit_code, 3);
}

// The recorded sequences of HOAP-2 and HOAP-3.
TEST_F(Export, RecordedSequencesComeBackToTheByte) {
  const fs::path data = AYUMI_SOURCE_DIR "/../shared/data";
  if (!fs::exists(data / "hoap3/motions")) GTEST_SKIP() << "no recorded sequences in " << data;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(data / "hoap3/motions"))
    files.push_back(entry.path());
  for (const auto& entry : fs::directory_iterator(data / "hoap2"))
    if (entry.path().string().find("excerpt") != std::string::npos) files.push_back(entry.path());
  const std::string path = (data / "hoap3/hoap3_description").string();
  for (const fs::path& file : files) {
    const Output imported = run_program(
        {"import", file.string(), "--robot", AYUMI_SOURCE_DIR "/examples/hoap3/robot.json",
         "--robot-path", path, "-o", "i.json", "-q", "--force"},
        folder.path());
    ASSERT_EQ(imported.exit_code, 0) << file << imported.err;
    ayumi({"i.json", "--robot-path", path, "--format", "hoap", "-o", "b.csv", "--force-unsafe",
           "--force"});
    const fs::path unsafe = folder.path() / "b.UNSAFE.csv", safe = folder.path() / "b.csv";
    EXPECT_TRUE(contents(fs::exists(unsafe) ? unsafe : safe) == contents(file)) << file;
    fs::remove(unsafe);
    fs::remove(safe);
  }
}

}  // namespace
}  // namespace ayumi::test
