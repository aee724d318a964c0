#include "ayumi/control/plan_shift.hpp"

#include <cmath>

#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::Isometry3d;

void shift_plan(const PlanShift& shift, CommandSample& plan) {
  if (shift.time_scale != 1) {
    plan.state.dtheta *= shift.time_scale;
    plan.state.base_velocity *= shift.time_scale;
    plan.state.base_angular_velocity *= shift.time_scale;
  }
  plan.cog += shift.cog;
  plan.dcog += shift.dcog;
  plan.ddcog += shift.ddcog;
  plan.zmp.head<2>() += shift.zmp;
  plan.state.base.position += shift.base;
  for (size_t i = 0; i < 2; ++i) {
    Isometry3d& foot = plan.feet[i];
    foot.translation() += shift.foot[i];
    if (!shift.foot_turn[i].isZero(0))
      foot.linear() = (foot.linear() * exp_rotation(shift.foot_turn[i]).toRotationMatrix()).eval();
  }
}

void turn_plan(const Isometry3d& turn, CommandSample& plan) {
  plan.state.base.position = turn * plan.state.base.position;
  plan.state.base.attitude = Eigen::Quaterniond(turn.linear()) * plan.state.base.attitude;
  plan.state.base_velocity = turn.linear() * plan.state.base_velocity;
  plan.state.base_angular_velocity = turn.linear() * plan.state.base_angular_velocity;
  plan.cog = turn * plan.cog;
  plan.dcog = turn.linear() * plan.dcog;
  plan.ddcog = turn.linear() * plan.ddcog;
  plan.zmp = turn * plan.zmp;
  for (Isometry3d& foot : plan.feet) foot = turn * foot;
}

void rest_plan(CommandSample& plan) {
  plan.fz *= kGravity / (kGravity + plan.ddcog.z());  // f_z = m (g + ddz)
  plan.zmp.head<2>() = plan.cog.head<2>();
  plan.dcog.setZero();
  plan.ddcog.setZero();
  plan.acceleration.setZero();
  plan.state.dtheta.setZero();
  plan.state.base_velocity.setZero();
  plan.state.base_angular_velocity.setZero();
}

Isometry3d pose_between(const std::array<Isometry3d, 2>& feet) {
  const double left = matrix_to_rpy(feet[0].linear()).z();
  const double turn = std::remainder(matrix_to_rpy(feet[1].linear()).z() - left, 2 * M_PI);
  Isometry3d pose = Isometry3d::Identity();
  pose.linear() = rpy_to_matrix({0, 0, left + 0.5 * turn});
  pose.translation() = 0.5 * (feet[0].translation() + feet[1].translation());
  return pose;
}

}  // namespace ayumi
