// `ayumi compare` with a recording made from the log of a run, in which one knee is 0.2 degrees
// away.

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/cli/program.hpp"

namespace ayumi::test {
namespace {

using Json = nlohmann::json;

/// The columns t and theta of an exported log, as a recording.
std::string recording_of(const std::string& log, double late, double knee) {
  std::istringstream lines(log);
  std::string line, text;
  std::vector<size_t> columns;
  size_t moved = 0;
  for (bool head = true; std::getline(lines, line); head = false) {
    std::istringstream cells(line);
    std::string cell, row;
    for (size_t i = 0; std::getline(cells, cell, ','); ++i) {
      if (head && i > 0 && cell.starts_with("theta.")) {
        if (cell.find("l_knee") != std::string::npos) moved = i;
        columns.push_back(i);
        row += "," + cell.substr(6);
      } else if (head && i == 0) {
        row = cell;
      } else if (i == 0) {
        row = std::to_string(std::stod(cell) + late);
      } else if (!head && std::find(columns.begin(), columns.end(), i) != columns.end()) {
        row += "," + std::to_string(std::stod(cell) + (i == moved ? knee : 0.0));
      }
    }
    text += row + "\n";
  }
  return text;
}

TEST(CompareCommand, NumbersPictureAndReport) {
  const Folder folder;
  const auto ayumi = [&](const std::vector<std::string>& words) {
    return run_program(words, folder.path());
  };
  write(folder / "p.json", R"({
    "format": "ayumi.pattern/1", "name": "squat", "robot": "hoap1",
    "phases": [{ "until": 2, "support": "both" }],
    "keyframes": [{ "t": 0, "cog": { "height": 0.245 } }, { "t": 1, "cog": { "height": 0.225 } },
                  { "t": 2, "cog": { "height": 0.245 } }]
  })");
  ASSERT_EQ(ayumi({"run", "p.json", "-o", "out", "-q", "--no-pictures"}).exit_code, 0);
  ASSERT_EQ(ayumi({"export", "out", "--format", "csv-log", "-o", "log.csv", "-q"}).exit_code, 0);
  const double knee = 0.2 * M_PI / 180;
  write(folder / "m.csv", recording_of(contents(folder / "log.csv"), 0, knee));
  const Output out = ayumi({"compare", "out", "m.csv", "--shift", "0", "--json", "-q", "--plot",
                            "c.svg", "--report", "c.html"});
  ASSERT_EQ(out.exit_code, 0) << out.err;
  const Json json = Json::parse(out.out);
  EXPECT_EQ(json.at("shift_s"), 0);
  EXPECT_NEAR(json.at("joint_max_rad"), knee, 1e-5);
  for (const Json& joint : json.at("joints"))
    EXPECT_NEAR(joint.at("mean"), joint.at("name") == "l_knee" ? knee : 0.0, 1e-5) << joint;
  const std::string picture = contents(folder / "c.svg");
  EXPECT_NE(picture.find("l_knee [deg]"), std::string::npos);
  // The recording is drawn as a ghost and has no outcome of its own.
  const std::string page = contents(folder / "c.html");
  EXPECT_NE(page.find("<option value=\"measured\">"), std::string::npos);
  EXPECT_EQ(page.find("measured (stands)"), std::string::npos);
  EXPECT_EQ(page.find("<th scope=\"row\">measured"), std::string::npos);
  EXPECT_EQ(ayumi({"compare", "out", "m.csv", "--plot", "c.svg"}).exit_code, 3);
  const Output none = ayumi({"compare", "out"});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_NE(none.err.find("name a recording"), std::string::npos);
}

// Servos of the default profile override those of the robot. The sidecar of `identify` has an
// effect nevertheless, and the zero offset that the recording shows is that of the simulated joint.
TEST(IdentifyCommand, ItsSidecarHasEffectOverServosOfAProfile) {
  const Folder folder;
  const auto ayumi = [&](const std::vector<std::string>& words) {
    return run_program(words, folder.path());
  };
  write(folder / "base.json", R"({
    "format": "ayumi.robot/1", "base": "hoap1", "name": "mine",
    "profiles": [{ "name": "hoap1", "servos": [{ "joints": ["*"], "kp": 3000, "kd": 12 }] }]
  })");
  const auto log_of = [&](const std::string& robot, const std::string& name) {
    write(folder / (name + ".json"), R"({
      "format": "ayumi.pattern/1", "name": "squat", "robot": ")" +
                                         robot + R"(",
      "phases": [{ "until": 2, "support": "both" }],
      "keyframes": [{ "t": 0, "cog": { "height": 0.245 } }, { "t": 1, "cog": { "height": 0.225 } },
                    { "t": 2, "cog": { "height": 0.245 } }]
    })");
    const Output run = ayumi({"run", name + ".json", "-o", name, "-q", "--no-pictures"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const Output table = ayumi({"export", name, "--format", "csv-log", "-o", name + ".csv", "-q"});
    EXPECT_EQ(table.exit_code, 0) << table.err;
    return contents(folder / (name + ".csv"));
  };
  const std::string log = log_of("base.json", "out");
  const double offset = 0.2 * M_PI / 180;
  write(folder / "command.csv", recording_of(log, 0, 0));
  write(folder / "measured.csv", recording_of(log, 0, offset));
  const Output found = ayumi({"identify", "base.json", "--command", "command.csv", "--measured",
                              "measured.csv", "-o", "found.json", "-q"});
  ASSERT_EQ(found.exit_code, 0) << found.err;
  const Json sidecar = Json::parse(contents(folder / "found.json"));
  ASSERT_EQ(sidecar.at("profiles").at(0).at("name"), "hoap1");
  for (const Json& group : sidecar.at("profiles").at(0).at("servos"))
    EXPECT_NEAR(group.at("offset"), group.at("joints").at(0) == "l_knee" ? offset : 0.0,
                0.05 * offset)
        << group;
  // The knee of a run with this sidecar stands farther by the offset when the run begins and ends.
  const auto knee_at_the_end = [](const std::string& text) {
    std::istringstream lines(text);
    std::string line, head, last, cell;
    std::getline(lines, head);
    while (std::getline(lines, line)) last = line;
    std::istringstream names(head), cells(last);
    double angle = 0, target = 0;
    for (std::string name; std::getline(names, name, ',') && std::getline(cells, cell, ',');) {
      if (name.starts_with("theta.l_knee")) angle = std::stod(cell);
      if (name.starts_with("target.l_knee")) target = std::stod(cell);
    }
    return angle - target;
  };
  EXPECT_NEAR(knee_at_the_end(log_of("found.json", "again")) - knee_at_the_end(log), offset,
              0.3 * offset);
}

}  // namespace
}  // namespace ayumi::test
