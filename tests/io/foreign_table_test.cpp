// Tables as spreadsheets and other programs write them, and one clear line for those that cannot be
// read.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "ayumi/base/error.hpp"
#include "ayumi/io/formats/hoap.hpp"
#include "ayumi/io/table/motion_import.hpp"
#include "tests/support/degree.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi::test {
namespace {

using test::kDegree;

ImportedMotion read(const std::string& text, ImportOptions options = {}) {
  return read_motion(text, "a.csv", hoap1(), options);
}

std::string refusal(const std::string& text, ImportOptions options = {}) {
  try {
    read(text, options);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_file);
    // The end of the message tells how the format was recognized.
    const std::string message = error.what();
    return message.substr(
        0, message.find(
               ". Ayumi read the file in the format 'csv' (table with a head row), because the "
               "first row"));
  }
  return "read";
}

// A table of 20 rows in 0.19 s, in which two joints turn evenly.
std::string table(const std::string& head, char separator, char point, double time, double angle,
                  const std::string& end = "\n") {
  const auto number = [&](double value) {
    std::string text = std::to_string(value);
    std::replace(text.begin(), text.end(), '.', point);
    return text;
  };
  std::string text = head + end;
  for (int k = 0; k < 20; ++k)
    text += number(0.01 * k * time) + separator + number(-k * angle) + separator +
            number(2 * k * angle) + end;
  return text;
}

void expect_the_motion(const ImportedMotion& motion, const std::string& what) {
  ASSERT_EQ(motion.motion.theta.rows(), 20) << what;
  EXPECT_NEAR(motion.motion.dt, 0.01, 1e-12) << what;
  for (int k = 0; k < 20; ++k) {
    EXPECT_NEAR(motion.motion.theta(k, hoap1().find_dof("l_elbow")), -k * kDegree, 2e-6) << what;
    EXPECT_NEAR(motion.motion.theta(k, hoap1().find_dof("r_knee")), 2 * k * kDegree, 2e-6) << what;
  }
}

TEST(ForeignTable, IsReadWithTheMarksOfOtherPrograms) {
  const ImportOptions degrees{.degrees = true};
  expect_the_motion(read("\xEF\xBB\xBF" + table("t,l_elbow,r_knee", ',', '.', 1, 1), degrees),
                    "mark of UTF-8");
  expect_the_motion(read(table("t;l_elbow;r_knee", ';', '.', 1, 1, "\r\n"), degrees), "semicolons");
  expect_the_motion(read(table("t;l_elbow;r_knee", ';', ',', 1, 1), degrees), "decimal commas");
  expect_the_motion(read(table("t\tl_elbow\tr_knee", '\t', '.', 1, 1), degrees), "tabs");
  expect_the_motion(read(table("\"t\",\"l_elbow\",\"r_knee\"", ',', '.', 1, 1), degrees), "quotes");
  expect_the_motion(read("# left; right\n" + table("Time,l_elbow,r_knee", ',', '.', 1, 1), degrees),
                    "a comment, another case");
  // As pandas writes a table with its index, and with a separator at the end of each row.
  const std::string plain = table("t,l_elbow,r_knee", ',', '.', 1, 1);
  std::string indexed, ended;
  std::string from_one;
  int row = -1;
  for (std::string_view rest = plain; !rest.empty(); ++row) {
    const std::string line(rest.substr(0, rest.find('\n')));
    rest.remove_prefix(line.size() + 1);
    indexed += (row < 0 ? "" : std::to_string(row)) + "," + line + "\n";
    from_one += (row < 0 ? "\"\"" : "\"" + std::to_string(row + 1) + "\"") + "," + line + "\n";
    ended += line + ",\n";
  }
  const ImportedMotion motion = read(indexed, degrees);
  expect_the_motion(motion, "a column without a name");
  EXPECT_EQ(std::count(motion.filled.begin(), motion.filled.end(),
                       "the first column has no name and counts the rows, so it is left out"),
            1);
  expect_the_motion(read(from_one, degrees), "a column without a name, from 1, in quotes");
  expect_the_motion(read(ended, degrees), "a separator at the end of each row");
  const auto with_tabs = [](std::string text) {
    std::replace(text.begin(), text.end(), ',', '\t');
    return text;
  };
  expect_the_motion(read(with_tabs(indexed), degrees), "tabs, a column without a name");
  expect_the_motion(read(with_tabs(ended), degrees), "a tab at the end of each row");
  expect_the_motion(read(table("t,\tl_elbow,\tr_knee", ',', '.', 1, 1), degrees),
                    "tabs behind commas");
  expect_the_motion(read(table("t\tl_elbow\tr_knee", '\t', ',', 1, 1), degrees),
                    "decimal commas, tabs");
}

// pandas also writes an index of times without a name.
TEST(ForeignTable, AColumnWithoutANameThatDoesNotCountTheRowsIsRefused) {
  const std::string lost =
      "a.csv:2: the first cell is empty, but only a column that counts the rows (0, 1, 2, ... or "
      "1, 2, 3, ...) needs no name. If the column has the times, write t into this cell; otherwise "
      "remove the column";
  const std::string times = "# of pandas\n" + table(",l_elbow,r_knee", ',', '.', 1, 1);
  EXPECT_EQ(refusal(times), lost);
  ImportOptions options;
  options.rate = 50;
  EXPECT_EQ(refusal(times, options), lost);
  EXPECT_EQ(refusal("\n,t,l_elbow\n0,0,0\n2,0.1,0\n"), lost);
  EXPECT_EQ(refusal("\n\tt\tl_elbow\n2\t0\t0\n3\t0,1\t0\n"), lost);
}

TEST(ForeignTable, UnitsMayStandInTheHeadRow) {
  expect_the_motion(read(table("t[s],l_elbow[deg],theta.r_knee[deg]", ',', '.', 1, 1)), "brackets");
  expect_the_motion(read(table("time (ms);l_elbow (deg);r_knee (deg)", ';', ',', 1e3, 1)),
                    "milliseconds");
  expect_the_motion(
      read(table("time_ms,l_elbow [rad],r_knee[rad]", ',', '.', 1e3, kDegree), {.degrees = true}),
      "what the column says goes before the option");
}

// A table without units may be in degrees. Small angles in degrees are possible angles in radians,
// but the joints would then be too fast.
TEST(ForeignTable, AnAssumedUnitIsSaid) {
  const auto units_of = [](const std::string& text, ImportOptions options = {}) {
    for (const std::string& line : read(text, options).filled)
      if (line.starts_with("units: ")) return line;
    return std::string();
  };
  EXPECT_EQ(units_of(table("t,l_elbow,r_knee", ',', '.', 1, 0.001)),
            "units: radians (assumed; --unit deg changes this)");
  EXPECT_EQ(units_of(table("t,l_elbow,r_knee", ',', '.', 1, 0.05)),
            "units: radians (assumed). In radians, 2 joints (r_knee, l_elbow) exceed position or "
            "speed limits. In degrees, these joints stay inside their limits. If the angles are in "
            "degrees, give --unit deg");
  EXPECT_EQ(units_of(table("t,l_elbow,r_knee", ',', '.', 1, 0.05), {.degrees = true}),
            "units: degrees, as --unit says");
  EXPECT_EQ(units_of(table("t,l_elbow[deg],r_knee[rad]", ',', '.', 1, 0.001)), "");
  // Only some columns may state their units.
  EXPECT_EQ(units_of(table("t,l_elbow[deg],r_knee", ',', '.', 1, 0.001)),
            "units: radians for r_knee (assumed; --unit deg changes this)");
  EXPECT_EQ(units_of(table("t,l_elbow[deg],r_knee", ',', '.', 1, 0.05)),
            "units: radians for r_knee (assumed). In radians, 1 joint (r_knee) exceeds position "
            "or speed limits. In degrees, this joint stays inside its limits. If the angles are in "
            "degrees, give --unit deg");
  EXPECT_EQ(units_of(table("t,l_elbow[deg],r_knee", ',', '.', 1, 0.05), {.degrees = true}),
            "units: degrees for r_knee, as --unit says");
}

// Three decimals at 500 rows per second give accelerations that no motion has.
TEST(ForeignTable, RoughAnglesAreSaid) {
  const auto rough = [](double decimals, ImportOptions options) {
    std::string text = "t,l_knee\n";
    for (int k = 0; k < 500; ++k)
      text += std::to_string(0.002 * k) + "," +
              std::to_string(std::round(0.5 * std::sin(0.004 * k) * decimals) / decimals) + "\n";
    for (const std::string& line : read(text, options).filled)
      if (line.find("the angles are rough") != std::string::npos) return line;
    return std::string();
  };
  EXPECT_NE(rough(1e3, {}).find("The root mean square of the acceleration of l_knee is "),
            std::string::npos);
  EXPECT_NE(rough(1e3, {}).find("--smooth DEG"), std::string::npos);
  EXPECT_EQ(rough(1e6, {}), "");
  ImportOptions smooth;
  smooth.smooth = 0.1;
  EXPECT_EQ(rough(1e3, smooth), "");
}

// Noise of a millimetre at 30 rows per second moves the ZMP by several centimetres.
TEST(ForeignTable, ARoughTrackOfTheRootIsSaid) {
  const auto rough = [](double noise) {
    std::string text = "t,root_x,root_y,root_z,root_qw,root_qx,root_qy,root_qz,l_knee\n";
    for (int k = 0; k < 90; ++k)
      text += std::to_string(k / 30.) + "," +
              std::to_string(0.05 * std::sin(k / 15.) + noise * (k * k % 7 - 2)) +
              ",0,0.3,1,0,0,0,0.3\n";
    for (const std::string& line : read(text).filled)
      if (line.find("the track of the root is rough") != std::string::npos) return true;
    return false;
  };
  EXPECT_FALSE(rough(0));
  EXPECT_FALSE(rough(1e-4));
  EXPECT_TRUE(rough(1e-3));
}

// Six columns of place and quaternion w x y z with these names, then a joint. The root turns by 90
// degrees about z and moves along x.
std::string rooted(const std::string& names) {
  std::string text = "t," + names + ",l_elbow\n";
  for (int k = 0; k < 9; ++k) {
    const double turn = 10 * kDegree * k;
    text += std::to_string(0.01 * k) + "," + std::to_string(0.1 * k) + ",0.5,0.25," +
            std::to_string(std::cos(turn / 2)) + ",0,0," + std::to_string(std::sin(turn / 2)) +
            "," + std::to_string(-0.01 * k) + "\n";
  }
  return text;
}

TEST(ForeignTable, ColumnsOfTheRootAreReadByTheirNames) {
  for (const char* names :
       {"root_x,root_y,root_z,root_qw,root_qx,root_qy,root_qz",
        "base_pos_x,base_pos_y,base_pos_z,base_quat_w,base_quat_x,base_quat_y,base_quat_z",
        "root_pos.x,root_pos.y,root_pos.z,root_rot.w,root_rot.x,root_rot.y,root_rot.z",
        "Pelvis_X[m],Pelvis_Y[m],Pelvis_Z[m],qw,qx,qy,qz",
        "/pose/position/x,/pose/position/y,/pose/position/z,/pose/orientation/w,"
        "/pose/orientation/x,/pose/orientation/y,/pose/orientation/z",
        "base_link_x,base_link_y,base_link_z,base_link_qw,base_link_qx,base_link_qy,base_link_qz",
        "x,y,z,qw,qx,qy,qz"}) {
    const ImportedMotion read_motion = read(rooted(names));
    const std::vector<BasePose>& base = read_motion.motion.base;
    ASSERT_EQ(base.size(), 9u) << names;
    EXPECT_NEAR(base[8].position.x(), 0.8, 1e-6) << names;
    EXPECT_NEAR(base[8].position.y(), 0.5, 1e-6) << names;
    EXPECT_NEAR(base[8].position.z(), 0.25, 1e-6) << names;
    EXPECT_NEAR(Eigen::AngleAxisd(base[8].attitude).angle(), 80 * kDegree, 1e-5) << names;
  }
  // Places of other links, and places without a quaternion, are not the root.
  for (const char* names : {"left_foot_x,left_foot_y,left_foot_z,left_foot_qw,left_foot_qx,"
                            "left_foot_qy,left_foot_qz",
                            "link_1_x,link_1_y,link_1_z,link_1_qw,link_1_qx,link_1_qy,link_1_qz",
                            "pelvis_x,pelvis_y,pelvis_z,torso_qw,torso_qx,torso_qy,torso_qz",
                            "root_x,root_y,root_z,a,b,c,d"})
    EXPECT_NE(refusal(rooted(names)).find("of its 8 joints only l_elbow"), std::string::npos);
  EXPECT_EQ(
      refusal("t,root_x,root_y,root_z,pelvis_x,pelvis_y,pelvis_z,qw,qx,qy,qz\n"
              "0,0,0,0,0,0,0,1,0,0,0\n0.1,0,0,0,0,0,0,1,0,0,0\n"),
      "a.csv: several groups of columns can be the motion of the root. These groups begin with "
      "the columns 'pelvis_x' and 'root_x'; keep one of these groups");
}

// Only one column of times counts; the others are left out.
TEST(ForeignTable, TheFirstColumnOfTimesCounts) {
  for (const char* names : {"t,timestamp", "time_ms,time_ns", "time_ms,t[s]"}) {
    std::string text = std::string(names) + ",l_elbow\n";
    const bool seconds = std::string(names).starts_with("t,");
    for (int k = 0; k < 9; ++k) {
      const std::string first = std::to_string(seconds ? 0.01 * k : 10.0 * k);
      const std::string second =
          std::string(names).ends_with("t[s]") ? std::to_string(0.01 * k) : std::to_string(1e9 + k);
      text += first + "," + second + "," + std::to_string(-0.01 * k) + "\n";
    }
    const ImportedMotion motion = read(text);
    EXPECT_NEAR(motion.motion.dt, 0.01, 1e-9) << names;
    EXPECT_EQ(motion.motion.base.size(), 0u) << names;
  }
}

TEST(ForeignTable, MistakesAreOneLine) {
  const std::string good = table("t,l_elbow,r_knee", ',', '.', 1, 1);
  EXPECT_EQ(
      refusal(good),
      "a.csv: column 'l_elbow' reaches 19 rad, but no joint with limits can turn so far; give "
      "--unit deg if the angles are in degrees");
  EXPECT_EQ(refusal("\xFF\xFEt\0,\0"), "a.csv:1: the file is UTF-16 text; save the file as UTF-8");
  EXPECT_EQ(refusal("t l_elbow r_knee\n0 0 0\n1 0 0\n"),
            "a.csv: the columns are separated by blanks; use commas, semicolons or tabs");
  EXPECT_EQ(refusal("t,l_elbow\n0,0\n0.2,0\n0.1,0\n"),
            "a.csv: data row 3: time 0.1 s does not come after 0.2 s of the row before; times must "
            "increase");
  EXPECT_EQ(refusal("t;l_elbow\n0;0\n0,1;nan\n"),
            "a.csv:3: column 'l_elbow': 'nan' is not a finite number");
  EXPECT_EQ(refusal("t;l_elbow\n0;0\n0,1;0;0\n"),
            "a.csv:3: the row has 3 values, but the head row names 2 columns");
  EXPECT_NE(refusal("t,l_elbow[turns]\n0,0\n1,0\n").find("unknown column 'l_elbow[turns]'"),
            std::string::npos);
}

// Offsets of encoders are added to the columns that the file has. Other joints keep their home
// angle.
TEST(ForeignTable, OffsetsAreAddedToReadingsOfEncodersOnly) {
  RobotDescription description = hoap1().description();
  for (const char* joint : {"l_knee", "l_elbow"}) description.servos.at(joint).offset = 0.05;
  const RobotModel unit(description);
  const int knee = unit.find_dof("l_knee"), elbow = unit.find_dof("l_elbow");
  std::string text = "t[s],l_knee[rad]\n";
  for (int k = 0; k < 10; ++k) text += std::to_string(0.01 * k) + ",0.5\n";
  const auto theta = [&](const std::string& bytes, const ImportOptions& options) {
    return Eigen::VectorXd(read_motion_rows(bytes, "m.csv", unit, options).motion.theta.row(3));
  };
  EXPECT_EQ(theta(text, {})[knee], 0.5);
  EXPECT_EQ(theta(text, {.commands = true, .measured_at = MeasuredAt::joint})[knee], 0.5);
  for (const ImportOptions& options :
       {ImportOptions{.commands = true}, ImportOptions{.measured_at = MeasuredAt::encoder},
        ImportOptions{.sent = true}}) {
    EXPECT_NEAR(theta(text, options)[knee], 0.55, 1e-15);
    EXPECT_EQ(theta(text, options)[elbow], unit.posture()[elbow]);
  }
}

// A sequence that lacks devices: their joints keep their home angle too.
TEST(ForeignTable, JointsWithoutADeviceKeepTheirHomeAngle) {
  RobotDescription description = hoap1().description();
  description.servos.at("l_elbow").offset = 0.05;
  description.encoders.erase("l_elbow");
  const RobotModel unit(description);
  ReferenceTrajectory table;
  table.dt = 0.001;
  table.joints = hoap1().dof_names();
  table.rows.resize(5);
  for (ReferenceRow& row : table.rows) row.theta = hoap1().posture();
  const ReferenceTrajectory targets =
      hoap_targets(unit, parse_hoap(hoap_csv(hoap1(), table), "h.csv", unit));
  const int elbow = unit.find_dof("l_elbow");
  EXPECT_NEAR(targets.rows[3].theta[elbow], unit.posture()[elbow], 1e-15);
}

}  // namespace
}  // namespace ayumi::test
