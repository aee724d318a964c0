// Spatial vectors (linear part first) about the base origin, world axes. Galilean invariance lets
// the base velocity be taken as zero. With S_j the joint screw, V, A the twist and spatial
// acceleration (gravity included) of its parent, and I, f of whole subtrees, the derivatives of
// the joint forces are (Singh, Russo, Wensing, RA-L 2022):
//   psi1_j = V x S_j,   psi2_j = A x S_j + V x psi1_j
//   d tau_i / d q_j  = S_i . (2B_i psi1_j + I_i psi2_j)                   j above i or j = i
//   d tau_j / d q_i  = S_j . (2B_i psi1_i + I_i psi2_i + S_i x* f_i)      j above i, base rows too
//   d tau    / d dq  = same with (2B S + 2 I psi1)
// 2B X is what a change X of the twist does to the velocity forces. Every particle of mass m at c
// with velocity u feels 2 m X_w x u there, so with p = sum m u and G = sum m u c' of the subtree
//   2B X = (2 X_w x p, D X_w),   D = 2 (tr G - G),   of one body G = v h' + [w x] sum m c c'.
// Base columns: translation 0; w: 2B_i S_k + I_i (0, w x e_k); rotation by turning the whole
// system back: -[F x] + dw [w x] + dalpha [alpha x] + da [(a + g) x].
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/dynamics/tree_dynamics.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

// The inertia about the base origin of a body with attitude R, whose centre of mass is at `com`
// from there.
SpatialInertia inertia_about_origin(const Body& body, const Matrix3d& R, const Vector3d& com) {
  SpatialInertia result;
  result.mass = body.inertia.mass;
  const Vector3d h = body.inertia.mass * com;
  result.moment = h;
  const Matrix3d turned = R * body.inertia.about_com;
  Matrix3d& I = result.inertia;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j <= i; ++j)
      I(i, j) = I(j, i) =
          turned(i, 0) * R(j, 0) + turned(i, 1) * R(j, 1) + turned(i, 2) * R(j, 2) - h[i] * com[j];
  I.diagonal().array() += h.dot(com);
  return result;
}

// X <- X M^-1 for all rows at once.
void solve_rows(const TreeCholesky& L, MatrixXd& X) {
  const int n = static_cast<int>(X.cols());
  for (int k = n - 1; k >= 0; --k) {
    auto of_k = X.col(L.column_at(k));
    of_k *= 1.0 / L.diagonal(k);
    for (int j = L.parent(k); j >= 0; j = L.parent(j))
      X.col(L.column_at(j)) -= L.below(k, j) * of_k;
  }
  for (int k = 0; k < n; ++k) {
    auto of_k = X.col(L.column_at(k));
    for (int j = L.parent(k); j >= 0; j = L.parent(j))
      of_k -= L.below(k, j) * X.col(L.column_at(j));
    of_k *= 1.0 / L.diagonal(k);
  }
}

}  // namespace

// Computes the twists, accelerations and joint terms of body i > 0 from those of its parent.
void TreeDynamics::carry_outwards(const Body& body, size_t i, double rate, double acceleration) {
  const Rates& p = rates_[static_cast<size_t>(body.parent)];
  Rates& t = rates_[i];
  const Vector3d s = body.ratio * data_.axis[i];
  if (body.prismatic) {
    t.screw_linear = s;
    t.screw_angular.setZero();
  } else {
    t.screw_linear = data_.position[i].cross(s);
    t.screw_angular = s;
  }
  const Vector3d &sl = t.screw_linear, &sw = t.screw_angular;
  t.psi1_angular = p.w.cross(sw);
  t.psi1_linear = p.w.cross(sl) + p.v.cross(sw);
  t.psi2_angular = p.alpha.cross(sw) + p.w.cross(t.psi1_angular);
  t.psi2_linear =
      p.alpha.cross(sl) + p.a.cross(sw) + p.w.cross(t.psi1_linear) + p.v.cross(t.psi1_angular);
  t.v = p.v + rate * sl;
  t.w = p.w + rate * sw;
  t.a = p.a + acceleration * sl + rate * t.psi1_linear;
  t.alpha = p.alpha + acceleration * sw + rate * t.psi1_angular;
}

// Computes the inertia, the momentum, its flow G and the force of one body.
void TreeDynamics::start_subtree(size_t i) {
  Rates& t = rates_[i];
  SpatialInertia& I = data_.composite[i];
  I = inertia_about_origin(model_->bodies()[i], data_.rotation[i], data_.com[i]);
  t.momentum = I.mass * t.v + t.w.cross(I.moment);
  const Vector3d angular = I.inertia * t.w + I.moment.cross(t.v);
  t.force = I.mass * t.a + t.alpha.cross(I.moment) + t.w.cross(t.momentum);
  t.moment = I.inertia * t.alpha + I.moment.cross(t.a) + t.w.cross(angular) + t.v.cross(t.momentum);
  Matrix3d second = -I.inertia;  // the sum of m c c'
  second.diagonal().array() += 0.5 * I.inertia.trace();
  for (int k = 0; k < 3; ++k)
    t.flow.col(k) = I.moment[k] * t.v + t.w.cross(Vector3d(second.col(k)));
}

// Fills the row and the column of joint i against itself and everything above it.
void TreeDynamics::add_columns(size_t i, const Vector3d& w0, InverseDynamicsDerivatives& d) const {
  const std::vector<Body>& bodies = model_->bodies();
  const Rates& t = rates_[i];
  const SpatialInertia& I = data_.composite[i];
  const int row = 6 + bodies[i].dof;
  const Vector3d &sl = t.screw_linear, &sw = t.screw_angular;
  Matrix3d D = -2.0 * t.flow;
  D.diagonal().array() += 2.0 * t.flow.trace();
  // The wrench of the subtree per ddq_i, q_i and dq_i, which every body above feels.
  const Vector3d m_force = I.mass * sl + sw.cross(I.moment);
  const Vector3d m_moment = I.inertia * sw + I.moment.cross(sl);
  const Vector3d q_force = 2.0 * t.psi1_angular.cross(t.momentum) + I.mass * t.psi2_linear +
                           t.psi2_angular.cross(I.moment) + sw.cross(t.force);
  const Vector3d q_moment = D * t.psi1_angular + I.inertia * t.psi2_angular +
                            I.moment.cross(t.psi2_linear) + sw.cross(t.moment) + sl.cross(t.force);
  const Vector3d v_force =
      2.0 * (sw.cross(t.momentum) + I.mass * t.psi1_linear + t.psi1_angular.cross(I.moment));
  const Vector3d v_moment =
      D * sw + 2.0 * (I.inertia * t.psi1_angular + I.moment.cross(t.psi1_linear));
  const Vector3d left = 2.0 * t.momentum.cross(sl) + D.transpose() * sw;  // angular part of 2B' S
  MatrixXd &dq = d.configuration, &dv = d.velocity, &M = d.acceleration;
  dq.col(row).head<3>() += q_force;
  dq.col(row).segment<3>(3) += q_moment;
  dv.col(row).head<3>() += v_force;
  dv.col(row).segment<3>(3) += v_moment;
  M.col(row).head<3>() += m_force;
  M.col(row).segment<3>(3) += m_moment;
  dq(row, row) += sl.dot(q_force) + sw.dot(q_moment);  // S x* f has no part along S
  dv(row, row) += sl.dot(v_force) + sw.dot(v_moment);
  M(row, row) += sl.dot(m_force) + sw.dot(m_moment);
  for (int j = bodies[i].parent; j > 0; j = bodies[static_cast<size_t>(j)].parent) {
    const Rates& above = rates_[static_cast<size_t>(j)];
    const int column = 6 + bodies[static_cast<size_t>(j)].dof;
    const Vector3d &jl = above.screw_linear, &jw = above.screw_angular;
    dq(column, row) += jl.dot(q_force) + jw.dot(q_moment);
    dv(column, row) += jl.dot(v_force) + jw.dot(v_moment);
    const double m = jl.dot(m_force) + jw.dot(m_moment);
    M(column, row) += m;
    M(row, column) += m;
    dq(row, column) += left.dot(above.psi1_angular) + m_force.dot(above.psi2_linear) +
                       m_moment.dot(above.psi2_angular);
    dv(row, column) +=
        left.dot(jw) + 2.0 * (m_force.dot(above.psi1_linear) + m_moment.dot(above.psi1_angular));
  }
  const Vector3d by_w0 = left + m_moment.cross(w0);
  for (int k = 0; k < 3; ++k) dv(row, 3 + k) += by_w0[k];
}

void TreeDynamics::finish_base(const RobotState& state, const VectorXd& acceleration,
                               InverseDynamicsDerivatives& d) const {
  const int n = model_->velocity_count();
  MatrixXd &dq = d.configuration, &dv = d.velocity, &M = d.acceleration;
  const SpatialInertia& total = data_.composite[0];
  const Rates& root = rates_[0];
  M.bottomLeftCorner(n - 6, 6) = M.topRightCorner(6, n - 6).transpose();
  M.topLeftCorner<3, 3>().diagonal().setConstant(total.mass);
  M.block<3, 3>(3, 0) = skew(total.moment);
  M.block<3, 3>(0, 3) = -M.block<3, 3>(3, 0);
  M.block<3, 3>(3, 3) = total.inertia;
  const Matrix3d W = skew(state.base_angular_velocity);
  dv.block<3, 3>(0, 3) = -2.0 * skew(root.momentum) - skew(total.moment) * W;
  dv.block<3, 3>(3, 3) = total.inertia * W - 2.0 * root.flow;
  dv.block<3, 3>(3, 3).diagonal().array() += 2.0 * root.flow.trace();
  const Matrix3d by_alpha = skew(acceleration.segment<3>(3)),
                 by_a = skew(acceleration.head<3>() + Vector3d(0, 0, kGravity));
  dq.middleCols<3>(3).noalias() = dv.middleCols<3>(3).lazyProduct(W);
  dq.middleCols<3>(3).noalias() += M.middleCols<3>(3).lazyProduct(by_alpha);
  dq.middleCols<3>(3).noalias() += M.leftCols<3>().lazyProduct(by_a);
  dq.block<3, 3>(0, 3) -= skew(root.force);
  dq.block<3, 3>(3, 3) -= skew(root.moment);
}

void TreeDynamics::inverse_derivatives(const RobotState& state, const VectorXd& acceleration,
                                       InverseDynamicsDerivatives& derivatives) {
  update_positions(*model_, state, data_);
  const std::vector<Body>& bodies = model_->bodies();
  const int n = model_->velocity_count();
  for (MatrixXd* each :
       {&derivatives.configuration, &derivatives.velocity, &derivatives.acceleration})
    each->setZero(n, n);
  Rates& root = rates_[0];
  root.v.setZero();
  root.w = state.base_angular_velocity;
  root.a = acceleration.head<3>() + Vector3d(0, 0, kGravity);
  root.alpha = acceleration.segment<3>(3);
  for (size_t i = 0; i < bodies.size(); ++i) {
    if (i > 0)
      carry_outwards(bodies[i], i, state.dtheta[bodies[i].dof], acceleration[6 + bodies[i].dof]);
    start_subtree(i);
  }
  for (size_t i = bodies.size() - 1; i > 0; --i) {
    add_columns(i, state.base_angular_velocity, derivatives);
    const auto parent = static_cast<size_t>(bodies[i].parent);
    const SpatialInertia& I = data_.composite[i];
    SpatialInertia& composite = data_.composite[parent];
    composite.mass += I.mass;
    composite.moment += I.moment;
    composite.inertia += I.inertia;
    const Rates& t = rates_[i];
    Rates& p = rates_[parent];
    p.momentum += t.momentum;
    p.flow += t.flow;
    p.force += t.force;
    p.moment += t.moment;
  }
  finish_base(state, acceleration, derivatives);
}

void TreeDynamics::forward_derivatives(const RobotState& state, const VectorXd& force,
                                       ForwardDynamicsDerivatives& derivatives,
                                       const JointDrive* drive) {
  const int n = model_->velocity_count();
  forward(state, force, derivatives.acceleration, drive);
  InverseDynamicsDerivatives& inverse = derivatives.inverse;
  inverse_derivatives(state, derivatives.acceleration, inverse);
  mass_ = inverse.acceleration;
  factor(drive);
  rows_.resize(3 * n, n);  // the rows are transposed: X M^-1 for a symmetric M
  rows_.topRows(n) = -inverse.configuration.transpose();
  rows_.middleRows(n, n) = -inverse.velocity.transpose();
  rows_.bottomRows(n).setIdentity();
  if (drive)
    for (int j = 0; j < n - 6; ++j)
      rows_(n + 6 + j, 6 + j) -= friction_slope(*drive, j, state.dtheta[j]);
  solve_rows(factor_, rows_);
  derivatives.configuration = rows_.topRows(n).transpose();
  derivatives.velocity = rows_.middleRows(n, n).transpose();
  derivatives.force = rows_.bottomRows(n);
}

}  // namespace ayumi
