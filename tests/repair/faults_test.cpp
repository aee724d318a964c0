// Faults planted one by one in the dense table of the HOAP-1 walk, and their repair.

#include "tests/support/faults.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/motion/correction.hpp"
#include "ayumi/motion/servo_feedforward.hpp"
#include "ayumi/repair/repair.hpp"
#include "tests/support/hoap1.hpp"

using namespace ayumi;
using namespace ayumi::test;
using Eigen::Vector3d;

namespace {

// A walk of 7 s as a table of theta, base, COG, ZMP and f_z.
const Pattern& table_walk() {
  static const Pattern pattern =
      baked(hoap1(), read_pattern(AYUMI_SOURCE_DIR "/patterns/hoap1_walk.json"));
  return pattern;
}

std::string kinds(const ConsistencyReport& report) {
  std::string out;
  for (const Finding& f : report.findings)
    if (f.severity == Severity::error) out += std::string(name_of(f.kind)) + " " + f.where + ", ";
  return out;
}

bool finds(const ConsistencyReport& report, const std::string& kind) {
  return std::any_of(report.findings.begin(), report.findings.end(),
                     [&](const Finding& f) { return name_of(f.kind) == kind; });
}

class Faults : public testing::Test {
 protected:
  Pattern pattern = table_walk();
  DenseTable& table = *pattern.table;
  RepairOptions options;
  CommandSeries series;

  // The fault is there, its repair passes the check within the tolerance of the solver, and a
  // second repair changes nothing.
  RepairResult repaired(const std::string& kind) {
    series = sample(hoap1(), pattern);
    const ConsistencyReport before = check_consistency(hoap1(), series, options.check);
    EXPECT_FALSE(before.consistent);
    EXPECT_TRUE(finds(before, kind)) << kinds(before);
    RepairResult r = repair(hoap1(), series, options);
    EXPECT_EQ(r.status, RepairStatus::repaired) << (r.reasons.empty() ? "" : r.reasons[0]);
    EXPECT_LE(r.constraint_violation, 1e-6);
    EXPECT_TRUE(r.check.consistent) << kinds(r.check);
    pattern.correction = r.correction;
    const CommandSeries read = sample(hoap1(), pattern);
    EXPECT_EQ(repair(hoap1(), read, options).status, RepairStatus::already_consistent);
    return r;
  }

  void move_cog(double way, double center) {
    for_rows(table, [&](double t, size_t k) { table.cog[k].y() += way * bump(t, center, 0.6); });
  }
};

}  // namespace

TEST_F(Faults, CogKeyMoved) {
  move_cog(0.015, 3);
  const RepairResult r = repaired("cog_residual");
  EXPECT_EQ(r.max_joint_change, 0);  // the posture is trusted
  EXPECT_LT(r.check.summary[FindingKind::cog_residual], 1e-9);
}

TEST_F(Faults, CogKeyMovedAndTrusted) {
  move_cog(0.015, 3);
  options.trust = Trust::cog;
  const RepairResult r = repaired("cog_residual");
  EXPECT_NEAR(r.max_cog_change, 0.015, 0.001);
  EXPECT_LT(r.check.summary[FindingKind::cog_residual], 0.002);
}

// The trusted COG moves the feet of a quick walk through each other: boxes that pass closely, whose
// nearest points jump.
TEST_F(Faults, CogMovedAndTrustedPartsTheFeet) {
  WalkParameters quick{.steps = 11, .stride = 0.04, .period = 0.5, .lift = 0.018};
  Pattern walk = walk_pattern(hoap1(), quick);
  walk.robot = "hoap1";
  pattern = baked(hoap1(), walk);
  move_cog(-0.015, 2.092);
  options.trust = Trust::cog;
  const RepairResult r = repaired("cog_residual");
  EXPECT_GE(r.check.summary[FindingKind::self_collision], 0.002);
}

TEST_F(Faults, ZmpTrackOutsideTheFeet) {
  for_rows(table, [&](double, size_t k) { table.zmp[k].y() += 0.0515; });
  const RepairResult r = repaired("zmp_residual");
  EXPECT_EQ(r.max_joint_change, 0);
  EXPECT_GT(r.check.summary[FindingKind::support_margin], 0.02);
}

TEST_F(Faults, ZmpMovedAndTrusted) {
  for_rows(table, [&](double t, size_t k) { table.zmp[k].x() += 0.01 * bump(t, 3, 0.6); });
  options.trust = Trust::zmp;
  const RepairResult r = repaired("zmp_residual");
  EXPECT_LT(r.check.summary[FindingKind::zmp_residual], 0.005);
  EXPECT_GT(r.max_joint_change, 0.005);
}

TEST_F(Faults, ForceScaled) {
  for (double& fz : table.fz) fz *= 1.1;
  EXPECT_EQ(repaired("fz_residual").max_joint_change, 0);
}

TEST_F(Faults, ArmJointBeyondItsLimit) {
  move_joint(hoap1(), table, "l_elbow", 40 * M_PI / 180, 3, 0.8);
  const RepairResult r = repaired("joint_position");
  EXPECT_EQ(r.where, "l_elbow");
  // The servo target, which turns back before the posture does, comes back to the limit itself.
  const int elbow = hoap1().find_dof("l_elbow");
  const Dof& dof = hoap1().dofs()[static_cast<size_t>(elbow)];
  const double lead = velocity_lead(hoap1().limits())[elbow];
  double most = -10, angle = -10;
  for (const CommandSample& s : r.series.samples) {
    most = std::max(most, s.state.theta[elbow] + lead * s.state.dtheta[elbow]);
    angle = std::max(angle, s.state.theta[elbow]);
  }
  const double limit = dof.upper - hoap1().description().soft_limit_margin;
  EXPECT_NEAR(most, limit, 1e-4);
  EXPECT_LE(most, limit);
  EXPECT_NEAR(r.max_joint_change, 14 * M_PI / 180 + limit - angle, 0.2 * M_PI / 180);
}

TEST_F(Faults, KneeThrownUp) {
  move_joint(hoap1(), table, "r_knee", 80 * M_PI / 180, 2.44, 0.4);
  repaired("joint_position");
}

TEST_F(Faults, TimeSqueezed) {
  squeeze(pattern, 0.65);
  const RepairResult r = repaired("joint_speed");
  EXPECT_LE(r.check.summary[FindingKind::joint_speed], 1);
}

TEST_F(Faults, FootSlips) {
  slip_foot(hoap1(), table, Side::left, Vector3d(0.005, 0, 0), 2.3, 0.3);
  const RepairResult r = repaired("foot_slip");
  EXPECT_LT(r.check.summary[FindingKind::foot_slip], 0.001);
}

TEST_F(Faults, ContactTooEarly) {
  pattern.phases[7].until -= 0.06;
  EXPECT_LT(repaired("foot_float").check.summary[FindingKind::foot_float], 0.0003);
}

TEST_F(Faults, ArmThroughTheTorso) {
  move_joint(hoap1(), table, "l_shoulder_roll", -35 * M_PI / 180, 3, 0.8);
  const RepairResult r = repaired("self_collision");
  EXPECT_GE(r.check.summary[FindingKind::self_collision], 0.002);
}

// The walk has three steps: the friction leaves little room, and the computing time grows with the
// length.
TEST_F(Faults, SeveralAtOnce) {
  Pattern walk = walk_pattern(hoap1(), {.steps = 3});
  walk.robot = "hoap1";
  pattern = baked(hoap1(), walk);
  move_cog(0.015, 1.4);
  for (double& fz : table.fz) fz *= 1.1;
  move_joint(hoap1(), table, "l_elbow", 40 * M_PI / 180, 2, 0.8);
  slip_foot(hoap1(), table, Side::left, Vector3d(0.005, 0, 0), 2.45, 0.4);
  pattern.phases[5].until -= 0.06;
  options.check.friction = 0.14;
  options.most_work *= 10;  // five faults take longer than a repair may by default
  repaired("foot_float");
}

// ---- steering

TEST_F(Faults, LockedWindowStaysToTheBit) {
  move_joint(hoap1(), table, "l_elbow", 40 * M_PI / 180, 3, 0.8);
  options.locked_windows = {{3.35, 3.6}, {1.0, 1.0}};
  const RepairResult r = repaired("joint_position");
  for (size_t k = 3350; k <= 3600; ++k) {
    ASSERT_EQ(r.series.samples[k].state.theta, series.samples[k].state.theta) << k;
    ASSERT_EQ(r.series.samples[k].state.base.position, series.samples[k].state.base.position);
    ASSERT_EQ(r.series.samples[k].state.base.attitude.coeffs(),
              series.samples[k].state.base.attitude.coeffs());
  }
}

// At locked instants the pose stays, while it may change a moment before and after. An arm is too
// quick from one kept pose to the next, which a straighter path can mend.
TEST_F(Faults, LockedInstantKeepsItsPoseAndLetsTheMotionThroughItMove) {
  move_joint(hoap1(), table, "l_shoulder_roll", 22 * M_PI / 180, 3.1, 0.24);
  options.locked_windows = {{3.1, 3.1}, {3.2404, 3.2404}, {0, 0}, {7, 7}};
  const RepairResult r = repaired("joint_speed");
  EXPECT_GT(r.max_joint_change, 0.01);
  for (const size_t k : {0, 3100, 3240}) {
    const RobotState &was = series.samples[k].state, &is = r.series.samples[k].state;
    EXPECT_EQ(is.theta, was.theta) << k;
    EXPECT_EQ(is.base.position, was.base.position) << k;
    EXPECT_EQ(is.base.attitude.coeffs(), was.base.attitude.coeffs()) << k;
  }
  const int arm = hoap1().find_dof("l_shoulder_roll");
  for (const size_t k : {3060, 3150, 3190})
    EXPECT_GT(std::abs(r.series.samples[k].state.theta[arm] - series.samples[k].state.theta[arm]),
              1e-4)
        << k;
}

// A posture that is wrong where it is locked is reported as such; a speed there is not.
TEST_F(Faults, APostureLockedWhereItIsWrongIsNamed) {
  move_joint(hoap1(), table, "l_elbow", 40 * M_PI / 180, 3, 0.8);
  options.locked_windows = {{3, 3}};
  series = sample(hoap1(), pattern);
  const RepairResult r = repair(hoap1(), series, options);
  EXPECT_EQ(r.status, RepairStatus::infeasible);
  EXPECT_EQ(r.work.rounds, 0);
  ASSERT_EQ(r.reasons.size(), 1u);
  EXPECT_NE(r.reasons[0].find("The posture at 3 s is locked. Remove the lock"), std::string::npos)
      << r.reasons[0];
}

TEST_F(Faults, LockedFootKeepsItsWayAndWeightsSteer) {
  sway_base(hoap1(), table, Vector3d(0, 0.012, 0), 2.44, 0.5);
  motion_alone(table);
  series = sample(hoap1(), pattern);
  ASSERT_TRUE(finds(check_consistency(hoap1(), series), "support_margin"));
  const RepairResult free = repair(hoap1(), series, options);
  ASSERT_EQ(free.status, RepairStatus::repaired);
  options.locked_feet = {false, true};
  options.joint_weights = {{"l_hip_roll", 20.0}};
  const RepairResult kept = repair(hoap1(), series, options);
  ASSERT_EQ(kept.status, RepairStatus::repaired) << kept.reasons[0];
  RobotData a(hoap1()), b(hoap1());
  for (size_t k = 0; k < series.samples.size(); k += 7) {
    update_positions(hoap1(), series.samples[k].state, a);
    update_positions(hoap1(), kept.series.samples[k].state, b);
    EXPECT_LT((sole_pose(hoap1(), a, Side::right).translation() -
               sole_pose(hoap1(), b, Side::right).translation())
                  .norm(),
              5e-5);
  }
  auto moved = [](const RepairResult& r, const std::string& joint) {
    for (const JointChange& j : r.moved.joints)
      if (j.joint == joint) return std::abs(j.most);
    return 0.0;
  };
  EXPECT_LT(moved(kept, "l_hip_roll"), moved(free, "l_hip_roll"));
}

TEST_F(Faults, SteeringThatIsWrongIsRefused) {
  for (double& fz : table.fz) fz *= 1.1;
  series = sample(hoap1(), pattern);
  options.joint_weights = {{"l_kne", 2.0}};
  EXPECT_THROW(repair(hoap1(), series, options), Error);
  options.joint_weights = {{"l_knee", 0.0}};
  EXPECT_THROW(repair(hoap1(), series, options), Error);
  options.joint_weights = {};
  options.locked_windows = {{2, 1}};
  EXPECT_THROW(repair(hoap1(), series, options), Error);
}

// ---- what cannot be

// One swing in a locked window is far too fast: the message has the speed and the time that it
// needs.
TEST_F(Faults, ReasonsNameJointTimeRatioAndTimeNeeded) {
  squeeze(pattern, 0.6);
  options.locked_windows = {{1.75, 2.1}};
  series = sample(hoap1(), pattern);
  const RepairResult r = repair(hoap1(), series, options);
  EXPECT_NE(r.status, RepairStatus::repaired);
  const auto speed = std::find_if(
      r.causes.begin(), r.causes.end(),
      [](const InfeasibilityCause& o) { return o.finding.kind == FindingKind::joint_speed; });
  ASSERT_NE(speed, r.causes.end());
  const InfeasibilityCause& first = *speed;
  EXPECT_GE(first.finding.at, 1.75);
  EXPECT_LE(first.finding.at, 2.1);
  EXPECT_TRUE(first.is_ratio);
  EXPECT_NEAR(first.time_factor, first.violation, 0.011);
  EXPECT_NE(first.text.find(" reaches 1."), std::string::npos) << first.text;
  EXPECT_NE(first.text.find("times its length"), std::string::npos) << first.text;
  EXPECT_NE(first.text.find("locked"), std::string::npos) << first.text;
}

TEST_F(Faults, StoppedRepairKeepsTheLeastViolatingMotion) {
  squeeze(pattern, 0.65);
  series = sample(hoap1(), pattern);
  int calls = 0;
  const Progress stop = [&](const ProgressEvent&) { return ++calls < 8; };
  EXPECT_THROW(repair(hoap1(), series, options, stop), Interrupted);
  calls = 0;
  options.keep_partial = true;
  const RepairResult r = repair(hoap1(), series, options, stop);
  EXPECT_TRUE(r.partial);
  EXPECT_NE(r.status, RepairStatus::repaired);
  EXPECT_GT(r.max_joint_change, 1e-4);
  EXPECT_LT(r.check.summary[FindingKind::joint_speed], r.before.summary[FindingKind::joint_speed]);
}
