// The Hessian of the repair's program is compared with differences of its gradient: for a robot
// that holds still in the middle of a step, without a correction, and for changes of base and legs.
// There, the Hessian leaves out no term.

#include <gtest/gtest.h>

#include <set>

#include "ayumi/math/rotation.hpp"
#include "ayumi/repair/correction_problem.hpp"
#include "tests/support/random_robot.hpp"
#include "tests/support/robot_motions.hpp"

using namespace ayumi;
using namespace ayumi::test;
using Eigen::VectorXd;

namespace {

class CurvatureOfRows : public testing::TestWithParam<RobotMotion> {
 protected:
  const RobotModel& model = bundled_robot(GetParam().robot);
  CommandSeries still(bool slope) const {
    CommandSeries result = sample(model, pattern_of(GetParam()), {.dt = 0.004});
    CommandSample still = result.samples[result.samples.size() * 2 / 5];
    still.state.base_velocity.setZero();
    still.state.base_angular_velocity.setZero();
    still.state.dtheta.setZero();
    still.acceleration.setZero();
    for (CommandSample& s : result.samples) {
      s.state = still.state;
      s.acceleration = still.acceleration;
      for (auto& foot : s.feet)
        if (slope) foot.linear() = exp_rotation({0.1, -0.05, 0.2}).toRotationMatrix();
    }
    return result;
  }

  CorrectionSpec spec(const CommandSeries& series) const {
    CorrectionSpec s;
    const double middle = 0.4 * series.duration();
    s.windows = {{middle - 0.5, middle + 0.5}};
    s.watched_share = 0;
    s.friction = 0.05;
    s.locked_feet = {true, false};
    return s;
  }
};

// The slope of J' l, by central differences of two widths along a direction.
VectorXd slope(const Nlp& nlp, const VectorXd& multipliers, const VectorXd& direction) {
  constexpr double kStep = 2e-6;
  VectorXd sum = VectorXd::Zero(direction.size()), values(nlp.jacobian.size());
  for (const auto& [steps, share] : {std::pair(1, 4.0 / 3), std::pair(2, -1.0 / 6)})
    for (const int side : {1, -1}) {
      nlp.jacobian_values(side * steps * kStep * direction, values);
      for (int i = 0; i < nlp.jacobian.size(); ++i)
        sum[nlp.jacobian.columns[i]] +=
            side * share * values[i] * multipliers[nlp.jacobian.rows[i]] / (2 * kStep);
    }
  return sum;
}

VectorXd computed(const Nlp& nlp, const VectorXd& multipliers, const VectorXd& direction) {
  VectorXd values(nlp.hessian.size()), sum = VectorXd::Zero(direction.size());
  nlp.hessian_values(VectorXd::Zero(direction.size()), 0, multipliers, values);
  for (int i = 0; i < nlp.hessian.size(); ++i) {
    const int a = nlp.hessian.rows[i], b = nlp.hessian.columns[i];
    sum[a] += values[i] * direction[b];
    if (a != b) sum[b] += values[i] * direction[a];
  }
  return sum;
}

}  // namespace

TEST_P(CurvatureOfRows, AgainstDifferencesOfTheGradient) {
  std::set<std::string> seen;
  for (const bool slopes : {false, true}) {  // on a slope, a robot at rest slides
    const CommandSeries series = still(slopes);
    const CorrectionProblem problem(model, series, spec(series));
    const Nlp nlp = problem.nlp();
    Eigen::MatrixXd curved = problem.track(VectorXd::Zero(problem.variable_count())).coefficients;
    curved.leftCols<6>().setOnes();
    for (const Side side : {Side::left, Side::right})
      for (const int dof : model.leg(side)) curved.col(6 + dof).setOnes();
    const VectorXd mask = problem.point(curved);
    Random random(5);
    const VectorXd direction = random.vector(problem.variable_count(), 1).cwiseProduct(mask);
    for (const std::string kind :
         {"support", "friction", "stance", "path", "swing", "landing", "foot_clearance"}) {
      if (kind == "friction" && !slopes) continue;  // there it is near its rounded tip
      VectorXd multipliers = random.vector(problem.constraint_count(), 1);
      for (const RowBlock& b : problem.blocks()) {
        if (b.kind->name == kind) seen.insert(kind);
        if (b.kind->name != kind) multipliers.segment(b.row, b.rows()).setZero();
      }
      const VectorXd expected = slope(nlp, multipliers, direction).cwiseProduct(mask);
      EXPECT_LT((computed(nlp, multipliers, direction) - expected).norm(),
                1e-6 * (1 + expected.norm()))
          << kind << ", size " << expected.norm() << (slopes ? ", on a slope" : "");
    }
  }
  EXPECT_EQ(seen.size(), 7U);
}

INSTANTIATE_TEST_SUITE_P(Walks, CurvatureOfRows,
                         testing::Values(RobotMotion{"hoap1", "walk"},
                                         RobotMotion{"humanoid30", "walk"}),
                         name_of_case);
