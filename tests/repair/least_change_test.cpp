// The repaired motion is compared with twenty others that also pass the check: parts of the
// correction, the correction with smooth noise, and, if it touches so many limits that noise breaks
// one of them, noisy motions between it and a correction for stricter limits. This is done for
// every fault that needs a change of the motion.

#include <gtest/gtest.h>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/motion/correction.hpp"
#include "ayumi/repair/repair.hpp"
#include "ayumi/repair/robustness_cost.hpp"
#include "tests/support/faults.hpp"
#include "tests/support/hoap1.hpp"
#include "tests/support/random_robot.hpp"
#include "tests/support/weighted_change.hpp"

using namespace ayumi;
using namespace ayumi::test;
using Eigen::Vector3d;

namespace {

const Pattern& trial_walk() {
  static const Pattern pattern = [] {
    Pattern walk = walk_pattern(hoap1(), {.steps = 3, .stride = 0.033, .lift = 0.017});
    walk.robot = "hoap1";
    return baked(hoap1(), walk);
  }();
  return pattern;
}

// Noise at all control points, as large as the track itself; the noise of the base position is a
// tenth of the noise of the joints.
CorrectionTrack with_noise(const CorrectionTrack& track, double size, Random& random) {
  CorrectionTrack noisy = track;
  for (Eigen::Index i = 3; i < track.coefficients.rows() - 3; ++i)
    for (Eigen::Index j = 0; j < track.coefficients.cols(); ++j)
      noisy.coefficients(i, j) += (j < 3 ? 0.1 : 1) * size * random.uniform();
  return noisy;
}

// The track a, with control points and joints where b also has them, and zeros elsewhere.
CorrectionTrack laid_on(const CorrectionTrack& a, const CorrectionTrack& b) {
  CorrectionTrack track = b;
  track.coefficients.setZero();
  const auto shift = std::lround((a.begin - b.begin) / b.spacing);
  for (Eigen::Index i = 0; i < a.coefficients.rows(); ++i)
    for (Eigen::Index j = 0; j < a.coefficients.cols(); ++j) {
      const auto column = j < 6 ? j
                                : 6 + (std::find(b.joints.begin(), b.joints.end(),
                                                 a.joints[static_cast<size_t>(j - 6)]) -
                                       b.joints.begin());
      const Eigen::Index row = i + shift;
      if (row < 0 || row >= track.coefficients.rows() || column >= track.coefficients.cols())
        continue;
      track.coefficients(row, column) = a.coefficients(i, j);
    }
  return track;
}

}  // namespace

class LeastChange : public testing::Test {
 protected:
  Pattern pattern = trial_walk();
  DenseTable& table = *pattern.table;
  RepairOptions options;
  int others = 0;
  CommandSeries series;
  ConsistencyReport before;
  WeightedChange least;

  double duration() const { return pattern.phases.back().until; }
  // The middle of the k-th phase on one foot, its length and its foot.
  struct Step {
    double middle, length;
    Side side;
  };
  Step step(size_t k) const {
    const Phase& phase = pattern.phases[2 * k + 1];
    const double begin = pattern.phases[2 * k].until;
    return {0.5 * (begin + phase.until), phase.until - begin,
            phase.support == Support::left ? Side::left : Side::right};
  }

  // Judges whether the motion passes the check; if it does, it must not be cheaper.
  void judge(const CorrectionTrack& track, const std::string& how) {
    const CommandSeries other = apply_correction(hoap1(), series, track);
    if (!check_consistency(hoap1(), other, options.check).consistent) return;
    ++others;
    constexpr double kRounding = 2e-5;  // rounding of limits, and the error that the solver leaves
    WeightedChange cost = weighted_change(hoap1(), series, other);
    if (cost.change < least.total())
      cost.safety = robustness_cost(hoap1(), series, other, options, before);
    EXPECT_GE(cost.total(), (1 - kRounding) * least.total()) << how << ", change " << cost.change;
  }

  // Judges motions between `track` and the correction for the limits `stricter`, at random shares
  // from 0.1 to 0.9.
  void judge_on_the_way(const CorrectionTrack& track, const RepairOptions& stricter,
                        Random& random) {
    const RepairResult far = repair(hoap1(), series, stricter);
    ASSERT_EQ(far.status, RepairStatus::repaired);
    const CorrectionTrack start = laid_on(track, far.correction);
    for (int i = 0; others < 20 && i < 40; ++i) {
      const double way = random.uniform(0.1, 0.9);
      CorrectionTrack other = with_noise(start, 2e-5 * way, random);
      other.coefficients += way * (far.correction.coefficients - start.coefficients);
      judge(other, "on the way, " + std::to_string(way));
    }
  }

  void expect_least(const RepairOptions* stricter = nullptr) {
    series = sample(hoap1(), pattern);
    const RepairResult repaired = repair(hoap1(), series, options);
    before = repaired.before;
    ASSERT_EQ(repaired.status, RepairStatus::repaired);
    EXPECT_LE(repaired.constraint_violation, 1e-6);
    least = repaired.change;
    ASSERT_GT(least.change, 0);
    EXPECT_NEAR(least.change, test::weighted_change(hoap1(), series, repaired.correction),
                1e-3 * least.change);
    for (const double share : {0.8, 0.95, 0.99, 0.999}) {
      CorrectionTrack track = repaired.correction;
      track.coefficients *= share;
      judge(track, "share " + std::to_string(share));
    }
    Random random(17);
    for (int i = 0; others < 20 && i < (stricter ? 9 : 60); ++i) {
      const double size = i % 3 == 0 ? 1e-3 : i % 3 == 1 ? 2e-4 : 2e-5;
      judge(with_noise(repaired.correction, size, random), "noise " + std::to_string(size));
    }
    if (stricter) judge_on_the_way(repaired.correction, *stricter, random);
    EXPECT_GE(others, 20);
  }
};

TEST_F(LeastChange, ElbowBeyondItsLimit) {
  move_joint(hoap1(), table, "l_elbow", 40 * M_PI / 180, 0.5 * duration(), 0.8);
  expect_least();
}

TEST_F(LeastChange, KneeThrownUp) {
  move_joint(hoap1(), table, "r_knee", 80 * M_PI / 180, step(2).middle, 0.4);
  RepairOptions stricter;
  stricter.check.tolerances = {{"joint_torque", 0.97}, {"joint_speed", 0.97}};
  expect_least(&stricter);
}

TEST_F(LeastChange, ArmThroughTheTorso) {
  move_joint(hoap1(), table, "l_shoulder_roll", -35 * M_PI / 180, 0.4 * duration(), 0.8);
  expect_least();
}

TEST_F(LeastChange, TimeSqueezed) {
  squeeze(pattern, 0.65);
  RepairOptions stricter;
  stricter.check.tolerances = {{"joint_torque", 0.97}, {"joint_speed", 0.97}, {"table_step", 0.97}};
  expect_least(&stricter);
}

TEST_F(LeastChange, FootSlips) {
  const Step at = step(1);
  slip_foot(hoap1(), table, at.side, Vector3d(0.003, 0.004, 0), at.middle, at.length);
  expect_least();
}

TEST_F(LeastChange, ContactTooEarly) {
  pattern.phases[5].until -= 0.06;
  expect_least();
}

TEST_F(LeastChange, SlipperyGround) {
  options.check.friction = 0.10;
  RepairOptions stricter = options;
  stricter.check.friction = 0.095;
  expect_least(&stricter);
}

TEST_F(LeastChange, ZmpOutside) {
  sway_base(hoap1(), table, Vector3d(0, 0.02, 0), step(2).middle, 0.5);
  motion_alone(table);
  expect_least();
}

// A fault of the commands alone needs no change of the motion, and no change is the smallest.
TEST_F(LeastChange, CommandsFollowAStillPosture) {
  for_rows(table, [&](double t, size_t k) {
    table.cog[k].y() += 0.015 * bump(t, 2, 0.6);
    table.zmp[k].y() += 0.0515;
    table.fz[k] *= 1.1;
  });
  series = sample(hoap1(), pattern);
  const RepairResult repaired = repair(hoap1(), series, options);
  EXPECT_EQ(repaired.status, RepairStatus::repaired);
  EXPECT_EQ(repaired.change.total(), 0);
}
