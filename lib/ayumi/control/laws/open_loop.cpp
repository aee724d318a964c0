#include "ayumi/control/laws/open_loop.hpp"

#include <utility>

#include "ayumi/control/torque_feedforward.hpp"
#include "ayumi/motion/servo_feedforward.hpp"

namespace ayumi {

OpenLoop::OpenLoop(const ActuatorLimits& actuators, CommandPlan command,
                   std::shared_ptr<const Eigen::MatrixXd> torque_lead,
                   const Eigen::VectorXd& target, const Eigen::MatrixXd& targets)
    : command_(std::move(command)),
      torque_lead_(std::move(torque_lead)),
      velocity_lead_(velocity_lead(actuators)),
      target_(target),
      targets_(&targets) {}

void OpenLoop::update(const Estimate& estimate, ControlOutput& out) {
  const long sample = command_.sample();
  const auto torque_lead = lead_at(*torque_lead_, sample);
  command_.look_ahead(estimate);
  const CommandSample& now = plan();
  out.reference = now.state;
  if (targets_->cols() > 0)
    out.target = lead_at(*targets_, sample);
  else
    out.target = now.state.theta + velocity_lead_.cwiseProduct(now.state.dtheta) + torque_lead;
  out.cog = now.cog;
  out.cog_reference = {now.zmp, now.fz, Eigen::Vector3d::Zero(), now.dcog};
  out.terms = {};
  out.terms.planned_zmp = out.terms.wanted_zmp = now.zmp;
  out.residuals = {};
  out.weight.setZero(out.target.size());
  target_ = out.target;
  command_.advance();
}

}  // namespace ayumi
