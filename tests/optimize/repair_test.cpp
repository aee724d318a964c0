#include "ayumi/optimize/repair.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <iostream>

#include "tests/support/limited_biped.hpp"
#include "tests/support/walk.hpp"

using namespace ayumi;
using namespace ayumi::test;

namespace {

double hill(double t, double center, double width) {
  const double s = (t - center) / width;
  return std::abs(s) < 0.5 ? std::pow(std::cos(M_PI * s), 4) : 0;
}

double middle_of_step(int n, const WalkShape& w = {}) {
  return w.lead + n * w.period + 0.5 * (w.period - w.double_support);
}

const CommandSeries& good_walk() {
  static const CommandSeries series = walk(limited_biped());
  return series;
}

// The COG hurries back in one step: the ZMP leaves the sole behind.
CommandSeries zmp_outside() {
  CommandSeries series = good_walk();
  RobotData data(limited_biped());
  for (size_t k = 0; k < series.samples.size(); ++k) {
    CommandSample& s = series.samples[k];
    s.state.base.position.x() -= 0.012 * hill(k * series.dt, middle_of_step(3), 0.5);
    place_legs(limited_biped(), s.feet, s.state, data);
  }
  complete_series(limited_biped(), series);
  return series;
}

RepairResult timed(const RobotModel& model, const CommandSeries& series,
                   const RepairOptions& options = {}) {
  const auto begin = std::chrono::steady_clock::now();
  const RepairResult r = repair(model, series, options);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::cout << name_of(r.status) << ": " << r.variables << " variables, " << r.constraints
            << " constraints, " << r.iterations << " iterations, " << seconds << " s, violation "
            << r.constraint_violation << ", moved " << r.max_joint_change << " rad " << r.where
            << " at " << r.at << ", cog " << r.max_cog_change << "\n";
  for (const std::string& reason : r.reasons) std::cout << "  " << reason << "\n";
  return r;
}

}  // namespace

TEST(Repair, ConsistentStaysAsItIs) {
  const RepairResult r = repair(limited_biped(), good_walk());
  EXPECT_EQ(r.status, RepairStatus::already_consistent);
  EXPECT_EQ(r.correction.coefficients.size(), 0);
  EXPECT_EQ(r.max_joint_change, 0);
}

TEST(Repair, ZmpComesInside) {
  const CommandSeries series = zmp_outside();
  const RepairResult r = timed(limited_biped(), series);
  ASSERT_EQ(r.status, RepairStatus::repaired);
  EXPECT_TRUE(r.check.consistent);
  EXPECT_LE(r.constraint_violation, 1e-6);
  EXPECT_GT(r.check.summary.min_zmp_margin, 0.001);
}

TEST(Repair, JointComesInsideItsLimit) {
  double highest = 0;
  const int knee = limited_biped().find_dof("l_knee");
  for (const CommandSample& s : good_walk().samples)
    highest = std::max(highest, s.state.theta[knee]);
  RobotDescription d = limited_biped_description();
  for (JointDescription& joint : d.joints)
    if (joint.name == "l_knee") joint.upper = highest - 2 * M_PI / 180;
  const RobotModel model(d);
  const RepairResult r = timed(model, good_walk());
  ASSERT_EQ(r.status, RepairStatus::repaired);
  EXPECT_GE(r.max_joint_change, 0.034);
}

TEST(Repair, JointBeyondItsLimitToTheEndIsBroughtBackThereToo) {
  CommandSeries series = good_walk();
  const int arm = limited_biped().find_dof("l_shoulder_pitch");
  ASSERT_GE(arm, 0);
  const double limit = series.samples[0].state.theta[arm] + 0.2;
  RobotDescription d = limited_biped_description();
  for (JointDescription& joint : d.joints)
    if (joint.name == "l_shoulder_pitch") joint.upper = limit;
  const RobotModel model(d);
  // A slow ramp to 0.05 rad beyond the limit, held to the end.
  const double over = 0.25;
  const double T = 0.8 * series.duration();
  for (size_t k = 0; k < series.samples.size(); ++k) {
    const double s = std::min(1.0, k * series.dt / T);
    series.samples[k].state.theta[arm] += over * s * s * s * (10 - 15 * s + 6 * s * s);
  }
  complete_series(model, series);
  const RepairResult r = timed(model, series);
  ASSERT_EQ(r.status, RepairStatus::repaired);
  EXPECT_LE(r.series.samples.back().state.theta[arm], model.dofs()[arm].upper);
  EXPECT_LT(std::abs(r.series.samples.back().state.dtheta[arm]), 1e-6);
}
