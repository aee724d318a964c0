#include "ayumi/dynamics/tree_dynamics.hpp"

#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/dynamics/tree_links.hpp"
#include "ayumi/model/gravity.hpp"

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
    fail(ErrorCode::usage,
         "this program or this processor has no AVX2 instructions. Choose the instruction set best "
         "or plain");
  return &kernels::best_kernels();
}

}  // namespace

const kernels::Kernels& kernels::best_kernels() {
  static const Kernels* const best = avx2_where_it_runs() ? avx2_kernels() : &plain_kernels();
  return *best;
}

TreeDynamics::TreeDynamics(const RobotModel& model, InstructionSet set)
    : model_(&model),
      kernels_(kernels_for(set)),
      links_(tree_links(model)),
      scratch_(static_cast<size_t>(kernels::scratch_doubles(static_cast<int>(links_.size())) / 8)),
      packed_(static_cast<size_t>(kernels::kMaxWidth * (7 + 4 * model.velocity_count()))),
      still_(VectorXd::Zero(model.velocity_count())),
      data_(model, *kernels_),
      rates_(model.bodies().size()),
      factor_(model, *kernels_) {}

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

// Adds the rotors to mass_ and factorises it.
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
  update_positions(*model_, state, data_);
  ayumi::mass_matrix(*model_, data_, M);
}

// Works through states and inputs in groups: state_of(k) gives state number k, and input_of(k) its
// 6+dof input numbers.
template <class StateOf, class InputOf>
void TreeDynamics::batch(int count, const StateOf& state_of, const InputOf& input_of,
                         MatrixXd& output, const JointDrive* drive, bool forward) {
  const int n = model_->dof_count(), width = kernels_->width;
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
      const RobotState& s = state_of(k);
      for (int i = 0; i < 4; ++i) attitude[i * width + lane] = s.base.attitude.coeffs()[i];
      for (int i = 0; i < 3; ++i) angular[i * width + lane] = s.base_angular_velocity[i];
      const double* from = input_of(k);
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

void TreeDynamics::inverse(std::span<const RobotState> states, const MatrixXd& acceleration,
                           MatrixXd& force) {
  batch(
      static_cast<int>(states.size()), [&](int k) -> const RobotState& { return states[k]; },
      [&](int k) { return acceleration.col(k).data(); }, force, nullptr, false);
}

void TreeDynamics::inverse(std::span<const Motion> motions, MatrixXd& force) {
  batch(
      static_cast<int>(motions.size()),
      [&](int k) -> const RobotState& { return *motions[k].state; },
      [&](int k) { return motions[k].acceleration->data(); }, force, nullptr, false);
}

void TreeDynamics::forward(std::span<const RobotState> states, const MatrixXd& force,
                           MatrixXd& acceleration, const JointDrive* drive) {
  if (!tied())
    return batch(
        static_cast<int>(states.size()), [&](int k) -> const RobotState& { return states[k]; },
        [&](int k) { return force.col(k).data(); }, acceleration, drive, true);
  acceleration.resize(model_->velocity_count(), static_cast<Eigen::Index>(states.size()));
  VectorXd column;
  for (size_t k = 0; k < states.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    without_friction_ = force.col(at);
    solve_tied(states[k], without_friction_, column, drive);
    acceleration.col(at) = column;
  }
}

}  // namespace ayumi
