// `ayumi compare` with a recording made from the log of a run, in which one knee is 0.2 degrees
// away.

#include <sstream>

#include "tests/cli/program.hpp"
#include "tests/support/json.hpp"

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
  const Json json = json_of(out.out);
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
  EXPECT_NE(none.err.find("Name a recording"), std::string::npos);
}

/// The numbers of the columns whose names begin with `column`, by row.
std::vector<double> column_of(const std::string& table, const std::string& column) {
  std::istringstream lines(table);
  std::string line, cell;
  size_t at = 0;
  std::vector<double> values;
  for (bool head = true; std::getline(lines, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream cells(line);
    for (size_t i = 0; std::getline(cells, cell, ','); ++i) {
      if (head && cell.starts_with(column)) at = i;
      if (!head && i == at) values.push_back(std::stod(cell));
    }
    head = false;
  }
  return values;
}

const char* const kSquat = R"(
  "phases": [{ "until": 2, "support": "both" }],
  "keyframes": [{ "t": 0, "cog": { "height": 0.245 } }, { "t": 1, "cog": { "height": 0.225 } },
                { "t": 2, "cog": { "height": 0.245 } }]
})";

/// The first rows of a table without comments, and its head row.
std::string first_rows(const std::string& table, size_t rows) {
  std::istringstream lines(table);
  std::string line, text;
  size_t taken = 0;
  for (; taken <= rows && std::getline(lines, line); ++taken) text += line + "\n";
  EXPECT_EQ(taken, rows + 1) << "the table is too short";
  return text;
}

// Servos of the default profile override those of the robot. The sidecar of `identify` has an
// effect nevertheless: the zero offset that angles of joints show is compensated in the next table.
// When the unit that has this offset plays this table, its knee is where the pattern wants it, and
// a second recording shows no further offset. On the other unit, the knee is wrong by exactly the
// offset. If the encoders themselves show a constant difference, it is no zero of an encoder, so no
// number of rounds changes the offset.
TEST(IdentifyCommand, TheNextTableCompensatesTheOffsetThatWasFound) {
  const Folder folder;
  const auto ayumi = [&](const std::vector<std::string>& words) {
    const Output out = run_program(words, folder.path());
    EXPECT_EQ(out.exit_code, 0) << out.err << out.out;
    return out;
  };
  const double degree = M_PI / 180, offset = 0.4 * degree;
  write(folder / "base.json", R"({
    "format": "ayumi.robot/1", "base": "hoap1", "name": "mine",
    "profiles": [{ "name": "hoap1", "servos": [{ "joints": ["*"], "kp": 3000, "kd": 12 }] }]
  })");
  write(folder / "true.json", R"({
    "format": "ayumi.robot/1", "base": "base.json", "name": "true",
    "servos": [{ "joints": ["l_knee"], "offset_deg": 0.4 }]
  })");
  const std::string head = R"({ "format": "ayumi.pattern/1", "name": "squat", "robot": ")";
  write(folder / "base_squat.json", head + "base.json\"," + kSquat);
  write(folder / "found_squat.json", head + "found.json\"," + kSquat);
  // The knee's angle, at rest at the end, when a robot plays a table.
  const auto knee_of = [&](const std::string& table, const std::string& robot) {
    ayumi({"replay", table, "--robot", robot, "--plant", "ayumi", "-o", "out", "--force", "-q"});
    ayumi({"export", "out", "--format", "csv-log", "-o", "log.csv", "--robot", robot, "--force",
           "-q"});
    return column_of(contents(folder / "log.csv"), "theta.l_knee").back();
  };
  ayumi({"export", "base_squat.json", "--format", "csv", "-o", "base.csv", "-q"});
  const double wanted = knee_of("base.csv", "base.json");
  EXPECT_NEAR(knee_of("base.csv", "true.json") - wanted, offset, 0.02 * degree);
  // The offset of the knee in the sidecar that `identify` writes for the log of the last run.
  const auto found = [&](const std::string& robot, const std::string& command,
                         const std::string& at, double further) {
    // The recording is as long as the command.
    write(folder / "measured.csv",
          first_rows(recording_of(contents(folder / "log.csv"), 0, further),
                     column_of(contents(folder / command), "t").size()));
    ayumi({"identify", robot, "--command", command, "--measured", "measured.csv", "--measured-at",
           at, "-o", "found.json", "--force", "-q"});
    const Json sidecar = json_of(contents(folder / "found.json"));
    EXPECT_EQ(sidecar.at("profiles").at(0).at("name"), "hoap1");
    double knee = 0;
    for (const Json& group : sidecar.at("profiles").at(0).at("servos")) {
      if (!group.contains("offset")) continue;
      if (group.at("joints").at(0) == "l_knee")
        knee = group.at("offset");
      else
        EXPECT_NEAR(group.at("offset"), 0, 0.02 * degree) << group;
    }
    return knee;
  };
  EXPECT_NEAR(found("base.json", "base.csv", "joint", 0), offset, 0.02 * degree);
  const std::string first = contents(folder / "found.json");
  for (const std::string format : {"csv", "hoap"}) {
    const std::string file = "found_" + format + ".csv";
    ayumi({"export", "found_squat.json", "--format", format, "-o", file, "-q", "--servo", "lead"});
    EXPECT_NEAR(knee_of(file, "true.json"), wanted, 0.02 * degree);
    // The offset that was found is right to 0.02 degrees; and the other leg, which is then shorter,
    // takes over a part of the load, so that this knee yields less by up to 0.02 degrees.
    EXPECT_NEAR(knee_of(file, "base.json") - wanted, -offset, 0.04 * degree);
  }
  EXPECT_NE(contents(folder / "found_csv.csv").find("# servo_offset: "), std::string::npos);
  // The second round finds the same offset, because the joints of the unit follow the table now.
  write(folder / "first.json", first);
  knee_of("found_csv.csv", "true.json");
  EXPECT_NEAR(found("first.json", "found_csv.csv", "joint", 0), offset, 0.02 * degree);
  // Encoders that read more than the command by a constant, in two rounds.
  knee_of("base.csv", "base.json");
  EXPECT_EQ(found("base.json", "base.csv", "encoder", offset), 0);
  write(folder / "first.json", contents(folder / "found.json"));
  EXPECT_EQ(found("first.json", "base.csv", "encoder", offset), 0);
}

}  // namespace
}  // namespace ayumi::test
