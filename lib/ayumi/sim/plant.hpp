#pragma once
// Ayumi's own plant: the floating robot with position servos on ground it can stick to and slip on.
// State in, joint targets and disturbances in, next state and contact forces out.

#include <Eigen/Dense>
#include <vector>

#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/tree_cholesky.hpp"
#include "ayumi/pattern/scenario.hpp"
#include "ayumi/sim/contact_points.hpp"
#include "ayumi/sim/contact_solver.hpp"
#include "ayumi/sim/step.hpp"

namespace ayumi {

class Plant {
 public:
  /// The model must outlive the plant. Throws Error(bad_model) when a joint has no servo.
  Plant(const RobotModel& model, const ActuatorLimits& limits, const World& world);

  const RobotState& state() const { return state_; }
  const RobotData& data() const { return data_; }  ///< positions and velocities of state()
  /// Puts the robot there and forgets contacts. Throws Error(usage) naming what is not a number.
  void set_state(const RobotState& state);

  /// Advances by `dt` [s] with the servo targets held. Throws Error(usage) with place and time for
  /// input that is not finite or beyond 1e6; the plant is then as before. The report holds until
  /// the next step.
  const StepReport& step(const Eigen::VectorXd& targets,
                         const std::vector<ExternalWrench>& wrenches, double dt);

 private:
  void check_input(const Eigen::VectorXd& targets, const std::vector<ExternalWrench>& wrenches,
                   double dt) const;
  void collect_contacts(double dt);
  void assemble(const std::vector<ExternalWrench>& wrenches, double dt);
  void push(const ExternalWrench& wrench, double dt);
  void fill_contact_rows(double dt);
  void fill_delassus();
  void solve_velocity(const Eigen::VectorXd& targets, double dt);
  bool limit_torques(const Eigen::VectorXd& targets, double dt);
  void report_contacts(double dt);
  void advance(const Momentum& momentum, double dt);

  const RobotModel* model_;
  ActuatorLimits limits_;
  World world_;
  Eigen::Matrix3d ground_;  // columns: normal, tangents
  RobotState state_;
  double time_ = 0;  // since set_state() [s]
  RobotData data_;
  std::vector<ContactPoint> points_;
  std::vector<PointGroup> groups_;
  Eigen::VectorXd kp_, kd_, rotor_, viscous_, coulomb_;

  // Workspace of step().
  struct Active {
    int point;
    double gap;
    Eigen::Vector3d position;
  };
  std::vector<Active> active_, last_active_;
  Eigen::MatrixXd M_, system_;
  TreeCholesky factor_;
  /// Contact Jacobians (normal and tangents per velocity column) and L^-T times their transposes,
  /// [contact * velocity_count + place]; filled along the chain of the contact's body only.
  std::vector<Eigen::Vector3d> J_, Y_;
  Eigen::VectorXd momentum_, bias_, still_, velocity_, lower_;
  std::vector<double> compliance_;
  std::vector<Eigen::Vector3d> shift_;
  std::vector<char> saturated_, sliding_;
  Eigen::VectorXd fixed_, dry_;
  ContactSolver solver_;
  Momentum external_;  // linear and angular (about the COG) momentum from outside in this step
  StepReport report_;
};

}  // namespace ayumi
