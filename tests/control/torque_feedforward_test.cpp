// Servos receive, beyond the posture, the torque of the motion, within the motor's limits, and
// nothing if the table already contains it. Its effect is tested in simulations by
// scenarios/open_loop_test.
#include "ayumi/control/torque_feedforward.hpp"

#include <gtest/gtest.h>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/plan/sample.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi {
namespace {

using test::hoap1;

const CommandSeries& squat() {
  static const CommandSeries series = [] {
    Pattern pattern = squat_pattern(hoap1(), squat_defaults(hoap1()));
    pattern.robot = "hoap1";
    return sample(hoap1(), pattern);
  }();
  return series;
}

// From rest to the deepest point, where the COG rests again, the work of the motors is that of the
// weight.
TEST(TorqueFeedforward, WorksAsTheWeightDoes) {
  const std::vector<CommandSample>& samples = squat().samples;
  const Eigen::MatrixXd lead = torque_feedforward(hoap1(), hoap1().limits("hoap1-strong"), squat());
  // One column more than samples, for the state of rest.
  ASSERT_EQ(lead.cols(), static_cast<Eigen::Index>(samples.size()) + 1);
  size_t deepest = 0;
  for (size_t k = 0; k < samples.size(); ++k)
    if (samples[k].cog.z() < samples[deepest].cog.z()) deepest = k;
  double work = 0;
  for (size_t k = 0; k < deepest; ++k)
    for (int j = 0; j < hoap1().dof_count(); ++j) {
      const auto column = static_cast<Eigen::Index>(k);
      work += hoap1().limits().servo[static_cast<size_t>(j)].kp * 0.5 *
              (lead(j, column) + lead(j, column + 1)) *
              (samples[k + 1].state.theta[j] - samples[k].state.theta[j]);
    }
  const double weight = hoap1().mass() * kGravity;
  const double drop = samples[deepest].cog.z() - samples[0].cog.z();
  ASSERT_LT(drop, -0.01);
  EXPECT_NEAR(work, weight * drop, 1e-4 * std::abs(weight * drop));
}

TEST(TorqueFeedforward, StaysWithinTheMotor) {
  ActuatorLimits limits = hoap1().limits();
  limits.peak_torque.setConstant(0.5);
  const Eigen::MatrixXd lead = torque_feedforward(hoap1(), limits, squat());
  double most = 0;
  for (int j = 0; j < hoap1().dof_count(); ++j)
    most = std::max(most, hoap1().limits().servo[static_cast<size_t>(j)].kp *
                              lead.row(j).cwiseAbs().maxCoeff());
  EXPECT_NEAR(most, 0.5, 1e-12);
}

}  // namespace
}  // namespace ayumi
