#pragma once
// Open loop: the servos receive the command with its feedforward, or the targets that the series
// has instead of the command. Nothing is measured.

#include <memory>

#include "ayumi/control/law.hpp"

namespace ayumi {

class OpenLoop {
 public:
  /// `torque_lead` has the offsets of the servo targets for each sample of the pattern [rad]; a
  /// single column applies to all samples (control/torque_feedforward). `target` has the last servo
  /// targets [rad]. `targets` has the targets for each sample of the series, dof x samples; it must
  /// outlive this law and its copies.
  OpenLoop(const ActuatorLimits& actuators, CommandPlan command,
           std::shared_ptr<const Eigen::MatrixXd> torque_lead, const Eigen::VectorXd& target,
           const Eigen::MatrixXd& targets);

  /// The command of the coming tick.
  const CommandSample& plan() const { return command_.now(); }

  /// Whether the targets depend on measurements: only if the footholds of the command move.
  bool measures() const { return command_.measures(); }

  void update(const Estimate& estimate, ControlOutput& out);

  Handover handover() const { return {plan().state, plan().dcog, target_, plan(), command_}; }

 private:
  CommandPlan command_;
  std::shared_ptr<const Eigen::MatrixXd> torque_lead_;
  Eigen::VectorXd velocity_lead_, target_;
  const Eigen::MatrixXd* targets_;
};

}  // namespace ayumi
