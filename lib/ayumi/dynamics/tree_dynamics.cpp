// A body's axes are turned by a constant C so that its joint axis is x, y or z: with R = E P(q) the
// body's attitude in its parent, C_p' R C = (C_p' E C) P'(q). Axes along -x and so on count q
// backwards instead.
#include "ayumi/dynamics/tree_dynamics.hpp"

#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/version.hpp"

namespace ayumi {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

const kernels::Kernels* avx2_where_it_runs() {
#if defined(__x86_64__) || defined(__i386__)
  if (__builtin_cpu_supports("avx2")) return kernels::avx2_kernels();
#endif
  return nullptr;
}

const kernels::Kernels* kernels_for(InstructionSet set) {
  if (set == InstructionSet::plain) return &kernels::plain_kernels();
  if (set == InstructionSet::avx2 && !avx2_where_it_runs())
    fail(ErrorCode::usage, "dynamics kernels for AVX2 are not available here; use best or plain");
  return &kernels::best_kernels();
}

void put(const Matrix3d& m, double* rows) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) rows[3 * i + j] = m(i, j);
}

// Fills axis and direction; returns C.
Matrix3d align(const Body& body, kernels::Link& link) {
  link.ratio = body.ratio;
  link.offset = body.offset;
  for (int k = 0; k < 3; ++k) {
    if (std::abs(body.axis[k]) != 1) continue;
    link.axis = k;
    if (body.axis[k] < 0) {
      link.ratio = -link.ratio;
      link.offset = -link.offset;
    }
    return Matrix3d::Identity();
  }
  link.axis = 2;
  Matrix3d C;
  C.col(2) = body.axis;
  C.col(0) = body.axis.unitOrthogonal();
  C.col(1) = C.col(2).cross(C.col(0));
  return C;
}

std::vector<kernels::Link> links_of(const RobotModel& model) {
  const std::vector<Body>& bodies = model.bodies();
  std::vector<kernels::Link> links(bodies.size());
  std::vector<Matrix3d> turn(bodies.size(), Matrix3d::Identity());
  for (size_t i = 0; i < bodies.size(); ++i) {
    const Body& body = bodies[i];
    kernels::Link& link = links[i];
    if (i > 0) {
      turn[i] = align(body, link);
      link.parent = body.parent;
      link.dof = body.dof;
      link.prismatic = body.prismatic;
      const Matrix3d& up = turn[static_cast<size_t>(body.parent)];
      const Matrix3d E = up.transpose() * body.placement.linear() * turn[i];
      link.turned = E != Matrix3d::Identity();
      put(E, link.E);
      Eigen::Map<Vector3d>(link.r) = up.transpose() * body.placement.translation();
    }
    const Vector3d com = turn[i].transpose() * body.inertia.com;
    Matrix3d I = turn[i].transpose() * body.inertia.about_com * turn[i];
    const double m = body.inertia.mass;
    I += m * (com.squaredNorm() * Matrix3d::Identity() - com * com.transpose());
    link.mass = m;
    Eigen::Map<Vector3d>(link.moment) = m * com;
    const double six[] = {I(0, 0), I(0, 1), I(0, 2), I(1, 1), I(1, 2), I(2, 2)};
    std::copy(six, six + 6, link.I);
  }
  for (size_t i = links.size(); i-- > 0;) {
    links[i].subtree_mass += links[i].mass;
    if (i > 0) links[static_cast<size_t>(links[i].parent)].subtree_mass += links[i].subtree_mass;
  }
  return links;
}

}  // namespace

const kernels::Kernels& kernels::best_kernels() {
  static const Kernels* const best = avx2_where_it_runs() ? avx2_kernels() : &plain_kernels();
  return *best;
}

TreeDynamics::TreeDynamics(const RobotModel& model, InstructionSet set)
    : model_(&model),
      kernels_(kernels_for(set)),
      links_(links_of(model)),
      scratch_(static_cast<size_t>(kernels::scratch_doubles(static_cast<int>(links_.size())) / 8)),
      packed_(static_cast<size_t>(kernels::kMaxWidth * (7 + 4 * model.velocity_count()))),
      still_(VectorXd::Zero(model.velocity_count())),
      data_(model),
      rates_(model.bodies().size()),
      factor_(model) {}

kernels::Tree TreeDynamics::tree() const {
  return {links_.data(), static_cast<int>(links_.size()), model_->dof_count(), kGravity};
}

bool TreeDynamics::tied() const {
  return static_cast<int>(links_.size()) != model_->dof_count() + 1;
}

void TreeDynamics::inverse(const RobotState& state, const VectorXd& acceleration, VectorXd& force) {
  force.resize(model_->velocity_count());
  kernels_->inverse(
      tree(),
      {state.base.attitude.coeffs().data(), state.base_angular_velocity.data(), state.theta.data(),
       state.dtheta.data(), acceleration.data(), nullptr, force.data(), scratch_[0].number});
}

void TreeDynamics::forward(const RobotState& state, const VectorXd& force, VectorXd& acceleration,
                           const JointDrive* drive) {
  if (tied()) return solve_tied(state, force, acceleration, drive);
  acceleration.resize(model_->velocity_count());
  const VectorXd* input = &force;
  if (drive) {
    without_friction_ = force;
    for (int j = 0; j < model_->dof_count(); ++j)
      without_friction_[6 + j] -= friction_torque(*drive, j, state.dtheta[j]);
    input = &without_friction_;
  }
  kernels_->forward(
      tree(),
      {state.base.attitude.coeffs().data(), state.base_angular_velocity.data(), state.theta.data(),
       state.dtheta.data(), input->data(), drive ? drive->rotor_inertia.data() : nullptr,
       acceleration.data(), scratch_[0].number});
}

// Adds the rotors to mass_ and factors it.
void TreeDynamics::factor(const JointDrive* drive) {
  if (drive) mass_.diagonal().tail(model_->dof_count()) += drive->rotor_inertia;
  if (!factor_.factor(mass_))
    fail(ErrorCode::internal, model_->name() + ": the mass matrix is not positive definite");
}

void TreeDynamics::solve_tied(const RobotState& state, const VectorXd& force,
                              VectorXd& acceleration, const JointDrive* drive) {
  inverse(state, still_, acceleration);
  acceleration = force - acceleration;
  if (drive)
    for (int j = 0; j < model_->dof_count(); ++j)
      acceleration[6 + j] -= friction_torque(*drive, j, state.dtheta[j]);
  mass_matrix(state, mass_);
  factor(drive);
  factor_.solve(acceleration);
}

void TreeDynamics::mass_matrix(const RobotState& state, MatrixXd& M) {
  M.resize(model_->velocity_count(), model_->velocity_count());
  kernels_->mass_matrix(tree(), {state.base.attitude.coeffs().data(), nullptr, state.theta.data(),
                                 nullptr, nullptr, nullptr, M.data(), scratch_[0].number});
}

void TreeDynamics::inverse(std::span<const RobotState> states, const MatrixXd& acceleration,
                           MatrixXd& force) {
  batch(states, acceleration, force, nullptr, false);
}

void TreeDynamics::forward(std::span<const RobotState> states, const MatrixXd& force,
                           MatrixXd& acceleration, const JointDrive* drive) {
  if (!tied()) return batch(states, force, acceleration, drive, true);
  acceleration.resize(model_->velocity_count(), static_cast<Eigen::Index>(states.size()));
  VectorXd column;
  for (size_t k = 0; k < states.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    without_friction_ = force.col(at);
    solve_tied(states[k], without_friction_, column, drive);
    acceleration.col(at) = column;
  }
}

void TreeDynamics::batch(std::span<const RobotState> states, const MatrixXd& input,
                         MatrixXd& output, const JointDrive* drive, bool forward) {
  const int n = model_->dof_count(), width = kernels_->width;
  const int count = static_cast<int>(states.size());
  output.resize(6 + n, count);
  double* attitude = packed_.data();
  double* angular = attitude + 4 * width;
  double* theta = angular + 3 * width;
  double* dtheta = theta + n * width;
  double* in = dtheta + n * width;
  double* out = in + (6 + n) * width;
  const kernels::Job job = {
      attitude, angular,           theta, dtheta, in, drive ? drive->rotor_inertia.data() : nullptr,
      out,      scratch_[0].number};
  for (int first = 0; first < count; first += width) {
    for (int lane = 0; lane < width; ++lane) {
      const int k = std::min(first + lane, count - 1);  // the last group is filled up with copies
      const RobotState& s = states[static_cast<size_t>(k)];
      for (int i = 0; i < 4; ++i) attitude[i * width + lane] = s.base.attitude.coeffs()[i];
      for (int i = 0; i < 3; ++i) angular[i * width + lane] = s.base_angular_velocity[i];
      const double* from = input.data() + static_cast<Eigen::Index>(k) * (6 + n);
      for (int i = 0; i < 6 + n; ++i) in[i * width + lane] = from[i];
      for (int j = 0; j < n; ++j) {
        theta[j * width + lane] = s.theta[j];
        dtheta[j * width + lane] = s.dtheta[j];
        if (drive) in[(6 + j) * width + lane] -= friction_torque(*drive, j, s.dtheta[j]);
      }
    }
    (forward ? kernels_->forward_wide : kernels_->inverse_wide)(tree(), job);
    for (int lane = 0; lane < width && first + lane < count; ++lane) {
      double* to = output.data() + static_cast<Eigen::Index>(first + lane) * (6 + n);
      for (int i = 0; i < 6 + n; ++i) to[i] = out[i * width + lane];
    }
  }
}

}  // namespace ayumi
