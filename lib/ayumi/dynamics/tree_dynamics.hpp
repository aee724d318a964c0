#pragma once
// Inverse and forward dynamics alone, made as fast as possible: recursions in link axes, with one
// state per call or with many states side by side in the processor's vector registers. Conventions
// and results are those of dynamics/inverse_dynamics.hpp, up to rounding; nothing else is computed.
// Results are equal to the bit for every instruction set, and for a state alone or in any batch.

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

/// Three matrices, each (6+dof) square: the derivatives of the acceleration by configuration (base
/// translation, base rotation vector in world axes, left-multiplied, theta), by velocity and by
/// generalised force. The last is the inverse of the mass matrix, rotors included.
struct ForwardDynamicsDerivatives {
  Eigen::VectorXd acceleration;  ///< the acceleration itself
  Eigen::MatrixXd configuration, velocity, force;
  /// Derivatives of the tree's inverse dynamics at that acceleration.
  InverseDynamicsDerivatives inverse;
};

class TreeDynamics {
 public:
  /// `model` must outlive this object. Throws Error(usage) if the processor lacks the requested
  /// instruction set.
  explicit TreeDynamics(const RobotModel& model, InstructionSet set = InstructionSet::best);

  const char* instruction_set() const { return kernels_->name; }
  int width() const { return kernels_->width; }  ///< number of states worked on at once in a batch

  /// The generalised force that gives `acceleration` (6+dof), by recursive Newton-Euler. It
  /// allocates nothing if `force` has its size.
  void inverse(const RobotState& state, const Eigen::VectorXd& acceleration,
               Eigen::VectorXd& force);

  /// The acceleration under `force` (6+dof), by articulated bodies; if mimic joints tie branches
  /// together, it is computed through the mass matrix. Without `drive` the joints have neither
  /// rotors nor friction.
  void forward(const RobotState& state, const Eigen::VectorXd& force, Eigen::VectorXd& acceleration,
               const JointDrive* drive = nullptr);

  /// The mass matrix, (6+dof) square, for the positions of `state`.
  void mass_matrix(const RobotState& state, Eigen::MatrixXd& M);

  /// Analytic derivatives. Twelve numbers describe the velocity forces of each subtree. The
  /// function allocates nothing after the first call.
  void inverse_derivatives(const RobotState& state, const Eigen::VectorXd& acceleration,
                           InverseDynamicsDerivatives& derivatives);

  /// From M a + b(q, v) = f follows da/dx = -M^-1 d(inverse dynamics)/dx at a, which is computed by
  /// the sparse factor of M. The function allocates nothing after the first call.
  void forward_derivatives(const RobotState& state, const Eigen::VectorXd& force,
                           ForwardDynamicsDerivatives& derivatives,
                           const JointDrive* drive = nullptr);

  /// inverse() and forward() for many states, with one column of the matrices per state.
  void inverse(std::span<const RobotState> states, const Eigen::MatrixXd& acceleration,
               Eigen::MatrixXd& force);
  void forward(std::span<const RobotState> states, const Eigen::MatrixXd& force,
               Eigen::MatrixXd& acceleration, const JointDrive* drive = nullptr);

  /// A state and an acceleration (6+dof) that are stored elsewhere.
  struct Motion {
    const RobotState* state;
    const Eigen::VectorXd* acceleration;
  };
  /// inverse() for many such motions.
  void inverse(std::span<const Motion> motions, Eigen::MatrixXd& force);

 private:
  struct alignas(64) Line {
    double number[8];
  };
  /// Quantities of one body in inverse_derivatives(), about the base origin; force, moment,
  /// momentum and flow become those of its subtree.
  struct Rates {
    Eigen::Vector3d screw_linear, screw_angular;  // joint screw S
    Eigen::Vector3d v, w, a, alpha;               // twist and spatial acceleration of the body
    Eigen::Vector3d psi1_linear, psi1_angular, psi2_linear, psi2_angular;
    Eigen::Vector3d force, moment, momentum;
    Eigen::Matrix3d flow;  // sum of m u c' over the body's particles
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
