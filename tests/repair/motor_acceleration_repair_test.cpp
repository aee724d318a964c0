// A limit of the table that bounds joint accelerations has its rows in the repair.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ayumi/repair/correction_problem.hpp"
#include "ayumi/repair/repair_setup.hpp"
#include "tests/support/planted.hpp"

namespace ayumi::test {
namespace {

using namespace planted;

constexpr double kBegin = 0.1, kPeriod = 0.004;  // beginning and period of a swing of the elbow [s]

/// A walk in which the left elbow accelerates by this much, as a sine of one period.
CommandSeries swung(double acceleration) {
  CommandSeries series = sample(hoap1(), walk());
  const int dof = hoap1().find_dof("l_elbow");
  const double w = 2 * M_PI / kPeriod;
  for (size_t k = 0; k < series.samples.size(); ++k) {
    const double t = static_cast<double>(k) * series.dt - kBegin;
    if (t < 0 || t > kPeriod) continue;
    CommandSample& s = series.samples[k];
    s.state.theta[dof] -= acceleration / (w * w) * std::sin(w * t);
    s.state.dtheta[dof] -= acceleration / w * std::cos(w * t);
    s.acceleration[6 + dof] += acceleration * std::sin(w * t);
  }
  return series;
}

/// The rows of the elbow's acceleration whose bound is that of its motor.
int motor_rows(const CommandSeries& series, double bound) {
  RepairOptions options;
  CorrectionSpec spec = repair_spec(hoap1(), series, options);
  spec.windows = {{0, 0.5}};
  spec.extra_times = {kBegin + 0.001};
  const CorrectionProblem problem(hoap1(), series, spec);
  return static_cast<int>(
      std::count_if(problem.blocks().begin(), problem.blocks().end(), [&](const RowBlock& block) {
        return std::string(block.kind->name) == "motor_acceleration" &&
               block.item == hoap1().find_dof("l_elbow") &&
               std::abs(std::get<JointRow>(block.rule).scale * bound - 1) < 1e-9;
      }));
}

TEST(MotorAccelerationRows, ArePlacedWhereTheMotorComesNearItsLimit) {
  const int dof = hoap1().find_dof("l_elbow");
  const double bound =
      hoap1().limits("").peak_torque[dof] / hoap1().limits("").servo[dof].rotor_inertia;
  EXPECT_EQ(motor_rows(swung(0.5 * bound), bound), 0);
  EXPECT_GE(motor_rows(swung(1.2 * bound), bound), 1);
}

}  // namespace
}  // namespace ayumi::test
