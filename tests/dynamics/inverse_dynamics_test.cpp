#include "ayumi/dynamics/inverse_dynamics.hpp"

#include <gtest/gtest.h>

#include "ayumi/dynamics/cog_jacobian.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/dynamics/tree_dynamics.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"
#include "tests/support/random_robot.hpp"

namespace ayumi {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

class RandomTrees : public testing::TestWithParam<unsigned> {
 protected:
  RandomTrees()
      : model(test::random_tree(GetParam(), 5 + static_cast<int>(GetParam() % 20))),
        data(model),
        random(GetParam() + 1000),
        state(test::random_state(model, random)),
        acceleration(random.vector(model.velocity_count(), 5.0)) {}
  RobotModel model;
  RobotData data;
  test::Random random;
  RobotState state;
  VectorXd acceleration;
};

TEST_P(RandomTrees, MassMatrixTimesAccelerationPlusBiasIsInverseDynamics) {
  const VectorXd force = inverse_dynamics(model, state, acceleration, data);
  const VectorXd bias = bias_force(model, state, data);
  MatrixXd M;
  mass_matrix(model, data, M);
  EXPECT_LT((M * acceleration + bias - force).norm(), 1e-12 * (1 + force.norm()));
  EXPECT_EQ((M - M.transpose()).norm(), 0);
  EXPECT_GT(M.llt().info() == Eigen::Success ? 1 : 0, 0);
}

TEST_P(RandomTrees, ForwardDynamicsInvertsInverseDynamics) {
  const VectorXd force = inverse_dynamics(model, state, acceleration, data);
  const VectorXd back = forward_dynamics(model, state, force, data);
  EXPECT_LT((back - acceleration).norm(), 1e-8 * acceleration.norm());
}

TEST_P(RandomTrees, KineticEnergyMatchesMassMatrix) {
  update_velocities(model, state, data);
  double energy = 0;
  for (size_t i = 0; i < model.bodies().size(); ++i) {
    const Inertia& inertia = model.bodies()[i].inertia;
    const Vector3d w = data.angular_velocity[i];
    const Vector3d v = point_velocity(data, static_cast<int>(i), data.base_position + data.com[i]);
    const Vector3d local = data.rotation[i].transpose() * w;
    energy += 0.5 * inertia.mass * v.squaredNorm() + 0.5 * local.dot(inertia.about_com * local);
  }
  MatrixXd M;
  mass_matrix(model, data, M);
  const VectorXd v = state.velocity();
  EXPECT_NEAR(0.5 * v.dot(M * v), energy, 1e-12 * energy);
}

TEST_P(RandomTrees, BaseWrenchIsTheRateOfMomentum) {
  const VectorXd force = inverse_dynamics(model, state, acceleration, data);
  const double h = 1e-4;
  auto momentum_at = [&](double t) {
    const VectorXd v = state.velocity();
    RobotState s = test::integrate(state, v + 0.5 * t * acceleration, t);
    s.base_velocity += t * acceleration.head<3>();
    s.base_angular_velocity += t * acceleration.segment<3>(3);
    s.dtheta += t * acceleration.tail(model.dof_count());
    RobotData d(model);
    update_velocities(model, s, d);
    return std::pair(centroidal_momentum(model, d), d.cog);
  };
  const auto [forward, cog_f] = momentum_at(h);
  const auto [backward, cog_b] = momentum_at(-h);
  update_positions(model, state, data);
  const Vector3d gravity(0, 0, -model.mass() * kGravity);
  const Vector3d linear = (forward.linear - backward.linear) / (2 * h) - gravity;
  const Vector3d angular = (forward.angular - backward.angular) / (2 * h);
  EXPECT_LT((linear - force.head<3>()).norm(), 1e-5 * (1 + force.norm()));
  const Vector3d about_cog = force.segment<3>(3) - data.cog_offset.cross(force.head<3>());
  EXPECT_LT((angular - about_cog).norm(), 1e-5 * (1 + force.norm()));
}

TEST_P(RandomTrees, JacobiansMatchDifferences) {
  update_positions(model, state, data);
  const int body = static_cast<int>(model.bodies().size()) - 1;
  const Vector3d local(0.1, -0.2, 0.05);
  const Vector3d point = data.pose(body) * local;
  const MatrixXd J = body_jacobian(model, data, body, point);
  const MatrixXd JG = cog_jacobian_floating(model, data);
  const double h = 1e-6;
  for (int k = 0; k < model.velocity_count(); ++k) {
    RobotData a(model), b(model);
    update_positions(model, test::integrate(state, VectorXd::Unit(J.cols(), k), h), a);
    update_positions(model, test::integrate(state, VectorXd::Unit(J.cols(), k), -h), b);
    const Vector3d dp = (a.pose(body) * local - b.pose(body) * local) / (2 * h);
    EXPECT_LT((dp - J.block<3, 1>(0, k)).norm(), 1e-8);
    EXPECT_LT(((a.cog - b.cog) / (2 * h) - JG.col(k)).norm(), 1e-8);
    const Vector3d dr =
        log_rotation(Eigen::Quaterniond(a.rotation[body] * b.rotation[body].transpose())) / (2 * h);
    EXPECT_LT((dr - J.block<3, 1>(3, k)).norm(), 1e-8);
  }
}

TEST_P(RandomTrees, DerivativesMatchCentralDifferences) {
  InverseDynamicsDerivatives d;
  TreeDynamics(model).inverse_derivatives(state, acceleration, d);
  const int n = model.velocity_count();
  const double h = 1e-5;
  RobotData scratch(model);
  auto force = [&](const RobotState& s, const VectorXd& a) {
    return inverse_dynamics(model, s, a, scratch);
  };
  const double scale = 1 + d.configuration.norm() + d.velocity.norm();
  for (int k = 0; k < n; ++k) {
    const VectorXd e = VectorXd::Unit(n, k);
    const VectorXd dq = (force(test::integrate(state, e, h), acceleration) -
                         force(test::integrate(state, e, -h), acceleration)) /
                        (2 * h);
    EXPECT_LT((dq - d.configuration.col(k)).norm(), 1e-7 * scale) << "configuration " << k;
    auto moved = [&](double step) {
      RobotState s = state;
      if (k < 3)
        s.base_velocity[k] += step;
      else if (k < 6)
        s.base_angular_velocity[k - 3] += step;
      else
        s.dtheta[k - 6] += step;
      return s;
    };
    const VectorXd dv = (force(moved(h), acceleration) - force(moved(-h), acceleration)) / (2 * h);
    EXPECT_LT((dv - d.velocity.col(k)).norm(), 1e-7 * scale) << "velocity " << k;
    const VectorXd da =
        (force(state, acceleration + h * e) - force(state, acceleration - h * e)) / (2 * h);
    EXPECT_LT((da - d.acceleration.col(k)).norm(), 1e-7 * scale) << "acceleration " << k;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomTrees, testing::Range(1u, 21u));

}  // namespace
}  // namespace ayumi
