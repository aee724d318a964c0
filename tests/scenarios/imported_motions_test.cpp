// DTAD on motions that nobody made for it: sequences of a real robot, plans that end or begin in
// motion, plans whose ZMP no ground gives.
#include <gtest/gtest.h>

#include <filesystem>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/io/table/motion_import.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/sim/simulate.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi {
namespace {

using test::hoap1;

SimulationLog play(const RobotModel& model, const CommandSeries& series, ControllerKind law) {
  SimulateOptions options;
  options.controller.type = law;
  options.settle = 2;
  return simulate(model, series, options);
}

CommandSeries sway() {
  Pattern pattern = sway_pattern(hoap1(), sway_defaults(hoap1()));
  pattern.robot = "hoap1";
  return sample(hoap1(), pattern);
}

// The robot stops where the plan ends and stands there: it neither goes on with the last velocity
// nor seeks the ZMP of the last acceleration.
TEST(ImportedMotions, APlanThatEndsInMotion) {
  CommandSeries series = sway();
  size_t fastest = 0;
  const std::vector<CommandSample>& samples = series.samples;
  for (size_t k = 0; k < samples.size() / 2; ++k)
    if (samples[k].ddcog.head<2>().norm() > samples[fastest].ddcog.head<2>().norm()) fastest = k;
  ASSERT_GT((samples[fastest].zmp - samples[fastest].cog).head<2>().norm(), 0.002);
  series.samples.resize(fastest + 1);
  for (const ControllerKind law : {ControllerKind::none, ControllerKind::dtad}) {
    const SimulationLog log = play(hoap1(), series, law);
    EXPECT_EQ(log.result.outcome, Outcome::stands);
    EXPECT_LT(log.result.final_cog_error, 2e-4);
    const SimulationSample& last = log.samples.back();
    EXPECT_LT((last.command_zmp - last.command_cog).head<2>().norm(), 1e-9);
    EXPECT_NEAR(last.command_fz, hoap1().mass() * 9.80665, 1e-6);
  }
}

// For 10 ms the plan has its ZMP 0.8 m in front of the feet, as differences of a coarse table give
// it. Trunk and arms do not answer what is no disturbance.
TEST(ImportedMotions, AZmpThatNoGroundGives) {
  CommandSeries series = sway();
  const size_t at = series.samples.size() / 2;
  for (size_t k = at; k < at + 10; ++k) series.samples[k].zmp.x() = 0.8;
  const SimulationLog log = play(hoap1(), series, ControllerKind::dtad);
  EXPECT_EQ(log.result.outcome, Outcome::stands);
  EXPECT_LT(log.result.max_tilt, 0.02);
  for (const SimulationSample& s : log.samples)
    EXPECT_LT((s.reference_theta - s.command_theta).cwiseAbs().maxCoeff(), 0.03);
}

// Every sequence of HOAP-3 that is at hand. The data are not part of this program: without them
// the test is skipped.
TEST(ImportedMotions, SequencesOfARealRobot) {
  const std::filesystem::path data = AYUMI_SOURCE_DIR "/../shared/data/hoap3";
  if (!std::filesystem::exists(data / "motions"))
    GTEST_SKIP() << "no recorded sequences in " << data;
  const RobotModel model = load_robot(AYUMI_SOURCE_DIR "/examples/hoap3/robot.json",
                                      {.folders = {data / "hoap3_description"}});
  for (const auto& entry : std::filesystem::directory_iterator(data / "motions")) {
    SCOPED_TRACE(entry.path().filename());
    const std::string file = entry.path().string();
    GroundedMotion motion =
        grounded(model, read_motion(read_file(file), file, model).motion, "motion.csv");
    motion.pattern.robot = "hoap3";
    const CommandSeries series = sample(model, motion.pattern);
    const SimulationLog law = play(model, series, ControllerKind::dtad);
    EXPECT_EQ(law.result.outcome, Outcome::stands) << "fell at " << law.result.fell_at;
    EXPECT_LT(law.result.final_cog_error, 1e-3);
  }
}

}  // namespace
}  // namespace ayumi
