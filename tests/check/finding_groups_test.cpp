#include "ayumi/check/finding_groups.hpp"

#include <gtest/gtest.h>

#include "ayumi/limits/amount_text.hpp"
#include "tests/support/check_report.hpp"
#include "tests/support/limited_biped.hpp"
#include "tests/support/walk.hpp"

using namespace ayumi;
using namespace ayumi::test;

namespace {

Finding finding(FindingKind kind, Place place, const std::string& where, double at, double worst,
                double limit, int cause = -1) {
  Finding f;
  f.kind = kind;
  f.severity = cause < 0 ? Severity::error : Severity::warning;
  f.begin = f.end = f.at = at;
  f.worst = worst;
  f.limit = limit;
  f.place = std::move(place);
  f.where = where;
  f.cause = cause;
  return f;
}

Finding too_fast(const std::string& joint, double at, double speed) {
  return finding(FindingKind::joint_speed, JointPlace{limited_biped().find_dof(joint)}, joint, at,
                 speed, 4);
}

/// How often each finding is in a group, either as a member or as a consequence of a member.
std::vector<int> uses(const ConsistencyReport& report, const std::vector<FindingGroup>& groups) {
  std::vector<int> used(report.findings.size(), 0);
  int consequences = 0;
  for (const FindingGroup& group : groups) {
    for (const int i : group.members) ++used[i];
    for (const GroupConsequence& c : group.consequences) consequences += c.count;
  }
  for (size_t i = 0; i < used.size(); ++i)
    if (report.findings[i].cause >= 0 && used[i] == 0 && consequences-- > 0) ++used[i];
  EXPECT_EQ(consequences, 0);
  return used;
}

CommandSeries walk_in(double share_of_time) {
  CommandSeries series = walk(limited_biped());
  series.dt *= share_of_time;
  complete_series(limited_biped(), series);
  return series;
}

}  // namespace

TEST(FindingGroups, LeftAndRightOfOneJointAreOneCauseAndOtherJointsAreNot) {
  ConsistencyReport report;
  report.findings = {too_fast("l_knee", 1.0, 4.5), too_fast("r_knee", 1.5, -5.5),
                     too_fast("l_hip_pitch", 1.6, 4.2), too_fast("l_knee", 2.0, 4.1)};
  const std::vector<FindingGroup> groups = finding_groups(report, limited_biped());
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].members, (std::vector<int>{0, 1, 3}));
  EXPECT_EQ(groups[0].worst, 1);  // -5.5 rad/s is the fastest
  EXPECT_EQ(groups[0].places, (std::vector<std::string>{"l_knee", "r_knee"}));
  EXPECT_EQ(groups[1].members, std::vector<int>{2});
}

// A finding of a file has no place, only the name of it.
TEST(FindingGroups, FindingsOfAFileAreGroupedAsTheyWere) {
  ConsistencyReport report;
  report.findings = {
      too_fast("l_knee", 1.0, 4.5), too_fast("r_knee", 1.5, -5.5),
      finding(FindingKind::foot_slip, FootPlace{Side::left}, "left", 3.0, 0.02, 0.001),
      finding(FindingKind::foot_slip, FootPlace{Side::right}, "right", 3.5, 0.02, 0.001)};
  // Both pairs of thigh and trunk.
  for (const char* name : {"l_knee", "r_knee"}) {
    const int body = limited_biped().dofs()[limited_biped().find_dof(name)].body;
    report.findings.push_back(
        finding(FindingKind::self_collision, BodyPairPlace{0, body},
                limited_biped().bodies()[0].name + " - " + limited_biped().bodies()[body].name, 4,
                -0.01, 0.002));
  }
  const size_t before = finding_groups(report, limited_biped()).size();
  for (Finding& f : report.findings) f.place = {};
  EXPECT_EQ(before, 3u);
  EXPECT_EQ(finding_groups(report, limited_biped()).size(), before);
}

TEST(FindingGroups, WhatFollowsFromAFindingIsCountedWithItThroughAllSteps) {
  ConsistencyReport report;
  report.findings = {
      too_fast("l_knee", 1.0, 4.5),
      finding(FindingKind::foot_slip, FootPlace{Side::left}, "left foot", 3.0, 0.02, 0.001),
      finding(FindingKind::table_step, JointPlace{0}, "a", 1.0, 60, 57, 0),
      finding(FindingKind::joint_torque, JointPlace{0}, "b", 1.1, 9, 3, 2),
      finding(FindingKind::table_step, JointPlace{1}, "c", 1.2, 70, 57, 0)};
  const std::vector<FindingGroup> groups = finding_groups(report, limited_biped());
  ASSERT_EQ(groups.size(), 2u);
  ASSERT_EQ(groups[0].consequences.size(), 2u);
  EXPECT_EQ(groups[0].consequences[0].kind, FindingKind::table_step);
  EXPECT_EQ(groups[0].consequences[0].count, 2);
  EXPECT_EQ(groups[0].consequences[0].worst, 4);
  EXPECT_EQ(groups[0].consequences[1].kind, FindingKind::joint_torque);
  EXPECT_TRUE(groups[1].consequences.empty());
}

TEST(FindingGroups, EveryFindingOfAFastWalkIsInOneGroup) {
  const CommandSeries series = walk_in(0.4);
  const ConsistencyReport report = check_consistency(limited_biped(), series);
  ASSERT_GT(report.findings.size(), 10u) << print(report);
  const std::vector<FindingGroup> groups = finding_groups(report, limited_biped());
  EXPECT_LT(groups.size(), report.findings.size() / 2);
  for (const int n : uses(report, groups)) EXPECT_EQ(n, 1);
  // The cause of a consequence is an error of its own, and the text names it.
  for (const Finding& f : report.findings) {
    EXPECT_EQ(f.cause >= 0, !f.follows_from.empty());
    if (f.cause < 0) continue;
    const Finding& cause = report.findings[f.cause];
    EXPECT_NE(f.follows_from.find(kind_and_place(cause.kind, cause.where)), std::string::npos)
        << f.follows_from;
  }
}

// The place of each figure is found again from the commands themselves.
TEST(FindingGroups, TheSummaryNamesTheJointAndTheTimeOfTheFastestSample) {
  const CommandSeries series = walk_in(0.8);
  const RobotModel& model = limited_biped();
  const ConsistencyReport report = check_consistency(model, series);
  double most = 0, at = 0;
  std::string joint;
  for (size_t k = 0; k < series.samples.size(); ++k)
    for (int i = 0; i < model.dof_count(); ++i) {
      const double ratio = std::abs(series.samples[k].state.dtheta[i]) / model.limits().speed[i];
      if (ratio > most) {
        most = ratio;
        at = static_cast<double>(k) * series.dt;
        joint = model.dofs()[i].name;
      }
    }
  EXPECT_DOUBLE_EQ(report.summary[FindingKind::joint_speed], most);
  EXPECT_EQ(report.summary_at[FindingKind::joint_speed].where, joint);
  EXPECT_DOUBLE_EQ(report.summary_at[FindingKind::joint_speed].at, at);
}
