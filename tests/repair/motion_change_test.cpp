#include "ayumi/repair/motion_change.hpp"

#include <gtest/gtest.h>

#include "ayumi/base/error.hpp"
#include "tests/support/faults.hpp"
#include "tests/support/limited_biped.hpp"

using namespace ayumi;
using namespace ayumi::test;

TEST(MotionChange, NamesJointsTimesAndQuantities) {
  const CommandSeries before = standing(limited_biped(), 2, 0.002);
  CommandSeries after = before;
  const int elbow = limited_biped().find_dof("l_elbow"),
            arm = limited_biped().find_dof("r_shoulder_pitch");
  for (size_t k = 0; k < after.samples.size(); ++k) {
    const double t = 0.002 * static_cast<double>(k);
    after.samples[k].state.theta[elbow] -= 0.2 * bump(t, 0.8, 0.4);
    after.samples[k].state.theta[arm] += 0.1 * bump(t, 1.2, 0.2);
    after.samples[k].state.base.position.x() += 0.003 * bump(t, 1.0, 0.2);
    after.samples[k].zmp.y() += 0.004 * bump(t, 1.5, 0.2);
  }
  after.samples.resize(901);  // it is shorter, so that only the common part is compared
  const MotionChange change = motion_change(limited_biped(), before, after);
  EXPECT_NEAR(change.compared, 1.8, 1e-9);
  ASSERT_EQ(change.joints.size(), 2u);
  EXPECT_EQ(change.joints[0].joint, "l_elbow");
  EXPECT_NEAR(change.joints[0].most, -0.2, 1e-9);
  EXPECT_NEAR(change.joints[0].at, 0.8, 1e-9);
  EXPECT_EQ(change.joints[1].joint, "r_shoulder_pitch");
  EXPECT_NEAR(change.joints[1].most, 0.1, 1e-9);
  // cos^4 falls to a tenth at 0.6943 rad of pi.
  const double half = 0.4 * std::acos(std::pow(0.1, 0.25)) / M_PI;
  EXPECT_NEAR(change.joints[0].begin, 0.8 - half, 0.002);
  EXPECT_NEAR(change.joints[0].end, 0.8 + half, 0.002);
  EXPECT_NEAR(change.foot.size, 0.003, 1e-9);
  EXPECT_NEAR(change.foot.at, 1, 1e-9);
  EXPECT_NEAR(change.zmp.size, 0.004, 1e-9);
  EXPECT_GT(change.cog.size, 0.0029);
  EXPECT_EQ(change.fz.size, 0);
  CommandSeries other = before;
  other.dt = 0.001;
  EXPECT_THROW(motion_change(limited_biped(), before, other), Error);
}
