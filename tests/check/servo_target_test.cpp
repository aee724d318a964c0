// Servos receive targets that lead the posture: the check finds the faults for which export refuses
// a table.

#include <gtest/gtest.h>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/check/consistency.hpp"
#include "ayumi/limits/table_safety.hpp"
#include "ayumi/motion/servo_feedforward.hpp"
#include "ayumi/plan/sample.hpp"
#include "tests/support/check_report.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi::test {
namespace {

Pattern walk_with_period(double period, double lift = WalkParameters().lift) {
  Pattern pattern = walk_pattern(hoap1(), {.steps = 3, .period = period, .lift = lift});
  pattern.robot = "hoap1";
  return pattern;
}

SafetyReport report_of_export(const CommandSeries& series, const std::string& profile = "") {
  const Eigen::VectorXd lead = velocity_lead(hoap1().limits(profile));
  SafetyOptions options;
  options.profile = profile;
  return make_safe(hoap1(), leading_targets(hoap1(), series, lead), options).report;
}

ConsistencyReport check_with(const CommandSeries& series, double tolerance) {
  CheckOptions options;
  options.tolerances = {{"table_step", tolerance}};
  return check_consistency(hoap1(), series, options);
}

bool is_of_table(const Finding& f) {
  return f.kind == FindingKind::table_step || f.kind == FindingKind::table_position ||
         f.kind == FindingKind::table_rest;
}

// The fault concerns the largest step in the table, with the lead of the servo in question.
TEST(ServoTarget, TheCheckFindsWhatExportRefuses) {
  int refused = 0;
  for (const double period : {0.37, 0.38, 0.39, 0.40, 0.55}) {
    const Pattern pattern = walk_with_period(period);
    const SafetyReport table = report_of_export(sample(hoap1(), pattern));
    const ConsistencyReport check = report_of(hoap1(), pattern);
    EXPECT_EQ(check.summary[FindingKind::table_step], table.max_step_ratio) << period;
    EXPECT_TRUE(table.safe || !check.consistent) << period;
    for (const SafetyViolation& v : table.violations) {
      ++refused;
      const auto same = [&](const Finding& f) {
        return is_of_table(f) && f.where == v.joint && f.worst == v.value && f.limit == v.limit &&
               std::abs(f.at - (v.t - v.begin)) < 1e-9;
      };
      EXPECT_TRUE(std::any_of(check.findings.begin(), check.findings.end(), same))
          << period << text_of(v);
      EXPECT_FALSE(check.consistent) << period;
    }
    for (const Finding& f : check.findings) EXPECT_FALSE(is_of_table(f) && table.safe) << f.hint;
  }
  EXPECT_GT(refused, 0);
}

// If export refuses the table for a profile that is not the robot's own, the check only warns.
TEST(ServoTarget, OfAStudyTheCheckOnlyWarns) {
  const Pattern pattern = walk_with_period(0.40);
  const CommandSeries series = sample(hoap1(), pattern);
  int refused = 0;
  for (const std::string& profile : hoap1().profile_names()) {
    if (profile == hoap1().limits().name) continue;
    CheckOptions options;
    options.profile = profile;
    const ConsistencyReport check = check_consistency(hoap1(), series, options);
    const bool safe = report_of_export(series, profile).safe;
    int found = 0;
    for (const Finding& f : check.findings) {
      if (!is_of_table(f)) continue;
      ++found;
      EXPECT_EQ(f.severity, Severity::warning) << profile;
      EXPECT_NE(f.hint.find("`export` refuses the table"), std::string::npos) << f.hint;
    }
    EXPECT_EQ(found == 0, safe) << profile;
    refused += safe ? 0 : 1;
  }
  EXPECT_GT(refused, 0);
}

// If the joint itself is too fast, this is the error, and the too large step in the table is its
// consequence.
TEST(ServoTarget, OfAJointThatIsTooFastFollowsFromIt) {
  const ConsistencyReport r = report_of(hoap1(), walk_with_period(0.8, 0.045));
  EXPECT_FALSE(r.consistent);
  int followed = 0;
  for (const Finding& speed : r.findings)
    for (const Finding& step : r.findings)
      if (speed.kind == FindingKind::joint_speed && step.kind == FindingKind::table_step &&
          speed.where == step.where && step.begin <= speed.end && speed.begin <= step.end) {
        EXPECT_EQ(step.severity, Severity::warning);
        EXPECT_FALSE(step.follows_from.empty());
        ++followed;
      }
  EXPECT_GT(followed, 0);
}

// A larger tolerance does not make export accept more.
TEST(ServoTarget, TolerancesAreAtMostThoseOfExport) {
  const CommandSeries series = sample(hoap1(), walk_with_period(0.55));
  ASSERT_TRUE(check_consistency(hoap1(), series).consistent);
  const double most = report_of_export(series).max_step_ratio;
  EXPECT_FALSE(check_with(series, 0.9 * most).consistent);
  const CommandSeries fast = sample(hoap1(), walk_with_period(0.38));
  ASSERT_GT(report_of_export(fast).max_step_ratio, 1);
  EXPECT_FALSE(check_with(fast, 2).consistent);
}

}  // namespace
}  // namespace ayumi::test
