// Broken input of every kind gives one clear complaint and exit code 3; nothing is written, and
// nothing crashes.

#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <numbers>

#include "tests/cli/program.hpp"

namespace ayumi::test {
namespace {

struct Broken {
  std::string name;
  /// Puts the broken input into the folder and returns the command line.
  std::function<std::vector<std::string>(const Folder&)> prepare;
  std::string complaint;  ///< text that the one line on stderr must contain
};
std::ostream& operator<<(std::ostream& out, const Broken& broken) { return out << broken.name; }

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

std::string bundled(const std::string& file) { return contents(fs::path(AYUMI_SOURCE_DIR) / file); }

const char* const kInertia =
    "<inertial><mass value='1'/><inertia ixx='0.01' ixy='0' ixz='0' iyy='0.01' iyz='0' "
    "izz='0.01'/></inertial>";

/// A robot of two links and a joint.
std::string small_urdf() {
  const std::string inertia = kInertia;
  return "<robot name='small'><link name='trunk'>" + inertia + "</link><link name='arm'>" +
         inertia +
         "</link><joint name='elbow' type='revolute'><parent link='trunk'/><child link='arm'/>"
         "<axis xyz='0 1 0'/><limit lower='-1' upper='1' velocity='5' effort='3'/></joint>"
         "</robot>";
}

/// The case of `inspect` with small_urdf() after one change.
Broken urdf(const std::string& name, const std::string& from, const std::string& to,
            const std::string& complaint) {
  return {name,
          [=](const Folder& folder) -> std::vector<std::string> {
            write(folder / "robot.urdf", replaced(small_urdf(), from, to));
            return {"inspect", "robot.urdf"};
          },
          complaint};
}

/// The case of `inspect` with HOAP-1's sidecar after one change.
Broken sidecar(const std::string& name, const std::string& from, const std::string& to,
               const std::string& complaint) {
  return {name,
          [=](const Folder& folder) -> std::vector<std::string> {
            fs::copy(fs::path(AYUMI_SOURCE_DIR) / "robots/hoap1", folder.path(),
                     fs::copy_options::recursive);
            write(folder / "robot.json", replaced(bundled("robots/hoap1/robot.json"), from, to));
            return {"inspect", "robot.json"};
          },
          complaint};
}

/// A round outline, as JSON.
std::string outline_of(int corners) {
  std::string text;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners;
    text += (i == 0 ? "[[" : "], [") + std::to_string(0.04 * std::cos(angle)) + ", " +
            std::to_string(0.04 * std::sin(angle));
  }
  return text + "]]";
}

/// The case of `inspect` with a file of the given bytes.
Broken robot_file(const std::string& name, const std::string& file, const std::string& bytes,
                  const std::string& complaint) {
  return {name,
          [=](const Folder& folder) -> std::vector<std::string> {
            write(folder / file, bytes);
            return {"inspect", file};
          },
          complaint};
}

std::vector<Broken> broken_robots() {
  const std::string inertia = kInertia;
  return {
      {"missing",
       [](const Folder&) {
         return std::vector<std::string>{"inspect", "no.urdf"};
       },
       "no.urdf"},
      robot_file("empty_urdf", "a.urdf", "", "a.urdf"),
      robot_file("no_xml", "a.urdf", "this is not a robot", "a.urdf"),
      robot_file("cut_off_xml", "a.urdf", small_urdf().substr(0, 300), "a.urdf"),
      robot_file("empty_sidecar", "a.json", "", "the file is empty"),
      robot_file("cut_off_json", "a.json", "{\"name\": \"x\",", "a.json:1:"),
      robot_file("array_as_sidecar", "a.json", "[]", "expected an object"),
      robot_file("binary_sidecar", "a.json", std::string("\0\1\2\3\xff\xfe", 6), "a.json"),
      {"folder_without_sidecar",
       [](const Folder& folder) -> std::vector<std::string> {
         fs::create_directories(folder / "empty");
         return {"inspect", "empty"};
       },
       "empty"},
      {"folder_named_like_a_file",
       [](const Folder& folder) -> std::vector<std::string> {
         fs::create_directories(folder / "robot.urdf");
         return {"inspect", "robot.urdf"};
       },
       "robot.urdf"},
      urdf("without_inertia", "<link name='arm'>" + inertia, "<link name='arm'>", "arm"),
      urdf("zero_mass", "<mass value='1'/>", "<mass value='0'/>", "trunk"),
      urdf("negative_mass", "<mass value='1'/>", "<mass value='-1'/>", "trunk"),
      urdf("nan_mass", "<mass value='1'/>", "<mass value='nan'/>", "trunk"),
      urdf("huge_mass", "<mass value='1'/>", "<mass value='1e300'/>", "trunk"),
      urdf("word_as_mass", "<mass value='1'/>", "<mass value='heavy'/>", "trunk"),
      urdf("impossible_inertia", "ixx='0.01'", "ixx='-0.01'", "trunk"),
      urdf("loop", "<parent link='trunk'/><child link='arm'/>",
           "<parent link='arm'/><child link='arm'/>", "arm"),
      urdf("unknown_link", "<child link='arm'/>", "<child link='hand'/>", "hand"),
      urdf("two_roots", "</robot>", "<link name='lonely'>" + inertia + "</link></robot>", "lonely"),
      urdf("axis_of_length_zero", "xyz='0 1 0'", "xyz='0 0 0'", "elbow"),
      urdf("limits_reversed", "lower='-1' upper='1'", "lower='1' upper='-1'", "elbow"),
      urdf("unknown_joint_type", "type='revolute'", "type='wobbly'", "elbow"),
      urdf("link_named_twice", "</robot>", "<link name='arm'>" + inertia + "</link></robot>",
           "arm"),
      sidecar("urdf_missing", "robot.urdf", "gone.urdf", "gone.urdf"),
      sidecar("sole_of_33_corners",
              "[[-0.042, -0.0315], [0.056, -0.0315], [0.056, 0.0315], [-0.042, 0.0315]]",
              outline_of(33), "33 corners, but at most 32"),
      sidecar("unknown_key", "\"joint_order\"", "\"joint_ordr\"", "did you mean 'joint_order'?"),
      sidecar("wrong_foot_name", "\"l_foot\"", "\"l_foott\"", "did you mean 'l_foot'?"),
      sidecar("unknown_joint", "\"r_hip_pitch\": -17.258", "\"r_hip_ptch\": -17.258",
              "did you mean 'r_hip_pitch'?"),
      sidecar("posture_beyond_limit", "\"r_knee\": 43.576", "\"r_knee\": 300",
              "/postures_deg/home/r_knee: the joint 'r_knee' is at 300 deg, above its limit of 120 "
              "deg"),
      sidecar("limits_in_degrees", "\"trunk_link\"",
              "\"position_limits_deg\": {\"r_knee\": [10, -10]}, \"trunk_link\"",
              "robot.json: /position_limits_deg/r_knee: the lower limit 10 deg exceeds the upper "
              "limit -10 deg"),
      sidecar("unknown_gain", "\"tau_z\": 0.01", "\"tau_y\": 0.01",
              "robot.json: /control/dtad/tau_y: dtad has no gain 'tau_y'"),
      sidecar("wrong_type", "\"servo_period\": 0.001", "\"servo_period\": \"fast\"",
              "/servo_period"),
      sidecar("readings_older_than_the_motion", "\"latency\": 0.003", "\"latency\": 1e9",
              "robot.json: /sensors/latency"),
      sidecar("key_twice", "\"servo_period\": 0.001", "\"servo_period\": 1, \"servo_period\": 1",
              "servo_period"),
      {"name_that_steers_the_terminal",
       [](const Folder&) {
         return std::vector<std::string>{"inspect", "\x1b[2J\u202egone.urdf"};
       },
       "\\x1b[2J\\u202egone.urdf"},
      {"no_permission",
       [](const Folder& folder) -> std::vector<std::string> {
         write(folder / "secret.urdf", small_urdf());
         fs::permissions(folder / "secret.urdf", fs::perms::none);
         return {"inspect", "secret.urdf"};
       },
       "secret.urdf"},
  };
}

/// A correct pattern with one step of HOAP-1.
const char* const kPattern = R"({
  "format": "ayumi.pattern/1",
  "robot": "hoap1",
  "units": { "angle": "deg" },
  "phases": [
    { "until": 0.8, "support": "both" },
    { "until": 1.2, "support": "left", "swing": { "foot": "right", "to": [0.02, -0.039] } },
    { "until": 2.0, "support": "both" }
  ],
  "keyframes": [
    { "t": 0.0, "zmp": "center" },
    { "t": 0.8, "zmp": "left" },
    { "t": 1.2, "zmp": "left" },
    { "t": 1.6, "zmp": "center", "posture": { "l_elbow": -30 } }
  ],
  "controller": { "type": "dtad", "gains": { "q": 0.25 } },
  "scenario": [
    { "type": "impulse", "at": 1.0, "duration": 0.02, "direction": [0, -1, 0], "impulse": 0.3 }
  ]
})";

/// The commands that read a pattern, up to the name of the pattern.
const std::map<std::string, std::vector<std::string>>& pattern_commands() {
  static const std::map<std::string, std::vector<std::string>> commands = {
      {"check", {"check", "--quiet"}},
      {"export", {"export", "--quiet", "--format", "csv", "-o", "out.csv"}},
      {"repair", {"repair", "--quiet", "-o", "out.json"}},
      {"run", {"run", "--quiet", "-o", "out"}},
      {"simulate", {"simulate", "--quiet", "-o", "out"}}};
  return commands;
}

/// kPattern with one change. The command comes before the pattern's name.
Broken pattern(const std::string& name, const std::string& from, const std::string& to,
               const std::string& complaint) {
  return {name,
          [=](const Folder& folder) -> std::vector<std::string> {
            write(folder / "p.json", replaced(kPattern, from, to));
            return {"p.json"};
          },
          complaint};
}

std::vector<Broken> broken_patterns() {
  return {
      {"missing", [](const Folder&) { return std::vector<std::string>{"no.json"}; }, "no.json"},
      {"folder",
       [](const Folder& folder) -> std::vector<std::string> {
         fs::create_directories(folder / "p.json");
         return {"p.json"};
       },
       "p.json"},
      {"empty",
       [](const Folder& folder) -> std::vector<std::string> {
         write(folder / "p.json", "");
         return {"p.json"};
       },
       "p.json: the file is empty"},
      pattern("bad_json", "\"robot\": \"hoap1\",", "\"robot\": \"hoap1\"",
              "p.json:3:19: a comma is missing after \"hoap1\""),
      pattern("unknown_format", "ayumi.pattern/1", "ayumi.pattern/9", "/format"),
      pattern("unknown_robot", "hoap1", "hoap7", "p.json: /robot: robot 'hoap7': no such file"),
      pattern("unknown_profile", "\"robot\": \"hoap1\",",
              "\"robot\": \"hoap1\", \"profile\": \"hoap1-strng\",",
              "p.json: /profile: the robot 'hoap1' has no actuator profile 'hoap1-strng'; known: "),
      pattern("missing_include", "\"phases\"", "\"include\": [\"a.json\"], \"phases\"",
              "p.json: /include/0: a.json: no such file"),
      pattern("missing_table", "\"phases\"", "\"table\": \"a.csv\", \"phases\"",
              "p.json: /table: a.csv: no such file"),
      pattern("unknown_key", "\"keyframes\"", "\"keyframe\"", "/keyframe: "),
      pattern("unknown_joint", "l_elbow", "l_elbw",
              "/keyframes/3: the robot 'hoap1' has no joint 'l_elbw'; did you mean 'l_elbow'?"),
      pattern("unknown_posture", "{ \"l_elbow\": -30 }", "\"hoem\"", "/keyframes/3"),
      pattern("time_not_increasing", "\"t\": 1.2", "\"t\": 0.8", "/keyframes/2/t"),
      pattern("phases_not_increasing", "\"until\": 1.2", "\"until\": 0.5", "/phases/1/until"),
      pattern("not_a_number", "\"t\": 1.6", "\"t\": NaN", "p.json:14:12: "),
      pattern("infinite", "\"t\": 1.6", "\"t\": 1e999", "p.json"),
      pattern("huge_number", "[0.02, -0.039]", "[2e30, -0.039]", "/phases/1/swing/to"),
      pattern("out_of_reach", "[0.02, -0.039]", "[2, -0.039]", "the right foot is out of reach"),
      pattern("wrong_unit", "\"angle\": \"deg\"", "\"angle\": \"grad\"", "/units/angle"),
      pattern("wrong_length_unit", "\"angle\": \"deg\"", "\"angle\": \"deg\", \"length\": \"mm\"",
              "/units/length"),
      pattern("number_with_unit", "\"until\": 2.0", "\"until\": \"2 s\"", "/phases/2/until"),
      pattern("wrong_type", "\"scenario\": [", "\"scenario\": {}, \"world\": [", "expected an"),
      pattern("empty_phases", R"("phases": [
    { "until": 0.8, "support": "both" },
    { "until": 1.2, "support": "left", "swing": { "foot": "right", "to": [0.02, -0.039] } },
    { "until": 2.0, "support": "both" }
  ])",
              "\"phases\": []", "/phases"),
      pattern("unknown_foot", "\"foot\": \"right\"", "\"foot\": \"middle\"",
              "/phases/1/swing/foot"),
      pattern("swing_of_a_supporting_foot", "\"foot\": \"right\"", "\"foot\": \"left\"",
              "/phases/1/swing"),
      pattern("unknown_controller", "\"dtad\"", "\"dtda\"", "/controller/type"),
      pattern("unknown_gain", "\"q\": 0.25", "\"kq\": 0.25",
              "p.json: /controller: controller gains: dtad has no gain 'kq'"),
      pattern("unknown_tolerance", "\"controller\"",
              "\"tolerances\": { \"zmp\": 1 }, \"controller\"",
              "p.json: /tolerances: there is no kind of finding 'zmp'"),
      pattern("direction_of_length_zero", "[0, -1, 0]", "[0, 0, 0]", "/scenario/0/direction"),
      pattern("negative_duration", "\"duration\": 0.02", "\"duration\": -0.02",
              "/scenario/0/duration"),
      pattern("table_missing", "\"controller\"", "\"table\": \"gone.csv\", \"controller\"",
              "gone.csv: no such file"),
  };
}

/// The case of `simulate` with kPattern after one change, or with more words.
Broken simulation(const std::string& name, const std::string& from, const std::string& to,
                  const std::string& complaint, const std::vector<std::string>& more = {}) {
  return {name,
          [=](const Folder& folder) -> std::vector<std::string> {
            write(folder / "p.json", replaced(kPattern, from, to));
            std::vector<std::string> words = {"simulate", "--quiet", "p.json", "-o", "out"};
            words.insert(words.end(), more.begin(), more.end());
            return words;
          },
          complaint};
}

std::vector<Broken> broken_simulations() {
  return {
      simulation("push_on_an_unknown_link", "\"type\": \"impulse\"",
                 "\"on\": \"tail\", \"type\": \"impulse\"", "tail"),
      simulation("unknown_profile", "", "", "known: hoap1, hoap1-soft, hoap1-strong",
                 {"--profile", "hoap"}),
      simulation("scenario_file_missing", "", "", "gone.json", {"--scenario", "gone.json"}),
      {"output_folder_in_the_way",
       [](const Folder& folder) -> std::vector<std::string> {
         write(folder / "p.json", kPattern);
         write(folder / "out", "a file");
         return {"simulate", "--quiet", "p.json", "-o", "out"};
       },
       "out"},
  };
}

/// Every broken pattern with every command that reads patterns.
std::vector<Broken> broken_patterns_by_command() {
  std::vector<Broken> all;
  for (const auto& [command, words] : pattern_commands())
    for (const Broken& broken : broken_patterns())
      all.push_back({command + "_" + broken.name,
                     [words, broken](const Folder& folder) {
                       std::vector<std::string> line = words;
                       for (const std::string& word : broken.prepare(folder)) line.push_back(word);
                       return line;
                     },
                     broken.complaint});
  return all;
}

class BrokenInput : public testing::TestWithParam<Broken> {};

TEST_P(BrokenInput, IsRefusedWithOneClearLine) {
  const Folder folder;
  const std::vector<std::string> command = GetParam().prepare(folder);
  if (GetParam().name == "no_permission" && ::geteuid() == 0)
    GTEST_SKIP() << "root may read everything";
  const std::vector<std::string> before = folder.files();
  const Output output = run_program(command, folder.path());
  EXPECT_EQ(output.exit_code, 3) << output.err;
  if (command.front() != "run") {  // run names each pattern at its beginning
    EXPECT_EQ(output.out, "");
  }
  EXPECT_NE(output.err.find(GetParam().complaint), std::string::npos) << output.err;
  EXPECT_EQ(line_count(output.err), 1) << output.err;
  EXPECT_EQ(folder.files(), before) << "nothing is written";
}

std::string name_of_case(const testing::TestParamInfo<Broken>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Robots, BrokenInput, testing::ValuesIn(broken_robots()), name_of_case);

INSTANTIATE_TEST_SUITE_P(Patterns, BrokenInput, testing::ValuesIn(broken_patterns_by_command()),
                         name_of_case);

INSTANTIATE_TEST_SUITE_P(Simulations, BrokenInput, testing::ValuesIn(broken_simulations()),
                         name_of_case);

// The pattern that the cases above change is itself correct.
TEST(SoundInput, IsTaken) {
  const Folder folder;
  write(folder / "p.json", kPattern);
  for (const auto& [command, words] : pattern_commands()) {
    std::vector<std::string> line = words;
    if (command == "run") line.push_back("--no-pictures");
    line.push_back("p.json");
    const Output output = run_program(line, folder.path());
    EXPECT_TRUE(output.exit_code == 0 || output.exit_code == 1) << command << ": " << output.err;
    fs::remove_all(folder / "out");
  }
}

// A word of a file may have a megabyte; the message about it still fits on a screen.
TEST(LongMessage, LosesItsMiddle) {
  const Folder folder;
  write(folder / "p.json",
        replaced(kPattern, "\"robot\"", "\"" + std::string(1'000'000, 'a') + "\": 1, \"robot\""));
  for (const char* option : {"--quiet", "--json"}) {
    const Output output = run_program({"check", "p.json", option}, folder.path());
    EXPECT_EQ(output.exit_code, 3);
    EXPECT_LT(output.err.size(), 2200u);
    EXPECT_LT(output.out.size(), 2400u);
    EXPECT_NE(output.err.find("p.json"), std::string::npos);
    // It says how much is left out, and is shortened once.
    for (const std::string& text : {output.err, output.out}) {
      if (text.empty()) continue;
      const size_t cut = text.find(" ... (");
      ASSERT_NE(cut, std::string::npos) << text;
      EXPECT_GT(std::stoul(text.substr(cut + 6)), 990'000u) << text;
    }
  }
}

// Names come from files of strangers and are printed, so that none may control the terminal of the
// reader.
TEST(SoundInput, NamesAreShownWithoutControlCharacters) {
  const Folder folder;
  write(folder / "p.json",
        replaced(kPattern, "\"robot\"", "\"name\": \"\\u001b[2J\\u202ekcehc\", \"robot\""));
  for (const auto& [command, words] : pattern_commands()) {
    std::vector<std::string> line = words;
    line.erase(std::remove(line.begin(), line.end(), "--quiet"), line.end());
    if (command == "run") line.push_back("--no-pictures");
    line.push_back("p.json");
    const Output output = run_program(line, folder.path());
    EXPECT_TRUE(output.exit_code == 0 || output.exit_code == 1) << command << ": " << output.err;
    for (const std::string& text : {output.out, output.err}) {
      EXPECT_EQ(text.find('\x1b'), std::string::npos) << command << ": " << text;
      EXPECT_EQ(text.find("\u202e"), std::string::npos) << command << ": " << text;
    }
    fs::remove_all(folder / "out");
  }
}

// In an earlier version, the program used up all memory.
TEST(StandardInput, WithoutEndIsRefused) {
  const std::string command = program_under_test() + " check - 2>&1 </dev/zero";
  FILE* const program = ::popen(command.c_str(), "r");
  ASSERT_TRUE(program);
  std::string said;
  std::array<char, 4096> block;
  while (const size_t got = std::fread(block.data(), 1, block.size(), program))
    said.append(block.data(), got);
  const int status = ::pclose(program);
  EXPECT_EQ(WEXITSTATUS(status), 3) << said;
  EXPECT_NE(said.find("ayumi: standard input: more than 67108864 bytes came"), std::string::npos)
      << said;
}

}  // namespace
}  // namespace ayumi::test
