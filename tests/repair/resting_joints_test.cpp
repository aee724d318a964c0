// Joints that rest at an end of their range, as the joints of many robots do in the home posture.

#include "ayumi/repair/resting_joints.hpp"

#include <gtest/gtest.h>

#include "ayumi/repair/repair.hpp"
#include "tests/support/ten_faults.hpp"

namespace ayumi::test {
namespace {

// HOAP-1 whose elbows and shoulders have an end of their range exactly where they are in a walk.
RobotModel hoap1_at_limits(const CommandSeries& series) {
  RobotDescription description = hoap1().description();
  const auto& rest = series.samples.front().state.theta;
  for (const std::string side : {"l", "r"})
    for (const std::string joint : {"_elbow", "_shoulder_roll"}) {
      const std::string name = side + joint;
      for (auto& j : description.joints) {
        if (j.name != name) continue;
        const double theta = rest[hoap1().find_dof(name)];
        j.upper = theta + description.soft_limit_margin;
      }
    }
  return RobotModel(description);
}

FaultyMotion thrown_knee() { return ten_faulty_motions()[0]; }

TEST(RestingJoints, AreFoundWhileTheyRest) {
  const FaultyMotion motion = thrown_knee();
  const RobotModel model = hoap1_at_limits(motion.series);
  CommandSeries series = motion.series;
  const int elbow = model.find_dof("l_elbow");
  const auto windows = [&](const std::vector<Finding>& errors) {
    return rests_at_limits(model, series, model.limits(), errors);
  };
  const auto whole = windows({});
  ASSERT_EQ(whole[static_cast<size_t>(elbow)].size(), 1u);
  EXPECT_EQ(whole[static_cast<size_t>(elbow)][0], TimeWindow(0, series.duration()));
  EXPECT_TRUE(whole[static_cast<size_t>(model.find_dof("l_knee"))].empty());
  for (size_t k = 1000; k < 1200; ++k) series.samples[k].state.theta[elbow] -= 0.2;
  const auto parts = windows({});
  ASSERT_EQ(parts[static_cast<size_t>(elbow)].size(), 2u);
  EXPECT_NEAR(parts[static_cast<size_t>(elbow)][0].second, 0.999, 1e-9);
  EXPECT_NEAR(parts[static_cast<size_t>(elbow)][1].first, 1.2, 1e-9);
  Finding error;
  error.severity = Severity::error;
  error.place = Place(JointPlace{elbow});
  EXPECT_TRUE(windows({error})[static_cast<size_t>(elbow)].empty());
}

TEST(RestingJoints, DoNotPreventARepair) {
  for (const size_t i : {0u, 3u, 7u}) {
    const FaultyMotion motion = ten_faulty_motions()[i];
    const RobotModel model = hoap1_at_limits(motion.series);
    const RepairResult r = repair(model, motion.series, motion.options);
    EXPECT_EQ(r.status, RepairStatus::repaired)
        << motion.name << ": " << (r.reasons.empty() ? "" : r.reasons[0]);
    for (const JointChange& change : r.moved.joints)
      EXPECT_TRUE(change.joint.find("elbow") == std::string::npos) << motion.name;
  }
}

}  // namespace
}  // namespace ayumi::test
