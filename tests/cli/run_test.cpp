// `ayumi run` and the table that it makes for a robot, as a person or a script uses them.

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <memory>

#include "tests/cli/program.hpp"
#include "tests/support/json.hpp"

namespace ayumi::test {
namespace {

using Json = nlohmann::json;

// HOAP-1 lifts an arm. `scenario` is inserted into the pattern.
std::string arm_up(const std::string& scenario = "", const std::string& more_keys = "") {
  return R"({
  "format": "ayumi.pattern/1", "name": "arm up", "robot": "hoap1", "units": { "angle": "deg" },
  "phases": [{ "until": 1.5, "support": "both" }],
  "keyframes": [
    { "t": 0, "posture": "home" },
    { "t": 1.0, "posture": { "l_shoulder_pitch": 60 } })" +
         more_keys + "]" + (scenario.empty() ? "" : R"(, "scenario": [)" + scenario + "]") + "}";
}

const std::string kPush =
    R"({ "type": "impulse", "at": 0.5, "duration": 0.02, "direction": [0, 1, 0], "impulse": 0.5 })";
const std::string kTooHard =
    R"({ "type": "impulse", "at": 0.5, "duration": 0.02, "direction": [0, 1, 0], "impulse": 9 })";
// A keyframe for which an elbow would have to turn by 60 degrees in a hundredth of a second.
const std::string kTooFast =
    R"(, { "t": 1.2, "joints": { "l_elbow": -25 } }, { "t": 1.21, "joints": { "l_elbow": -85 } })";

class Run : public testing::Test {
 protected:
  void SetUp() override {
    write(folder / "calm.json", arm_up());
    write(folder / "pushed.json", arm_up(kPush));
  }
  Output ayumi(const std::vector<std::string>& arguments) {
    return run_program(arguments, folder.path());
  }
  Output run(const std::string& pattern, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words = {"run", pattern, "-o", "out", "--no-pictures", "-q"};
    words.insert(words.end(), more.begin(), more.end());
    return ayumi(words);
  }
  /// Puts a run of a pattern at `out`. Each pattern is run once for all tests that only need a run.
  void given_run(const std::string& pattern) {
    if (!made_) made_ = std::make_unique<Folder>("Run");
    if (!fs::exists(*made_ / pattern)) {
      const Output made = run(pattern);
      ASSERT_EQ(made.exit_code, 0) << made.out << made.err;
      fs::copy(folder / "out", *made_ / pattern, fs::copy_options::recursive);
      return;
    }
    fs::copy(*made_ / pattern, folder / "out", fs::copy_options::recursive);
  }
  static void TearDownTestSuite() { made_.reset(); }
  Output exported(const std::vector<std::string>& more, const std::string& format = "hoap") {
    std::vector<std::string> words = {"export", "out", "--format", format, "-o", "t", "-q"};
    words.insert(words.end(), more.begin(), more.end());
    return ayumi(words);
  }
  /// The rows of a table without its head.
  std::string rows(const std::string& file) {
    const std::string text = contents(folder / file);
    return text.substr(text.find("\nt[s]") + 1);
  }
  Folder folder;
  static inline std::unique_ptr<Folder> made_;
};

TEST_F(Run, TheTableIsThatOfTheRunWithoutDisturbances) {
  const Output calm = run("calm.json");
  ASSERT_EQ(calm.exit_code, 0) << calm.out << calm.err;
  const std::string table = rows("out/reference.csv"), hoap = contents(folder / "out/hoap.csv");
  EXPECT_FALSE(fs::exists(folder / "out/reference_pushed.csv"));
  fs::remove_all(folder / "out");

  const Output pushed = run("pushed.json", {"--json"});
  ASSERT_EQ(pushed.exit_code, 0) << pushed.err;
  EXPECT_EQ(rows("out/reference.csv"), table);
  EXPECT_EQ(contents(folder / "out/hoap.csv"), hoap);
  EXPECT_NE(rows("out/reference_pushed.csv"), table);
  const Json said = json_of(pushed.out);
  EXPECT_EQ(said.at("undisturbed").at("outcome"), "stands");
  EXPECT_EQ(said.at("simulate").at("closed_loop").at("outcome"), "stands");
  EXPECT_EQ(contents(folder / "out/reference.csv").find("disturbances"), std::string::npos);
  EXPECT_NE(contents(folder / "out/reference_pushed.csv")
                .find("# disturbances: 0.5 N s on cog at 0.5 s\n"),
            std::string::npos);
}

// Whatever disturbs the run, the tables for the robot are those of the run without disturbances.
TEST_F(Run, TheTablesOfManyDisturbedRunsAreThoseOfTheUndisturbedRun) {
  ASSERT_NO_FATAL_FAILURE(given_run("calm.json"));
  const std::string table = rows("out/reference.csv"), hoap = contents(folder / "out/hoap.csv");
  const std::vector<std::string> scenarios = {
      R"({ "type": "impulse", "at": 0.2, "duration": 0.02, "direction": [1, 0, 0], "impulse": 0.4 })",
      R"({ "type": "impulse", "at": 0.7, "duration": 0.05, "direction": [-1, 0, 0], "impulse": 0.4 })",
      R"({ "type": "impulse", "at": 0.4, "duration": 0.02, "direction": [0, -1, 0], "impulse": 0.4 })",
      R"({ "type": "payload", "at": 0, "mass": 0.2, "on": "torso" })",
      R"({ "type": "latency", "at": 0, "latency": 0.004 })",
      kPush + "," +
          R"({ "type": "impulse", "at": 1.0, "duration": 0.02, "direction": [1, 0, 0], "impulse": 0.3 })"};
  for (const std::string& scenario : scenarios) {
    fs::remove_all(folder / "out");
    write(folder / "p.json", arm_up(scenario));
    const Output pushed = run("p.json");
    ASSERT_LE(pushed.exit_code, 1) << scenario << pushed.err;
    EXPECT_TRUE(rows("out/reference.csv") == table) << scenario;
    EXPECT_TRUE(rows("out/reference_pushed.csv") != table) << scenario;
    EXPECT_NE(contents(folder / "out/reference_pushed.csv").find("# disturbances: "),
              std::string::npos);
    if (fs::exists(folder / "out/hoap.csv")) {
      EXPECT_TRUE(contents(folder / "out/hoap.csv") == hoap) << scenario;
    }
  }
}

// A table says which servo it was made for, and may be made for another.
TEST_F(Run, TablesAreMadeForAServo) {
  ASSERT_NO_FATAL_FAILURE(given_run("calm.json"));
  EXPECT_NE(contents(folder / "out/reference.csv").find("\n# servo: lead\n# servo_profile: hoap1"),
            std::string::npos);
  std::vector<std::string> made;
  for (const std::string input : {"out", "calm.json"})
    for (const std::string servo : {"ideal", "lead", "lead+sag"}) {
      const Output out = ayumi({"export", input, "--format", "csv", "-o", "t", "-q", "--force",
                                "--servo", servo, "--ramp", "0", "--hold", "0"});
      ASSERT_EQ(out.exit_code, 0) << out.err << out.out;
      EXPECT_NE(contents(folder / "t").find("# servo: " + servo + "\n"), std::string::npos);
      made.push_back(rows("t"));
    }
  ASSERT_EQ(exported({"--ramp", "0", "--hold", "0", "--force"}, "csv").exit_code, 0);
  EXPECT_TRUE(rows("t") == made[1]);  // the lead is used by default
  EXPECT_TRUE(made[0] != made[1] && made[1] != made[2] && made[0] != made[2]);
  EXPECT_TRUE(made[3] != made[4] && made[4] != made[5] && made[3] != made[5]);
  const Output table =
      ayumi({"export", "out/reference.csv", "--format", "csv", "-o", "u", "--servo", "ideal"});
  EXPECT_EQ(table.exit_code, 2);
}

TEST_F(Run, TheTableOfAPushedRunIsExportedWithPushedOnlyAndSaysSo) {
  ASSERT_NO_FATAL_FAILURE(given_run("pushed.json"));
  ASSERT_EQ(exported({}, "csv").exit_code, 0);
  EXPECT_EQ(contents(folder / "t").find("disturbances"), std::string::npos);
  for (const std::string input : {"out", "out/reference_pushed.csv"}) {
    std::vector<std::string> words = {"export", input, "--format", "hoap", "-o", "p.csv", "-q"};
    if (input == "out") words.insert(words.end(), {"--log", "closed_loop"});
    const Output refused = ayumi(words);
    EXPECT_EQ(refused.exit_code, 1) << input << refused.err;
    EXPECT_NE(refused.out.find("0.5 N s on cog at 0.5 s"), std::string::npos) << refused.out;
    EXPECT_FALSE(fs::exists(folder / "p.csv"));
    words.emplace_back("--pushed");
    EXPECT_EQ(ayumi(words).exit_code, 0) << input;
    EXPECT_NE(contents(folder / "p.csv.txt").find("disturbances: 0.5 N s"), std::string::npos);
    fs::remove(folder / "p.csv");
    fs::remove(folder / "p.csv.txt");
  }
  fs::remove(folder / "t");
  ASSERT_EQ(exported({"--pushed"}, "json").exit_code, 0);
  EXPECT_EQ(json_of(contents(folder / "t")).at("disturbances"), "0.5 N s on cog at 0.5 s");
}

// If a table becomes a pattern, the caution stays with it.
TEST_F(Run, APatternMadeOfAPushedTableIsNotForARobotEither) {
  ASSERT_NO_FATAL_FAILURE(given_run("pushed.json"));
  ASSERT_EQ(
      ayumi({"import", "out/reference_pushed.csv", "--robot", "hoap1", "-o", "i.json"}).exit_code,
      0);
  const std::vector<std::string> words = {"export", "i.json", "--format", "hoap",
                                          "-o",     "h.csv",  "-q",       "--force-unsafe"};
  const Output refused = ayumi(words);
  EXPECT_EQ(refused.exit_code, 1) << refused.out;
  EXPECT_NE(refused.out.find("--pushed"), std::string::npos) << refused.out;
}

TEST_F(Run, SimulateWritesThePushedTableUnderItsName) {
  ASSERT_EQ(ayumi({"simulate", "pushed.json", "-o", "out", "-q"}).exit_code, 0);
  EXPECT_FALSE(fs::exists(folder / "out/reference.csv"));
  EXPECT_TRUE(fs::exists(folder / "out/reference_pushed.csv"));
  EXPECT_EQ(exported({}).exit_code, 1);
  EXPECT_EQ(exported({"--pushed"}).exit_code, 0);
}

TEST_F(Run, ARunThatFellGivesNoTableForARobot) {
  write(folder / "hard.json", arm_up(kTooHard));
  const Output fell = run("hard.json", {"--json"});
  EXPECT_EQ(fell.exit_code, 1);
  const Json said = json_of(fell.out);
  ASSERT_EQ(said.at("simulate").at("closed_loop").at("outcome"), "fell");
  ASSERT_EQ(said.at("undisturbed").at("outcome"), "stands");
  EXPECT_FALSE(fs::exists(folder / "out/hoap.csv"));
  EXPECT_NE(contents(folder / "out/reference.csv")
                .find("# unfit: under its disturbances the robot "
                      "fell at"),
            std::string::npos);
  for (const std::string format : {"hoap", "csv", "json"}) {
    const Output refused = exported({}, format);
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_EQ(refused.out.find("t: not written, because under its disturbances the robot fell at"),
              0u)
        << refused.out;
  }
  EXPECT_FALSE(fs::exists(folder / "t"));
  const Output forced = exported({"--force-unsafe"}, "csv");
  EXPECT_EQ(forced.exit_code, 0);
  EXPECT_FALSE(fs::exists(folder / "t"));  // the name also says that the table is unsafe
  EXPECT_NE(contents(folder / "t.UNSAFE").find("# unfit: under its disturbances the robot fell at"),
            std::string::npos);
  // The forced table is still marked, and refused as it stands.
  const Output again = ayumi({"export", "t.UNSAFE", "--format", "hoap", "-o", "h.csv", "-q"});
  EXPECT_NE(again.exit_code, 0);
}

TEST_F(Run, AnInconsistentPatternGivesNoTableForARobot) {
  write(folder / "fast.json", arm_up("", kTooFast));
  const Output judged = run("fast.json");
  EXPECT_EQ(judged.exit_code, 1);
  EXPECT_NE(judged.out.find("no table for a robot: the pattern is inconsistent"), std::string::npos)
      << judged.out;
  EXPECT_FALSE(fs::exists(folder / "out/hoap.csv"));
  const Output of_run = exported({});
  EXPECT_EQ(of_run.exit_code, 1);
  EXPECT_EQ(of_run.out.find("t: not written, because the pattern is inconsistent"), 0u)
      << of_run.out;
  const Output of_pattern =
      ayumi({"export", "fast.json", "--format", "csv", "-o", "t", "-q", "--json"});
  EXPECT_EQ(of_pattern.exit_code, 1) << of_pattern.err;
  const std::string reason = json_of(of_pattern.out).at("refused").at(0);
  EXPECT_EQ(reason.find("the pattern is inconsistent: "), 0u) << reason;
  EXPECT_FALSE(fs::exists(folder / "t"));
}

TEST_F(Run, ExplainSaysWhereTheTracksOfTheRunComeFrom) {
  ASSERT_NO_FATAL_FAILURE(given_run("calm.json"));
  const Output people = ayumi({"explain", "18", "out@0.5"});
  ASSERT_EQ(people.exit_code, 0) << people.err;
  EXPECT_NE(people.out.find("  where each track comes from\n    joints "), std::string::npos)
      << people.out;
  const Json json = json_of(ayumi({"explain", "18", "out@0.5", "--json"}).out);
  for (const char* track : {"joints", "base", "cog", "zmp"})
    EXPECT_TRUE(json.at("sampled_from").contains(track)) << track;
}

TEST_F(Run, ExportRefusesAFolderThatHasChanged) {
  ASSERT_NO_FATAL_FAILURE(given_run("calm.json"));
  for (const std::string name :
       {"reference.csv", "reference.json", "hoap.csv", "log_open_loop.bin", "run.json"}) {
    const std::string before = contents(folder / "out" / name);
    std::string after = before;
    const size_t at = name == "run.json" ? after.find("\"consistent\"") + 1 : after.size() / 2;
    after[at] = after[at] == '1' ? '2' : '1';
    write(folder / "out" / name, after);
    const Output refused = exported({});
    EXPECT_EQ(refused.exit_code, 3) << name;
    EXPECT_NE(refused.err.find(name + ": the file has changed since the run was written"),
              std::string::npos)
        << refused.err;
    write(folder / "out" / name, before);
  }
  fs::rename(folder / "out/reference.json", folder / "elsewhere");
  EXPECT_EQ(exported({}).exit_code, 3);
  fs::rename(folder / "elsewhere", folder / "out/reference.json");
  // A table in the folder is part of the run, too.
  std::string table = contents(folder / "out/reference.csv");
  table[table.size() - 2] = table[table.size() - 2] == '1' ? '0' : '1';
  write(folder / "out/reference.csv", table);
  EXPECT_EQ(ayumi({"export", "out/reference.csv", "--format", "hoap", "-o", "t", "-q"}).exit_code,
            3);
  fs::remove(folder / "out/run.json");
  const Output none = exported({});
  EXPECT_EQ(none.exit_code, 3);
  EXPECT_NE(none.err.find("out: the folder has no run.json; a RUN is needed"), std::string::npos)
      << none.err;
  EXPECT_FALSE(fs::exists(folder / "t"));
}

TEST_F(Run, ForceLeavesNothingOfTheRunBeforeAndEverythingOfTheUser) {
  ASSERT_NO_FATAL_FAILURE(given_run("pushed.json"));
  write(folder / "out/notes.txt", "mine");
  const Output second = run("calm.json");
  EXPECT_EQ(second.exit_code, 3);
  EXPECT_NE(second.err.find(
                "out: this already exists; choose another name, or overwrite it with --force"),
            std::string::npos)
      << second.err;
  EXPECT_TRUE(fs::exists(folder / "out/reference_pushed.csv"));
  ASSERT_EQ(run("calm.json", {"--force"}).exit_code, 0);
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder / "out"))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names,
            (std::vector<std::string>{"hoap.csv", "log_closed_loop.bin", "log_open_loop.bin",
                                      "notes.txt", "reference.csv", "reference.json", "run.json"}));
  EXPECT_EQ(contents(folder / "out/notes.txt"), "mine");
}

TEST_F(Run, AFileOfTheUserIsNeverOverwritten) {
  write(folder / "out/hoap.csv", "mine");
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{}, std::vector<std::string>{"--force"}}) {
    const Output refused = run("calm.json", more);
    EXPECT_EQ(refused.exit_code, 3);
    EXPECT_NE(refused.err.find("out/hoap.csv: this file already exists"), std::string::npos)
        << refused.err;
  }
  EXPECT_EQ(contents(folder / "out/hoap.csv"), "mine");
  EXPECT_EQ(folder.files(),
            (std::vector<std::string>{"calm.json", "out", "out/hoap.csv", "pushed.json"}));
}

TEST_F(Run, OneFolderIsWrittenByOneRunAtATime) {
  fs::create_directories(folder / "out");
  const std::string lock = folder / "out/.ayumi_lock";
  const int held = ::open(lock.c_str(), O_RDWR | O_CREAT, 0644);
  ASSERT_EQ(::flock(held, LOCK_EX), 0);
  const Output refused = run("calm.json");
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_NE(refused.err.find("out: another run is being written to this folder"), std::string::npos)
      << refused.err;
  // Closing the file releases the lock, as the end of the other process does. The file alone locks
  // nothing.
  ::close(held);
  ASSERT_TRUE(fs::exists(lock));
  EXPECT_EQ(run("calm.json").exit_code, 0);
  EXPECT_FALSE(fs::exists(lock));
}

TEST_F(Run, BadInputLeavesNoFolder) {
  write(folder / "bad.json", "{");
  EXPECT_EQ(run("bad.json").exit_code, 3);
  write(folder / "unknown.json", arm_up(R"({ "type": "impulse", "at": 0.5, "duration": 0.02,
      "direction": [0, 1, 0], "impulse": 1, "on": "tail" })"));
  EXPECT_EQ(run("unknown.json").exit_code, 3);
  EXPECT_FALSE(fs::exists(folder / "out"));
}

// If something that is no regular file has the name of an output, it stays as it is.
TEST_F(Run, NoCommandReplacesALinkADeviceOrAPipe) {
  ASSERT_NO_FATAL_FAILURE(given_run("calm.json"));
  write(folder / "target", "mine");
  for (const std::string name : {"l.json", "l.csv", "l.svg", "l.html", "l.png"})
    fs::create_symlink("target", folder / name);
  ASSERT_EQ(::mkfifo((folder / "pipe.csv").c_str(), 0600), 0);
  const std::vector<std::vector<std::string>> commands = {
      {"export", "out", "--format", "csv", "-o", "l.csv"},
      {"export", "out", "--format", "csv", "-o", "pipe.csv"},
      {"export", "out", "--format", "csv", "-o", "/dev/null"},
      {"plot", "out", "-o", "l.svg"},
      {"report", "out", "-o", "l.html"},
      {"preview", "out", "-o", "l.png"},
      {"preview", "out", "-o", "/dev/null"},
      {"new", "stand", "-o", "l.json"},
      {"repair", "calm.json", "-o", "l.json"},
      {"edit", "bake", "calm.json", "-o", "l.json"},
      {"import", "out/reference.csv", "--robot", "hoap1", "-o", "l.json"},
      {"inspect", "hoap1", "--picture", "l.png"},
      {"push", "calm.json", "-o", "l.json"},
      {"diff", "calm.json", "pushed.json", "--plot", "l.svg"},
      {"run", "calm.json", "-o", "l.json"},
      {"simulate", "calm.json", "-o", "/dev/null"}};
  for (std::vector<std::string> words : commands) {
    words.insert(words.end(), {"-q", "--force"});
    const Output refused = ayumi(words);
    EXPECT_EQ(refused.exit_code, 3) << words[0] << " " << words[words.size() - 3] << refused.err;
    EXPECT_EQ(line_count(refused.err), 1) << words[0] << ": " << refused.err;
  }
  EXPECT_EQ(contents(folder / "target"), "mine");
  EXPECT_TRUE(fs::is_symlink(folder / "l.json"));
  EXPECT_TRUE(fs::is_fifo(folder / "pipe.csv"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(Run, AllCommandsRefuseAnExistingFileInOneSentence) {
  ASSERT_NO_FATAL_FAILURE(given_run("calm.json"));
  for (const std::string name : {"x.json", "x.csv", "x.svg", "x.html", "x.png", "x.glb"})
    write(folder / name, "mine");
  const std::vector<std::vector<std::string>> commands = {
      {"export", "out", "--format", "csv", "-o", "x.csv"},
      {"export", "out", "--format", "gltf", "-o", "x.glb"},
      {"plot", "out", "-o", "x.svg"},
      {"report", "out", "-o", "x.html"},
      {"preview", "out", "-o", "x.png"},
      {"new", "stand", "-o", "x.json"},
      {"repair", "calm.json", "-o", "x.json"},
      {"inspect", "hoap1", "--picture", "x.png"}};
  for (std::vector<std::string> words : commands) {
    words.emplace_back("-q");
    const Output refused = ayumi(words);
    EXPECT_EQ(refused.exit_code, 3) << words[0] << refused.err;
    EXPECT_NE(refused.err.find(
                  ": this already exists; choose another name, or overwrite it with --force\n"),
              std::string::npos)
        << words[0] << ": " << refused.err;
  }
}

}  // namespace
}  // namespace ayumi::test
