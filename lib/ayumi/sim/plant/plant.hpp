#pragma once
// Ayumi's own plant: the floating robot with position servos on ground that it can stick to and
// slip on. Its input is the state, the joint targets and the disturbances; its output is the next
// state and the contact forces. The contacts, the equation of a step and the motion that follows
// are in files of their own: contacts.hpp, step_system.hpp with joint_laws.hpp and
// contact_rows.hpp, and integrator.hpp.

#include <Eigen/Dense>
#include <optional>
#include <vector>

#include "ayumi/sim/plant/contacts.hpp"
#include "ayumi/sim/plant/integrator.hpp"
#include "ayumi/sim/plant/joint_laws.hpp"
#include "ayumi/sim/plant/step_system.hpp"
#include "ayumi/sim/step.hpp"

namespace ayumi {

class Plant {
 public:
  /// The model must outlive the plant and its copies. Throws Error(bad_model) if a joint has no
  /// servo, and Error(bad_pattern) for a world with a value that is not a number.
  Plant(const RobotModel& model, const ActuatorLimits& limits, const World& world);

  const RobotState& state() const { return integrator_.state(); }
  const RobotData& data() const {
    return integrator_.data();
  }  ///< positions and velocities of state()
  /// Puts the robot in this state and removes the contacts. Throws Error(usage) that names a value
  /// that is not a number.
  void set_state(const RobotState& state);

  /// Advances by `dt` [s] with constant servo targets [rad, m]. Throws Error(usage) with place and
  /// time for input that is not finite or not below 1e6; then the plant is as before. The report is
  /// valid until the next step.
  const StepReport& step(const Eigen::VectorXd& targets, const StepInput& input, double dt);

 private:
  /// The robot with its loads.
  const RobotModel& robot() const { return loaded_ ? *loaded_ : *model_; }
  void load(const std::vector<CarriedMass>& payloads);
  void solve(const StepInput& input, double dt, bool landing = false);
  void clear_report();
  void finish(double dt, double whole);
  void report_contacts(double whole);
  void report_sole(const ActiveContact& contact, const Eigen::Vector3d& force);
  void share_among_cells(const ActiveContact& contact, const Eigen::Vector3d& force);

  const RobotModel* model_;
  std::vector<CarriedMass> carried_;
  std::optional<RobotModel> loaded_;  // the model with the loads carried_
  JointLaws joints_;
  ContactSet contacts_;
  StepSystem system_;
  Integrator integrator_;
  double time_ = 0;  // time since set_state() [s]
  StepReport report_;
  std::vector<char> limited_;    // by dof: whether it was at the torque limit in a part of the step
  std::vector<double> weights_;  // workspace of share_among_cells()
};

}  // namespace ayumi
