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

RecordedMotion recorded_walk(const RobotModel& model) {
  const auto read = [&](const std::string& name) { return read_file(kHoap3 + "/" + name); };
  RecordedMotion motion;
  motion.command =
      read_angles(read("motions/walk_m03_fujitsu_sample_pulses_1ms.csv"), "command", model);
  motion.measured =
      read_angles(read("recordings/walk_m03_measured_encoder_pulses_1ms.csv"), "measured", model);
  motion.sensors = read_sensors_table(read("recordings/walk_m03_measured_sensors_adc_1ms.csv"),
                                      "sensors", model);
  return motion;
}

// Two independent evaluations of this recording gave 3.5 to 3.8 ms at the legs, 0.055 to 0.059
// degrees of sag at the knees and 0.035 to 0.037 at the hip rolls.
TEST(IdentifyHoap3, FindsDelayAndSagOfTheRecordedWalk) {
  if (!has_recordings()) GTEST_SKIP() << "no recordings of HOAP-3 at " << kHoap3;
  constexpr double kDegree = M_PI / 180;
  const RobotModel model = recorded_robot();
  const Identification result = identify(model, recorded_walk(model), {}, "measured");
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
  EXPECT_NEAR(delays.front(), 0.0036, 0.0005);
  EXPECT_NEAR(delays.back(), 0.0036, 0.0005);
}

// Five rows of a file without time are missing: the answer comes earlier from there on.
TEST(IdentifyHoap3, RefusesMissingRows) {
  if (!has_recordings()) GTEST_SKIP() << "no recordings of HOAP-3 at " << kHoap3;
  const RobotModel model = recorded_robot();
  RecordedMotion motion = recorded_walk(model);
  const Eigen::MatrixXd whole = motion.measured.theta;
  EXPECT_NO_THROW(require_answer(model, motion.command, motion.measured, 0.1, "m.csv"));
  const Eigen::Index gap = 8000, missing = 5, rows = whole.rows() - missing;
  motion.measured.theta.resize(rows, whole.cols());
  motion.measured.theta << whole.topRows(gap), whole.bottomRows(rows - gap);
  try {
    require_answer(model, motion.command, motion.measured, 0.1, "m.csv");
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("5 ms earlier than before: rows are missing"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace ayumi::test
