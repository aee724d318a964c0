// A swinging sole that is low must be level and over its place, and other soles must not be low.
// This is tested for programs and for the motions that they repair.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/check/consistency.hpp"
#include "ayumi/demand/ground_demand.hpp"
#include "ayumi/limits/swing_foot.hpp"
#include "ayumi/repair/correction_problem.hpp"
#include "ayumi/repair/repair.hpp"
#include "tests/support/faults.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi::test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

Pattern table_of(const WalkParameters& parameters) {
  Pattern pattern = walk_pattern(hoap1(), parameters);
  pattern.robot = "hoap1";
  return baked(hoap1(), pattern);
}

// The sole is 3 mm ahead, 4 mm to the left and 20 mm above a place that is turned and on a slope,
// rolled by 0.01 rad and turned by 0.02 rad. The offsets are along the place's axes; the rotations
// are multiplied by half the size of the sole.
TEST(Landing, OffsetIsAlongThePlacesAxes) {
  Isometry3d place = Isometry3d::Identity();
  place.linear() = exp_rotation({0.1, -0.05, 0.8}).toRotationMatrix();
  place.translation() = Vector3d(0.3, -0.2, 0.05);
  Isometry3d off = Isometry3d::Identity();
  off.translation() = Vector3d(0.003, 0.004, 0.020);
  off.linear() = exp_rotation({0.01, 0, 0.02}).toRotationMatrix();
  const auto offset = landing_offset(hoap1(), Side::left, place * off, place);
  const double reach = std::hypot(0.056, 0.0315);
  EXPECT_NEAR(offset[0], 0.003, 1e-12);
  EXPECT_NEAR(offset[1], 0.004, 1e-12);
  EXPECT_NEAR(offset[2], 0.01 * reach, 3e-7);  // it is the sine of that angle
  EXPECT_NEAR(offset[3], 0, 1e-12);
  EXPECT_NEAR(offset[4], 0.02 * reach, 3e-7);
}

// An unchanged walk satisfies all rows.
TEST(Landing, ASoundWalkMeetsItsRows) {
  const Pattern pattern = table_of({.steps = 3, .stride = 0.025, .turn = 0.08, .side = 0.02});
  const CommandSeries series = sample(hoap1(), pattern);
  CorrectionSpec spec;
  spec.windows = {{0, series.duration()}};
  spec.watched_share = 0;
  const CorrectionProblem problem(hoap1(), series, spec);
  const Eigen::VectorXd g = problem.constraints(Eigen::VectorXd::Zero(problem.variable_count()));
  std::map<std::string, int> rows;
  for (const RowBlock& b : problem.blocks()) {
    const std::string kind = b.kind->name;
    if (kind != "landing" && kind != "foot_clearance") continue;
    for (int i = b.row; i < b.row + b.rows(); ++i) {
      EXPECT_GE(g[i], problem.lower()[i] - 1e-5) << "at " << problem.points()[b.point].sample;
      ++rows[kind];
    }
  }
  EXPECT_GT(rows["landing"], 200);
  EXPECT_GT(rows["foot_clearance"], 100);
}

// The distance of a swinging foot from its place while it is lower than 1.5 mm, in the tenth of a
// second before it lands [m].
double low_offset(const CommandSeries& series, Side side, int landing) {
  const Isometry3d place = series.samples[landing + 10].feet[static_cast<int>(side)];
  RobotData data(hoap1());
  double most = 0;
  for (int k = landing - 100; k < landing; ++k) {
    update_positions(hoap1(), series.samples[k].state, data);
    const SoleError error = sole_error(hoap1().sole(side), sole_pose(hoap1(), data, side), place);
    if (error.lowest < 0.0015) most = std::max(most, error.slip);
  }
  return most;
}

// In an earlier version, a foot that had to land 60 ms earlier approached the ground 7 mm beside
// its place. A robot whose servos sag under its weight by a millimetre stumbled over this foot.
TEST(Landing, EarlyContactComesDownOnItsPlace) {
  Pattern pattern = table_of({.steps = 9, .stride = 0, .side = 0.03});
  size_t step = pattern.phases.size() / 2;
  if (!pattern.phases[step].swing) ++step;
  pattern.phases[step].until -= 0.06;
  const CommandSeries series = sample(hoap1(), pattern);
  const RepairResult r = repair(hoap1(), series);
  ASSERT_EQ(r.status, RepairStatus::repaired);
  const int landing = static_cast<int>(std::lround(pattern.phases[step].until / series.dt));
  EXPECT_LT(low_offset(r.series, pattern.phases[step].swing->foot, landing), 0.0012);
}

// Each foot slides along the ground where it begins to move, and is raised there.
TEST(Landing, AWalkWhoseFeetScrapeIsRepaired) {
  Pattern pattern = walk_pattern(hoap1(), {.steps = 2});
  for (Phase& phase : pattern.phases)
    if (phase.swing) phase.swing->lift = 0.0006;
  const auto scrapes = [](const ConsistencyReport& report) {
    return std::count_if(report.findings.begin(), report.findings.end(),
                         [](const Finding& f) { return f.kind == FindingKind::foot_scrape; });
  };
  const CommandSeries series = sample(hoap1(), pattern);
  EXPECT_GT(scrapes(check_consistency(hoap1(), series)), 0);
  for (const double safety : {0.0, 0.5}) {
    RepairOptions options;
    options.safety = safety;
    const RepairResult r = repair(hoap1(), series, options);
    EXPECT_EQ(r.status, RepairStatus::repaired) << safety;
    EXPECT_EQ(scrapes(check_consistency(hoap1(), r.series)), 0) << safety;
  }
}

// A motion on ground of 50 mm that begins in a swing: the place and the ground of this swing are
// those of the landing, and not the pose in the middle of the swing.
TEST(Landing, ASwingAtTheBeginningIsAboveItsLandingPlace) {
  const CommandSeries walk = sample(hoap1(), walk_pattern(hoap1(), {.steps = 2}));
  const ContactPlan plan = contact_plan(walk);
  const size_t foot =
      plan.intervals[0].size() > 2 && plan.intervals[0][1].first < plan.intervals[1][1].first ? 0
                                                                                              : 1;
  const ContactInterval& swing = plan.intervals[foot][1];
  CommandSeries series = walk;
  series.samples.assign(walk.samples.begin() + (swing.first + swing.last) / 2, walk.samples.end());
  const Vector3d up(0, 0, 0.05);
  for (CommandSample& s : series.samples) {
    s.state.base.position += up;
    s.cog += up;
    s.zmp += up;
    for (Isometry3d& sole : s.feet) sole.translation() += up;
  }
  CorrectionSpec spec;
  spec.windows = {{0, series.duration()}};
  const CorrectionProblem problem(hoap1(), series, spec);
  ASSERT_FALSE(problem.points().front().contact[foot]);
  const int landing = contact_plan(series).intervals[foot][1].first - 1;
  for (const CollocationPoint& point : problem.points()) {
    if (point.sample > landing) continue;
    for (const Isometry3d& at : {point.ground[foot], point.place[foot]})
      EXPECT_NEAR(at.translation().z(), 0.05, 1e-9) << point.sample;
  }
}

// The height of the lowest corner of a foot in the middle half of a swing [m].
double clearance_of(const CommandSeries& series, Side side, int lift, int landing) {
  RobotData data(hoap1());
  const int quarter = (landing - lift) / 4;
  double least = 1;
  for (int k = lift + quarter; k <= landing - quarter; ++k) {
    update_positions(hoap1(), series.samples[k].state, data);
    const SoleError error = sole_error(hoap1().sole(side), sole_pose(hoap1(), data, side),
                                       series.samples[landing + 10].feet[static_cast<int>(side)]);
    least = std::min(least, error.lowest);
  }
  return least;
}

// A knee that stretches by 75 degrees moves the swinging foot through the ground. In an earlier
// version, the foot was only raised to the ground: it scraped over the ground because the servos
// sag, and the robot fell.
TEST(Landing, AThrownKneePassesOverTheGround) {
  Pattern pattern = table_of({.steps = 5, .stride = 0.02, .lift = 0.018, .turn = 0.08});
  size_t step = pattern.phases.size() / 2;
  if (!pattern.phases[step].swing) ++step;
  const Side side = pattern.phases[step].swing->foot;
  const double lift = pattern.phases[step - 1].until, landing = pattern.phases[step].until;
  const CommandSeries sound = sample(hoap1(), pattern);
  move_joint(hoap1(), *pattern.table, side == Side::left ? "l_knee" : "r_knee", -1.3,
             0.5 * (lift + landing), 0.45);
  const RepairResult r = repair(hoap1(), sample(hoap1(), pattern));
  ASSERT_EQ(r.status, RepairStatus::repaired);
  auto tick = [&](double t) { return static_cast<int>(std::lround(t / sound.dt)); };
  const double wanted = 0.5 * clearance_of(sound, side, tick(lift), tick(landing));
  EXPECT_GT(wanted, 0.003);
  EXPECT_GT(clearance_of(r.series, side, tick(lift), tick(landing)), 0.9 * wanted);
}

}  // namespace
}  // namespace ayumi::test
