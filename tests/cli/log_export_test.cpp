// `ayumi export` of everything that is known about a run, for other programs.

#include <cmath>
#include <map>

#include "ayumi/io/run/run_folder.hpp"
#include "tests/cli/program.hpp"
#include "tests/support/json.hpp"

namespace ayumi::test {
namespace {

const char* const kPushed = R"({
  "format": "ayumi.pattern/1", "name": "arm up", "robot": "hoap1", "units": { "angle": "deg" },
  "phases": [{ "until": 1, "support": "both" }],
  "keyframes": [
    { "t": 0, "posture": "home" }, { "t": 0.8, "posture": { "l_shoulder_pitch": 30 } }
  ],
  "scenario": [{ "type": "impulse", "at": 0.3, "impulse": 0.3, "direction": [1, 0, 0], "duration": 0.05 }]
})";

// There is one run for all tests.
class LogExport : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = new Folder("LogExport");
    write(folder->path() / "p.json", kPushed);
    const Output output =
        run_program({"run", "-q", "p.json", "--no-pictures", "-o", "run"}, folder->path());
    ASSERT_EQ(output.exit_code, 0) << output.out << output.err;
  }
  static void TearDownTestSuite() { delete folder; }

  static Output ayumi(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"export", "-q"});
    return run_program(arguments, folder->path());
  }
  static void expect_refused(const std::vector<std::string>& arguments, int exit_code,
                             const std::string& message) {
    const Output output = ayumi(arguments);
    EXPECT_EQ(output.exit_code, exit_code) << message;
    EXPECT_NE(output.err.find(message), std::string::npos) << output.err;
    EXPECT_EQ(std::count(output.err.begin(), output.err.end(), '\n'), 1) << output.err;
    EXPECT_FALSE(fs::exists(folder->path() / arguments.back())) << message;
  }
  // Columns by name. Cells are separated by commas and not quoted.
  static std::map<std::string, std::vector<double>> columns(const std::string& file) {
    std::istringstream stream(contents(folder->path() / file));
    std::vector<std::string> names;
    std::map<std::string, std::vector<double>> result;
    std::string line, cell;
    std::getline(stream, line);
    for (std::istringstream cells(line); std::getline(cells, cell, ',');) names.push_back(cell);
    while (std::getline(stream, line)) {
      std::istringstream cells(line);
      for (const std::string& name : names) {
        std::getline(cells, cell, ',');
        result[name].push_back(std::stod(cell));
      }
      EXPECT_FALSE(std::getline(cells, cell, ',')) << "more cells than columns";
    }
    EXPECT_EQ(result.size(), names.size()) << "a name twice";
    return result;
  }
  static Folder* folder;
};
Folder* LogExport::folder = nullptr;

TEST_F(LogExport, CsvHasAllColumnsOfTheLog) {
  const Output output = ayumi({"run", "--format", "csv-log", "--json", "-o", "all.csv"});
  ASSERT_EQ(output.exit_code, 0) << output.err;
  const auto json = json_of(output.out);
  auto table = columns("all.csv");
  EXPECT_EQ(json.at("rows"), table.at("t[s]").size());
  EXPECT_EQ(json.at("columns").size(), table.size());
  EXPECT_EQ(json.at("rate_hz"), 1000);
  for (const char* name :
       {"base.qw", "theta.l_elbow[rad]", "dtheta.l_elbow[rad/s]", "target.l_elbow[rad]",
        "torque.l_elbow[N m]", "cog.z[m]", "ref.zmp.x[m]", "left.force.z[N]", "zmp.margin[m]",
        "push.force.x[N]", "disturbance.1_impulse", "energy[J]"})
    EXPECT_TRUE(table.contains(name)) << name;
  // The header of the log names its columns, and the export has all of them.
  const std::string log = contents(folder->path() / "run/log_closed_loop.bin");
  const size_t begin = log.find("\"columns\":[") + 10, end = log.find("],\"rows\"", begin) + 1;
  const auto logged = json_of(log.substr(begin, end - begin));
  EXPECT_GT(logged.size(), 200u);
  for (const auto& name : logged) EXPECT_TRUE(table.contains(name)) << name;
}

// Quantities that follow from the columns of the log are computed again.
TEST_F(LogExport, DerivedColumnsFollowFromTheOthers) {
  ASSERT_EQ(ayumi({"run", "--format", "csv-log", "-o", "derived.csv"}).exit_code, 0);
  auto table = columns("derived.csv");
  int pushed = 0;
  for (size_t k = 0; k < table["t[s]"].size(); ++k) {
    const auto at = [&](const std::string& name) { return table.at(name).at(k); };
    EXPECT_EQ(at("t[s]"), static_cast<double>(k) * 0.001);
    const double omega = std::sqrt(9.80665 / (at("cog.z[m]") - at("zmp.z[m]")));
    EXPECT_NEAR(at("dcm.x[m]"), at("cog.x[m]") + at("dcog.x[m/s]") / omega, 1e-12);
    EXPECT_EQ(at("planned_support"), 3);
    EXPECT_EQ(at("phase"), 0);
    EXPECT_EQ(at("support"), at("left.contact") + 2 * at("right.contact"));
    EXPECT_EQ(at("left.contact"), at("left.force.z[N]") > 0 ? 1 : 0);
    EXPECT_EQ(at("disturbance.1_impulse"), at("push.force.x[N]") != 0 ? 1 : 0) << k;
    pushed += static_cast<int>(at("disturbance.1_impulse"));
    // The ZMP of a standing robot is between the edges of its soles.
    EXPECT_GT(at("zmp.margin[m]"), -1e-3) << k;
    EXPECT_LT(at("zmp.margin[m]"), 0.1) << k;
  }
  EXPECT_EQ(pushed, 50) << "0.05 s of 1 ms";
}

TEST_F(LogExport, NumpyReadsTheArchiveWithoutPickle) {
  const char* const python = "/usr/bin/python3";
  if (!fs::exists(python) || run_program({"-c", "import numpy"}, folder->path(), python).exit_code)
    GTEST_SKIP() << "python3-numpy is not installed";
  const Output output =
      ayumi({"run", "--format", "npz", "--log", "open_loop", "--json", "-o", "a.npz"});
  ASSERT_EQ(output.exit_code, 0) << output.err;
  ASSERT_EQ(ayumi({"run/log_open_loop.bin", "--format", "csv-log", "-o", "a.csv"}).exit_code, 0);
  const Output said = run_program({AYUMI_SOURCE_DIR "/tests/cli/read_npz.py", "a.npz", "a.csv"},
                                  folder->path(), python);
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_NE(said.out.find("arrays agree"), std::string::npos) << said.out;
  const auto arrays = json_of(output.out).at("arrays");
  EXPECT_EQ(arrays.at(0).at("name"), "t");
  EXPECT_EQ(arrays.at(1).at("shape").at(1), 7);
}

// Foxglove's own libraries read the file, in order and by its index.
TEST_F(LogExport, FoxgloveReadsTheMcap) {
  if (std::string(AYUMI_NODE).empty())
    GTEST_SKIP() << "built without npm: @mcap/core and @foxglove/schemas are not there";
  for (const std::string log : {"closed_loop", "open_loop"}) {
    const Output output =
        ayumi({"run", "--format", "mcap", "--log", log, "--json", "-o", log + ".mcap"});
    ASSERT_EQ(output.exit_code, 0) << output.err;
    ASSERT_EQ(ayumi({"run", "--format", "csv-log", "--log", log, "-o", log + ".csv"}).exit_code, 0);
    const Output said =
        run_program({"NODE_PATH=" AYUMI_NODE_MODULES, AYUMI_NODE,
                     AYUMI_SOURCE_DIR "/tests/cli/read_mcap.cjs", log + ".mcap", log + ".csv"},
                    folder->path(), "/usr/bin/env");
    EXPECT_EQ(said.exit_code, 0) << said.out << said.err;
    EXPECT_NE(said.out.find(" agree"), std::string::npos) << said.out;
    const auto topics = json_of(output.out).at("topics");
    std::map<std::string, nlohmann::json> by_name;
    for (const auto& topic : topics) by_name[topic.at("topic")] = topic;
    EXPECT_EQ(by_name.at("/tf").at("schema"), "foxglove.FrameTransforms");
    EXPECT_EQ(by_name.at("/scene").at("schema"), "foxglove.SceneUpdate");
    EXPECT_EQ(by_name.at("/joint_states").at("schema"), "foxglove.JointStates");
    EXPECT_EQ(by_name.at("/robot").at("messages"), 1);
    EXPECT_GE(by_name.at("/events").at("messages"), 1) << "the push";
  }
}

TEST_F(LogExport, SameLogSameBytes) {
  for (const std::string format : {"csv-log", "npz", "mcap"}) {
    const std::string extension = format == "csv-log" ? ".csv" : "." + format;
    for (const char* threads : {"1", "2"})
      ASSERT_EQ(ayumi({"run", "--threads", threads, "--format", format, "-o",
                       "same" + std::string(threads) + extension})
                    .exit_code,
                0);
    EXPECT_EQ(contents(folder->path() / ("same1" + extension)),
              contents(folder->path() / ("same2" + extension)));
    EXPECT_EQ(contents(folder->path() / ("same1" + extension)).find("same1"), std::string::npos);
  }
}

TEST_F(LogExport, BadInputGetsOneLine) {
  write(folder->path() / "half.bin",
        contents(folder->path() / "run/log_closed_loop.bin").substr(0, 100000));
  std::string old = contents(folder->path() / "run/log_closed_loop.bin");
  old[8] = 7;
  write(folder->path() / "other.bin", old);
  write(folder->path() / "empty.csv", "");
  expect_refused({"half.bin", "--format", "npz", "-o", "x.npz"}, 3, "truncated");
  expect_refused({"other.bin", "--format", "csv-log", "-o", "x.csv"}, 3, "log version 7");
  expect_refused({"empty.csv", "--format", "npz", "-o", "x.npz"}, 3, "needs a RUN");
  expect_refused({"p.json", "--format", "npz", "-o", "x.npz"}, 3, "needs a RUN");
  expect_refused({"nowhere", "--format", "npz", "-o", "x.npz"}, 3, "no such folder");
  expect_refused({"run", "--format", "npz", "--log", "open", "-o", "x.npz"}, 3,
                 "the run has no log 'open'");
  expect_refused({"run", "--format", "npz", "--robot", "humanoid30", "-o", "x.npz"}, 3,
                 "but the robot 'humanoid30' has the joints ");
  expect_refused({"run/log_open_loop.bin", "--format", "hoap", "-o", "x.csv"}, 3,
                 "this is a single log, but a joint table is made from the whole run");
  expect_refused({"run", "--format", "npz", "-o", "x.csv"}, 2,
                 "--format npz needs a file name that ends in .npz");
  expect_refused({"run", "--format", "npz", "--ramp", "3", "-o", "x.npz"}, 2, "--ramp");
  expect_refused({"run/log_open_loop.bin", "--format", "npz", "--log", "a", "-o", "x.npz"}, 2,
                 "is a single log");
}

// A light run has no tables and no pictures, but everything that is made from a run is the same.
TEST_F(LogExport, LightRunGivesTheSameFiles) {
  for (const std::string kind : {"full", "light"}) {
    std::vector<std::string> words = {"run", "-q", "p.json", "-o", kind};
    words.push_back(kind == "light" ? "--light" : "--no-pictures");
    const Output output = run_program(words, folder->path());
    ASSERT_EQ(output.exit_code, 0) << output.out << output.err;
    std::vector<std::vector<std::string>> commands = {
        {"export", kind, "--format", "csv", "-o", "/table.csv"},
        {"export", kind, "--format", "json", "-o", "/table.json"},
        {"export", kind, "--format", "csv", "--pushed", "-o", "/pushed.csv"},
        {"export", kind, "--format", "hoap", "-o", "/hoap.csv"},
        {"export", kind, "--format", "gltf", "-o", "/walk.glb"},
        {"export", kind, "--format", "csv-log", "-o", "/log.csv"},
        {"preview", kind, "--at", "0.4", "--size", "320x240", "-o", "/one.png"},
        {"plot", kind, "-o", "/loci.svg"},
        {"report", kind, "-o", "/report.html"}};
    for (std::vector<std::string>& command : commands) {
      command.back() = kind + "_" + command.back().substr(1);
      command.insert(command.begin() + 1, "-q");
      const Output made = run_program(command, folder->path());
      EXPECT_EQ(made.exit_code, 0) << command[0] << " " << command.back() << "\n" << made.err;
    }
  }
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(folder->path() / "light"))
    files.push_back(entry.path().filename());
  std::sort(files.begin(), files.end());
  EXPECT_EQ(files, (std::vector<std::string>{"log_closed_loop.bin", "log_open_loop.bin",
                                             "log_undisturbed.bin", "run.json"}));
  // The command line of the run is in the heads: only the options differ.
  const auto without = [](std::string text, const std::string& word) {
    for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at))
      text.erase(at, word.size());
    return text;
  };
  for (const char* name : {"table.csv", "table.json", "pushed.csv", "hoap.csv", "walk.glb",
                           "log.csv", "one.png", "loci.svg", "report.html"}) {
    const std::string full = contents(folder->path() / ("full_" + std::string(name)));
    const std::string light = contents(folder->path() / ("light_" + std::string(name)));
    EXPECT_FALSE(full.empty()) << name;
    EXPECT_TRUE(without(full, " --no-pictures") == without(light, " --light")) << name;
  }
  EXPECT_EQ(contents(folder->path() / "full/hoap.csv"),
            contents(folder->path() / "light_hoap.csv"));
}

TEST_F(LogExport, LightRunThatIsUnfitIsRefused) {
  std::string text = kPushed;
  text.replace(text.find("\"impulse\": 0.3"), 14, "\"impulse\": 8.0");
  write(folder->path() / "q.json", text);
  const Output fell = run_program({"run", "-q", "q.json", "--light", "-o", "fell"}, folder->path());
  EXPECT_EQ(fell.exit_code, 1) << fell.out;
  const Output output = ayumi({"fell", "--format", "hoap", "-o", "fell.csv"});
  EXPECT_EQ(output.exit_code, 1);
  EXPECT_NE(output.out.find("not written, because"), std::string::npos) << output.out;
  EXPECT_NE(output.out.find("fell at"), std::string::npos) << output.out;
  EXPECT_FALSE(fs::exists(folder->path() / "fell.csv"));
}

// A run whose postures were changed after it was made, with all hashes made to fit.
TEST_F(LogExport, ForgedPosturesAreRefused) {
  for (const std::string name : {"closed_loop", "open_loop"}) {
    RunFolder forged = read_run(folder->path() / "run");
    for (SimulationSample& sample : forged.logs.at(name).samples)
      std::swap(sample.state.theta[2], sample.state.theta[9]);
    fs::remove_all(folder->path() / "forged");
    fs::copy(folder->path() / "run", folder->path() / "forged");
    write_run(folder->path() / "forged", forged);
    std::vector<std::vector<std::string>> commands = {{"report", "forged", "-o", "f.html"}};
    if (name == "closed_loop")
      commands.insert(
          commands.end(),
          {{"preview", "forged", "-o", "f.png"},
           {"preview", "forged", "-o", "f.glb"},
           {"preview", "forged", "--log", "open_loop", "--ghost", "closed_loop", "-o", "f.png"},
           {"plot", "forged", "-o", "f.svg"},
           {"explain", "18", "forged@0.3"},
           {"export", "forged", "--pushed", "--format", "csv", "-o", "f.csv"},
           {"export", "forged", "--format", "csv-log", "-o", "f.csv"}});
    for (const std::vector<std::string>& command : commands) {
      const Output output = run_program(command, folder->path());
      EXPECT_EQ(output.exit_code, 3) << command[0] << output.out;
      EXPECT_NE(output.err.find("' differs from the COG in the log by "), std::string::npos)
          << command[0] << output.err;
    }
  }
  for (const auto& entry : fs::directory_iterator(folder->path()))
    EXPECT_NE(entry.path().stem(), "f") << entry.path();
}

// A table of a run that was edited, read as a file.
TEST_F(LogExport, EditedTablesOfARunAreRefused) {
  for (const std::string name : {"reference.csv", "reference.json", "reference_pushed.csv"}) {
    fs::remove_all(folder->path() / "edited");
    fs::copy(folder->path() / "run", folder->path() / "edited");
    const fs::path file = folder->path() / "edited" / name;
    std::string text = contents(file);
    const size_t at = text.find_last_of("0123456789");
    text[at] = text[at] == '1' ? '2' : '1';
    write(file, text);
    expect_refused({"edited/" + name, "--format", "csv", "--pushed", "-o", "e.csv"}, 3, name);
  }
}

// A table that does not come from the log of its run, with all hashes made to fit.
TEST_F(LogExport, TablesOfAnotherLogAreRefused) {
  const auto expect_refused_run = [&](const std::string& what, const auto& forge,
                                      const std::string& message) {
    RunFolder forged = read_run(folder->path() / "run");
    forge(forged);
    fs::remove_all(folder->path() / "forged");
    fs::copy(folder->path() / "run", folder->path() / "forged");
    write_run(folder->path() / "forged", forged);
    for (const char* const format : {"hoap", "csv"}) {
      const Output output = ayumi({"forged", "--format", format, "-o", "f.out"});
      EXPECT_EQ(output.exit_code, 3) << what << output.out;
      EXPECT_NE(output.err.find(message), std::string::npos) << what << output.err;
    }
    EXPECT_FALSE(fs::exists(folder->path() / "f.out")) << what;
  };
  expect_refused_run(
      "bent knee", [](RunFolder& run) { run.reference->rows[100].theta[10] += 0.5; },
      "forged/reference.csv: row 101 of the table differs from the log of the run");
  expect_refused_run(
      "other ZMP", [](RunFolder& run) { run.reference->rows[0].zmp.x() += 0.001; },
      "forged/reference.csv: row 1 of the table differs from the log of the run");
  expect_refused_run(
      "fewer rows", [](RunFolder& run) { run.reference->rows.pop_back(); }, " rows, but the log");
  expect_refused_run(
      "other rate", [](RunFolder& run) { run.reference->dt = 0.002; },
      "the table has a row every 2 ms, but the log of the run has a row every 1 ms");
}

// A log with another tick, with all hashes made to fit, also where no table is compared with it.
TEST_F(LogExport, ALogWithAnotherTickIsRefused) {
  for (const bool light : {false, true}) {
    RunFolder forged = read_run(folder->path() / "run");
    for (auto& [name, log] : forged.logs) log.dt = 0.002;
    forged.light = light;
    fs::remove_all(folder->path() / "forged");
    if (light) forged.files.clear();
    if (!light) fs::copy(folder->path() / "run", folder->path() / "forged");
    write_run(folder->path() / "forged", forged);
    for (const std::vector<std::string>& more :
         {std::vector<std::string>{}, {"--servo", "ideal"}, {"--log", "open_loop"}}) {
      std::vector<std::string> words = {"forged", "--format", "csv", "-o", "f.out"};
      words.insert(words.end(), more.begin(), more.end());
      const Output output = ayumi(words);
      EXPECT_EQ(output.exit_code, 3) << light << output.out;
      EXPECT_NE(output.err.find("the log has a row every 2 ms, but the servo period of robot "
                                "'hoap1' is 1 ms"),
                std::string::npos)
          << light << output.err;
    }
    EXPECT_FALSE(fs::exists(folder->path() / "f.out")) << light;
  }
}

// Their COG is not that of the robot as its files describe it.
TEST_F(LogExport, RunsWithAPayloadAndCasesOfAStudyAreExported) {
  std::string text = kPushed;
  const size_t at = text.find("{ \"type\": \"impulse\"");
  text.replace(at, text.find("]", text.find("}", at)) - at,
               R"({ "type": "payload", "at": 0, "duration": 0.5, "on": "torso", "mass": 0.3 })");
  write(folder->path() / "loaded.json", text);
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{}, std::vector<std::string>{"--case", "1"}}) {
    std::vector<std::string> command = {"simulate", "-q", "--force", "-o", "loaded"};
    command.push_back(more.empty() ? "loaded.json" : "p.json");
    command.insert(command.end(), more.begin(), more.end());
    const Output made = run_program(command, folder->path());
    ASSERT_EQ(made.exit_code, 0) << made.out << made.err;
    const Output output = ayumi({"loaded", "--force", "--format", "csv-log", "-o", "loaded.csv"});
    EXPECT_EQ(output.exit_code, 0) << output.err;
  }
}

}  // namespace
}  // namespace ayumi::test
