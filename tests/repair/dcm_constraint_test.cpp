// A posture that is wrong for a moment moves the COG. In the repaired walk, the divergent component
// is where it was planned, and therefore the capture bounds and the pushes that it withstands are
// as planned.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/control/capture_bound.hpp"
#include "ayumi/repair/repair.hpp"
#include "ayumi/repair/repair_setup.hpp"
#include "ayumi/study/push.hpp"
#include "tests/support/faults.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi::test {
namespace {

constexpr double kStep = 0.06;  // step of a push study's search, in units of the bound

// A walk whose swinging knee is thrown up by 75 degrees in its second step.
class ThrownKnee : public testing::Test {
 protected:
  Pattern plan = [] {
    Pattern walk = walk_pattern(hoap1(), {.steps = 3, .stride = 0.028, .period = 0.72});
    walk.robot = "hoap1";
    return baked(hoap1(), walk);
  }();
  double begin = plan.phases[2].until, end = plan.phases[3].until;
  CommandSeries planned = sample(hoap1(), plan);
  CommandSeries thrown = [this] {
    Pattern pattern = plan;
    const bool left = plan.phases[3].support == Support::left;
    move_joint(hoap1(), *pattern.table, left ? "r_knee" : "l_knee", -75 * M_PI / 180,
               0.5 * (begin + end), 0.4);
    return sample(hoap1(), pattern);
  }();

  const RepairResult& repaired() const {
    static const RepairResult result = repair(hoap1(), thrown);
    return result;
  }

  // The number of pairs of a moment and one of eight directions in which `series` has at least a
  // step less room than planned.
  int smaller_bounds(const CommandSeries& series) const {
    int count = 0;
    for (size_t k = 0; k < planned.samples.size(); k += 20) {
      const CaptureRegion before = capture_region(hoap1(), planned, static_cast<long>(k));
      const CaptureRegion after = capture_region(hoap1(), series, static_cast<long>(k));
      for (int i = 0; i < 8; ++i) {
        const Eigen::Vector2d u(std::cos(i * M_PI / 4), std::sin(i * M_PI / 4));
        const double bound = capture_bound(before, u);
        count += capture_bound(after, u) < (1 - kStep) * bound;
      }
    }
    return count;
  }
};

TEST_F(ThrownKnee, LeavesTheCaptureBoundsAsTheyWerePlanned) {
  ASSERT_EQ(repaired().status, RepairStatus::repaired);
  EXPECT_EQ(smaller_bounds(repaired().series), 0);
  RepairOptions least;
  least.safety = 0;
  const RepairResult cheapest = repair(hoap1(), thrown, least);
  ASSERT_EQ(cheapest.status, RepairStatus::repaired);
  EXPECT_GT(smaller_bounds(cheapest.series), 20);
  EXPECT_LT(cheapest.change.change, repaired().change.change);
}

// DTAD plays the planned COG over the planned feet: a thrown knee of the posture does not affect
// it, and the repaired pattern has to withstand what that plan withstands.
TEST_F(ThrownKnee, RepairedWithstandsThePushesOfItsPlan) {
  PushOptions options;
  options.phases = {{"middle of the step", begin + 0.35 * (end - begin), false}};
  options.controllers = {{ControllerKind::dtad, {}}};
  options.directions = 4;
  options.replicas = 0;
  // A third of the difference that is allowed below, so that the steps themselves do not fail the
  // test.
  options.step = kStep / 3;
  const auto before = push_limits(hoap1(), thrown, options);
  const auto after = push_limits(hoap1(), repaired().series, options);
  for (size_t i = 0; i < before.size(); ++i)
    EXPECT_GE(after[i].limits[0].impulse, before[i].limits[0].impulse - kStep * before[i].bound)
        << before[i].direction << " rad";
}

// The commanded COG is displaced by 15 mm for half a second. It is wrong there, and the posture
// must not follow it.
TEST_F(ThrownKnee, FollowsNoPlanThatIsItselfAtFault) {
  Pattern pattern = plan;
  const double middle = 0.5 * (begin + end);
  for_rows(*pattern.table,
           [&](double t, size_t k) { pattern.table->cog[k].y() += 0.015 * bump(t, middle, 0.6); });
  move_joint(hoap1(), *pattern.table, "l_elbow", 100 * M_PI / 180, middle + 0.9, 0.8);
  const CommandSeries series = sample(hoap1(), pattern);
  const RepairResult repaired = repair(hoap1(), series);
  ASSERT_EQ(repaired.status, RepairStatus::repaired);
  ASSERT_EQ(wrong_plan(repaired.before).size(), 1u);
  RobotData data(hoap1());
  double most = 0;
  for (size_t k = 0; k < series.samples.size(); ++k) {
    update_positions(hoap1(), series.samples[k].state, data);
    most = std::max(most, (repaired.series.samples[k].cog - data.cog).norm());
  }
  EXPECT_LT(most, 0.003);
}

}  // namespace
}  // namespace ayumi::test
