#pragma once
// The equation of one step: mass matrix, smooth forces, the laws of the joints and the contacts,
// solved for the generalised velocity at the end of the step. docs/theory_plant.md, (P1).

#include <Eigen/Dense>
#include <vector>

#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/tree_cholesky.hpp"
#include "ayumi/sim/plant/contact_rows.hpp"
#include "ayumi/sim/plant/contacts.hpp"
#include "ayumi/sim/plant/joint_laws.hpp"
#include "ayumi/sim/step.hpp"

namespace ayumi {

/// The inertia about a point at the distance `r` [m] from the centre of mass, computed from the
/// inertia about the centre of mass; with a negative mass, the reverse (Steiner's theorem).
Eigen::Matrix3d parallel_axis(const Eigen::Matrix3d& inertia, double mass,
                              const Eigen::Vector3d& r);

class StepSystem {
 public:
  /// `points` is the number of contact points of the robot, for which memory is reserved.
  StepSystem(const RobotModel& model, const ActuatorLimits& actuators, size_t points);

  /// Fills the mass matrix, rotors included, of the posture in `data`.
  void set_posture(RobotData& data);

  /// Linear momentum [N s] (three numbers) and angular momentum about the base origin [N m s]
  /// (three numbers) of the whole robot per unit rate of joint j.
  const double* momentum_of_joint(int j) const {
    return mass_.data() + factor_.row_begin(factor_.place_of(6 + j));
  }

  /// The inertia about the COG with the joints locked [kg m^2].
  Eigen::Matrix3d locked_inertia(const RobotModel& robot, const RobotData& data) const;

  /// Starts the step of `dt` [s] with gravity, Coriolis and centrifugal forces. `robot` includes
  /// its loads.
  void begin(const RobotModel& robot, const RobotState& state, RobotData& data, double dt);

  /// Adds forces from outside. Must be called once, after begin().
  void push(const RobotModel& model, const std::vector<ExternalWrench>& wrenches,
            const RobotData& data, double dt);

  /// Writes the equation in axes that are turned by `half_turn` (world from these axes). Gravity
  /// and the frames of the contacts with the ground are turned back; the numbers of the robot do
  /// not change.
  void turn(const Eigen::Matrix3d& half_turn, const RobotModel& robot, const RobotData& data,
            std::vector<ActiveContact>& contacts, double dt);

  /// Takes the contacts of the step, after turn().
  void set_contacts(const std::vector<ActiveContact>& contacts, const RobotData& data, double dt) {
    rows_.set(contacts, data, factor_, before_, dt);
    contact_count_ = contacts.size();
  }

  /// Solves for velocity() and the impulses of the contacts, again each time a joint reaches a
  /// limit. Returns false if the mass matrix is not positive definite.
  bool solve(JointLaws& joints, const RobotData& data, const Eigen::VectorXd& theta, double dt);

  /// The generalised velocity before and after the step, in the turned axes.
  const Eigen::VectorXd& before() const { return before_; }
  const Eigen::VectorXd& velocity() const { return velocity_; }
  const double* joint_rates_before() const { return before_.data() + 6; }
  const double* joint_rates() const { return velocity_.data() + 6; }
  const ContactRows& rows() const { return rows_; }
  const ContactSolution& contact_solution() const { return solution_; }

  /// Stores impulses and tangential deflections in the contacts after solve() and adds the work of
  /// the contacts [J].
  void take_impulses(std::vector<ActiveContact>& contacts, const RobotData& data, double dt,
                     double& work);

  /// The work of the forces from outside in this step [J].
  double work_from_outside() const { return 0.5 * outside_.dot(before_ + velocity_); }

  /// A vector of the turned axes in world axes.
  Eigen::Vector3d in_world(const Eigen::Vector3d& v) const {
    return turned_ ? Eigen::Vector3d(half_turn_ * v) : v;
  }
  void end_turn() { turned_ = false; }

  /// The momentum about the COG that the robot receives from outside in this step. After push() it
  /// contains gravity and the pushes; the caller adds the momentum from the contacts.
  Momentum& external() { return external_; }
  const Momentum& external() const { return external_; }

 private:
  void add_wrench(const RobotModel& model, const ExternalWrench& wrench, const RobotData& data,
                  double dt);
  bool solve_once(JointLaws& joints, const RobotData& data, const Eigen::VectorXd& theta,
                  double dt);
  enum class Contacts { springs, rows };
  bool solve_change(const RobotData& data, Contacts contacts);

  TreeCholesky factor_;
  std::vector<double> mass_;            // rows of the mass matrix, including rotors
  std::vector<size_t> joint_diagonal_;  // places of the joints' diagonal in these rows, by dof
  Eigen::VectorXd rotor_;               // inertia of motors without a gear [kg m^2, kg]
  ContactRows rows_;
  size_t contact_count_ = 0;
  ContactSolution solution_;
  Eigen::VectorXd before_, velocity_;  // generalised velocity [m/s, rad/s]
  Eigen::VectorXd impulse_,
      outside_;  // generalised impulses: without joints and contacts, and of the pushes
  Momentum external_;
  bool turned_ = false;
  Eigen::Matrix3d half_turn_;
  // Workspace.
  Eigen::VectorXd zero_, bias_, change_;
  std::vector<double> diagonal_;
};

}  // namespace ayumi
