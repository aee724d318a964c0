#include "ayumi/report/report.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/report/html.hpp"
#include "ayumi/report/page.hpp"
#include "tests/cli/program.hpp"
#include "tests/render/box_robot.hpp"
#include "tests/support/json.hpp"

namespace ayumi::test {
namespace {

struct Made {
  RobotModel model = box_robot();
  SimulationLog open = box_run(model), closed = box_run(model);
  ReportInput input;

  Made() {
    open.controller = ControllerKind::none;
    open.result.outcome = Outcome::fell;
    open.result.fell_at = 0.8;
    open.samples.resize(450);
    closed.scenario = {
        {.at = 0.1, .duration = 0.3, .what = FloorPath{.tilt = {0.1, 0}, .shift = {0, 0, 0.02}}},
        {.at = 0.2, .duration = 9, .what = Bump{.height = 0.01}}};
    closed.world.blocks = {{.low = {0.2, 0.2}, .high = {0.3, 0.4}, .height = 0.03}};
    closed.provenance.command_line = "ayumi run a<b>.json";
    closed.events.push_back({0.3, EventKind::push, "0.4 N s on cog"});
    input.title = "sway & <push>";
    input.runs = {{"open loop", &open}, {"closed loop", &closed}};
  }
};

/// The page of Made, which is made once for all tests that only read it.
const Report& whole_page() {
  static const Made made;
  static const Report report = make_report(made.model, made.input);
  return report;
}

TEST(Report, SaysTheVerdictFirst) {
  Made made;
  const std::string& html = whole_page().html;
  const size_t verdict = html.find(
      "The closed loop (dtad) <span class=\"good\">stands</span>, "
      "pushed with 0.4 N s at 0.3 s.");
  ASSERT_NE(verdict, std::string::npos);
  EXPECT_LT(verdict, html.find("id=\"replay\""));
  EXPECT_LT(html.find("id=\"replay\""), html.find("id=\"loci\""));
  EXPECT_NE(html.find("<span class=\"bad\">falls at 0.80 s</span>"), std::string::npos);
  EXPECT_NE(html.find("<title>sway &amp; &lt;push&gt;</title>"), std::string::npos);
  EXPECT_NE(html.find("ayumi run a&lt;b&gt;.json"), std::string::npos);
  EXPECT_EQ(html.find("<push>"), std::string::npos) << "names are text, not tags";
  EXPECT_EQ(html, make_report(made.model, made.input).html) << "the same input, the same bytes";
}

TEST(Report, ShowsFindingsRepairAndThresholds) {
  Made made;
  ConsistencyReport check;
  check.findings.push_back({.kind = FindingKind::support_margin,
                            .begin = 0.2,
                            .end = 0.4,
                            .at = 0.3,
                            .worst = -0.012,
                            .unit = "m",
                            .where = "left foot",
                            .hint = "move the ZMP inwards"});
  made.input.results.check = check;
  made.input.results.repair = RepairNote{"infeasible", 0.1, 0.02, 17, {"l_knee has no room"}};
  made.input.results.safety = ExportNote{false, 1.2, "l_knee", {"step of l_knee at 0.100 s"}};
  made.input.thresholds.push_back({"left foot", "dtad", 0.5, M_PI / 2, 0.83, 0.21, 1.1, true});
  const std::string html = make_report(made.model, made.input).html;
  for (const char* words :
       {"Verdict: not good", "<span class=\"bad\">inconsistent</span>", "move the ZMP inwards",
        "0.20 to 0.40 s, worst at", "l_knee has no room", "step of l_knee at 0.100 s", "0.83+",
        "<td class=\"number\">90</td>", "<td class=\"number\">0.75</td>"})
    EXPECT_NE(html.find(words), std::string::npos) << words;
}

// One entry for each cause: neighbours, both sides and consequences are put together.
TEST(Report, GroupsFindings) {
  Made made;
  ConsistencyReport check;
  for (int i = 0; i < 12; ++i)
    check.findings.push_back({.kind = FindingKind::joint_speed,
                              .begin = 0.1 * i,
                              .end = 0.1 * i + 0.05,
                              .at = 0.1 * i + 0.02,
                              .worst = 5.0 + i,
                              .limit = 4.7,
                              .unit = "rad/s",
                              .where = made.model.dofs()[i % 2].name,
                              .hint = "turn it more slowly"});
  check.findings.push_back({.kind = FindingKind::table_step,
                            .severity = Severity::warning,
                            .begin = 0.1,
                            .end = 0.2,
                            .at = 0.15,
                            .worst = 12345.6,
                            .limit = 57,
                            .unit = "counts",
                            .where = made.model.dofs()[0].name,
                            .hint = "",
                            .cause = 0});
  made.input.results.check = check;
  const std::string html = make_report(made.model, made.input).html;
  const size_t from = html.find("id=\"findings\"");
  ASSERT_NE(from, std::string::npos);
  const std::string found = html.substr(from, html.find("Figures of the check", from) - from);
  size_t entries = 0;
  for (size_t at = 0; (at = found.find("<li>", at)) != std::string::npos; ++at) ++entries;
  EXPECT_LE(entries, 2u) << found;
  EXPECT_NE(found.find("consequences: table_step"), std::string::npos) << found;
  EXPECT_NE(found.find(": 12300 counts, limit 57 counts"), std::string::npos) << found;
}

// In an earlier version, "0 % of the limit" was written for robots that state no limit.
TEST(Report, SaysWhichLimitsAreNotStatedAndHowSoftTheSolesAre) {
  Made made;
  ASSERT_FALSE(has_limit(made.model, FindingKind::continuous_torque));
  made.input.results.check = ConsistencyReport{};
  const std::string html = make_report(made.model, made.input).html;
  EXPECT_NE(html.find("no limit is stated"), std::string::npos);
  const size_t soft = html.find("softness of the soles");
  ASSERT_NE(soft, std::string::npos);
  EXPECT_NE(html.find("kN/m, damping time 4 ms", soft), std::string::npos);
  EXPECT_EQ(html.find("does not use these values"), std::string::npos);
  made.closed.plant = "mujoco";
  EXPECT_NE(
      make_report(made.model, made.input).html.find("The plant mujoco does not use these values"),
      std::string::npos);
  RobotDescription stated = made.model.description();
  for (auto& [side, sole] : stated.soles) sole.stiffness = 1e5;
  EXPECT_NE(
      make_report(RobotModel(stated), made.input).html.find("along the normal of the sole only"),
      std::string::npos);
}

// Lengths are in mm and angles in deg wherever they occur, with three digits.
TEST(Report, NamesTheJointAndTheTimeOfTheLargestShares) {
  Made made;
  ReportOptions plain;
  plain.replay = false;
  EXPECT_EQ(make_report(made.model, made.input, plain).html.find(">42 ("), std::string::npos);
  made.closed.result.torque = {.ratio = 0.42, .joint = 0, .at = 0.25};
  const std::string cell = ">42 (" + made.closed.joints[0] + " at 0.25 s)</td>";
  EXPECT_NE(make_report(made.model, made.input, plain).html.find(cell), std::string::npos) << cell;
}

TEST(Report, HasOneUnitPerQuantity) {
  Made made;
  ConsistencyReport check;
  check.findings.push_back({.kind = FindingKind::support_margin,
                            .worst = -0.0123456,
                            .limit = 0.002,
                            .unit = "m",
                            .where = "left foot",
                            .hint = ""});
  check.findings.push_back({.kind = FindingKind::joint_position,
                            .worst = 1.2345,
                            .limit = 1.0,
                            .unit = "rad",
                            .where = "knee",
                            .hint = ""});
  made.input.results.check = check;
  made.closed.result.max_slip = 0.0012345;
  made.closed.result.max_tilt = 0.2;
  ReportOptions plain;
  plain.replay = false;
  const std::string html = make_report(made.model, made.input, plain).html;
  for (const char* words : {": -12.3 mm, limit 2 mm<", ": 70.7 deg, limit 57.3 deg<", ">1.23<",
                            ">11.5<", "COG x [mm]", "x [mm]"})
    EXPECT_NE(html.find(words), std::string::npos) << words;
  std::string read = html;  // the text without scripts, in which the same letters may occur
  for (size_t at = 0; (at = read.find("<script", at)) != std::string::npos;)
    read.erase(at, read.find("</script>", at) - at);
  for (const char* words : {"[m]", " rad<"})
    EXPECT_EQ(read.find(words), std::string::npos) << words;
}

TEST(Report, OnlyWhatIsGoodIsGreen) {
  Made made;
  made.closed.result.outcome = Outcome::unsettled;
  made.input.results.check = ConsistencyReport{};
  made.input.results.check->consistent = false;
  made.input.results.repair = RepairNote{"repaired", 0.1, 0.02, 17, {}};
  made.input.results.safety = ExportNote{true, 0.2, "l_knee", {}};
  ReportOptions plain;
  plain.replay = false;
  const std::string bad = make_report(made.model, made.input, plain).html;
  EXPECT_EQ(bad.find("class=\"good\""), std::string::npos);
  EXPECT_NE(bad.find("inconsistent as written, but it was repaired"), std::string::npos);
  made.closed.result.outcome = Outcome::stands;
  const std::string good = make_report(made.model, made.input, plain).html;
  EXPECT_NE(good.find("<span class=\"good\">stands</span>"), std::string::npos);
}

// The page has every phase and law of a study, whatever directions it has.
TEST(Report, ShowsThePushMap) {
  Made made;
  for (const char* phase : {"left foot", "standing"})
    for (const double direction : {0.0, 2.1, 4.2})
      for (const char* law : {"dtad", "viip"})
        made.input.thresholds.push_back({phase, law, 0.5, direction, 0.83, 0.21, 1.1, false});
  ReportOptions plain;
  plain.replay = false;
  const std::string html = make_report(made.model, made.input, plain).html;
  const size_t map = html.find("Largest survivable impulse by phase and direction");
  ASSERT_NE(map, std::string::npos);
  const std::string drawn = html.substr(map, html.find("</svg>", map) - map);
  for (const char* words : {"left foot", "standing", "dtad", "viip", "open loop"})
    EXPECT_NE(drawn.find(words), std::string::npos) << words;
}

TEST(Report, TimesOfEventsTakeTheReplayThere) {
  EXPECT_NE(whole_page().html.find("<a href=\"#stage\" data-time=\"0.300\">0.300</a>"),
            std::string::npos);
}

TEST(Report, KeepsItsSizeAndSaysWhatItLeftOut) {
  Made made;
  ReportOptions small;
  small.max_bytes = 400'000;
  const Report less = make_report(made.model, made.input, small);
  EXPECT_LE(less.html.size(), small.max_bytes);
  EXPECT_LT(less.html.size(), whole_page().html.size());
  ASSERT_FALSE(less.caps.empty());
  for (const std::string& cap : less.caps)
    EXPECT_NE(less.html.find(html::escaped(cap)), std::string::npos) << cap;
  EXPECT_NE(less.caps.back().find("0.4 MB"), std::string::npos) << less.caps.back();
  small.max_bytes = 1000;
  const Report least = make_report(made.model, made.input, small);
  EXPECT_EQ(least.caps.back().find("the page is larger than 0.001 MB"), 0u) << least.caps.back();
}

TEST(Report, ARunIsNeeded) {
  Made made;
  made.input.runs.clear();
  EXPECT_THROW(make_report(made.model, made.input), Error);
  SimulationLog empty;
  made.input.runs = {{"closed loop", &empty}};
  EXPECT_THROW(make_report(made.model, made.input), Error);
}

TEST(Report, LoadsAndReplaysInABrowser) {
  if (!has_replay()) GTEST_SKIP() << "built without npm: there is no replay to try";
  if (std::string(AYUMI_CHROMEDRIVER).empty())
    GTEST_SKIP() << "chromium-driver is not installed: the page is not tried in a browser";
  const Folder folder;
  write(folder / "report.html", whole_page().html);
  const Output said = run_program(
      {AYUMI_SOURCE_DIR "/tests/report/browser.mjs", AYUMI_CHROMEDRIVER, folder / "report.html"},
      folder.path(), AYUMI_NODE);
  EXPECT_EQ(said.exit_code, 0) << said.out << said.err;
  EXPECT_EQ(said.out, "ok\n");
}

TEST(AuthorPage, PartsThatNeedNoBrowser) {
  if (std::string(AYUMI_NODE).empty()) GTEST_SKIP() << "node is not installed";
  const Folder folder;
  const Output said = run_program({"--test", AYUMI_SOURCE_DIR "/tests/report/author_parts.mjs"},
                                  folder.path(), AYUMI_NODE);
  EXPECT_EQ(said.exit_code, 0) << said.out << said.err;
}

// Runs the trials in a script on the live page of a pattern.
void expect_page_works(const std::string& script, const Folder& folder, const char* pattern) {
  const fs::path file = folder / pattern;
  const Output said = run_program({AYUMI_SOURCE_DIR "/tests/report/" + script, AYUMI_CHROMEDRIVER,
                                   file, "--", program_under_test(), "author", file},
                                  folder.path(), AYUMI_NODE);
  EXPECT_EQ(said.exit_code, 0) << said.out << said.err;
  EXPECT_EQ(said.out, "ok\n");
}

TEST(AuthorPage, IsWorkedWithInABrowser) {
  if (kAuthorPage.empty()) GTEST_SKIP() << "built without npm: there is no page to try";
  if (std::string(AYUMI_CHROMEDRIVER).empty())
    GTEST_SKIP() << "chromium-driver is not installed: the page is not tried in a browser";
  const Folder folder;
  // The bundled walk without its last five steps; the trials change the part before them.
  ASSERT_EQ(run_program({"new", "walk", "--steps", "3", "-q", "-o", "three.json"}, folder.path())
                .exit_code,
            0);
  // The trials read the file as JSON, which has no comments.
  std::istringstream lines(contents(folder / "three.json"));
  std::string walk;
  for (std::string line; std::getline(lines, line);)
    if (!line.starts_with("//")) walk += line + "\n";
  walk.insert(walk.rfind('}'), R"(, "scenario": [{ "type": "impulse", "at": 3, "duration": 0.02,
    "on": "cog", "direction": [0, 1, 0], "impulse": 1.1 }]
)");
  write(folder / "walk.json", walk);
  expect_page_works("author_browser.mjs", folder, "walk.json");
}

// The robot is humanoid30 with seven fingers on each hand, which makes 44 joints.
void write_robot_with_fingers(const Folder& folder) {
  fs::create_directories(folder / "fingers");
  fs::create_symlink(AYUMI_SOURCE_DIR "/robots/humanoid30/meshes", folder / "fingers/meshes");
  std::string urdf = contents(AYUMI_SOURCE_DIR "/robots/humanoid30/robot.urdf");
  std::string fingers, names;
  for (const std::string side : {"l", "r"})
    for (int i = 0; i < 7; ++i) {
      const std::string name = side + "_finger_" + std::to_string(i);
      names += ", \"" + name + "\"";
      fingers += "<link name=\"" + name +
                 "_link\"><inertial><origin xyz=\"0 0 -0.015\"/><mass value=\"0.01\"/>"
                 "<inertia ixx=\"1e-5\" ixy=\"0\" ixz=\"0\" iyy=\"1e-5\" iyz=\"0\" "
                 "izz=\"1e-5\"/></inertial></link>\n<joint name=\"" +
                 name + "\" type=\"revolute\"><parent link=\"" + side + "_hand\"/><child link=\"" +
                 name + "_link\"/><origin xyz=\"0 " + text::fixed(0.008 * (i - 3), 3) +
                 " -0.12\"/><axis xyz=\"0 1 0\"/><limit lower=\"-1\" upper=\"1\" effort=\"1\" "
                 "velocity=\"12\"/></joint>\n";
    }
  write(folder / "fingers/robot.urdf", urdf.insert(urdf.rfind("</robot>"), fingers));
  std::string sidecar = contents(AYUMI_SOURCE_DIR "/robots/humanoid30/robot.json");
  const std::string last = "\"head_roll\", \"head_pitch\"";
  write(folder / "fingers/robot.json", sidecar.insert(sidecar.find(last) + last.size(), names));
}

// A minute of standing, in which a hand and the gaze move from target to target.
std::string minute_of_targets() {
  std::string keys;
  for (int i = 0; i < 15; ++i) {
    const double t = 2 + 4 * i, side = i % 2 == 0 ? 1 : -1;
    keys += ",\n  {\"t\": " + text::exact(t) + ", \"cog\": {\"y\": " + text::exact(0.01 * side) +
            "}, \"hands\": {\"left\": [0.2, " + text::exact(0.25 + 0.02 * side) +
            ", 0.6]}, \"gaze\": [1.5, " + text::exact(0.2 * side) +
            ", 1], \"joints\": {\"r_elbow\": " + text::exact(-40 - 5 * side) + "}}";
  }
  return "{\"format\": \"ayumi.pattern/1\", \"name\": \"targets\", \"units\": {\"angle\": "
         "\"deg\"}, \"robot\": \"./fingers\",\n"
         "\"phases\": [{\"until\": 60, \"support\": \"both\"}],\n\"keyframes\": [\n"
         "  {\"t\": 0, \"posture\": \"home\", \"cog\": {\"y\": 0}}" +
         keys + "]}";
}

TEST(AuthorPage, ShowsTargetsOfManyJointsForAMinute) {
  if (kAuthorPage.empty()) GTEST_SKIP() << "built without npm: there is no page to try";
  if (std::string(AYUMI_CHROMEDRIVER).empty())
    GTEST_SKIP() << "chromium-driver is not installed: the page is not tried in a browser";
  const Folder folder;
  write_robot_with_fingers(folder);
  // The text is as the trials write it.
  write(folder / "targets.json", json_of(minute_of_targets()).dump(1));
  expect_page_works("author_targets.mjs", folder, "targets.json");
}

TEST(Html, Base64OfEveryRemainder) {
  EXPECT_EQ(html::base64(""), "");
  EXPECT_EQ(html::base64("f"), "Zg==");
  EXPECT_EQ(html::base64("fo"), "Zm8=");
  EXPECT_EQ(html::base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(html::base64(std::string("\xff\xfe\x00", 3)), "//4A");
}

TEST(Html, NothingInJsonEndsAScript) {
  EXPECT_EQ(html::quoted("</script>&\"\n"), "\"\\u003c/script\\u003e\\u0026\\\"\\u000a\"");
}

}  // namespace
}  // namespace ayumi::test
