// The servos of a real HOAP-3 from its recorded walk. The data are not part of this program:
// without them these tests are skipped.

#include <gtest/gtest.h>

#include <filesystem>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/identify/identify.hpp"
#include "ayumi/identify/recording_checks.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/io/table/recording.hpp"

namespace ayumi::test {
namespace {

const std::string kHoap3 = AYUMI_SOURCE_DIR "/../shared/data/hoap3";

bool has_recordings() { return std::filesystem::exists(kHoap3 + "/recordings"); }

RobotModel recorded_robot() {
  return load_robot(AYUMI_SOURCE_DIR "/examples/hoap3/robot.json",
                    {.folders = {kHoap3 + "/hoap3_description"}});
}

RecordedMotion recorded_walk(const RobotModel& model, bool with_loads = true) {
  const auto read = [&](const std::string& name) { return read_file(kHoap3 + "/" + name); };
  RecordedMotion motion;
  motion.command =
      read_angles(read("motions/walk_m03_fujitsu_sample_pulses_1ms.csv"), "command", model);
  motion.measured =
      read_angles(read("recordings/walk_m03_measured_encoder_pulses_1ms.csv"), "measured", model);
  if (!with_loads) return motion;
  motion.sensors = read_sensors_table(read("recordings/walk_m03_measured_sensors_adc_1ms.csv"),
                                      "sensors", model);
  return motion;
}

// Two independent evaluations of this recording gave 3.5 to 3.8 ms at the legs, 0.055 to 0.059
// degrees of sag at the knees and 0.035 to 0.037 at the hip rolls.
void expect_the_servos_of_the_walk(bool with_loads) {
  constexpr double kDegree = M_PI / 180;
  const RobotModel model = recorded_robot();
  const Identification result = identify(model, recorded_walk(model, with_loads), {}, "measured");
  EXPECT_EQ(result.caution, "");
  std::vector<double> delays;
  for (const IdentifiedJoint& joint : result.joints) {
    if (!joint.moved) continue;
    delays.push_back(joint.delay.value);
    EXPECT_LT(joint.mean_error, 0.02 * kDegree) << joint.joint;
    EXPECT_LT(joint.largest_error, 0.13 * kDegree) << joint.joint;
    const bool left = joint.joint[0] == 'L';
    if (joint.joint.ends_with("_KN_joint")) {
      EXPECT_NEAR(std::abs(joint.sag), 0.055 * kDegree, 0.01 * kDegree) << joint.joint;
      EXPECT_GT(joint.sag, 0);
    }
    if (joint.joint.ends_with("_LAA_joint")) {
      EXPECT_NEAR(left ? -joint.sag : joint.sag, 0.035 * kDegree, 0.01 * kDegree) << joint.joint;
    }
  }
  ASSERT_EQ(delays.size(), 14u);
  std::sort(delays.begin(), delays.end());
  EXPECT_NEAR(0.5 * (delays[6] + delays[7]), 0.0036, 0.0003);
  EXPECT_NEAR(delays.front(), 0.0036, 0.0003);
  EXPECT_NEAR(delays.back(), 0.0036, 0.0003);
  // The weight shows the stiffness of knees and hip rolls: 2500 to 5000 N m/rad, with an
  // uncertainty of 10 % for the lever, and the two sides agree with each other.
  for (const std::string joint : {"LFE_%_KN_joint", "LR_%_LAA_joint"}) {
    std::vector<ServoEstimate> sides;
    for (const IdentifiedJoint& each : result.joints)
      for (const char side : {'R', 'L'}) {
        std::string name = std::string(1, side) + "_" + joint;
        name[name.find('%')] = side;
        if (each.joint != name) continue;
        EXPECT_TRUE(each.kp.known) << name;
        EXPECT_GT(each.kp.value, 2500 * 0.9) << name;
        EXPECT_LT(each.kp.value, 5000 * 1.1) << name;
        sides.push_back(each.kp);
      }
    ASSERT_EQ(sides.size(), 2u) << joint;
    EXPECT_LT(sides[0].lower, sides[1].upper) << joint;
    EXPECT_LT(sides[1].lower, sides[0].upper) << joint;
  }
}

TEST(IdentifyHoap3, FindsTheServosOfTheRecordedWalk) {
  if (!has_recordings()) GTEST_SKIP() << "no recordings of HOAP-3 at " << kHoap3;
  expect_the_servos_of_the_walk(true);
}

// Without load cells, the way in which the feet share the weight follows from the geometry.
TEST(IdentifyHoap3, FindsTheServosWithoutLoadCells) {
  if (!has_recordings()) GTEST_SKIP() << "no recordings of HOAP-3 at " << kHoap3;
  expect_the_servos_of_the_walk(false);
}

// Load cells that begin half a second later than the angles are not of this recording.
TEST(IdentifyHoap3, RefusesLoadCellsThatAreLate) {
  if (!has_recordings()) GTEST_SKIP() << "no recordings of HOAP-3 at " << kHoap3;
  const RobotModel model = recorded_robot();
  RecordedMotion motion = recorded_walk(model);
  const auto agreement = [&] { return joint_loads(model, motion, RobotStand::feet).agreement; };
  EXPECT_GT(agreement(), 0.9);
  const Eigen::MatrixXd loads = motion.sensors.foot_load;
  motion.sensors.foot_load.bottomRows(loads.rows() - 500) = loads.topRows(loads.rows() - 500);
  EXPECT_THROW(require_loads(motion.sensors, motion.measured, agreement(), "l.csv"), Error);
}

std::string refusal_of(const RobotModel& model, const RecordedMotion& motion) {
  try {
    require_answer(model, motion.command, motion.measured, 0.03, "m.csv");
    require_loads(motion.sensors, motion.measured, 1, "l.csv");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

Eigen::MatrixXd without_rows(const Eigen::MatrixXd& whole, Eigen::Index gap, Eigen::Index missing) {
  const Eigen::Index rows = whole.rows() - missing;
  Eigen::MatrixXd rest(rows, whole.cols());
  rest << whole.topRows(gap), whole.bottomRows(rows - gap);
  return rest;
}

// Rows are missing or repeated in files without times. The message names the row with an error of
// at most two rows.
TEST(IdentifyHoap3, RefusesMissingRows) {
  if (!has_recordings()) GTEST_SKIP() << "no recordings of HOAP-3 at " << kHoap3;
  const RobotModel model = recorded_robot();
  RecordedMotion motion = recorded_walk(model);
  EXPECT_EQ(refusal_of(model, motion), "");
  const Eigen::MatrixXd whole = motion.measured.theta;
  for (const Eigen::Index missing : {1, 2, 3, 5})
    for (const Eigen::Index gap : {2353, 4902, 8000, 12331, 15228}) {
      motion.measured.theta = without_rows(whole, gap, missing);
      const std::string said = refusal_of(model, motion);
      EXPECT_NE(said.find(std::to_string(missing) + (missing == 1 ? " row is" : " rows are") +
                          " missing. From this row on, the angles come " + std::to_string(missing) +
                          " ms earlier than in the rows before"),
                std::string::npos)
          << gap << ": " << said;
      // "m.csv: at data row 8001 (8.000 s, one row every 1 ms) ...": the row, with an error of at
      // most two rows.
      ASSERT_TRUE(said.starts_with("m.csv: at data row ")) << said;
      EXPECT_NEAR(std::stod(said.substr(19)), static_cast<double>(gap + 1), 2) << said;
    }
  // If rows are missing where nothing moves, the total number of rows shows it.
  for (const Eigen::Index missing : {1, 2, 3}) {
    motion.measured.theta = without_rows(whole, 300, missing);
    EXPECT_NE(
        refusal_of(model, motion).find(missing == 1 ? "1 row is missing" : "rows are missing"),
        std::string::npos)
        << refusal_of(model, motion);
  }
  motion.measured.theta.resize(whole.rows() + 2, whole.cols());
  motion.measured.theta << whole.topRows(8002), whole.bottomRows(whole.rows() - 8000);
  EXPECT_NE(refusal_of(model, motion).find("2 rows are repeated"), std::string::npos)
      << refusal_of(model, motion);
}

// Load cells are recorded with the angles, row by row.
TEST(IdentifyHoap3, RefusesLoadCellsWithMissingRows) {
  if (!has_recordings()) GTEST_SKIP() << "no recordings of HOAP-3 at " << kHoap3;
  const RobotModel model = recorded_robot();
  RecordedMotion motion = recorded_walk(model);
  const Eigen::MatrixXd whole = motion.sensors.foot_load;
  for (const Eigen::Index missing : {1, 2, 3}) {
    motion.sensors.foot_load = without_rows(whole, 8000, missing);
    EXPECT_NE(refusal_of(model, motion)
                  .find("l.csv: the recording has " + std::to_string(17902 - missing) +
                        " rows, one every 1 ms, so it lasts"),
              std::string::npos)
        << refusal_of(model, motion);
  }
  motion.sensors.timed = true;
  EXPECT_EQ(refusal_of(model, motion), "");
}

}  // namespace
}  // namespace ayumi::test
