#include "ayumi/repair/resting_joints.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/limits/table_safety.hpp"
#include "ayumi/model/encoder_angles.hpp"
#include "ayumi/motion/servo_feedforward.hpp"
#include "ayumi/repair/policy.hpp"

namespace ayumi {

namespace policy = repair_policy;

namespace {

std::vector<bool> dofs_at_fault(const RobotModel& model, const std::vector<Finding>& findings) {
  std::vector<bool> faulty(static_cast<size_t>(model.dof_count()), false);
  for (const Finding& f : findings)
    if (const int dof = dof_of(f); dof >= 0 && f.severity == Severity::error) faulty[dof] = true;
  return faulty;
}

std::vector<TimeWindow> rests(const CommandSeries& series, int dof, const TargetRange& range) {
  std::vector<TimeWindow> windows;
  bool rested = false;
  for (size_t k = 0; k < series.samples.size(); ++k) {
    const RobotState& state = series.samples[k].state;
    const double theta = state.theta[dof], t = static_cast<double>(k) * series.dt;
    const double room = std::min(theta - range.lower, range.upper - theta);
    const bool here = std::abs(room) <= policy::kFirstBackoff.joint_position &&
                      std::abs(state.dtheta[dof]) <= policy::kRestingSpeed;
    if (here && !rested) windows.emplace_back(t, t);
    if (here) windows.back().second = t;
    rested = here;
  }
  return windows;
}

}  // namespace

std::vector<std::vector<TimeWindow>> rests_at_limits(const RobotModel& model,
                                                     const CommandSeries& series,
                                                     const ActuatorLimits& actuators,
                                                     const std::vector<Finding>& errors) {
  const Eigen::VectorXd lead = velocity_lead(actuators), zeros = encoder_zeros(model);
  const std::vector<bool> faulty = dofs_at_fault(model, errors);
  const double margin = model.description().soft_limit_margin;
  std::vector<std::vector<TimeWindow>> windows(faulty.size());
  for (int i = 0; i < model.dof_count(); ++i) {
    const Dof& dof = model.dofs()[i];
    if (dof.limited && lead[i] > 0 && !faulty[static_cast<size_t>(i)])
      windows[static_cast<size_t>(i)] = rests(series, i, target_range(dof, zeros[i], margin));
  }
  return windows;
}

}  // namespace ayumi
