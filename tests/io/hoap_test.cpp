#include "ayumi/io/formats/hoap.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/io/table/motion_import.hpp"
#include "tests/support/bus_robot.hpp"
#include "tests/support/degree.hpp"
#include "tests/support/error_message.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi {
namespace {

namespace fs = std::filesystem;

using test::hoap1;
using test::kDegree;

HoapFile parsed(const std::string& bytes) { return parse_hoap(bytes, "s.csv", test::bus_robot()); }

std::string hoap_error(const std::string& bytes) {
  return test::error_message([&] { parsed(bytes); });
}

ReferenceTrajectory sway() {
  ReferenceTrajectory table;
  table.joints = {"a", "b", "c"};
  for (int k = 0; k < 2000; ++k) {
    ReferenceRow row;
    row.theta = Eigen::Vector3d(0.3 + 0.4 * std::sin(0.005 * k), 0.5 - 0.7 * std::sin(0.004 * k),
                                0.2 + 0.5 * std::sin(0.003 * k));
    table.rows.push_back(row);
  }
  return table;
}

TEST(Hoap, MotorsStandInDeviceOrder) {
  ReferenceTrajectory table = sway();
  table.rows.resize(1);
  // The devices have the order 3, 1, 2.
  table.rows[0].theta = Eigen::Vector3d(10, 20, -5) * kDegree;
  EXPECT_EQ(hoap_csv(test::bus_robot(), table), "1,2,-4180,-1045,2090,R,R,R\n");
}

TEST(Hoap, ReadsBackWithinOneCount) {
  const RobotModel robot = test::bus_robot();
  const ReferenceTrajectory table = sway();
  const std::string text = hoap_csv(robot, table);
  const ReferenceTrajectory back = hoap_targets(robot, parsed(text));
  ASSERT_EQ(back.rows.size(), table.rows.size());
  EXPECT_EQ(back.dt, table.dt);
  EXPECT_EQ(back.joints, table.joints);
  double worst = 0;
  for (size_t k = 0; k < back.rows.size(); ++k)
    worst = std::max(worst, (back.rows[k].theta - table.rows[k].theta).cwiseAbs().maxCoeff());
  EXPECT_LT(worst, 0.51 / 209 * kDegree);
  EXPECT_GT(worst, 0);
  EXPECT_EQ(hoap_csv(robot, back), text);  // counts stay the same on a second round trip
}

TEST(Hoap, BlanksAndLineEndsOfRealFiles) {
  const HoapFile sequence = parsed("2,2,0,-0 , 17, R ,R ,R\r\n2,2,0,0,18,60,R,R\r\n");
  EXPECT_EQ(sequence.tick_ms, 2);
  ASSERT_EQ(sequence.rows.size(), 2u);
  EXPECT_EQ(sequence.rows[0].values[1], 0);
  EXPECT_EQ(sequence.rows[1].values[2], 18);
  EXPECT_EQ(sequence.line_end, "\r\n");
  EXPECT_EQ(sequence.first_words, ", R ,R ,R");
  EXPECT_EQ(sequence.last_words, ",60,R,R");
}

TEST(Hoap, GeneralCommandsTakeTheirTime) {
  const HoapFile sequence = parsed("1,2,0,0,0,R,R,R\n2,3,1,A,12\n1,2,30,0,0,R,R,R\n");
  EXPECT_EQ(sequence.general_commands, 1);
  ASSERT_EQ(sequence.rows.size(), 2u);
  EXPECT_EQ(sequence.rows[1].at, 3);
  EXPECT_EQ(values_on_ticks(sequence, 1), Eigen::Vector2d(0, 30));
}

TEST(Hoap, IntervalsThatChangeAreInterpolated) {
  const HoapFile sequence = parsed("2,2,0,0,0,R,R,R\n4,2,20,0,0,R,R,R\n2,2,60,0,0,R,R,R\n");
  EXPECT_FALSE(sequence.even);
  EXPECT_EQ(sequence.tick_ms, 2);
  EXPECT_EQ(values_on_ticks(sequence, 1), Eigen::Vector4d(0, 20, 40, 60));
}

TEST(Hoap, SaysWhatIsWrong) {
  EXPECT_EQ(hoap_error(""), "s.csv: the file has no row with targets for the motors");
  EXPECT_NE(hoap_error("1,2,0,0,R,R,R\n")
                .find("s.csv:1: the row has 7 columns, but sequences of this robot have 8"),
            std::string::npos);
  EXPECT_NE(
      hoap_error("1,4,0,0,0,R,R,R\n").find("a row must begin with an interval [ms] and a code"),
      std::string::npos);
  EXPECT_NE(hoap_error("1,2,0,0,1.5,R,R,R\n")
                .find("column 5: '1.5' is not a whole number from -32768 to 32767"),
            std::string::npos);
  EXPECT_NE(hoap_error("1,2,0,0,nan,R,R,R\n").find("column 5: 'nan'"), std::string::npos);
  EXPECT_NE(hoap_error("1,2,0,40000,0,R,R,R\n").find("column 4: '40000' is not a whole number"),
            std::string::npos);
  EXPECT_NE(hoap_error("0,2,0,0,0,R,R,R\n").find("'0' is not an interval"), std::string::npos);
  // The file is cut off in its second row.
  EXPECT_NE(hoap_error("1,2,0,0,0,R,R,R\n1,2,0,0,\n")
                .find("s.csv:2: the row has 5 columns, but each row before it has 8"),
            std::string::npos);
  EXPECT_NE(hoap_error("1,2,0,0,0,R,R,R\n1,2,0,0,0,R,R,")
                .find("s.csv:2: the row ends with ',R,R,', but the first row ends with ',R,R,R'. "
                      "The file may be truncated"),
            std::string::npos);
}

TEST(Hoap, NeedsEncodersAndWholeMilliseconds) {
  RobotDescription description = test::bus_description();
  description.encoders["c"].device = 1;
  const std::string error = test::error_message([&] { hoap_csv(RobotModel(description), sway()); });
  EXPECT_NE(error.find("has encoder device 1. For the layout"), std::string::npos) << error;
  description.encoders.clear();
  const std::string bare = test::error_message(
      [&] { parse_hoap("1,2,0,0,0,R,R,R\n", "s.csv", RobotModel(description)); });
  EXPECT_NE(bare.find("this robot has no encoders. With --robot, name the robot"),
            std::string::npos)
      << bare;
  ReferenceTrajectory table = sway();
  table.dt = 0.0015;
  EXPECT_THROW(hoap_csv(test::bus_robot(), table), Error);
}

// The layout in the sidecar says which columns surround the motors, and which intervals there are.
TEST(Hoap, LayoutsAreThoseOfTheSidecar) {
  RobotDescription description = test::bus_description();
  description.layouts = {{"two words", {"interval", "2"}, {"60", "75", "R"}, 3, false, {1, 2}},
                         {"bare", {"*"}, {"*"}, 3, false, {5}}};
  const RobotModel robot(description);
  ReferenceTrajectory table = sway();
  table.rows.resize(1);
  table.rows[0].theta.setZero();
  EXPECT_EQ(hoap_csv(robot, table), "1,2,0,0,0,60,75,R\n");
  EXPECT_EQ(written_layout(robot).name, "two words");
  EXPECT_THROW(written_layout(robot, "bare"), Error);
  const HoapFile bare = parse_hoap("7,1,2,3,7\n7,1,2,4,7\n", "b.csv", robot);
  EXPECT_EQ(bare.layout.name, "bare");
  EXPECT_EQ(bare.tick_ms, 5);
  EXPECT_EQ(bare.rows[1].values[2], 4);
  EXPECT_TRUE(looks_like_hoap("7,1,2,3,7\n", robot));
  EXPECT_FALSE(looks_like_hoap("7,1,2,3\n", robot));
}

// HOAP-1 sways its hips and arms: the table has 25 columns, is inside every limit, and reads back
// within one count.
TEST(Hoap, TableOfHoap1) {
  const RobotModel& robot = hoap1();
  ReferenceTrajectory motion;
  motion.joints = robot.dof_names();
  const Eigen::VectorXd home = robot.posture();
  for (int k = 0; k <= 4000; ++k) {
    const double t = 0.001 * k, ease = 0.5 - 0.5 * std::cos(EIGEN_PI * t / 2);
    ReferenceRow row;
    row.theta = home;
    for (int j = 0; j < robot.dof_count(); ++j) row.theta[j] += 0.05 * ease * std::sin(3 * t + j);
    motion.rows.push_back(row);
  }
  for (size_t k = 3000; k <= 4000; ++k) motion.rows[k].theta = motion.rows[3000].theta;
  for (ReferenceRow& row : motion.rows)
    for (int j = 0; j < robot.dof_count(); ++j) {
      const Dof& dof = robot.dofs()[static_cast<size_t>(j)];
      row.theta[j] = std::clamp(row.theta[j], dof.lower, dof.upper);
    }
  const SafeTable safe = make_safe(robot, motion);
  for (const SafetyViolation& violation : safe.report.violations)
    EXPECT_NE(violation.kind, TableLimit::position) << text_of(violation);
  const std::string text = hoap_csv(robot, safe.table);
  const std::string first = text.substr(0, text.find('\n'));
  EXPECT_EQ(std::count(first.begin(), first.end(), ',') + 1, 25);
  EXPECT_TRUE(first.starts_with("1,2,") && first.ends_with(",R,R,R"));
  const ReferenceTrajectory back = hoap_targets(robot, parse_hoap(text, "h.csv", robot));
  ASSERT_EQ(back.rows.size(), safe.table.rows.size());
  for (size_t k = 0; k < back.rows.size(); ++k)
    for (int j = 0; j < robot.dof_count(); ++j) {
      const Dof& dof = robot.dofs()[static_cast<size_t>(j)];
      EXPECT_LT(std::abs(back.rows[k].theta[j] - safe.table.rows[k].theta[j]), kDegree / 209);
      EXPECT_GE(back.rows[k].theta[j], dof.lower - 1e-9);
      EXPECT_LE(back.rows[k].theta[j], dof.upper + 1e-9);
    }
}

// A kick as in the robot's own files in radians: the knees flex, whatever the signs of their
// encoders are.
TEST(Hoap, RowsOfRadiansHaveTheSignsOfTheEncoders) {
  const RobotModel& robot = hoap1();
  std::string bytes;
  for (int k = 0; k < 40; ++k) {
    std::string row;
    for (int device = 1; device <= 21; ++device) {
      double value = 0;
      for (const Dof& dof : robot.dofs())
        if (dof.encoder.device == device && dof.name.ends_with("knee"))
          value = (0.3 + 0.01 * k) * (dof.encoder.counts_per_degree < 0 ? -1 : 1);
      row += std::to_string(value) + ",";
    }
    bytes += row + "0,0\n";
  }
  const ImportedMotion motion = read_motion_rows(bytes, "kick.csv", robot);
  EXPECT_EQ(motion.motion.dt, 0.002);
  for (const char* const knee : {"l_knee", "r_knee"})
    EXPECT_NEAR(motion.motion.theta(39, robot.find_dof(knee)), 0.69, 1e-6) << knee;
  std::string said;
  for (const std::string& line : motion.filled) said += line + "\n";
  EXPECT_NE(said.find("have the signs of the encoders, so the angles of r_hip_pitch, "),
            std::string::npos)
      << said;
  EXPECT_EQ(said.find("exceed the position limits"), std::string::npos) << said;
  const ImportedMotion other = read_motion_rows(bytes, "kick.csv", robot, {.encoder_signs = false});
  EXPECT_NEAR(other.motion.theta(39, robot.find_dof("l_knee")), -0.69, 1e-6);
  EXPECT_NE(other.filled.back().find("l_knee exceed the position limits"), std::string::npos)
      << other.filled.back();
}

TEST(Hoap, ZerosAreNoRecordingAndJumpsAreNamed) {
  const std::string tail = ",0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,R,R,R\n";
  std::string zeros, jump;
  for (int k = 0; k < 10; ++k) {
    zeros += "1,2,0" + tail;
    jump += (k < 5 ? "2,2,0" : "2,2,200") + tail;
  }
  const std::string error = test::error_message([&] { read_motion_rows(zeros, "z.csv", hoap1()); });
  EXPECT_TRUE(
      error.starts_with("z.csv: all values of all motors are 0, so nothing was recorded; record "
                        "again. Ayumi read the file in the format 'hoap' (HOAP sequence), "))
      << error;
  const ImportedMotion motion = read_motion_rows(jump, "j.csv", hoap1());
  ASSERT_FALSE(motion.filled.empty());
  EXPECT_EQ(motion.filled.front(),
            "at row 6, the target of device 1 changes by 100 counts/ms from the row before, but "
            "motor boards allow at most 57 counts/ms. Rows may be missing before this row");
}

TEST(Hoap, ReadsRealSequences) {
  const fs::path data = AYUMI_SOURCE_DIR "/../shared/data/hoap3";
  const fs::path path = data / "motions/walk_m03_fujitsu_sample_pulses_1ms.csv";
  if (!fs::exists(path)) GTEST_SKIP() << "no recorded HOAP-3 sequence at " << path;
  const RobotModel robot =
      load_robot(AYUMI_SOURCE_DIR "/examples/hoap3/robot.json", {{data / "hoap3_description"}});
  const HoapFile sequence = parse_hoap(read_file(path), path.string(), robot);
  EXPECT_EQ(sequence.tick_ms, 1);
  EXPECT_EQ(sequence.layout.name, "HOAP-3");
  EXPECT_NEAR(sequence.rows[0].values[2] / 209.0, 17.7, 0.05);  // the hip pitch
  EXPECT_NEAR(sequence.rows[0].values[3] / 209.0, 45.6, 0.05);  // the knee
  const std::string again = hoap_csv(robot, hoap_targets(robot, sequence));
  EXPECT_EQ(again.substr(0, again.find('\n')),
            "1,2,0,39,3696,9537,-5841,-334,18810,-2000,0,8800,0,39,-3730,-9537,5806,425,-18810,"
            "2000,0,-8800,418,60,60,R,R,R,R");
}

}  // namespace
}  // namespace ayumi
