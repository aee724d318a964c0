// Derivatives of inverse and forward dynamics, and the effect of rotors and friction on them.

#include <gtest/gtest.h>

#include "ayumi/dynamics/tree_dynamics.hpp"
#include "tests/support/random_robot.hpp"
#include "tests/support/spatial_derivatives.hpp"

namespace ayumi {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

class ForwardDynamics : public testing::TestWithParam<unsigned> {
 protected:
  ForwardDynamics()
      : model(test::odd_tree(GetParam(), 6 + static_cast<int>(GetParam() % 12))),
        data(model),
        fast(model),
        random(GetParam() + 70),
        state(test::random_state(model, random)),
        force(random.vector(model.velocity_count(), 3.0)) {
    const int n = model.dof_count();
    drive.rotor_inertia = random.vector(n, 0.01).cwiseAbs();
    drive.viscous = random.vector(n, 0.1).cwiseAbs();
    drive.coulomb = random.vector(n, 0.1).cwiseAbs();
  }
  VectorXd acceleration(const RobotState& s, const VectorXd& f, const JointDrive* with) {
    VectorXd result;
    fast.forward(s, f, result, with);
    return result;
  }
  RobotState faster(int k, double step) const {
    RobotState s = state;
    if (k < 3)
      s.base_velocity[k] += step;
    else if (k < 6)
      s.base_angular_velocity[k - 3] += step;
    else
      s.dtheta[k - 6] += step;
    return s;
  }
  RobotModel model;
  RobotData data;
  TreeDynamics fast;
  test::Random random;
  RobotState state;
  VectorXd force;
  JointDrive drive;
};

TEST_P(ForwardDynamics, DerivativesMatchCentralDifferences) {
  const int n = model.velocity_count();
  const double h = 1e-5;
  for (const JointDrive* with : {static_cast<const JointDrive*>(nullptr), &std::as_const(drive)}) {
    ForwardDynamicsDerivatives d;
    fast.forward_derivatives(state, force, d, with);
    EXPECT_LT((d.acceleration - acceleration(state, force, with)).norm(),
              1e-12 * d.acceleration.norm());
    MatrixXd dq(n, n), dv(n, n), df(n, n);
    for (int k = 0; k < n; ++k) {
      const VectorXd e = VectorXd::Unit(n, k);
      dq.col(k) = (acceleration(test::integrate(state, e, h), force, with) -
                   acceleration(test::integrate(state, e, -h), force, with)) /
                  (2 * h);
      dv.col(k) =
          (acceleration(faster(k, h), force, with) - acceleration(faster(k, -h), force, with)) /
          (2 * h);
      df.col(k) =
          (acceleration(state, force + h * e, with) - acceleration(state, force - h * e, with)) /
          (2 * h);
    }
    EXPECT_LT((dq - d.configuration).norm(), 1e-6 * d.configuration.norm());
    EXPECT_LT((dv - d.velocity).norm(), 1e-6 * d.velocity.norm());
    EXPECT_LT((df - d.force).norm(), 1e-6 * d.force.norm());
  }
}

// The derivatives are computed with twelve numbers per subtree. They are equal to those that are
// computed with 6 x 6 matrices.
TEST_P(ForwardDynamics, InverseDerivativesAgreeWithTheSecondRoute) {
  const VectorXd acceleration = random.vector(model.velocity_count(), 5.0);
  InverseDynamicsDerivatives found, expected;
  fast.inverse_derivatives(state, acceleration, found);
  test::spatial_derivatives(model, state, acceleration, data, expected);
  EXPECT_LT((found.configuration - expected.configuration).norm(),
            1e-12 * expected.configuration.norm());
  EXPECT_LT((found.velocity - expected.velocity).norm(), 1e-12 * expected.velocity.norm());
  EXPECT_LT((found.acceleration - expected.acceleration).norm(),
            1e-12 * expected.acceleration.norm());
}

// If the torques of rotors and friction are added to the forces of inverse dynamics, forward
// dynamics returns the same accelerations.
TEST_P(ForwardDynamics, UndoesInverseDynamicsWithDrives) {
  const VectorXd wanted = random.vector(model.velocity_count(), 5.0);
  VectorXd needed = inverse_dynamics(model, state, wanted, data);
  needed.tail(model.dof_count()) +=
      drive_torque(drive, state.dtheta, wanted.tail(model.dof_count()));
  const VectorXd found = acceleration(state, needed, &drive);
  // There are two routes through M, whose condition limits the precision.
  EXPECT_LT((inverse_dynamics(model, state, found, data) +
             (VectorXd(model.velocity_count()) << VectorXd::Zero(6),
              drive_torque(drive, state.dtheta, found.tail(model.dof_count())))
                 .finished() -
             needed)
                .norm(),
            1e-12 * needed.norm());
}

TEST_P(ForwardDynamics, DryFrictionIsOddAndBounded) {
  for (int j = 0; j < model.dof_count(); ++j) {
    const double fast = friction_torque(drive, j, 2.0) - 2.0 * drive.viscous[j];
    EXPECT_NEAR(fast, drive.coulomb[j], 1e-15);
    EXPECT_DOUBLE_EQ(friction_torque(drive, j, -2.0), -friction_torque(drive, j, 2.0));
    EXPECT_EQ(friction_torque(drive, j, 0), 0);
    EXPECT_GT(friction_slope(drive, j, 0), friction_slope(drive, j, 1));
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, ForwardDynamics, testing::Range(1u, 17u));

}  // namespace
}  // namespace ayumi
