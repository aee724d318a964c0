// Motions in the formats of other programs: round trips, recognition and mapping of joints. A file
// that cannot be read gives a message of one line.

#include "ayumi/io/formats/motion_formats.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <regex>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/io/robot/ztk.hpp"
#include "ayumi/io/yaml/yaml_tree.hpp"
#include "tests/io/moving_motion.hpp"
#include "tests/support/error_message.hpp"
#include "tests/support/hoap1.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ayumi::test {
namespace {

namespace fs = std::filesystem;

struct RoundTrip {
  std::string format;
  double angle, place;  // largest differences [rad, m]
  bool names, root;
  double rate = 50;
};

class MotionFormats : public testing::TestWithParam<RoundTrip> {};

TEST_P(MotionFormats, ReadsWhatItWrites) {
  const RoundTrip& expected = GetParam();
  const RobotModel& model = hoap1();
  const MotionFile written = moving(model, 40, expected.rate);
  const MotionFormat* format = find_motion_format(expected.format);
  ASSERT_TRUE(format && format->write);
  TemporaryFolder folder;
  std::string main;
  const std::vector<WrittenFile> first = format->write(model, written);
  for (const WrittenFile& file : first) {
    const fs::path path =
        (folder.path() / "motion")
            .replace_extension(file.extension.empty() ? ".motion" : file.extension);
    write_file(path, file.bytes);
    if (main.empty()) main = path.string();
  }
  ImportOptions options;
  options.by_order = !expected.names;
  if (!(format->holds & kRate)) options.rate = expected.rate;
  const ImportedMotion read = read_motion_rows(read_file(main), main, model, options);
  EXPECT_EQ(read.format, expected.format);
  EXPECT_FALSE(read.reason.empty());
  EXPECT_NEAR(read.motion.dt, 1 / expected.rate, 1e-12);
  ASSERT_EQ(read.motion.theta.rows(), written.rows());
  EXPECT_LE((read.motion.theta - written.values).cwiseAbs().maxCoeff(), expected.angle);
  ASSERT_EQ(read.motion.base.size(), expected.root ? written.base.size() : 0);
  for (size_t k = 0; k < read.motion.base.size(); ++k) {
    EXPECT_LE((read.motion.base[k].position - written.base[k].position).norm(), expected.place);
    EXPECT_LE(read.motion.base[k].attitude.angularDistance(written.base[k].attitude),
              expected.place + 2e-8);
  }
  // What was read and is written again is the same file.
  MotionFile again = written;
  again.values = read.motion.theta;
  if (expected.root) again.base = read.motion.base;
  if (!read.motion.zmp.empty()) again.zmp = read.motion.zmp;
  const std::vector<WrittenFile> second = format->write(model, again);
  ASSERT_EQ(second.size(), first.size());
  for (size_t k = 0; k < first.size(); ++k) EXPECT_EQ(second[k].bytes, first[k].bytes) << k;
}

INSTANTIATE_TEST_SUITE_P(
    Formats, MotionFormats,
    testing::Values(
        RoundTrip{"webots", 0, 0, true, false}, RoundTrip{"webots-1.1", 0, 0, true, false},
        RoundTrip{"choreonoid", 0, 0, true, true}, RoundTrip{"tracking-npz", 0, 0, true, true},
        RoundTrip{"gmr-npz", 0, 0, true, true},
        // The error is half a count of 4096 per turn; the servos have a period of 8 ms.
        RoundTrip{"op3-action", 0.5 * EIGEN_PI / 2048 + 1e-12, 0, true, false, 62.5},
        RoundTrip{"ros-trajectory", 0, 0, true, false},
        RoundTrip{"play-motion2", 0, 0, true, false},
        // The format has degrees with twelve digits.
        RoundTrip{"qianim", 1e-12, 0, true, false}, RoundTrip{"poppy-move", 1e-12, 0, true, false},
        RoundTrip{"open-duck", 0, 0, true, true}, RoundTrip{"deepmimic", 0, 0, true, true},
        RoundTrip{"zvs", 0, 1e-15, true, true}, RoundTrip{"transposed-csv", 0, 0, true, false},
        RoundTrip{"motion-csv", 0, 0, false, true}, RoundTrip{"hrpsys", 0, 1e-15, false, true}),
    [](const auto& info) {
      std::string name = info.param.format;
      std::replace_if(
          name.begin(), name.end(), [](char c) { return c == '-' || c == '.'; }, '_');
      return name;
    });

// Each text of a format is changed as other programs and people write it, and reads the same.
TEST(MotionFormats, VariantsOfOtherProgramsAreRead) {
  const MotionFile written = moving(hoap1(), 40, 50);
  const auto written_as = [&](const std::string& format) {
    return find_motion_format(format)->write(hoap1(), written).front().bytes;
  };
  const auto replaced = [](std::string text, const std::string& what, const std::string& with) {
    return std::regex_replace(text, std::regex(what), with);
  };
  const auto same = [&](const std::string& text, const std::string& format, const char* what) {
    SCOPED_TRACE(what);
    ImportOptions options;
    options.by_order = !(find_motion_format(format)->holds & kJointNames);
    if (!(find_motion_format(format)->holds & kRate)) options.rate = 50;
    ImportedMotion read;
    ASSERT_EQ(error_message([&] { read = read_motion_rows(text, "m.dat", hoap1(), options); }),
              "no error");
    EXPECT_EQ(read.format, format);
    ASSERT_EQ(read.motion.theta.rows(), written.rows());
    EXPECT_EQ((read.motion.theta - written.values).cwiseAbs().maxCoeff(), 0);
  };
  const std::string rows = written_as("motion-csv");
  same(replaced(rows, ",", ";"), "motion-csv", "semicolons");
  same(replaced(replaced(rows, ",", ";"), "\\.", ","), "motion-csv", "decimal commas");
  same(replaced(replaced(rows, ",", "\t"), "\\.", ","), "motion-csv", "decimal commas, tabs");
  for (const std::string separator : {",", ";", "\t", "  "})
    same("% recorded by me today\n% x; y, z\n" + replaced(rows, ",", separator), "motion-csv",
         ("comments above rows with '" + separator + "'").c_str());
  same(replaced(rows, ",", "\t"), "motion-csv", "tabs");
  same(replaced(rows, ",", "  "), "motion-csv", "blanks");
  same(replaced(rows, "\n", ",\n"), "motion-csv", "a comma at the end of each row");
  same(replaced(rows, "([^,\n]+)", "\"$1\""), "motion-csv", "quotes");
  same(replaced(rows, ",([0-9])", ",+$1"), "motion-csv", "signs");
  const std::string joints = written_as("transposed-csv");
  same(replaced(joints, "time", "Time"), "transposed-csv", "a capital letter");
  same(replaced(joints, "time", "time [s]"), "transposed-csv", "a unit");
  same(replaced(joints, "\n", ",\n"), "transposed-csv", "a comma at the end of each row");
  same(replaced(joints, ",", ";"), "transposed-csv", "semicolons");
  same(replaced(replaced(joints, ",", "\t"), "\\.", ","), "transposed-csv", "decimal commas, tabs");
  same(replaced(replaced(joints, ",", "\t"), "\n", "\t\n"), "transposed-csv",
       "a tab at the end of each row");
  const std::string poses = written_as("webots");
  std::string capitals = poses;
  for (size_t i = 0; i < capitals.find('\n'); ++i)
    capitals[i] = static_cast<char>(std::toupper(static_cast<unsigned char>(capitals[i])));
  same(capitals, "webots", "capital letters");
  same(replaced(poses, "\n", ",\n"), "webots", "a comma at the end of each row");
  same(replaced(poses, "\n([0-9:]*),Pose7,", "\n\n# lifts the foot\n$1,Pose7,"), "webots",
       "an empty line and a comment");
  same(replaced(poses, "V1.0,(.*)", "V1.0,\n$1"), "webots", "names below an open first line");
  // A pose may have no name, or one that begins with #; its row is no comment.
  const std::string durations = written_as("webots-1.1");
  same(replaced(durations, "\nplay", "\n"), "webots-1.1", "poses without names");
  same(replaced(durations, "\nplay", "\n#play"), "webots-1.1", "poses that are called #play");
  same(replaced(durations, "V1.1", "V1.1,"), "webots-1.1", "a comma at the end of the first line");
  same(durations + "# the end\n", "webots-1.1", "a comment");
  same("% recorded\n" + written_as("hrpsys"), "hrpsys", "a comment");
  const std::string trajectory = written_as("ros-trajectory");
  const size_t points = trajectory.find("points:"), names = trajectory.find("joint_names");
  same("play_motion:\n  motions:\n    walk:\n      joints" +
           trajectory.substr(names + 11, points - names - 11) + "      " +
           replaced(trajectory.substr(points), "\n", "\n      ") + "\n",
       "play-motion2", "points, as in ROS 1");
  // YAML may be written as JSON.
  std::string json;
  for (Eigen::Index k = 0; k < written.rows(); ++k) {
    std::vector<std::string> angles;
    for (const double angle : written.values.row(k)) angles.push_back(text::exact(angle));
    json += std::string(k > 0 ? ", " : "") + "{\"positions\": [" + text::join(angles, ", ") +
            "], \"time_from_start\": " + text::exact(written.times[static_cast<size_t>(k)]) + "}";
  }
  same("{\"joint_names\": [\"" + text::join(written.joints, "\", \"") + "\"], \"points\": [" +
           json + "]}",
       "ros-trajectory", "JSON");
  const std::string body = written_as("choreonoid");
  same(replaced(replaced(body, "JointDisplacement", "MultiJointDisplacementSeq"), "LinkPosition",
                "MultiLinkPositionSeq"),
       "choreonoid", "the contents of version 3");
  same("% recorded\n" + written_as("zvs"), "zvs", "a comment");
  same(replaced(written_as("zvs"), "(\\( .*[0-9]) ([-0-9.]+ \\))", "$1\n$2"), "zvs",
       "rows over several lines");
}

std::string refusal_of(const std::string& bytes, const std::string& file = "m.dat",
                       ImportOptions options = {}) {
  return error_message([&] { read_motion_rows(bytes, file, hoap1(), options); });
}

// A root at 1e30 m, which a damaged number can cause, is no motion.
TEST(MotionFormats, PlacesThatNoMotionReachesAreRefused) {
  const auto rows = [](const std::string& x) {
    std::string text;
    for (int k = 0; k < 8; ++k) {
      text += (k == 4 ? x : "0") + ",0,0.3,0,0,0,1";
      for (int j = 0; j < hoap1().dof_count(); ++j) text += ",0." + std::to_string(k);
      text += "\n";
    }
    return text;
  };
  ImportOptions options;
  options.by_order = true;
  options.rate = 30;
  EXPECT_EQ(refusal_of(rows("12"), "m.csv", options), "no error");
  const std::string refused = refusal_of(rows("1e30"), "m.csv", options);
  EXPECT_TRUE(
      refused.starts_with("m.csv: row 5: a coordinate of the root is 1e+30 m, but at most 10 km "
                          "are possible; correct the file"))
      << refused;
}

TEST(MotionFormats, ForeignFilesAreNamed) {
  EXPECT_NE(refusal_of(std::string("\x80\x04\x95\x00", 4)).find("a Python pickle"),
            std::string::npos);
  EXPECT_NE(refusal_of("#ROSBAG V2.0\n").find("a ROS 1 bag"), std::string::npos);
  EXPECT_NE(refusal_of("\x57\xE0\xE0\x57\x10\xC0\xC0\x10").find("a Havok animation"),
            std::string::npos);
  EXPECT_NE(refusal_of("BLENDER-v300").find("a scene of Blender"), std::string::npos);
  EXPECT_NE(refusal_of("{\"asset\": {\"version\": \"2.0\"}, \"nodes\": []}").find("a glTF scene"),
            std::string::npos);
  EXPECT_NE(refusal_of("<?xml version=\"1.0\"?><mvnx version=\"4\"/>").find("Xsens"),
            std::string::npos);
  EXPECT_NE(refusal_of(std::string("\0\0\0\x18"
                                   "ftypmp42",
                                   12))
                .find("a video"),
            std::string::npos);
  EXPECT_NE(refusal_of(std::string("PK\x03\x04\x14\0\0\0", 8)).find("that was cut off"),
            std::string::npos);
  EXPECT_NE(refusal_of(std::string("PK\x03\x04\x14\0\0\0", 8) + "poses.npy trans.npy PK\x05\x06")
                .find("of a person"),
            std::string::npos);
  EXPECT_NE(refusal_of("Kaydara FBX Binary  ").find("an FBX scene"), std::string::npos);
  EXPECT_NE(refusal_of("<?xml version=\"1.0\"?><a/>", "m.mtnx").find("R+ Motion"),
            std::string::npos);
  EXPECT_NE(refusal_of("<?xml version=\"1.0\"?><a/>").find("an XML file"), std::string::npos);
  std::string c3d(512, '\0');
  c3d[0] = 2;
  c3d[1] = 'P';
  EXPECT_NE(refusal_of(c3d).find("a C3D recording"), std::string::npos);
  EXPECT_NE(refusal_of("(dp0\nVfps\np1\n", "m.pkl").find("a Python pickle"), std::string::npos);
  EXPECT_NE(refusal_of("Coordinates\nversion=1\nendheader\ntime\tknee\n0\t1\n").find("OpenSim"),
            std::string::npos);
  for (const char* const htr :
       {"[Header]\nFileType htr\n", "#Created by a program\r\n[Header]\r\nFileType htr\r\n",
        "# a remark\n[Header]  # another\nFileType htr # hierarchical\n"})
    EXPECT_NE(refusal_of(htr).find("an HTR recording"), std::string::npos) << htr;
  EXPECT_NE(refusal_of("<Root type=\"Motion\"/>").find("R+ Motion"), std::string::npos);
  EXPECT_NE(refusal_of("#VRML V2.0 utf8\nPROTO Joint [\n]\n").find("a VRML scene"),
            std::string::npos);
  EXPECT_NE(refusal_of("solid foot\n facet normal 0 0 1\n  outer loop\n").find("an STL mesh"),
            std::string::npos);
  EXPECT_NE(refusal_of("# a person\n:version 1.10\n:name x\n").find("a skeleton of ASF/AMC"),
            std::string::npos);
  EXPECT_NE(refusal_of(":FULLY-SPECIFIED\n:DEGREES\n1\nroot 1 2 3\n").find("ASF/AMC"),
            std::string::npos);
  EXPECT_NE(refusal_of("This robot, as I said, walks at 3 m/s.\nIt has no motion here.\n")
                .find("this is a text without rows of numbers"),
            std::string::npos);
  // Numbers under words that are separated by blanks are a table with wrong separators.
  EXPECT_NE(
      refusal_of("time l_knee r_knee\n0 0.1 0.2\n").find("the columns are separated by blanks"),
      std::string::npos);
  for (const std::string& name : read_format_names())
    EXPECT_NE(refusal_of("???").find(name), std::string::npos) << name;
}

TEST(MotionFormats, MistakesNameFileLineAndFormat) {
  const std::string head = "#WEBOTS_MOTION,V1.0,l_knee,r_knee\n";
  const std::string webots =
      ". Ayumi read the file in the format 'webots' (Webots .motion), because the first line "
      "begins "
      "with #WEBOTS_MOTION";
  EXPECT_EQ(refusal_of(head + "00:00:000,a,0,0\n00:00:040,b,0\n"),
            "m.dat:3: the row has 3 cells, but the head row needs 4 (2 joints)" + webots);
  EXPECT_EQ(refusal_of(head + "00:00:000,a,0,0\n00:00:040,b,0"),
            "m.dat:3: the row has 3 cells, but the head row needs 4 (2 joints); the file may be "
            "truncated" +
                webots);
  EXPECT_EQ(refusal_of(head + "00:00:000,a,0,nan\n"),
            "m.dat:2: column r_knee: 'nan' is not a finite number" + webots);
  EXPECT_EQ(refusal_of("#WEBOTS_MOTION,V3.0,l_knee\n"),
            "m.dat:1: version 'V3.0' is unknown; Ayumi reads V1.0 and V1.1" + webots);
  EXPECT_EQ(
      refusal_of("time,0,1\nl_knee,0,1\nr_knee,0\n"),
      "m.dat:3: the row of 'r_knee' has 1 value, but the first row has 2 times. Ayumi read the "
      "file in the format 'transposed-csv' (CSV with a row for each joint), because the first "
      "row has times, so each further row is a joint");
  EXPECT_EQ(
      refusal_of("0.02 3 ( 1 2 )\n"),
      "m.dat:1: the row has 2 values between the brackets, but its number of values, n, is 3. "
      "Ayumi read the file in the format 'zvs' (mi-lib .zvs), because the rows have the form "
      "`dt n ( values )`");
  EXPECT_EQ(
      refusal_of("0.02 2 ( 1 2 )\n0.02 2 ( 1 2\n"),
      "m.dat:2: the bracket ( is not closed, so the row was cut; copy the file again. Ayumi "
      "read the file in the format 'zvs' (mi-lib .zvs), because the rows have the form `dt n ( "
      "values )`");
  EXPECT_TRUE(refusal_of("0.02 2 ( 1\n2 )\n0.02 2 ( 1\n0.02 2 ( 1 2 )\n")
                  .starts_with("m.dat:3: the bracket ( is not closed"));
  EXPECT_NE(refusal_of(R"({"framerate": 50, "positions": {"0.0": {"l_knee": [1,5, 0]}}})")
                .find("expected an angle, or [angle, speed], found 3 numbers"),
            std::string::npos);
  EXPECT_NE(refusal_of(R"({"framerate": 50, "positions": {"0.0": {"l_knee": [1, [2]]}}})")
                .find("/positions/0.0/l_knee/1: expected "),
            std::string::npos);
  const ImportOptions stated{.format = "webots"};
  EXPECT_EQ(refusal_of("#WEBOTS_MOTION,V3.0,l_knee\n", "m.dat", stated),
            "m.dat:1: version 'V3.0' is unknown; Ayumi reads V1.0 and V1.1. Ayumi read the file in "
            "the format 'webots' (Webots .motion)");
  EXPECT_NE(refusal_of("0 0.1 0,2\n0.1 0.1 0.2\n0.2 0 0\n", "m.pos").find("not "),
            std::string::npos);
  EXPECT_NE(refusal_of("type: CompositeSeq\ncontent: BodyMotion\ncomponents:\n  - [ 1, 2\n")
                .find("not valid YAML"),
            std::string::npos);
  EXPECT_NE(refusal_of("type: CompositeSeq\ncontent: BodyMotion\ntype: a\ncomponents: []\n")
                .find("m.dat:3: the key 'type' appears twice in one map; keep one"),
            std::string::npos);
  EXPECT_NE(
      refusal_of("type: CompositeSeq\ncontent: BodyMotion\nformat_version: 7\ncomponents: []\n")
          .find("Ayumi reads versions 1 to 4"),
      std::string::npos);
}

TEST(MotionFormats, TheRobotBesideAZvsNamesItsJoints) {
  const RobotModel& model = hoap1();
  const MotionFile written = moving(model, 40, 50);
  const std::vector<WrittenFile> files = find_motion_format("zvs")->write(model, written);
  ASSERT_EQ(files.size(), 2u);
  TemporaryFolder folder;
  const std::string main = (folder.path() / "m.zvs").string();
  const fs::path robot = folder.path() / "m.ztk";
  write_file(main, files[0].bytes);
  EXPECT_NE(refusal_of(files[0].bytes, main).find("without names; give --order"),
            std::string::npos);
  // This robot has its joints in another order than the model.
  std::vector<std::string> turned = model.dof_names();
  std::reverse(turned.begin(), turned.end());
  write_file(robot, ztk_text(model.description(), turned));
  const ImportedMotion read = read_motion_rows(files[0].bytes, main, model, {});
  for (int i = 0; i < model.dof_count(); ++i)
    EXPECT_EQ(read.motion.theta.col(i), written.values.col(model.dof_count() - 1 - i)) << i;
  EXPECT_EQ(read.motion.base.size(), written.base.size());
  // A robot with another number of joints, and one that cannot be read, are reported and not used.
  turned.pop_back();
  for (const std::string& other :
       {ztk_text(model.description(), turned), std::string("[roki::chain]\n[roki::link]\n")}) {
    write_file(robot, other);
    EXPECT_NE(refusal_of(files[0].bytes, main).find("give --order"), std::string::npos);
    ImportOptions options;
    options.by_order = true;
    const ImportedMotion ordered = read_motion_rows(files[0].bytes, main, model, options);
    EXPECT_EQ(ordered.motion.theta, written.values);
    EXPECT_TRUE(std::any_of(ordered.filled.begin(), ordered.filled.end(), [](const auto& note) {
      return note.find("is not used") != std::string::npos;
    }));
  }
}

TEST(MotionFormats, JointsAreMappedByNameAndByOrderOnlyOnRequest) {
  std::string rows;
  for (int k = 0; k < 10; ++k) {
    rows += "0,0,0.25,0,0,0,1";
    for (int j = 0; j < hoap1().dof_count(); ++j) rows += ",0." + std::to_string(k);
    rows += "\n";
  }
  EXPECT_NE(refusal_of(rows).find("20 joint columns without names; give --order"),
            std::string::npos)
      << refusal_of(rows);
  // An order of 20 joints does not fit 19 columns.
  const std::string fewer = refusal_of(std::regex_replace(rows, std::regex(",[^,]*\n"), "\n"));
  EXPECT_NE(fewer.find("19 joint columns without names, but 'hoap1' has 20 joints"),
            std::string::npos)
      << fewer;
  EXPECT_EQ(fewer.find("--order"), std::string::npos) << fewer;
  ImportOptions options;
  options.by_order = true;
  EXPECT_NE(refusal_of(rows, "m.csv", options).find("Give --rate HZ"), std::string::npos);
  options.rate = 30;
  const ImportedMotion read = read_motion_rows(rows, "m.csv", hoap1(), options);
  EXPECT_EQ(read.motion.dt, 1.0 / 30);
  EXPECT_EQ(read.motion.theta(5, 3), 0.5);

  std::string webots = "#WEBOTS_MOTION,V1.0,l_knee,r_knee,HeadYaw\n";
  for (int k = 0; k < 10; ++k) webots += std::to_string(40 * k) + ",p,0.1,*,0\n";
  const ImportedMotion some = read_motion_rows(webots, "m.motion", hoap1());
  std::string said;
  for (const std::string& line : some.filled) said += line + "\n";
  EXPECT_NE(said.find("unknown joints are left out: HeadYaw\n"), std::string::npos) << said;
  EXPECT_NE(
      said.find("these joints are missing in the file and keep the angles of the home posture: "),
      std::string::npos);
  const std::string other = "#WEBOTS_MOTION,V1.0,l_knee,A,B,C\n0,p,0,0,0,0\n40,p,0,0,0,0\n";
  EXPECT_NE(refusal_of(other).find("of its 4 joints only l_knee are joints of"), std::string::npos)
      << refusal_of(other);
}

TEST(MotionFormats, TrajectoriesFollowEachOtherOrRunTogether) {
  const auto one = [](const std::string& joint, double to) {
    return "joint_names: [" + joint +
           "]\npoints:\n  - positions: [0]\n    time_from_start: {sec: 0, " +
           "nanosec: 0}\n  - positions: [" + std::to_string(to) +
           "]\n    time_from_start: {sec: 0, nanosec: 500000000}\n";
  };
  const std::string text =
      one("l_knee", 1) + "---\n" + one("r_knee", 0.5) + "---\n" + one("l_knee", 0.2);
  const ImportedMotion read = read_motion_rows(text, "t.yaml", hoap1());
  ASSERT_EQ(read.motion.theta.rows(), 101);
  EXPECT_EQ(read.motion.theta(50, hoap1().find_dof("l_knee")), 1);
  EXPECT_NEAR(read.motion.theta(100, hoap1().find_dof("l_knee")), 0.2, 1e-12);
  EXPECT_EQ(read.motion.theta(100, hoap1().find_dof("r_knee")), 0.5);
}

TEST(MotionFormats, DamagedArchivesAndActionFilesAreRefused) {
  const MotionFile motion = moving(hoap1());
  const std::string npz = find_motion_format("gmr-npz")->write(hoap1(), motion)[0].bytes;
  EXPECT_NE(refusal_of(npz.substr(0, npz.size() / 2)).find("truncated"), std::string::npos)
      << refusal_of(npz.substr(0, npz.size() / 2));
  MotionFile bad = motion;
  bad.values(3, 2) = std::nan("");
  EXPECT_NE(refusal_of(find_motion_format("gmr-npz")->write(hoap1(), bad)[0].bytes)
                .find("not a finite number"),
            std::string::npos);
  EXPECT_NE(refusal_of(std::string(256 * 512, '\0')).find("no page has both steps"),
            std::string::npos);
}

TEST(MotionFormats, WrittenOnlyFormatsHaveARowForEachRow) {
  const MotionFile motion = moving(hoap1());
  const std::string bvh = find_motion_format("bvh")->write(hoap1(), motion)[0].bytes;
  EXPECT_NE(bvh.find("Frames: 40\nFrame Time: 0.02\n"), std::string::npos);
  EXPECT_EQ(std::count(bvh.begin(), bvh.end(), '{'), std::count(bvh.begin(), bvh.end(), '}'));
  const std::string keys = find_motion_format("mujoco-keys")->write(hoap1(), motion)[0].bytes;
  EXPECT_NE(keys.find("<key name=\"k39\" time=\"0.78\" qpos=\"0.39 "), std::string::npos);
}

// The motion passes through the keys, and does not swing beyond them.
TEST(MotionFormats, KeysAreMet) {
  const std::string text = "time,0,0.5,1.5\nl_knee,0,1,1\nr_knee,0,0.5,1\n";
  const ImportedMotion read = read_motion_rows(text, "k.csv", hoap1());
  EXPECT_EQ(read.format, "transposed-csv");
  const auto knee = read.motion.theta.col(hoap1().find_dof("l_knee"));
  ASSERT_EQ(knee.size(), 151);
  EXPECT_EQ(knee[0], 0);
  EXPECT_EQ(knee[50], 1);
  EXPECT_LE(knee.maxCoeff(), 1 + 1e-12);
  const ImportedMotion scaled =
      read_motion_rows("time [ms],0,500,1500\nl_knee,0,1,1\nr_knee,0,0.5,1\n", "k.csv", hoap1());
  EXPECT_EQ(scaled.format, "transposed-csv");
  EXPECT_EQ(scaled.motion.dt, read.motion.dt);
  EXPECT_EQ(scaled.motion.theta, read.motion.theta);
}

// A row of words below the joints, as in soccerbot's files, does not name joints. A word among
// numbers is a mistake.
TEST(MotionFormats, RowsOfWordsAreNoJoints) {
  const std::string keys = "time,0.5,1.5,2\nl_knee,0,1,1\nr_knee,0,0.5,1\n";
  const ImportedMotion read =
      read_motion_rows(keys + "comment,stance,x,step, to balance\n", "k.csv", hoap1());
  EXPECT_EQ(read.motion.theta, read_motion_rows(keys, "k.csv", hoap1()).motion.theta);
  const auto is_note = [](const std::string& line) {
    return line.find("row 'comment' (line 4) has words and no numbers") != std::string::npos;
  };
  EXPECT_EQ(std::count_if(read.filled.begin(), read.filled.end(), is_note), 1);
  EXPECT_NE(refusal_of(keys + "l_elbow,0,x,0\n", "k.csv").find("k.csv:4: value 2: 'x'"),
            std::string::npos);
  EXPECT_NE(refusal_of(keys + "l_elbow,a,b,c\n", "k.csv").find("k.csv:4: value 1: 'a'"),
            std::string::npos);
}

// The robot stands in its home posture, with the soles `height` [m] above the ground in each row.
RawMotion standing(const std::vector<double>& height, double dt) {
  const RobotModel& model = hoap1();
  RawMotion motion;
  motion.dt = dt;
  motion.theta = model.posture().transpose().replicate(static_cast<Eigen::Index>(height.size()), 1);
  RobotData data(model);
  const RobotState state = model.rest_state();
  update_positions(model, state, data);
  for (const double z : height) {
    BasePose base;
    base.position.z() = z - sole_pose(model, data, Side::left).translation().z();
    motion.base.push_back(base);
  }
  return motion;
}

TEST(MotionFormats, SolesThatHoverCarryAndSolesThatFallDoNot) {
  std::vector<double> hovers, jumps;
  for (int k = 0; k < 100; ++k) {
    hovers.push_back(0.005 + 0.004 * std::sin(0.1 * k));
    const double t = 0.02 * (k - 40);  // it is in the air from row 40 to row 60
    jumps.push_back(k < 40 || k > 60 ? 0 : 0.5 * 9.80665 * t * (0.4 - t));
  }
  const RawMotion hovering = standing(hovers, 0.02);
  for (const Support support : detect_supports(hoap1(), hovering))
    EXPECT_EQ(support, Support::both);
  const std::vector<Support> jump = detect_supports(hoap1(), standing(jumps, 0.02));
  EXPECT_EQ(jump[20], Support::both);
  EXPECT_EQ(jump[50], Support::none);
  EXPECT_EQ(jump[90], Support::both);
  const GroundedMotion found = grounded(hoap1(), hovering, "t.csv");
  ASSERT_EQ(found.notes.size(), 1u);
  EXPECT_NE(found.notes[0].find("supporting soles are up to 9 mm above the ground (--ground"),
            std::string::npos)
      << found.notes[0];
  const RawMotion low = put_on_ground(hoap1(), hovering);
  EXPECT_TRUE(grounded(hoap1(), low, "t.csv").notes.empty());
}

// A recording is cut off at both ends: a knee turns at 1 rad/s all the time, and the root moves
// forward.
TEST(MotionFormats, RampsLetARecordingBeginAndEndAtRest) {
  RawMotion motion = standing(std::vector<double>(60, 0), 0.02);
  const int knee = hoap1().find_dof("l_knee");
  for (int k = 0; k < 60; ++k) {
    motion.theta(k, knee) = 0.02 * k;
    motion.base[static_cast<size_t>(k)].position.x() = 0.004 * k;
    motion.zmp.emplace_back(0.004 * k, 0, 0);
  }
  motion.support.assign(60, Support::both);
  const CutEnds cut = cut_ends(hoap1(), motion);
  EXPECT_TRUE(cut.begin && cut.end);
  ASSERT_EQ(cut.words.size(), 2u);
  EXPECT_NE(cut.words[0].find("begins while the robot moves (l_knee at 57.3 deg/s)"),
            std::string::npos)
      << cut.words[0];
  EXPECT_NE(cut.words[0].find("--ramp"), std::string::npos);
  const RawMotion ramped = with_ramps(hoap1(), motion, 0.4);
  ASSERT_EQ(ramped.theta.rows(), 80);
  ASSERT_EQ(ramped.support.size(), 80u);
  EXPECT_TRUE(ramped.zmp.empty());
  EXPECT_EQ(ramped.theta.middleRows(20, 40), motion.theta.middleRows(10, 40));
  EXPECT_EQ(ramped.theta.row(0), motion.theta.row(0));
  EXPECT_EQ(ramped.theta.row(79), motion.theta.row(59));
  double jump = 0;  // largest jump of the rate, from rest at both ends [rad/s]
  for (int k = 0; k <= 79; ++k) {
    const double before = k > 0 ? ramped.theta(k, knee) - ramped.theta(k - 1, knee) : 0;
    const double after = k < 79 ? ramped.theta(k + 1, knee) - ramped.theta(k, knee) : 0;
    EXPECT_GE(after, -1e-12);
    EXPECT_NEAR(ramped.base[static_cast<size_t>(k)].position.x(), 0.2 * ramped.theta(k, knee),
                1e-12);
    jump = std::max(jump, std::abs(after - before) / 0.02);
  }
  // A minimum-jerk ramp from 0 to 1 rad/s in 20 rows has at most 1.875 / 20; without a ramp the
  // jump is 1.
  EXPECT_LT(jump, 0.1);
  EXPECT_TRUE(cut_ends(hoap1(), ramped).words.empty());
  EXPECT_NE(error_message([&] { with_ramps(hoap1(), motion, 2); }).find("too long for a motion"),
            std::string::npos);
  const RawMotion still = standing(std::vector<double>(60, 0), 0.02);
  EXPECT_EQ(with_ramps(hoap1(), still, 0.4).theta.rows(), 60);
}

// The right foot twitches for a moment, while the COG is between the feet and far from either.
TEST(MotionFormats, AFootThatTheCogIsFarFromDoesNotCarryAlone) {
  RawMotion motion = standing(std::vector<double>(100, 0), 0.01);
  const RobotModel& model = hoap1();
  const auto turn = [&](const char* joint, double angle, int first, int count) {
    motion.theta.col(model.find_dof(joint)).segment(first, count).array() += angle;
  };
  for (const auto& [joint, angle] : {std::pair{"l_hip_roll", 0.25},
                                     {"l_ankle_roll", -0.25},
                                     {"r_hip_roll", -0.25},
                                     {"r_ankle_roll", 0.25}})
    turn(joint, angle, 0, 100);
  const auto twitch = [&](int first, int count) {
    turn("r_knee", 0.3, first, count);
    turn("r_hip_pitch", -0.15, first, count);
    turn("r_ankle_pitch", -0.15, first, count);
  };
  // The height is approximate, because the lowest sole is found anyway.
  for (BasePose& base : motion.base) base.position.z() -= 0.01;
  twitch(50, 3);
  const std::vector<Support> brief = detect_supports(model, motion);
  EXPECT_EQ(std::count(brief.begin(), brief.end(), Support::both), 100);
  twitch(20, 25);  // a quarter of a second is more than a moment
  const std::vector<Support> longer = detect_supports(model, motion);
  EXPECT_EQ(longer[32], Support::left);
  EXPECT_EQ(longer[51], Support::both);
}

TEST(MotionFormats, OneOfSeveralMotionsIsChosen) {
  const auto motion_text = [](const std::string& name, double to) {
    return "      " + name + ":\n        joints: [l_knee]\n        positions: [0, " +
           std::to_string(to) + "]\n        times_from_start: [0, 0.5]\n";
  };
  const std::string text = "/play_motion2:\n  ros__parameters:\n    motions:\n" +
                           motion_text("wave", 1) + motion_text("bow", 0.5);
  const auto last = [&](const std::string& motion) {
    ImportOptions options;
    options.motion = motion;
    const ImportedMotion read = read_motion_rows(text, "p.yaml", hoap1(), options);
    return read.motion.theta(read.motion.theta.rows() - 1, hoap1().find_dof("l_knee"));
  };
  EXPECT_EQ(last(""), 1);
  EXPECT_EQ(last("wave"), 1);
  EXPECT_EQ(last("bow"), 0.5);
  EXPECT_EQ(last("2"), 0.5);
  ImportOptions options;
  options.motion = "jump";
  EXPECT_NE(refusal_of(text, "p.yaml", options)
                .find("there is no motion 'jump'; the motions of the file are 1 'wave', 2 'bow'"),
            std::string::npos);

  // These are two pages of an action file that do not follow each other.
  MotionFile short_motion = moving(hoap1(), 7, 62.5);
  short_motion.name = "nod";
  std::string bytes = find_motion_format("op3-action")->write(hoap1(), short_motion)[0].bytes;
  constexpr size_t kPage = 512, kSum = 31;
  std::string page = bytes.substr(kPage, kPage);
  page.replace(0, 3, "sit");
  page[kSum] = 0;
  unsigned sum = 0;
  for (const char c : page) sum += static_cast<unsigned char>(c);
  page[kSum] = static_cast<char>(0xff - sum);
  bytes.replace(9 * kPage, kPage, page);
  options.motion = "9";
  std::string said;
  for (const std::string& line : read_motion_rows(bytes, "a.bin", hoap1(), options).filled)
    said += line + "\n";
  EXPECT_NE(said.find("the motion 9 'sit' is read; the motions of the file are 1 'nod', 9 'sit'"),
            std::string::npos)
      << said;
}

// In an earlier version, a damaged page was played if another page led to it, and a file that was
// cut off had no known format.
TEST(MotionFormats, DamagedPagesOfAnActionFileAreRefused) {
  MotionFile motion = moving(hoap1(), 15, 62.5);
  motion.name = "nod";
  const std::string bytes = find_motion_format("op3-action")->write(hoap1(), motion)[0].bytes;
  constexpr size_t kPage = 512, kHead = 64, kSum = 31, kStepCount = 20;
  const auto with = [&](size_t page, size_t at, int value, bool sums) {
    std::string changed = bytes;
    changed[page * kPage + at] = static_cast<char>(value);
    unsigned sum = 0;
    for (size_t i = 0; i < kPage; ++i)
      if (i != kSum) sum += static_cast<unsigned char>(changed[page * kPage + i]);
    if (sums) changed[page * kPage + kSum] = static_cast<char>(0xff - sum);
    return refusal_of(changed, "a.bin");
  };
  const std::string damaged =
      "a.bin: page 2 belongs to the motion, but it is damaged (wrong checksum";
  EXPECT_EQ(with(2, kHead, 1, false).find(damaged), 0u);
  EXPECT_EQ(with(2, kStepCount, 9, true).find(damaged), 0u);
  EXPECT_EQ(with(2, kHead + 3, 0x1f, true).find("a.bin: page 2, step 1, servo 1: the position "),
            0u);
  EXPECT_EQ(refusal_of(bytes.substr(0, 3000), "a.bin")
                .find("a.bin: the file has 3000 bytes, but an action file has 131072; "),
            0u);
}

TEST(MotionFormats, KeyPosesOfAnotherVersionOrWithAJointTwiceAreRefused) {
  const std::string head = "type: PoseSeq\nname: a\n",
                    keys =
                        "refs:\n"
                        "  - {time: 0, refer: {type: Pose, joints: [0, 1], q: [0, 0]}}\n"
                        "  - {time: 1, refer: {type: Pose, joints: [0, 1], q: [0, 0.1]}}\n";
  const ImportOptions by_order{.by_order = true};
  const auto refusal = [&](const std::string& text) {
    return error_message([&] { read_key_poses(text, "m.pseq", hoap1(), by_order); });
  };
  const auto replaced = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  EXPECT_EQ(refusal("# Body pose sequence format version 1.0 defined by cnoid\n" + head + keys),
            "no error");
  EXPECT_EQ(refusal("# Body pose sequence format version 2.0 defined by cnoid\n" + head + keys)
                .find("m.pseq:1: format version '2.0' is unknown; Ayumi reads version 1.0"),
            0u);
  EXPECT_EQ(
      refusal(head + "format_version: 9\n" + keys).find("m.pseq:3: format version '9' is unknown"),
      0u);
  EXPECT_EQ(refusal(replaced(head + keys, "[0, 1], q: [0, 0.1]", "[1, 1], q: [0, 0.1]"))
                .find("m.pseq:5: joints: the joint 1 is there twice; keep one"),
            0u);
  std::string many = head + "refs:\n";
  for (int i = 0; i <= 20'000; ++i) many += "  - {time: 0, refer: {type: Pose}}\n";
  EXPECT_EQ(refusal(many).find(
                "m.pseq: the file has 20001 key poses, but import reads at most 20000; export"),
            0u);
  EXPECT_EQ(refusal("# Body pose sequence format version 1.0, by a program\n" + head + keys),
            "no error");
  // "refer:" within a word does not count as a key.
  std::string remarks;
  for (int i = 0; i <= 20'000; ++i) remarks += "# prefer:\n";
  EXPECT_EQ(refusal(head + remarks + keys), "no error");
  // The character that marks lists is written as such, and as an escape.
  for (const std::string del : {"\x7f", "\\x7f"})
    EXPECT_EQ(refusal(replaced(head, "PoseSeq\n", "PoseSeq\nlabel: \"a" + del + "\"\n") + keys),
              "no error");
  EXPECT_EQ(refusal(replaced(head + keys, "PoseSeq", "PoseSequel"))
                .find("m.pseq:1: type 'PoseSequel' is unknown; Ayumi reads PoseSeq"),
            0u);
}

// Lists of numbers are not read by the parser; text that only looks like such a list is read as
// before.
TEST(MotionFormats, ListsOfNumbersInYamlAreThoseOfTheParser) {
  const YamlNode root = parse_yaml(
      "a: [ 1, -2.5e-3 , +3 ]\n"
      "b: text [1, 2]\n"
      "c: [[ 1 ], [ 2, x ], []]\n"
      "d: \"[1,\n  2]\"  # [3]\n"
      "e: |\n  [1, 2]\n"
      "f: [1 2]\n",
      "m.yaml");
  EXPECT_EQ(root.find("a")->numbers, (std::vector<double>{1, -2.5e-3, 3}));
  EXPECT_EQ(root.find("b")->text, "text [1, 2]");
  EXPECT_EQ(root.find("c")->items[0].numbers, std::vector<double>{1});
  EXPECT_EQ(root.find("c")->items[1].items[0].text, "2");
  EXPECT_TRUE(root.find("c")->items[2].is_list());
  EXPECT_EQ(root.find("d")->text, "[1, 2]");
  EXPECT_EQ(root.find("e")->text, "[1, 2]\n");
  EXPECT_EQ(root.find("f")->items[0].text, "1 2");
  const YamlNode lists = parse_yaml("a: [ 1, -2.5e-3 ]\nb:\n  - [ 3, 4 ]\nc: [ .nan, 1 ]\n", "m");
  EXPECT_EQ(lists.find("a")->numbers, (std::vector<double>{1, -2.5e-3}));
  EXPECT_EQ(lists.find("b")->items[0].numbers, (std::vector<double>{3, 4}));
  EXPECT_EQ(lists.find("c")->items.size(), 2u);
  EXPECT_EQ(lists.find("c")->line, 4);
}

TEST(MotionFormats, AChangeInTheLastRowMakesNoPhase) {
  RawMotion motion = standing(std::vector<double>(20, 0), 0.02);
  motion.support.assign(20, Support::both);
  motion.support.back() = Support::left;
  const Pattern pattern = grounded(hoap1(), motion, "t.csv").pattern;
  ASSERT_EQ(pattern.phases.size(), 1u);
  EXPECT_NEAR(pattern.phases[0].until, 0.38, 1e-12);
}

// These are real files of other projects. Their robots are not here, so that the joints of this
// robot are renamed after them.
TEST(MotionFormats, RealFilesAreRead) {
  const fs::path data = fs::path(AYUMI_SOURCE_DIR) / "../shared/data";
  if (!fs::exists(data)) GTEST_SKIP() << "no real files";
  int tried = 0;
  for (const auto& entry : fs::directory_iterator(data / "nao_webots_motion")) {
    const std::string file = entry.path().string();
    if (entry.path().extension() != ".motion") continue;
    const std::string bytes = read_file(file);
    // For another robot, the message says which joints match.
    EXPECT_NE(refusal_of(bytes, file).find("this is a motion of another robot"), std::string::npos);
    ++tried;
  }
  EXPECT_EQ(tried, 7);
}

}  // namespace
}  // namespace ayumi::test
