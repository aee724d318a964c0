#include "ayumi/io/formats/hoap.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "tests/support/bus_robot.hpp"
#include "tests/support/degree.hpp"
#include "tests/support/error_message.hpp"

namespace ayumi {
namespace {

namespace fs = std::filesystem;

using test::kDegree;
const HoapLayout kThree = {.motors = 3};

std::string hoap_error(const std::string& bytes, const HoapLayout& layout = kThree) {
  return test::error_message([&] { parse_hoap(bytes, "s.csv", layout); });
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
  table.rows[0].theta = Eigen::Vector3d(10, 20, -5) * kDegree;  // devices 3, 1, 2
  EXPECT_EQ(hoap_csv(test::bus_robot(), table), "1,2,-4180,-1045,2090,R,R,R\n");
}

TEST(Hoap, ReadsBackWithinOneCount) {
  const RobotModel robot = test::bus_robot();
  const ReferenceTrajectory table = sway();
  const fs::path path = fs::path(::testing::TempDir()) / "ayumi_sway.csv";
  const std::string text = hoap_csv(robot, table);
  write_file(path, text);
  const ReferenceTrajectory back = read_hoap(path, robot);
  ASSERT_EQ(back.rows.size(), table.rows.size());
  EXPECT_EQ(back.dt, table.dt);
  EXPECT_EQ(back.joints, table.joints);
  double worst = 0;
  for (size_t k = 0; k < back.rows.size(); ++k)
    worst = std::max(worst, (back.rows[k].theta - table.rows[k].theta).cwiseAbs().maxCoeff());
  EXPECT_LT(worst, 0.51 / 209 * kDegree);
  EXPECT_GT(worst, 0);
  EXPECT_EQ(hoap_csv(robot, back), text);  // counts survive a second trip
  fs::remove(path);
}

TEST(Hoap, BlanksAndLineEndsOfRealFiles) {
  const HoapSequence sequence =
      parse_hoap("2,2,0,-0 , 17, R ,R ,R\r\n2,2,0,0,18,R,R,R\r\n", "s", kThree);
  EXPECT_EQ(sequence.interval_ms, 2);
  EXPECT_EQ(sequence.counts.rows(), 2);
  EXPECT_EQ(sequence.counts(0, 1), 0);
  EXPECT_EQ(sequence.counts(1, 2), 18);
}

TEST(Hoap, SaysWhatIsWrong) {
  EXPECT_EQ(hoap_error(""), "s.csv: the file has no row of a sequence");
  EXPECT_NE(
      hoap_error("1,2,0,0,R,R,R\n").find("s.csv:1: 7 columns, but sequences of this robot have 8"),
      std::string::npos);
  EXPECT_NE(hoap_error("1,3,0,0,0,R,R,R\n").find("s.csv:1: command '3'"), std::string::npos);
  EXPECT_NE(hoap_error("1,2,0,0,1.5,R,R,R\n").find("column 5: '1.5' is not a whole number"),
            std::string::npos);
  EXPECT_NE(hoap_error("1,2,0,0,nan,R,R,R\n").find("column 5: 'nan'"), std::string::npos);
  EXPECT_NE(hoap_error("1,2,0,40000,0,R,R,R\n").find("column 4: 40000 does not fit into 16 bits"),
            std::string::npos);
  EXPECT_NE(hoap_error("1,2,0,0,0,R,R,R\n2,2,0,0,0,R,R,R\n").find("s.csv:2: the interval changes"),
            std::string::npos);
  EXPECT_NE(hoap_error("0,2,0,0,0,R,R,R\n").find("an interval of 0 ms"), std::string::npos);
}

TEST(Hoap, NeedsEncodersAndWholeMilliseconds) {
  RobotDescription description = test::bus_description();
  description.encoders["c"].device = 1;
  try {
    hoap_csv(RobotModel(description), sway());
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("joint 'c' has encoder device 1; a HOAP sequence"),
              std::string::npos);
  }
  ReferenceTrajectory table = sway();
  table.dt = 0.0015;
  EXPECT_THROW(hoap_csv(test::bus_robot(), table), Error);
}

// HOAP-1 swaying its hips and arms: 25 columns, inside every limit, back within one count.
TEST(Hoap, TableOfHoap1) {
  const RobotModel robot = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1/robot.json");
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
    EXPECT_NE(violation.kind, "position") << text_of(violation);
  const std::string text = hoap_csv(robot, safe.table);
  const std::string first = text.substr(0, text.find('\n'));
  EXPECT_EQ(std::count(first.begin(), first.end(), ',') + 1, 25);
  EXPECT_TRUE(first.starts_with("1,2,") && first.ends_with(",R,R,R"));
  const fs::path path = fs::path(::testing::TempDir()) / "ayumi_hoap1.csv";
  write_file(path, text);
  const ReferenceTrajectory back = read_hoap(path, robot);
  fs::remove(path);
  ASSERT_EQ(back.rows.size(), safe.table.rows.size());
  for (size_t k = 0; k < back.rows.size(); ++k)
    for (int j = 0; j < robot.dof_count(); ++j) {
      const Dof& dof = robot.dofs()[static_cast<size_t>(j)];
      EXPECT_LT(std::abs(back.rows[k].theta[j] - safe.table.rows[k].theta[j]), kDegree / 209);
      EXPECT_GE(back.rows[k].theta[j], dof.lower - 1e-9);
      EXPECT_LE(back.rows[k].theta[j], dof.upper + 1e-9);
    }
}

TEST(Hoap, ReadsRealSequences) {
  const fs::path path = AYUMI_SOURCE_DIR
      "/../shared/data/hoap3/motions/"
      "walk_m03_fujitsu_sample_pulses_1ms.csv";
  if (!fs::exists(path)) GTEST_SKIP() << "no recorded HOAP-3 sequence at " << path;
  const HoapLayout layout = {.motors = 21, .rc_words = 2, .requests = 4};
  const std::string bytes = read_file(path);
  const HoapSequence sequence = parse_hoap(bytes, path.string(), layout);
  EXPECT_EQ(sequence.interval_ms, 1);
  EXPECT_NEAR(sequence.counts(0, 2) / 209.0, 17.7, 0.05);  // hip pitch
  EXPECT_NEAR(sequence.counts(0, 3) / 209.0, 45.6, 0.05);  // knee
  // What was read is written the same.
  const std::string again = hoap_text(sequence, layout);
  EXPECT_EQ(again.substr(0, again.find('\n')),
            "1,2,0,39,3696,9537,-5841,-334,18810,-2000,0,8800,0,39,-3730,-9537,5806,425,-18810,"
            "2000,0,-8800,418,60,60,R,R,R,R");
}

}  // namespace
}  // namespace ayumi
