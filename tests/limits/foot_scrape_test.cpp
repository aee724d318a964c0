// A swinging sole that moves along the ground must be high enough above it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/check/consistency.hpp"
#include "ayumi/plan/foot_plan.hpp"
#include "ayumi/plan/sample.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi::test {
namespace {

Pattern walk_with_lift(double lift) {
  Pattern pattern = walk_pattern(hoap1(), {.steps = 2});
  pattern.robot = "hoap1";
  for (Phase& phase : pattern.phases)
    if (phase.swing) phase.swing->lift = lift;
  return pattern;
}

std::vector<Finding> scrapes(const Pattern& pattern) {
  std::vector<Finding> found;
  for (const Finding& f : check_consistency(hoap1(), sample(hoap1(), pattern)).findings)
    if (f.kind == FindingKind::foot_scrape) found.push_back(f);
  return found;
}

TEST(FootScrape, ALowSwingIsFoundWithItsHeight) {
  const std::vector<Finding> found = scrapes(walk_with_lift(0.0006));
  ASSERT_EQ(found.size(), 3u);  // two steps, and one that brings the feet together
  for (const Finding& f : found) {
    EXPECT_EQ(f.severity, Severity::error);
    EXPECT_EQ(f.unit, "m");
    EXPECT_NEAR(f.limit, 0.001, 1e-12);
    // The foot is lowest where it begins to be away from its places, and highest in the middle.
    EXPECT_GE(f.worst, 0);
    EXPECT_LT(f.worst, 0.0006);
  }
  EXPECT_EQ(found[0].where, "right");
  EXPECT_EQ(found[1].where, "left");
  EXPECT_TRUE(scrapes(walk_with_lift(0.012)).empty());
}

// While the robot stands on the left foot, the right foot stays on the ground without a load.
TEST(FootScrape, AFootThatRestsOrRisesInPlaceIsLeftAlone) {
  for (const double lift : {0.0, 0.0005, 0.02}) {
    Pattern pattern;
    pattern.robot = "hoap1";
    const auto feet = start_feet(hoap1(), pattern);
    for (const auto& [until, support] :
         {std::pair(1.2, Support::both), std::pair(2.0, Support::left),
          std::pair(3.4, Support::both)}) {
      Phase phase;
      phase.until = until;
      phase.support = support;
      if (support == Support::left && lift > 0) {
        phase.swing.emplace();
        phase.swing->foot = Side::right;
        phase.swing->to.position = feet[1].translation();
        phase.swing->to.rpy.setZero();
        phase.swing->lift = lift;
      }
      pattern.phases.push_back(phase);
    }
    Keyframe key;
    key.zmp = ZmpKey{.place = ZmpKey::Place::center};
    pattern.keyframes.push_back(key);
    EXPECT_TRUE(scrapes(pattern).empty()) << lift;
  }
}

TEST(FootScrape, TheLimitIsATolerance) {
  Pattern pattern = walk_with_lift(0.0006);
  CheckOptions options;
  options.tolerances["foot_scrape"] = 0;
  for (const Finding& f : check_consistency(hoap1(), sample(hoap1(), pattern), options).findings)
    EXPECT_NE(f.kind, FindingKind::foot_scrape);
}

}  // namespace
}  // namespace ayumi::test
