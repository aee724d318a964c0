#pragma once
// Derivatives of inverse dynamics by matrices of six. Spatial vectors have their linear part first,
// and are about the base origin in world axes. Galilean invariance lets the base velocity be taken
// as zero. With S_j the joint screw, V, A the twist and spatial acceleration (gravity included) of
// its parent, and composite sums over subtrees of I, f and
//   2B = (V x*) I - I (V x) + (I V) xbar*,
// the derivatives of the joint forces are (Singh, Russo, Wensing, RA-L 2022):
//   psi1_j = V x S_j,   psi2_j = A x S_j + V x psi1_j
//   d tau_i / d q_j  = S_i . (2B_i psi1_j + I_i psi2_j)                   j above i or j = i
//   d tau_j / d q_i  = S_j . (2B_i psi1_i + I_i psi2_i + S_i x* f_i)      j above i, base rows too
//   d tau    / d dq  = same with (2B S + 2 I psi1)
// Base columns: translation 0; w: 2B_i S_k + I_i (0, w x e_k); rotation by turning the whole
// system back: -[F x] + dw [w x] + dalpha [alpha x] + da [(a + g) x].
#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/tree_dynamics.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi::test {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

inline Vector6d spatial(const Vector3d& linear, const Vector3d& angular) {
  Vector6d v;
  v << linear, angular;
  return v;
}

inline Vector6d cross_motion(const Vector6d& a, const Vector6d& b) {
  const Vector3d w = a.tail<3>();
  return spatial(w.cross(b.head<3>()) + a.head<3>().cross(b.tail<3>()), w.cross(b.tail<3>()));
}

inline Vector6d cross_force(const Vector6d& a, const Vector6d& f) {
  const Vector3d w = a.tail<3>();
  return spatial(w.cross(f.head<3>()), w.cross(f.tail<3>()) + a.head<3>().cross(f.head<3>()));
}

inline Matrix6d cross_motion_matrix(const Vector6d& a) {
  Matrix6d m = Matrix6d::Zero();
  m.topLeftCorner<3, 3>() = m.bottomRightCorner<3, 3>() = skew(a.tail<3>());
  m.topRightCorner<3, 3>() = skew(a.head<3>());
  return m;
}

// The matrix for which (h xbar*) S = S x* h.
inline Matrix6d cross_bar_matrix(const Vector6d& h) {
  Matrix6d m = Matrix6d::Zero();
  m.topRightCorner<3, 3>() = m.bottomLeftCorner<3, 3>() = -skew(h.head<3>());
  m.bottomRightCorner<3, 3>() = -skew(h.tail<3>());
  return m;
}

struct Subtree {
  Matrix6d inertia, twice_b;
  Vector6d force, twist, acceleration;  // twist and acceleration of the body itself
};

inline Matrix6d inertia_matrix(const Body& body, const Matrix3d& R, const Vector3d& com) {
  Matrix6d I;
  const double m = body.inertia.mass;
  const Matrix3d c = skew(com);
  I.topLeftCorner<3, 3>() = m * Matrix3d::Identity();
  I.topRightCorner<3, 3>() = -m * c;
  I.bottomLeftCorner<3, 3>() = m * c;
  I.bottomRightCorner<3, 3>() = R * body.inertia.about_com * R.transpose() - m * c * c;
  return I;
}

inline Vector6d screw(const Body& body, const RobotData& data, size_t i) {
  const Vector3d s = body.ratio * data.axis[i];
  return body.prismatic ? spatial(s, Vector3d::Zero()) : spatial(data.position[i].cross(s), s);
}

/// The result of TreeDynamics::inverse_derivatives(), computed in another way for comparison.
inline void spatial_derivatives(const RobotModel& model, const RobotState& state,
                                const VectorXd& acceleration, RobotData& data,
                                InverseDynamicsDerivatives& derivatives) {
  const std::vector<Body>& bodies = model.bodies();
  const int n = model.velocity_count();
  const VectorXd force = inverse_dynamics(model, state, acceleration, data);
  mass_matrix(model, data, derivatives.acceleration);
  MatrixXd& dq = derivatives.configuration;
  MatrixXd& dv = derivatives.velocity;
  dq.setZero(n, n);
  dv.setZero(n, n);

  std::vector<Subtree> tree(bodies.size());
  std::vector<Vector6d> S(bodies.size()), psi1(bodies.size()), psi2(bodies.size());
  const Vector3d w0 = state.base_angular_velocity;
  for (size_t i = 0; i < bodies.size(); ++i) {
    Subtree& t = tree[i];
    if (i == 0) {
      const Vector3d a0 = acceleration.head<3>() + Vector3d(0, 0, kGravity);
      t.twist = spatial(Vector3d::Zero(), w0);
      t.acceleration = spatial(a0, acceleration.segment<3>(3));
    } else {
      const Body& body = bodies[i];
      const Subtree& p = tree[body.parent];
      S[i] = screw(body, data, i);
      psi1[i] = cross_motion(p.twist, S[i]);
      psi2[i] = cross_motion(p.acceleration, S[i]) + cross_motion(p.twist, psi1[i]);
      t.twist = p.twist + S[i] * state.dtheta[body.dof];
      t.acceleration =
          p.acceleration + S[i] * acceleration[6 + body.dof] + psi1[i] * state.dtheta[body.dof];
    }
    t.inertia = inertia_matrix(bodies[i], data.rotation[i], data.com[i]);
    const Vector6d h = t.inertia * t.twist;
    const Matrix6d vx = cross_motion_matrix(t.twist);
    t.twice_b = -vx.transpose() * t.inertia - t.inertia * vx + cross_bar_matrix(h);
    t.force = t.inertia * t.acceleration + cross_force(t.twist, h);
  }

  for (size_t i = bodies.size() - 1; i > 0; --i) {
    const Body& body = bodies[i];
    const Subtree& t = tree[i];
    const int row = 6 + body.dof;
    // The wrench of the subtree per q_i and per dq_i, which every body above feels.
    const Vector6d per_q = t.twice_b * psi1[i] + t.inertia * psi2[i] + cross_force(S[i], t.force);
    const Vector6d per_dq = t.twice_b * S[i] + 2.0 * t.inertia * psi1[i];
    dq.block<6, 1>(0, row) += per_q;
    dv.block<6, 1>(0, row) += per_dq;
    const Vector6d left_b = t.twice_b.transpose() * S[i];
    const Vector6d left_i = t.inertia * S[i];
    dq(row, row) += left_b.dot(psi1[i]) + left_i.dot(psi2[i]);
    dv(row, row) += S[i].dot(per_dq);
    for (int j = body.parent; j > 0; j = bodies[j].parent) {
      const int column = 6 + bodies[j].dof;
      dq(row, column) += left_b.dot(psi1[j]) + left_i.dot(psi2[j]);
      dv(row, column) += left_b.dot(S[j]) + 2.0 * left_i.dot(psi1[j]);
      dq(column, row) += S[j].dot(per_q);
      dv(column, row) += S[j].dot(per_dq);
    }
    for (int k = 0; k < 3; ++k) {
      const Vector3d e = Vector3d::Unit(k);
      dv(row, 3 + k) += left_b[3 + k] + left_i.tail<3>().dot(w0.cross(e));
    }
    Subtree& p = tree[body.parent];
    p.inertia += t.inertia;
    p.twice_b += t.twice_b;
    p.force += t.force;
  }
  for (int k = 0; k < 3; ++k) {
    const Vector3d e = Vector3d::Unit(k);
    dv.block<6, 1>(0, 3 + k) =
        tree[0].twice_b.col(3 + k) + tree[0].inertia * spatial(Vector3d::Zero(), w0.cross(e));
  }
  const MatrixXd& M = derivatives.acceleration;
  const Vector3d a0 = acceleration.head<3>() + Vector3d(0, 0, kGravity);
  dq.middleCols<3>(3) = dv.middleCols<3>(3) * skew(w0) +
                        M.middleCols<3>(3) * skew(acceleration.segment<3>(3)) +
                        M.leftCols<3>() * skew(a0);
  dq.block<3, 3>(0, 3) -= skew(force.head<3>());
  dq.block<3, 3>(3, 3) -= skew(force.segment<3>(3));
}

}  // namespace ayumi::test
