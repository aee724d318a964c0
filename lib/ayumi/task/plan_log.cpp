#include "ayumi/task/plan_log.hpp"

#include <algorithm>

#include "ayumi/demand/motion_demand.hpp"
#include "ayumi/motion/differentiate.hpp"

namespace ayumi {

namespace {

using Eigen::Vector3d;

// The point at the height of a foot's sole about which the moment of the foot's wrench is vertical.
// The wrench is given about `base`.
Vector3d pressure(const Vector6d& wrench, const Vector3d& base, const Vector3d& sole) {
  const Vector3d f = wrench.head<3>(), n = wrench.tail<3>();
  const double down = base.z() - sole.z();
  return {base.x() - (n.y() + down * f.x()) / f.z(), base.y() + (n.x() - down * f.y()) / f.z(),
          sole.z()};
}

void add_feet(const RobotModel& model, const CommandSample& planned, const MotionDynamics& motion,
              const SampleDynamics& now, SimulationSample& sample) {
  const Vector3d base = planned.state.base.position;
  const auto wrenches = foot_wrenches(model, planned.support, motion.soles(), motion.plane(),
                                      now.use, base, now.wrench);
  for (size_t s = 0; s < 2; ++s) {
    sample.foot_force[s] = wrenches[s].head<3>();
    const Vector3d sole = motion.soles()[s].translation();
    sample.foot_cop[s] = wrenches[s][2] > 0 ? pressure(wrenches[s], base, sole) : sole;
  }
}

}  // namespace

SimulationLog plan_log(const RobotModel& model, const ActuatorLimits& actuators,
                       const CommandSeries& motion, const CommandSeries& command, int stride) {
  SimulationLog log;
  log.dt = motion.dt * stride;
  log.joints = model.dof_names();
  const ContactPlan plan = contact_plan(motion);
  MotionDynamics dynamics(model, actuators, motion, plan);
  RobotData data(model);
  for (size_t k = 0; k < motion.samples.size(); k += static_cast<size_t>(stride)) {
    const CommandSample& s = motion.samples[k];
    const CommandSample& c = command.samples[std::min(k, command.samples.size() - 1)];
    SimulationSample sample;
    const GroundReaction full = full_model_reaction(model, s, data);
    sample.state = s.state;
    sample.cog = data.cog;
    sample.dcog = data.dcog;
    sample.zmp = full.zmp;
    sample.fz = full.force.z();
    const SampleDynamics& now = dynamics.at(static_cast<int>(k));
    sample.torque = now.torque;
    sample.target = sample.reference_theta = s.state.theta;
    sample.reference_base = s.state.base;
    sample.reference_dtheta = s.state.dtheta;
    sample.weight.setZero(s.state.theta.size());
    sample.reference_cog = sample.cog;
    sample.command_base = c.state.base;
    sample.command_theta = c.state.theta;
    sample.command_cog = c.cog;
    sample.command_zmp = sample.reference_zmp = c.zmp;
    sample.command_fz = sample.reference_fz = c.fz;
    sample.planned_contact = {supports(s.support, Side::left), supports(s.support, Side::right)};
    add_feet(model, s, dynamics, now, sample);
    log.samples.push_back(std::move(sample));
  }
  return log;
}

}  // namespace ayumi
