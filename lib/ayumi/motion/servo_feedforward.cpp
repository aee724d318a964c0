// The solution of theta + L dtheta = u over one row, with u linear between rows k and k + 1, is
//   theta(k+1) = a theta(k) + (1 - a) u(k) + (1 - (1 - a) L / dt) (u(k+1) - u(k)),  a = exp(-dt/L)
#include "ayumi/motion/servo_feedforward.hpp"

#include <cmath>

#include "ayumi/math/elementary.hpp"

namespace ayumi {

Eigen::VectorXd velocity_lead(const ActuatorLimits& actuators) {
  Eigen::VectorXd lead(static_cast<Eigen::Index>(actuators.servo.size()));
  for (Eigen::Index j = 0; j < lead.size(); ++j) {
    const ServoDescription& servo = actuators.servo[static_cast<size_t>(j)];
    lead[j] = servo.kp > 0 ? servo.lag() : 0.0;
  }
  return lead;
}

DenseTable postures_of(const RobotModel& model, const ActuatorLimits& actuators, DenseTable table) {
  if (!table.commands) return table;
  const Eigen::VectorXd lead = velocity_lead(actuators);
  for (size_t i = 0; i < table.joints.size(); ++i) {
    const int dof = model.find_dof(table.joints[i]);
    if (dof < 0 || !(lead[dof] > 0)) continue;
    auto column = table.theta.col(static_cast<Eigen::Index>(i));
    const double kept = elementary::exp(-table.dt / lead[dof]);
    const double slope = 1 - (1 - kept) * lead[dof] / table.dt;
    double before = column[0];
    for (Eigen::Index k = 1; k < column.size(); ++k) {
      const double command = column[k];
      column[k] = kept * column[k - 1] + (1 - kept) * before + slope * (command - before);
      before = command;
    }
  }
  table.commands = false;
  return table;
}

Eigen::VectorXd leading_target(const CommandSample& sample, const Eigen::VectorXd& lead) {
  return sample.state.theta + lead.cwiseProduct(sample.state.dtheta);
}

ReferenceTrajectory leading_targets(const RobotModel& model, const CommandSeries& series,
                                    const Eigen::VectorXd& lead) {
  ReferenceTrajectory reference;
  reference.dt = series.dt;
  reference.joints = model.dof_names();
  reference.rows.reserve(series.samples.size());
  for (const CommandSample& sample : series.samples) {
    ReferenceRow row;
    row.theta = leading_target(sample, lead);
    row.base = sample.state.base;
    row.cog = sample.cog;
    row.zmp = sample.zmp;
    row.fz = sample.fz;
    row.contact = {supports(sample.support, Side::left), supports(sample.support, Side::right)};
    reference.rows.push_back(std::move(row));
  }
  return reference;
}

}  // namespace ayumi
