// The errata of docs/notation.md, row by row: the printed form fails, the corrected one holds.

#include <gtest/gtest.h>

#include "ayumi/dynamics/cog_jacobian.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/math/weighted_solve.hpp"
#include "tests/support/dense.hpp"
#include "tests/support/pendulum.hpp"
#include "tests/support/random_robot.hpp"

namespace ayumi {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using test::LevelPendulum;
using test::Motion;

class Errata : public testing::Test {
 protected:
  Errata() : model(load_robot(AYUMI_SOURCE_DIR "/robots/hoap1/robot.json")), data(model) {}

  /// The home posture with every joint bent a little, and the base level at the origin.
  RobotState bent() const {
    test::Random random(7);
    RobotState state = model.rest_state();
    state.theta += random.vector(model.dof_count(), 0.1);
    return state;
  }

  RobotModel model;
  RobotData data;
};

// (3): the joint rates give the angular velocity of a link, not its derivative.
TEST_F(Errata, Equation3IsAVelocityRelation) {
  test::Random random(3);
  RobotState state = bent();
  state.dtheta = random.vector(model.dof_count(), 2.0);
  const int hand = static_cast<int>(model.bodies().size()) - 1;
  auto angular_velocity = [&](double t) {
    RobotState s = state;
    s.theta += t * state.dtheta;  // joint rates are constant, and the base is at rest
    update_velocities(model, s, data);
    return data.angular_velocity[static_cast<size_t>(hand)];
  };
  auto attitude = [&](double t) {
    angular_velocity(t);
    return Eigen::Quaterniond(data.rotation[static_cast<size_t>(hand)]);
  };
  const double h = 1e-5;
  const Vector3d rate = log_rotation(attitude(h) * attitude(-h).conjugate()) / (2 * h);
  const Vector3d acceleration = (angular_velocity(h) - angular_velocity(-h)) / (2 * h);
  update_positions(model, state, data);
  const MatrixXd J = body_jacobian(model, data, hand, data.pose(hand).translation());
  const Vector3d predicted = J.bottomRows<3>() * state.velocity();
  EXPECT_LT((rate - predicted).norm(), 1e-8);
  EXPECT_GT((acceleration - predicted).norm(), 0.5 * predicted.norm());
}

// (6)(7): the sum of masses includes the root, k = 0..n.
TEST_F(Errata, Equations6And7CountTheRootMass) {
  RobotState state = bent();
  update_positions(model, state, data);
  const Eigen::Isometry3d sole = sole_pose(model, data, Side::left);
  const int n = model.dof_count();

  // (13) from its parts, all in world axes: J_G, J_F and J_wF relative to the base.
  MatrixXd weighted = MatrixXd::Zero(3, n);
  for (size_t k = 1; k < model.bodies().size(); ++k) {
    const Vector3d com = data.base_position + data.com[k];
    weighted += model.bodies()[k].inertia.mass *
                body_jacobian(model, data, static_cast<int>(k), com).topRightCorner(3, n);
  }
  const MatrixXd foot =
      body_jacobian(model, data, model.sole(Side::left).body, sole.translation()).rightCols(n);
  auto cog_jacobian_with = [&](double denominator) -> MatrixXd {
    return weighted / denominator - foot.topRows<3>() +
           skew(data.cog - sole.translation()) * foot.bottomRows<3>();
  };
  const double root = model.bodies()[0].inertia.mass;
  const MatrixXd printed = cog_jacobian_with(model.mass() - root);
  const MatrixXd corrected = cog_jacobian_with(model.mass());
  EXPECT_LT((corrected - cog_jacobian(model, data, Side::left)).norm(), 1e-12);

  // These are central differences of the COG while the left sole is held.
  MatrixXd differences(3, n);
  const double h = 1e-5;
  auto cog_at = [&](int joint, double change) {
    RobotState s = state;
    s.theta[joint] += change;
    RobotData d(model);
    anchor_base(model, Side::left, sole, s, d);
    return d.cog;
  };
  for (int k = 0; k < n; ++k) differences.col(k) = (cog_at(k, h) - cog_at(k, -h)) / (2 * h);
  EXPECT_LT((corrected - differences).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_GT((printed - differences).cwiseAbs().maxCoeff(), 1e-2);
}

/// The distance of the COG from its command after `time`, if it starts at rest 10 mm away, under
///   z = cmd z - K delta + sign D ddelta,  delta = cmd x - x.
double after(double time, double K, double D, double sign) {
  const LevelPendulum pendulum;
  const double dt = 1e-4;
  Motion s = {0.010, 0};
  for (int k = 0; k < std::lround(time / dt); ++k)
    s = test::step(s, dt, [&](const Motion& m) {
      return pendulum.acceleration(m.x, K * m.x - sign * D * m.v);
    });
  return std::abs(s.x);
}

// (18)(19): the differential term has the minus sign, and K must exceed 1.
TEST_F(Errata, Equations18And19NeedMinusD) {
  const double omega = LevelPendulum().omega();
  const double D = 2 / omega;
  EXPECT_GT(after(0.6, 2, D, +1), 0.3) << "as printed: diverges";
  EXPECT_LT(after(2.0, 2, D, -1), 1e-4) << "corrected: converges";
  EXPECT_GT(after(5.0, 1.0, D, -1), 0.009) << "K = 1: stays off";
  EXPECT_GT(after(5.0, 0.9, D, -1), 0.010) << "K < 1: leaves";
}

// The characteristic polynomial of (18)(19) is s^2 + omega^2 D s + omega^2 (K - 1).
TEST_F(Errata, GainsFromPoles) {
  const double omega = LevelPendulum().omega();
  const double q1 = 1.0, q2 = 0.25;
  const double K = 1 + q1 * q2, D = (q1 + q2) / omega;
  auto mode = [&](double q, double t) {  // a motion that starts on one pole stays on it
    const LevelPendulum pendulum;
    Motion s = {0.010, -q * omega * 0.010};
    const double dt = 1e-4;
    for (int k = 0; k < std::lround(t / dt); ++k)
      s = test::step(
          s, dt, [&](const Motion& m) { return pendulum.acceleration(m.x, K * m.x + D * m.v); });
    return s.x;
  };
  EXPECT_NEAR(mode(q1, 0.3), 0.010 * std::exp(-q1 * omega * 0.3), 1e-10);
  EXPECT_NEAR(mode(q2, 0.3), 0.010 * std::exp(-q2 * omega * 0.3), 1e-10);
}

// (22)(23): v = u - J cmd; with the printed sign the constraint is missed by twice the distance.
TEST_F(Errata, Equation23ResolvesTheTask) {
  const MatrixXd J = (MatrixXd(1, 2) << 1, 1).finished();
  const VectorXd u = VectorXd::Constant(1, 1.0);
  const VectorXd w = (VectorXd(2) << 1, 4).finished();
  const VectorXd command = (VectorXd(2) << 0.1, 0.3).finished();

  const VectorXd corrected = weighted_least_norm(J, u, w, command);
  EXPECT_NEAR((J * corrected - u)[0], 0, 1e-15);

  const VectorXd v_printed = J * command - u;
  const MatrixXd winv = w.cwiseInverse().asDiagonal();
  const MatrixXd spread = winv * J.transpose();
  const VectorXd printed = command + spread * test::solve_dense(J * spread, v_printed);
  EXPECT_NEAR((J * printed - u)[0], -1.2, 1e-12);

  // No solution that meets the task is nearer to the command.
  auto cost = [&](const VectorXd& x) { return (x - command).dot(w.asDiagonal() * (x - command)); };
  const VectorXd null = (VectorXd(2) << 1, -1).finished();
  for (double a : {-0.1, -1e-3, 1e-3, 0.1}) EXPECT_GT(cost(corrected + a * null), cost(corrected));
}

/// The distance by which (24) exceeds its goal height if it starts 20 mm above it [m].
double overshoot(double mass, double kp, double kd) {
  Motion s = {0.020, 0};
  double lowest = 0;
  for (int k = 0; k < 40000; ++k) {
    s = test::step(s, 1e-4, [&](const Motion& m) {
      const double fz = -kp * m.x - kd * m.v + mass * kGravity;
      return vertical_acceleration(fz, mass);
    });
    lowest = std::min(lowest, s.x);
  }
  return -lowest;
}

// (25): the gains are forces per metre, so that the mass belongs into the condition.
TEST_F(Errata, Equation25NeedsTheMass) {
  for (auto [mass, expected] : {std::pair{6.5, 5.2e-3}, {35.0, 11.7e-3}}) {
    const double kp = mass * 100;
    EXPECT_NEAR(overshoot(mass, kp, std::sqrt(4 * kp)), expected, 0.1e-3) << "as printed";
    EXPECT_LT(overshoot(mass, kp, std::sqrt(4 * mass * kp)), 1e-9) << "corrected";
  }
}

// (17): if the ground force goes to zero before a flight, omega^2 goes to zero, too, and the ZMP
// that (14) requires goes to infinity.
TEST_F(Errata, Equation17LosesItsMeaningInFlight) {
  const double mass = 6.5, height = 0.225;
  const Vector3d cog(0, 0, height), ddcog(0.2, 0, -kGravity);
  auto zmp_at = [&](double share) {
    const double fz = share * mass * kGravity;
    const double w2 = omega_squared(fz, mass, height);
    return cog.x() - ddcog.x() / w2;
  };
  EXPECT_LT(std::abs(zmp_at(1.0)), 0.005);
  EXPECT_GT(std::abs(zmp_at(1e-3)), 4.0);
  EXPECT_FALSE(std::isfinite(zmp_at(0)));
  // Ayumi does this instead: below a small force, the ZMP is not computed at all.
  Eigen::Matrix<double, 6, 1> wrench = Eigen::Matrix<double, 6, 1>::Zero();
  wrench.head<3>() = Vector3d(mass * 0.2, 0, 1e-3 * mass * kGravity);
  const GroundReaction held = ground_reaction(cog, wrench, 0, 0.05 * mass * kGravity);
  EXPECT_EQ(held.zmp, Vector3d(0, 0, 0));
  EXPECT_GT(std::abs(ground_reaction(cog, wrench, 0).zmp.x()), 4.0);
}

}  // namespace
}  // namespace ayumi
