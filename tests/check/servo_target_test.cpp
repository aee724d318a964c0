// What servos receive leads the posture: the check warns of its steps where export refuses them.

#include <gtest/gtest.h>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/check/consistency.hpp"
#include "ayumi/check/table_safety.hpp"
#include "ayumi/motion/servo_feedforward.hpp"
#include "ayumi/plan/sample.hpp"
#include "tests/support/check_report.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi::test {
namespace {

// The table as export makes it of a pattern, without rounding to counts.
double largest_step_of_export(const CommandSeries& series) {
  const Eigen::VectorXd lead = velocity_lead(hoap1().limits()), limit = hoap1().limits().speed;
  double ratio = 0;
  Eigen::VectorXd before;
  for (const CommandSample& s : series.samples) {
    const Eigen::VectorXd target = s.state.theta + lead.cwiseProduct(s.state.dtheta);
    if (before.size() > 0)
      ratio =
          std::max(ratio, (target - before).cwiseAbs().cwiseQuotient(series.dt * limit).maxCoeff());
    before = target;
  }
  return ratio;
}

TEST(ServoTarget, StepsBeyondTheSpeedLimitAreToldAsExportTellsThem) {
  for (const double period : {0.40, 0.43, 0.55}) {
    Pattern pattern = walk_pattern(hoap1(), {.steps = 3, .period = period});
    pattern.robot = "hoap1";
    const CommandSeries series = sample(hoap1(), pattern);
    const double most = largest_step_of_export(series);
    double told = 0;
    for (const Finding& f : report_of(hoap1(), pattern).findings) {
      EXPECT_NE(f.severity, Severity::error) << name_of(f.kind);
      if (f.kind != FindingKind::servo_step) continue;
      EXPECT_EQ(f.severity, Severity::warning);
      EXPECT_NE(f.hint.find("`export` will refuse"), std::string::npos) << f.hint;
      told = std::max(told, std::abs(f.worst / f.limit));
    }
    if (most > 1.005)
      EXPECT_NEAR(told, most, 1e-12) << period;
    else
      EXPECT_EQ(told, 0) << period;
    EXPECT_EQ(most > 1.005, period < 0.42);
    ReferenceTrajectory table;
    table.dt = series.dt;
    table.joints = hoap1().dof_names();
    for (const CommandSample& s : series.samples) {
      ReferenceRow row;
      row.theta = s.state.theta + velocity_lead(hoap1().limits()).cwiseProduct(s.state.dtheta);
      row.base = s.state.base;
      table.rows.push_back(row);
    }
    EXPECT_EQ(make_safe(hoap1(), table).report.safe, told == 0) << period;
  }
}

// A joint that is too fast by itself is one error, not a warning beside it.
TEST(ServoTarget, OfAJointThatIsTooFastIsNotToldTwice) {
  Pattern pattern = walk_pattern(hoap1(), {.steps = 2, .period = 0.8, .lift = 0.045});
  pattern.robot = "hoap1";
  const ConsistencyReport r = report_of(hoap1(), pattern);
  for (const Finding& speed : r.findings)
    for (const Finding& step : r.findings)
      if (speed.kind == FindingKind::joint_speed && step.kind == FindingKind::servo_step &&
          speed.where == step.where) {
        EXPECT_TRUE(step.at < speed.begin || step.at > speed.end) << step.at;
      }
  EXPECT_FALSE(r.consistent);
}

}  // namespace
}  // namespace ayumi::test
