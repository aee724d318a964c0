// The log of a planned motion agrees with the laws of mechanics, which are computed here in another
// way.
#include "ayumi/task/plan_log.hpp"

#include <gtest/gtest.h>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/joint_drive.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/plan/sample.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using test::hoap1;

class PlanLog : public testing::Test {
 protected:
  static const CommandSeries& walk() {
    static const CommandSeries series = sample(hoap1(), walk_pattern(hoap1(), {.steps = 2}));
    return series;
  }
  static SimulationLog log(int stride) {
    return plan_log(hoap1(), hoap1().limits(), walk(), walk(), stride);
  }
};

TEST_F(PlanLog, HasEveryStrideThSample) {
  const SimulationLog all = log(25), some = log(50);
  EXPECT_EQ(some.dt, 50 * walk().dt);
  EXPECT_EQ(some.samples.size(), (walk().samples.size() + 49) / 50);
  for (size_t k = 0; k < some.samples.size(); ++k) {
    EXPECT_EQ(some.samples[k].torque, all.samples[2 * k].torque);
    EXPECT_EQ(some.samples[k].foot_cop[0], all.samples[2 * k].foot_cop[0]);
    EXPECT_EQ(some.samples[k].command_cog, walk().samples[50 * k].cog);
  }
}

// Forces and moments of the feet are together those of the ground reaction; a foot without a
// contact has no force.
TEST_F(PlanLog, FeetCarryTheRobotAboutItsZmp) {
  int both = 0, single = 0;
  for (const SimulationSample& s : log(20).samples) {
    EXPECT_NEAR(s.foot_force[0].z() + s.foot_force[1].z(), s.fz, 1e-9 * s.fz);
    Vector3d center = Vector3d::Zero();
    for (size_t foot = 0; foot < 2; ++foot) {
      center += s.foot_force[foot].z() * s.foot_cop[foot] / s.fz;
      EXPECT_GE(s.foot_force[foot].z(), 0);
      if (!s.planned_contact[foot]) {
        EXPECT_EQ(s.foot_force[foot], Vector3d(0, 0, 0));
      }
    }
    // The soles are on one plane, so forces along it have no lever.
    EXPECT_LT((center - s.zmp).head<2>().norm(), 1e-9);
    ++(s.planned_contact[0] && s.planned_contact[1] ? both : single);
  }
  EXPECT_GT(both, 10);
  EXPECT_GT(single, 10);
}

// On one foot, all forces are known: the joints give what inverse dynamics asks for, less what the
// force at the foot does, and the motors also turn rotors and overcome friction.
TEST_F(PlanLog, TorquesOnOneFootByJacobians) {
  const int stride = 20;
  const SimulationLog planned = log(stride);
  const JointDrive drive = joint_drive(hoap1().limits());
  const int dofs = hoap1().dof_count();
  RobotData data(hoap1());
  int compared = 0;
  for (size_t k = 0; k < planned.samples.size(); ++k) {
    const SimulationSample& s = planned.samples[k];
    if (s.planned_contact[0] == s.planned_contact[1]) continue;
    const Side side = s.planned_contact[0] ? Side::left : Side::right;
    const CommandSample& c = walk().samples[k * stride];
    const VectorXd force = inverse_dynamics(hoap1(), c.state, c.acceleration, data);
    const Eigen::MatrixXd J =
        body_jacobian(hoap1(), data, hoap1().sole(side).body, c.state.base.position);
    const VectorXd expected = force.tail(dofs) - (J.transpose() * force.head(6)).tail(dofs) +
                              drive_torque(drive, c.state.dtheta, c.acceleration.tail(dofs));
    EXPECT_LT((s.torque - expected).norm(), 1e-9 * (1 + expected.norm())) << k;
    ++compared;
  }
  EXPECT_GT(compared, 10);
}

// A changed motion is drawn with the commands from before the change, the last of which stays.
TEST_F(PlanLog, CommandsMayEndEarlier) {
  CommandSeries before = walk();
  before.samples.resize(100);
  const SimulationLog changed = plan_log(hoap1(), hoap1().limits(), walk(), before, 100);
  EXPECT_EQ(changed.samples[0].command_cog, before.samples[0].cog);
  for (size_t k = 1; k < changed.samples.size(); ++k) {
    EXPECT_EQ(changed.samples[k].command_cog, before.samples.back().cog);
    EXPECT_EQ(changed.samples[k].state.theta, walk().samples[100 * k].state.theta);
  }
}

}  // namespace
}  // namespace ayumi
