#pragma once
// Inverse and forward dynamics alone, as fast as they go: recursions in link axes, one state per
// call or many states side by side in the processor's vector registers. Conventions and results
// are those of dynamics/inverse_dynamics.hpp, to rounding; nothing else is computed. The same bits
// come out for every instruction set, and for a state alone or in any batch.

#include <span>
#include <vector>

#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/joint_drive.hpp"
#include "ayumi/dynamics/kernels/tree_kernels.hpp"
#include "ayumi/dynamics/tree_cholesky.hpp"

namespace ayumi {

enum class InstructionSet { best, plain, avx2 };

/// Partial derivatives of inverse dynamics, each (6+dof) square. Columns of `configuration` are
/// base translation (world), base rotation vector (world axes, left-multiplied) and theta; the
/// velocity and acceleration components stay fixed in world axes.
struct InverseDynamicsDerivatives {
  Eigen::MatrixXd configuration, velocity, acceleration;
};

/// Each (6+dof) square: derivative of the acceleration by configuration (base translation, base
/// rotation vector in world axes, left-multiplied, theta), velocity and generalised force. The
/// last is the inverse of the mass matrix, rotors included.
struct ForwardDynamicsDerivatives {
  Eigen::VectorXd acceleration;  ///< itself
  Eigen::MatrixXd configuration, velocity, force;
  InverseDynamicsDerivatives inverse;  ///< of the tree, at that acceleration
};

class TreeDynamics {
 public:
  /// `model` must outlive this. Throws Error(usage) when the processor lacks the set asked for.
  explicit TreeDynamics(const RobotModel& model, InstructionSet set = InstructionSet::best);

  const char* instruction_set() const { return kernels_->name; }
  int width() const { return kernels_->width; }  ///< states worked on at once in a batch

  /// Generalised force that gives `acceleration` (6+dof): RNEA. No allocation when `force` has its
  /// size.
  void inverse(const RobotState& state, const Eigen::VectorXd& acceleration,
               Eigen::VectorXd& force);

  /// Acceleration under `force` (6+dof): articulated bodies; through the mass matrix where mimic
  /// joints tie branches together. Without `drive` the joints have neither rotors nor friction.
  void forward(const RobotState& state, const Eigen::VectorXd& force, Eigen::VectorXd& acceleration,
               const JointDrive* drive = nullptr);

  /// (6+dof) square, of the positions of `state`.
  void mass_matrix(const RobotState& state, Eigen::MatrixXd& M);

  /// Analytic, by twelve numbers per subtree; allocates nothing after the first call.
  void inverse_derivatives(const RobotState& state, const Eigen::VectorXd& acceleration,
                           InverseDynamicsDerivatives& derivatives);

  /// From M a + b(q, v) = f: da/dx = -M^-1 d(inverse dynamics)/dx at a, by the sparse factor of M.
  /// Allocates nothing after the first call.
  void forward_derivatives(const RobotState& state, const Eigen::VectorXd& force,
                           ForwardDynamicsDerivatives& derivatives,
                           const JointDrive* drive = nullptr);

  /// inverse() and forward() for many states; one column of the matrices per state.
  void inverse(std::span<const RobotState> states, const Eigen::MatrixXd& acceleration,
               Eigen::MatrixXd& force);
  void forward(std::span<const RobotState> states, const Eigen::MatrixXd& force,
               Eigen::MatrixXd& acceleration, const JointDrive* drive = nullptr);

  /// A state and an acceleration (6+dof) that lie elsewhere.
  struct Motion {
    const RobotState* state;
    const Eigen::VectorXd* acceleration;
  };
  /// inverse() for many of them.
  void inverse(std::span<const Motion> motions, Eigen::MatrixXd& force);

 private:
  struct alignas(64) Line {
    double number[8];
  };
  /// Of one body in inverse_derivatives(), about the base origin; force, moment, momentum and flow
  /// become those of its subtree.
  struct Rates {
    Eigen::Vector3d screw_linear, screw_angular;  // S
    Eigen::Vector3d v, w, a, alpha;               // twist and spatial acceleration of the body
    Eigen::Vector3d psi1_linear, psi1_angular, psi2_linear, psi2_angular;
    Eigen::Vector3d force, moment, momentum;
    Eigen::Matrix3d flow;  // sum of m u c' over its particles
  };
  void carry_outwards(const Body& body, size_t i, double rate, double acceleration);
  void start_subtree(size_t i);
  void add_columns(size_t i, const Eigen::Vector3d& w0, InverseDynamicsDerivatives& d) const;
  void finish_base(const RobotState& state, const Eigen::VectorXd& acceleration,
                   InverseDynamicsDerivatives& d) const;
  template <class StateOf, class InputOf>
  void batch(int count, const StateOf& state_of, const InputOf& input_of, Eigen::MatrixXd& output,
             const JointDrive* drive, bool forward);
  void solve_tied(const RobotState& state, const Eigen::VectorXd& force,
                  Eigen::VectorXd& acceleration, const JointDrive* drive);
  void factor(const JointDrive* drive);
  kernels::Tree tree() const;
  bool tied() const;

  const RobotModel* model_;
  const kernels::Kernels* kernels_;
  std::vector<kernels::Link> links_;
  std::vector<Line> scratch_;
  std::vector<double> packed_;  // inputs and output of one group of states
  Eigen::VectorXd without_friction_, still_;
  RobotData data_;
  std::vector<Rates> rates_;
  Eigen::MatrixXd mass_, rows_;
  TreeCholesky factor_;
};

}  // namespace ayumi
