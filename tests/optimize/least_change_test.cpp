// The repaired motion against twenty others that pass as well: points of the same program drawn by
// adding a random linear cost, and motions between those and the repaired one.

#include <gtest/gtest.h>

#include "ayumi/optimize/elastic.hpp"
#include "ayumi/optimize/repair.hpp"
#include "ayumi/optimize/repair_spec.hpp"
#include "ayumi/pattern/generate.hpp"
#include "tests/support/faults.hpp"
#include "tests/support/hoap1.hpp"
#include "tests/support/random_robot.hpp"
#include "tests/support/weighted_change.hpp"

using namespace ayumi;
using namespace ayumi::test;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

Pattern walk(const WalkParameters& parameters) {
  Pattern pattern = walk_pattern(hoap1(), parameters);
  pattern.robot = "hoap1";
  return baked(hoap1(), pattern);
}

const Pattern& straight() {
  static const Pattern pattern = walk({.steps = 3});
  return pattern;
}

const Pattern& turning() {
  static const Pattern pattern =
      walk({.steps = 4, .stride = 0.02, .period = 0.7, .turn = 0.08, .first_swing = Side::left});
  return pattern;
}

// What the first round of a repair of `series` solves where no bodies meet.
CorrectionSpec first_round(const CommandSeries& series, const RepairOptions& options) {
  constexpr double kPad = 0.5;
  CorrectionSpec spec = repair_spec(hoap1(), series, options);
  for (const Finding& f : check_consistency(hoap1(), series, options.check).findings)
    if (f.severity == Severity::error) spec.windows.emplace_back(f.begin - kPad, f.end + kPad);
  std::sort(spec.windows.begin(), spec.windows.end());
  for (size_t i = 1; i < spec.windows.size();) {
    if (spec.windows[i].first > spec.windows[i - 1].second) {
      ++i;
      continue;
    }
    spec.windows[i - 1].second = std::max(spec.windows[i - 1].second, spec.windows[i].second);
    spec.windows.erase(spec.windows.begin() + static_cast<long>(i));
  }
  return spec;
}

// Twenty motions that meet the rows of the first round and pass the check change more.
void expect_least(const Pattern& pattern, const RepairOptions& options = {}) {
  constexpr double kMet = 1e-6;
  const CommandSeries series = sample(hoap1(), pattern);
  const RepairResult repaired = repair(hoap1(), series, options);
  ASSERT_EQ(repaired.status, RepairStatus::repaired);
  ASSERT_GT(repaired.iterations, 0);
  const double least = weighted_change(hoap1(), series, repaired.correction);
  const CorrectionProblem problem(hoap1(), series, first_round(series, options));
  const Nlp hard = problem.nlp(), nlp = with_soft_safety(problem, hard, series.dt);
  const NlpSolution best = solve(nlp);
  VectorXd slope(best.x.size());
  nlp.gradient(best.x, slope);
  Random random(17);
  int others = 0;
  for (int i = 0; i < 12 && others < 20; ++i) {
    VectorXd pull(best.x.size());
    const double size = 0.3 * slope.norm() / std::sqrt(static_cast<double>(pull.size()));
    for (double& p : pull) p = size * random.uniform();
    Nlp pulled = nlp;
    pulled.objective = [&](const VectorXd& x) { return nlp.objective(x) + pull.dot(x); };
    pulled.gradient = [&](const VectorXd& x, VectorXd& g) {
      nlp.gradient(x, g);
      g += pull;
    };
    pulled.start = best.x;
    const NlpSolution other = solve(pulled);
    for (const double share : {1.0, 0.7, 0.4, 0.2}) {
      const VectorXd x = best.x + share * (other.x - best.x);
      VectorXd g(nlp.constraint_lower.size());
      nlp.constraints(x, g);
      if ((nlp.constraint_lower - g).maxCoeff() > kMet) continue;
      if ((g - nlp.constraint_upper).maxCoeff() > kMet) continue;
      const CorrectionTrack track = problem.track(x.head(problem.variable_count()));
      if (!check_consistency(hoap1(), apply_correction(hoap1(), series, track), options.check)
               .consistent)
        continue;
      ++others;
      EXPECT_GE(weighted_change(hoap1(), series, track), (1 - 1e-4) * least) << i << " " << share;
    }
  }
  EXPECT_GE(others, 20);
}

}  // namespace

class LeastChange : public testing::TestWithParam<const Pattern* (*)()> {
 protected:
  Pattern pattern = *GetParam()();
  DenseTable& table = *pattern.table;
  double duration() const { return pattern.phases.back().until; }
  // The middle of the k-th phase on one foot, and its length.
  std::pair<double, double> step(int k) const {
    const Phase& phase = pattern.phases[static_cast<size_t>(2 * k + 1)];
    const double begin = pattern.phases[static_cast<size_t>(2 * k)].until;
    return {0.5 * (begin + phase.until), phase.until - begin};
  }
};

TEST_P(LeastChange, FootSlips) {
  const Side side = pattern.phases[3].support == Support::left ? Side::left : Side::right;
  const auto [middle, length] = step(1);
  slip_foot(hoap1(), table, side, Vector3d(0.003, 0.004, 0), middle, length);
  expect_least(pattern);
}

TEST_P(LeastChange, ElbowBeyondItsLimit) {
  move_joint(hoap1(), table, "l_elbow", 40 * M_PI / 180, 0.5 * duration(), 0.8);
  expect_least(pattern);
}

INSTANTIATE_TEST_SUITE_P(Walks, LeastChange,
                         testing::Values(
                             +[] { return &straight(); }, +[] { return &turning(); }));
