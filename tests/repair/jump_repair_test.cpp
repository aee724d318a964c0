// Jumps whose posture is wrong, in flight and after it.

#include <gtest/gtest.h>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/repair/repair.hpp"
#include "tests/support/faults.hpp"
#include "tests/support/hoap1.hpp"

using namespace ayumi;
using namespace ayumi::test;

namespace {

class JumpRepair : public testing::Test {
 protected:
  Pattern pattern = [] {
    Pattern p = jump_pattern(hoap1(), jump_defaults(hoap1()));
    p.robot = "hoap1";
    p.profile = "hoap1-strong";
    return baked(hoap1(), p);
  }();
  DenseTable& table = *pattern.table;

  // Middle and length of the flight.
  std::pair<double, double> flight() const {
    for (size_t i = 1; i < pattern.phases.size(); ++i)
      if (pattern.phases[i].support == Support::none) {
        const double begin = pattern.phases[i - 1].until, end = pattern.phases[i].until;
        return {0.5 * (begin + end), end - begin};
      }
    return {};
  }

  RepairResult repaired(const std::string& kind) {
    const CommandSeries series = sample(hoap1(), pattern);
    RepairOptions options;
    options.check.profile = pattern.profile;
    const ConsistencyReport before = check_consistency(hoap1(), series, options.check);
    EXPECT_TRUE(std::any_of(before.findings.begin(), before.findings.end(), [&](const Finding& f) {
      return f.severity == Severity::error && name_of(f.kind) == kind;
    }));
    const RepairResult r = repair(hoap1(), series, options);
    EXPECT_EQ(r.status, RepairStatus::repaired) << (r.reasons.empty() ? "" : r.reasons[0]);
    EXPECT_LE(r.constraint_violation, 1e-6);
    EXPECT_LT(r.iterations, 120);
    pattern.correction = r.correction;
    EXPECT_EQ(repair(hoap1(), sample(hoap1(), pattern), options).status,
              RepairStatus::already_consistent);
    return r;
  }
};

}  // namespace

TEST_F(JumpRepair, BodyThatRisesInFlight) {
  const auto [middle, length] = flight();
  for_rows(table, [&](double t, size_t k) {
    table.base[k].position.z() += 0.004 * bump(t, middle, 0.9 * length);
  });
  const RepairResult r = repaired("ballistic");
  EXPECT_LT(r.check.summary[FindingKind::ballistic], 0.5);
  EXPECT_NEAR(r.max_cog_change, 0.004, 5e-4);
}

TEST_F(JumpRepair, ArmThatSwingsInFlight) {
  const auto [middle, length] = flight();
  move_joint(hoap1(), table, "l_shoulder_pitch", -0.5, middle, 0.9 * length);
  EXPECT_LT(repaired("ballistic").check.summary[FindingKind::ballistic], 0.5);
}

// The window includes the flight, which stays as correct as it was.
TEST_F(JumpRepair, ArmBeyondItsLimitAfterLanding) {
  const int arm = hoap1().find_dof("l_shoulder_pitch");
  const double at = flight().first + 0.28;
  const double now = table.theta(std::lround(at / table.dt), arm);
  const double over = hoap1().dofs()[arm].upper + 0.14;
  move_joint(hoap1(), table, "l_shoulder_pitch", over - now, at, 1.2);
  const RepairResult r = repaired("joint_position");
  EXPECT_EQ(r.where, "l_shoulder_pitch");
}
