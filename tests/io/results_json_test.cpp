#include "ayumi/io/run/results_json.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "ayumi/io/run/run_results.hpp"
#include "ayumi/io/run/simulation_log_file.hpp"
#include "tests/support/json.hpp"

namespace ayumi {
namespace {

using Json = nlohmann::json;

TEST(ResultsJson, CheckHasTheKeysOfTheCommandLine) {
  ConsistencyReport report;
  report.profile = "hoap1";
  report.findings = {{.kind = FindingKind::support_margin,
                      .severity = Severity::error,
                      .begin = 1,
                      .end = 2,
                      .at = 1.5,
                      .worst = -0.003,
                      .limit = 0,
                      .unit = "m",
                      .where = "left",
                      .hint = "move the ZMP \"in\""}};
  report.summary[FindingKind::support_margin] = -0.003;
  report.summary[FindingKind::self_collision] = std::numeric_limits<double>::infinity();
  const Json json = test::json_of(check_json(report));
  EXPECT_EQ(json.at("verdict"), "inconsistent");
  const Json& finding = json.at("findings").at(0);
  EXPECT_EQ(finding.at("kind"), "support_margin");
  EXPECT_EQ(finding.at("severity"), "error");
  EXPECT_EQ(finding.at("at_s"), 1.5);
  EXPECT_EQ(finding.at("worst"), -0.003);
  EXPECT_EQ(finding.at("hint"), "move the ZMP \"in\"");
  for (const char* const key :
       {"min_zmp_margin_m", "max_cog_residual_m", "max_zmp_residual_m", "max_fz_residual_N",
        "max_joint_position_ratio", "max_joint_speed_ratio", "max_torque_ratio",
        "max_friction_ratio", "max_foot_slip_m", "min_self_clearance_m"})
    EXPECT_TRUE(json.at("summary").contains(key)) << key;
  EXPECT_EQ(json.at("summary").at("min_zmp_margin_m"), -0.003);
  EXPECT_TRUE(json.at("summary").at("min_self_clearance_m").is_null());
  report.consistent = true;
  EXPECT_EQ(test::json_of(check_json(report)).at("verdict"), "consistent");
}

// All figures of a check, each with a different value, are read back from run.json.
TEST(ResultsJson, EveryFigureOfACheckIsReadBack) {
  ConsistencyReport report;
  report.profile = "hoap1";
  double value = 0;
  for (const FindingSpec* spec : summary_figures()) report.summary[spec->kind] = value += 0.125;
  RunFolder run;
  run.sections = {{"check", check_json(report)}};
  const RunResults results = read_results(run, "run.json");
  ASSERT_TRUE(results.check);
  EXPECT_GE(summary_figures().size(), 20u);
  for (const FindingSpec* spec : summary_figures())
    EXPECT_EQ(results.check->summary[spec->kind], report.summary[spec->kind]) << spec->figure.key;
}

// A consequence has the number of its cause, so that a report can list it there.
TEST(ResultsJson, CausesOfFindingsAreReadBackAndAreNoCircle) {
  ConsistencyReport report;
  report.profile = "hoap1";
  for (int i = 0; i < 3; ++i)
    report.findings.push_back(
        {.kind = FindingKind::joint_speed, .unit = "rad/s", .where = "l_knee", .hint = ""});
  report.findings[1].cause = 2;
  report.findings[2].cause = 0;
  RunFolder run;
  run.sections = {{"check", check_json(report)}};
  const RunResults results = read_results(run, "run.json");
  ASSERT_TRUE(results.check);
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(results.check->findings[i].cause, report.findings[i].cause) << i;

  for (const auto& [cause, words] :
       {std::pair(1, "this finding is a consequence of itself"), {3, "from 0 to 2"}}) {
    report.findings[0].cause = cause;
    run.sections = {{"check", check_json(report)}};
    try {
      read_results(run, "run.json");
      ADD_FAILURE() << cause;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  }
}

TEST(ResultsJson, SimulationHasTheKeysOfTheCommandLine) {
  SimulationLog log;
  log.controller = ControllerKind::dtad;
  log.result = {.outcome = Outcome::fell, .fell_at = 2.25, .max_tilt = 0.9, .steps = 3};
  log.events = {{2.25, EventKind::fell, "on its side"}};
  Json json = test::json_of(simulation_json(log));
  EXPECT_EQ(json.at("outcome"), "fell");
  EXPECT_EQ(json.at("fell_at_s"), 2.25);
  EXPECT_EQ(json.at("max_tilt_rad"), 0.9);
  EXPECT_EQ(json.at("steps"), 3);
  EXPECT_EQ(json.at("events").at(0).at("kind"), "fell");
  EXPECT_EQ(json.at("log_hash"), log_hash(log));
  for (const char* const key : {"final_cog_error_m", "zmp_tracking_rms_m", "flight_s", "apex_m"})
    EXPECT_TRUE(json.contains(key)) << key;
  log.result = {.outcome = Outcome::stands};
  json = test::json_of(simulation_json(log));
  EXPECT_EQ(json.at("outcome"), "stands");
  EXPECT_TRUE(json.at("fell_at_s").is_null());
  EXPECT_TRUE(json.at("apex_m").is_null());
  log.result.flight = 0.2;
  log.result.apex = 0.03;
  EXPECT_EQ(test::json_of(simulation_json(log)).at("apex_m"), 0.03);
  EXPECT_TRUE(json.at("figures_at").empty());
  log.joints = {"knee", "hip"};
  log.result.torque = {.ratio = 0.5, .joint = 1, .at = 2.9};
  json = test::json_of(simulation_json(log));
  EXPECT_EQ(json.at("max_torque_ratio"), 0.5);
  EXPECT_EQ(json.at("figures_at"),
            test::json_of(R"({"max_torque_ratio": {"where": "hip", "at_s": 2.9}})"));
}

TEST(ResultsJson, SafetyNamesEveryViolation) {
  SafetyReport report;
  report.safe = false;
  report.ramp = 2;
  report.violations = {{TableLimit::step, "l_knee", 1.234, 61, 57, "counts", 3}};
  const Json json = test::json_of(safety_json(report));
  EXPECT_EQ(json.at("safe"), false);
  EXPECT_EQ(json.at("ramp_s"), 2);
  EXPECT_EQ(json.at("violations").at(0).at("joint"), "l_knee");
  EXPECT_EQ(json.at("violations").at(0).at("rows"), 3);
}

// A report has angles in degrees, and as many digits as show that a limit is exceeded.
TEST(ResultsJson, ViolationsOfATableAreReadInTheUnitsOfTheReport) {
  SafetyReport report;
  report.violations = {{TableLimit::position, "l_knee", 2, -2.481e-5, 0, "rad", 1},
                       {TableLimit::step, "l_knee", 1.234, 61, 57, "counts", 3},
                       {TableLimit::step, "r_knee", 1.5, 57.04, 57, "counts", 1},
                       {TableLimit::step, "r_hip", 1.5, 57.0004, 57, "counts", 1}};
  RunFolder run;
  run.sections = {{"export", safety_json(report)}};
  const RunResults results = read_results(run, "run.json");
  ASSERT_TRUE(results.safety);
  EXPECT_EQ(
      results.safety->violations,
      (std::vector<std::string>{"position of l_knee at 2.000 s: -0.001422 deg, limit 0 deg",
                                "step of l_knee at 1.234 s: 61 counts, limit 57 counts",
                                "step of r_knee at 1.500 s: 57.04 counts, limit 57 counts",
                                "step of r_hip at 1.500 s: 57.0004 counts, limit 57 counts"}));
}

}  // namespace
}  // namespace ayumi
