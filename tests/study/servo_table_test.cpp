// Tables of servo targets: their contents differ by the lag of the servos and by their sag, both of
// which are computed here in another way.
#include "ayumi/task/servo_table.hpp"

#include <gtest/gtest.h>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/motion/servo_feedforward.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/sim/simulate.hpp"
#include "ayumi/task/plan_log.hpp"
#include "tests/support/error_message.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi {
namespace {

using Eigen::VectorXd;
using test::hoap1;

constexpr ServoContent kContents[] = {ServoContent::ideal, ServoContent::lead,
                                      ServoContent::lead_and_sag};

TEST(ServoTable, ContentsHaveNames) {
  for (const ServoContent content : kContents) EXPECT_EQ(servo_content(name_of(content)), content);
  EXPECT_EQ(test::error_message([] { servo_content("sag"); }, ErrorCode::usage),
            "unknown servo 'sag' (known: ideal, lead, lead+sag)");
}

// tau / kp with the torque of the planned motion; it lies within what the motors can give.
TEST(ServoTable, LeadAndSagOfAPattern) {
  const CommandSeries series = sample(hoap1(), squat_pattern(hoap1(), {.cycles = 1}),
                                      {.dt = hoap1().description().servo_period});
  const SimulationLog plan = plan_log(hoap1(), hoap1().limits(), series, series);
  ReferenceTrajectory tables[3];
  for (const ServoContent content : kContents)
    tables[static_cast<size_t>(content)] = table_of_series(hoap1(), "", series, content);
  const VectorXd lead = velocity_lead(hoap1().limits());
  double most_lead = 0, most_sag = 0;
  for (size_t k = 0; k < series.samples.size(); ++k) {
    const VectorXd& theta = tables[0].rows[k].theta;
    EXPECT_EQ(theta, series.samples[k].state.theta);
    const VectorXd ahead = tables[1].rows[k].theta - theta;
    const VectorXd sag = tables[2].rows[k].theta - tables[1].rows[k].theta;
    for (int j = 0; j < hoap1().dof_count(); ++j) {
      EXPECT_NEAR(ahead[j], lead[j] * series.samples[k].state.dtheta[j], 1e-12);
      const double kp = hoap1().limits().servo[static_cast<size_t>(j)].kp;
      EXPECT_NEAR(sag[j], plan.samples[k].torque[j] / kp, 1e-9) << k << " " << j;
    }
    most_lead = std::max(most_lead, ahead.cwiseAbs().maxCoeff());
    most_sag = std::max(most_sag, sag.cwiseAbs().maxCoeff());
  }
  EXPECT_GT(most_lead, 1e-3);
  EXPECT_GT(most_sag, 1e-4);
}

// The targets of a run in open loop are its table with lead and sag. The servos of the profile
// hoap1-soft have a sixth of the stiffness, so they sag six times as far.
TEST(ServoTable, SagOfARunForOtherServos) {
  const CommandSeries series = sample(hoap1(), stand_pattern(hoap1(), 0.2));
  SimulateOptions options;
  options.controller = {ControllerKind::none, {}};
  SimulationLog log = simulate(hoap1(), series, options);
  log.provenance.profile = "hoap1";
  const auto table = [&](const char* profile, ServoContent content) {
    return table_of_log(hoap1(), profile, log, content);
  };
  const ReferenceTrajectory own = table("hoap1", ServoContent::lead_and_sag),
                            plain = table("hoap1", ServoContent::ideal),
                            soft = table("hoap1-soft", ServoContent::lead_and_sag);
  EXPECT_EQ(soft.servo.profile, "hoap1-soft");
  ASSERT_EQ(own.rows.size(), log.samples.size());
  const VectorXd lead = velocity_lead(hoap1().limits("hoap1")),
                 soft_lead = velocity_lead(hoap1().limits("hoap1-soft"));
  double most = 0;
  for (size_t k = 1; k + 1 < own.rows.size(); ++k) {
    EXPECT_EQ(own.rows[k].theta, log.samples[k].target);
    EXPECT_EQ(plain.rows[k].theta, log.samples[k].reference_theta);
    const VectorXd& theta = plain.rows[k].theta;
    const VectorXd rate = (plain.rows[k + 1].theta - plain.rows[k - 1].theta) / (2 * log.dt);
    const VectorXd sag = own.rows[k].theta - theta - lead.cwiseProduct(rate);
    const VectorXd expected = theta + soft_lead.cwiseProduct(rate) + 6 * sag;
    ASSERT_LT((soft.rows[k].theta - expected).norm(), 1e-12) << k;
    most = std::max(most, sag.cwiseAbs().maxCoeff());
  }
  EXPECT_GT(most, 1e-4);
}

}  // namespace
}  // namespace ayumi
