// A swinging sole that moves along the ground must be high enough above it.

#include "ayumi/limits/foot_scrape.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/author/generate/pattern_builder.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/check/consistency.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/motion/differentiate.hpp"
#include "ayumi/plan/foot_plan.hpp"
#include "ayumi/plan/sample.hpp"
#include "tests/support/hoap1.hpp"
#include "tests/support/robot_motions.hpp"

namespace ayumi::test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

Pattern walk_with_lift(double lift) {
  Pattern pattern = walk_pattern(hoap1(), {.steps = 2});
  pattern.robot = "hoap1";
  for (Phase& phase : pattern.phases)
    if (phase.swing) phase.swing->lift = lift;
  return pattern;
}

std::vector<Finding> scrapes_of(const CommandSeries& series, const RobotModel& model = hoap1()) {
  std::vector<Finding> found;
  for (const Finding& f : check_consistency(model, series).findings)
    if (f.kind == FindingKind::foot_scrape) found.push_back(f);
  return found;
}

std::vector<Finding> scrapes_of(const Pattern& pattern) {
  return scrapes_of(sample(hoap1(), pattern));
}

// ---- the limit alone: a right foot that swings for a hundred samples

constexpr double kLow = 0.0003, kSlip = 0.002;

Isometry3d pose(double x, double z, double pitch = 0) {
  Isometry3d at = Isometry3d::Identity();
  at.translation() = Vector3d(x, 0, z);
  at.linear() = exp_rotation({0, pitch, 0}).toRotationMatrix();
  return at;
}

/// A sole of 100 mm that swings from one place to the other. `path` is its pose as a function of
/// the share of the swing that has passed. Returns the heights of scraping corners and their
/// samples.
struct Swing {
  Isometry3d from = pose(0, 0), to = pose(0.1, 0);
  std::function<Isometry3d(double)> path;
  bool stands_before = true;

  std::vector<std::vector<Scrape>> scraping() const {
    Sole sole;
    sole.polygon = {{0.05, 0.02}, {-0.05, 0.02}, {-0.05, -0.02}, {0.05, -0.02}};
    const int still = stands_before ? 10 : 0, count = still + 110;
    ContactPlan plan;
    plan.intervals[0] = {{0, count - 1, true, pose(0, 0)}};
    if (stands_before) plan.intervals[1].push_back({0, 9, true, from});
    plan.intervals[1].push_back({still, still + 99, false, pose(0, 0)});
    plan.intervals[1].push_back({still + 100, count - 1, true, to});
    for (int s = 0; s < 2; ++s) plan.index[s] = interval_index(plan.intervals[s]);
    std::vector<Isometry3d> poses(count, from);
    for (int k = still; k < count; ++k) poses[k] = k < still + 100 ? path((k - still) / 100.0) : to;
    return scrapes(
        sole, plan, Side::right, [&](int k) { return poses[static_cast<size_t>(k)]; }, kLow, kSlip);
  }

  int count() const {
    int sum = 0;
    for (const auto& at : scraping()) sum += static_cast<int>(at.size());
    return sum;
  }
};

double share(double s, double from, double to) {
  return std::clamp((s - from) / (to - from), 0.0, 1.0);
}

/// The pose of a sole that is turned about its heel (or its toe), which is at (x, z).
Isometry3d about(double heel_or_toe, double x, double z, double pitch) {
  return pose(x, z) * exp_rotation({0, pitch, 0}) * pose(-heel_or_toe, 0);
}

TEST(FootScrape, ASoleThatSlidesScrapesAwayFromBothPlaces) {
  const Swing slide = {.path = [](double s) { return pose(0.1 * s, 0.0001); }};
  const auto found = slide.scraping();
  for (int k = 0; k < static_cast<int>(found.size()); ++k) {
    const double x = 0.001 * (k - 10);
    if (std::abs(x - kSlip) < 1e-9 || std::abs(x - (0.1 - kSlip)) < 1e-9) continue;  // rounding
    EXPECT_EQ(found[k].size(), x > kSlip && x < 0.1 - kSlip ? 4u : 0u) << k;
    for (const Scrape& scrape : found[k]) EXPECT_NEAR(scrape.height, 0.0001, 1e-12);
  }
}

// The toe (or the heel) moves by 3.4 mm along the ground while the other end rests on it.
TEST(FootScrape, AHeelStrikeAndAToeOffAreNoScrapes) {
  const double pitch = 0.26;  // 15 deg
  const Swing heel = {.path = [&](double s) {
    return about(-0.05, 0.05 * share(s, 0, 0.5) * 2 - 0.05,
                 0.01 * (1 - share(s, 0.5, 0.7)) * (s > 0), -pitch * (1 - share(s, 0.7, 1)));
  }};
  EXPECT_EQ(heel.count(), 0);
  const Swing toe = {.path = [&](double s) {
    return about(0.05, 0.05 + 0.1 * share(s, 0.5, 0.9),
                 0.01 * share(s, 0.3, 0.5) * (1 - share(s, 0.9, 1)),
                 pitch * share(s, 0, 0.3) * (1 - share(s, 0.5, 0.9)));
  }};
  EXPECT_EQ(toe.count(), 0);
}

TEST(FootScrape, AFootThatRestsAwayFromItsPlacesIsNoScrape) {
  const Swing rest = {.path = [](double s) {
    const double away = share(s, 0.6, 0.9);
    return pose(0.05 * share(s, 0.1, 0.3) + 0.05 * away,
                0.0001 + 0.01 * share(s, 0, 0.1) * (1 - share(s, 0.3, 0.4)) +
                    0.01 * share(s, 0.5, 0.6) * (1 - share(s, 0.9, 1)));
  }};
  EXPECT_EQ(rest.count(), 0);
}

// The toe comes down in the middle of the swing and slides by 20 mm.
TEST(FootScrape, OnlyTheCornersThatSlideAreNamed) {
  const Swing toe = {.path = [](double s) {
    const double high = 0.01 * share(s, 0, 0.1) * (1 - share(s, 0.9, 1));
    return about(0.05, 0.05 + 0.1 * share(s, 0.1, 0.9), s > 0.4 && s < 0.56 ? 0.0002 : high,
                 0.2 * share(s, 0, 0.1) * (1 - share(s, 0.9, 1)));
  }};
  std::set<int> corners;
  int samples = 0;
  for (const auto& at : toe.scraping()) {
    samples += !at.empty();
    for (const Scrape& scrape : at) corners.insert(scrape.corner);
  }
  EXPECT_EQ(corners, (std::set<int>{0, 3}));
  EXPECT_GT(samples, 8);
  EXPECT_LT(samples, 16);
}

// The foot comes down from a step of 20 mm. Over the upper tread it may be low, and beside the
// lower one it may not.
TEST(FootScrape, TheHeightOverTheLowerPlaceCounts) {
  Swing down = {.from = pose(0, 0.02), .path = [](double s) { return pose(0.1 * s, 0.0201); }};
  EXPECT_EQ(down.count(), 0);
  down.path = [](double s) { return pose(0.1 * s, 0.0001); };
  const auto found = down.scraping();
  ASSERT_EQ(found[60].size(), 4u);
  EXPECT_EQ(found[60][0].place, 2);
  EXPECT_NEAR(found[60][0].height, 0.0001, 1e-12);
}

// A motion may begin with a swing: then only the place of landing is known.
TEST(FootScrape, ASwingAtTheBeginningHasOnePlace) {
  Swing first = {.to = pose(0.1, 0.05),
                 .path = [](double s) { return pose(0.1 * s, 0.0501); },
                 .stands_before = false};
  EXPECT_GT(first.count(), 300);
  first.path = [](double s) { return pose(0.1 * s, 0.05 + 0.02 * (1 - share(s, 0.9, 1))); };
  EXPECT_EQ(first.count(), 0);
}

// ---- motions

TEST(FootScrape, ALowSwingIsFoundWithItsHeight) {
  const std::vector<Finding> found = scrapes_of(walk_with_lift(0.0006));
  ASSERT_GE(found.size(), 3u);  // two steps, and one that brings the feet together
  for (const Finding& f : found) {
    EXPECT_EQ(f.severity, Severity::error);
    EXPECT_EQ(f.unit, "m");
    EXPECT_NEAR(f.limit, 0.0003, 1e-12);
    // The foot is lowest where it begins to be away from its places, and highest in the middle.
    EXPECT_GE(f.worst, 0);
    EXPECT_LT(f.worst, 0.0003);
    EXPECT_NE(f.hint.find("at least 0.30 mm"), std::string::npos) << f.hint;
  }
  EXPECT_EQ(found[0].where, "right");
  EXPECT_TRUE(scrapes_of(walk_with_lift(0.012)).empty());
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
    EXPECT_TRUE(scrapes_of(pattern).empty()) << lift;
  }
}

// `new walk` accepts no lift with which the feet scrape.
TEST(FootScrape, TheLowestLiftPasses) {
  for (const char* robot : {"hoap1", "humanoid30"}) {
    const RobotModel& model = bundled_robot(robot);
    const double leg = leg_length(model), lowest = std::max(0.002, 0.01 * leg);
    for (const double share : {0.05, 0.15, 0.25}) {
      WalkParameters p = walk_defaults(model);
      p.steps = 2;
      p.lift = 1e-4 * std::ceil(1e4 * lowest - 1e-6);
      p.stride = share * leg;
      EXPECT_TRUE(scrapes_of(sample(model, walk_pattern(model, p)), model).empty())
          << robot << ' ' << share;
    }
    WalkParameters low = walk_defaults(model);
    low.lift = 0.9 * lowest;
    EXPECT_THROW(walk_pattern(model, low), Error) << robot;
  }
}

TEST(FootScrape, TheLimitIsATolerance) {
  Pattern pattern = walk_with_lift(0.0006);
  CheckOptions options;
  options.tolerances["foot_scrape"] = 0;
  for (const Finding& f : check_consistency(hoap1(), sample(hoap1(), pattern), options).findings)
    EXPECT_NE(f.kind, FindingKind::foot_scrape);
}

// ---- causes

// A knee that is stretched for a moment while the foot swings presses the foot into the ground. The
// foot also scrapes it before and after it is too deep, which is no error of its own.
TEST(FootScrape, AScrapeFollowsFromAFootInTheGround) {
  CommandSeries series = sample(hoap1(), walk_pattern(hoap1(), {.steps = 2}));
  const ContactPlan plan = contact_plan(series);
  const ContactInterval& swing = plan.intervals[1][1];
  const int knee = hoap1().leg(Side::right)[3];
  for (int k = swing.first; k <= swing.last; ++k) {
    const double s = static_cast<double>(k - swing.first) / (swing.last - swing.first);
    series.samples[k].state.theta[knee] *= 1 - std::pow(std::sin(M_PI * s), 4);
  }
  fill_rates(series.samples, series.dt, true);
  const std::vector<Finding> findings = check_consistency(hoap1(), series).findings;
  int scraped = 0, sank = 0;
  for (const Finding& f : findings) {
    sank += f.kind == FindingKind::foot_penetration && f.severity == Severity::error;
    if (f.kind != FindingKind::foot_scrape) continue;
    ++scraped;
    EXPECT_EQ(f.severity, Severity::warning) << f.begin;
  }
  EXPECT_GT(sank, 0);
  EXPECT_GT(scraped, 0);
}

}  // namespace
}  // namespace ayumi::test
