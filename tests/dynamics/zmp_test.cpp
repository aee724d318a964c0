#include "ayumi/dynamics/zmp.hpp"

#include <gtest/gtest.h>

#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/model/gravity.hpp"
#include "tests/support/random_robot.hpp"

namespace ayumi {
namespace {

using Eigen::Vector3d;

// (14)(15): only a horizontal force f_z (x_G - x_Z)/(z_G - z_Z) leaves no moment about the COG.
TEST(Pendulum, ForceThroughTheCogLeavesNoMoment) {
  test::Random random(5);
  for (int i = 0; i < 50; ++i) {
    const double mass = random.uniform(1, 50), fz = mass * random.uniform(2, 20);
    const Vector3d zmp = random.vector(0.1), cog = zmp + Vector3d(0.05, -0.1, 0.3);
    const double omega2 = omega_squared(fz, mass, cog.z() - zmp.z());
    Vector3d a(0, 0, vertical_acceleration(fz, mass));
    a.head<2>() = horizontal_acceleration(omega2, cog.head<2>(), zmp.head<2>());
    const Vector3d force = mass * (a + Vector3d(0, 0, kGravity));
    EXPECT_LT((zmp - cog).cross(force).norm(), 1e-12 * force.norm());
    EXPECT_NEAR(force.z(), fz, 1e-12 * fz);
    EXPECT_LT((pendulum_zmp(cog, a, zmp.z()) - zmp).norm(), 1e-12);
  }
}

TEST(Pendulum, OmegaOfARobotAtRestIsThatOfAPendulumOfItsHeight) {
  EXPECT_NEAR(omega_squared(6.5 * kGravity, 6.5, 0.225), kGravity / 0.225, 1e-12);
}

// The ZMP from the base wrench of inverse dynamics agrees with the one from momentum rates.
TEST(GroundReaction, TwoRoutesToTheZmp) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const RobotModel model(test::random_tree(seed, 12, false));
    test::Random random(seed);
    RobotData data(model);
    const RobotState state = test::random_state(model, random);
    const Eigen::VectorXd acceleration = random.vector(model.velocity_count(), 1.0);
    const Eigen::VectorXd wrench = inverse_dynamics(model, state, acceleration, data);
    const double ground = -1.0;
    const GroundReaction reaction = ground_reaction(state.base.position, wrench.head<6>(), ground);
    if (reaction.force.z() <= 0) continue;

    const double h = 1e-4;
    auto momentum_at = [&](double t) {
      const Eigen::VectorXd v = state.velocity();
      RobotState s = test::integrate(state, v + 0.5 * t * acceleration, t);
      s.base_velocity += t * acceleration.head<3>();
      s.base_angular_velocity += t * acceleration.segment<3>(3);
      s.dtheta += t * acceleration.tail(model.dof_count());
      update_velocities(model, s, data);
      return centroidal_momentum(model, data);
    };
    const Momentum after = momentum_at(h), before = momentum_at(-h);
    const Vector3d force =
        (after.linear - before.linear) / (2 * h) + Vector3d(0, 0, model.mass() * kGravity);
    const Vector3d rate = (after.angular - before.angular) / (2 * h);
    update_positions(model, state, data);
    // The force acts at the ZMP, so that the remaining moment about the COG is vertical.
    const Vector3d left = rate - (reaction.zmp - data.cog).cross(force);
    EXPECT_LT(left.head<2>().norm(), 1e-4 * (1 + rate.norm()));
    EXPECT_NEAR(left.z(), reaction.yaw_moment, 1e-4 * (1 + rate.norm()));
    EXPECT_EQ(reaction.zmp.z(), ground);
  }
}

}  // namespace
}  // namespace ayumi
