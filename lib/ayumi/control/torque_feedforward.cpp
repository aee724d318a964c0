#include "ayumi/control/torque_feedforward.hpp"

#include <algorithm>

#include "ayumi/demand/motion_demand.hpp"

namespace ayumi {

Eigen::MatrixXd torque_feedforward(const RobotModel& model, const ActuatorLimits& limits,
                                   const CommandSeries& series) {
  const auto samples = static_cast<Eigen::Index>(series.samples.size());
  Eigen::MatrixXd lead = Eigen::MatrixXd::Zero(model.dof_count(), samples + 1);
  const ContactPlan contacts = contact_plan(series);
  MotionDynamics dynamics(model, limits, series, contacts);
  for (Eigen::Index k = 0; k <= samples; ++k) {
    const bool rest = k == samples;
    const Eigen::VectorXd& torque = rest ? dynamics.at(static_cast<int>(k - 1), 0).torque
                                         : dynamics.at(static_cast<int>(k)).torque;
    for (int j = 0; j < model.dof_count(); ++j) {
      const double kp = limits.servo[static_cast<size_t>(j)].kp, peak = limits.peak_torque[j];
      if (kp > 0) lead(j, k) = std::clamp(torque[j], -peak, peak) / kp;
    }
  }
  return lead;
}

}  // namespace ayumi
