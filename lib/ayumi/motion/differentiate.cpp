// Values relative to sample k, so that the rotation vector r of q_i q_k^-1 is zero there and
// w = r', dw = r''. x' = (x_-2 - 8 x_-1 + 8 x_1 - x_2) / 12 h,
// x'' = (-x_-2 + 16 x_-1 - 30 x_0 + 16 x_1 - x_2) / 12 h^2.
#include "ayumi/motion/differentiate.hpp"

#include <algorithm>

#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::VectorXd;

namespace {

/// Fraction of the weight below which the ZMP has no meaning, as in flight: it is a quotient by the
/// ground force. Chosen: 5 %, above the force of a foot that only touches.
constexpr double kZmpMinLoad = 0.05;

// [position; rotation vector; theta; COG] of sample i from sample k.
VectorXd between(const std::vector<CommandSample>& samples, int k, int i) {
  const RobotState& from = samples[k].state;
  const RobotState& to = samples[i].state;
  VectorXd d(9 + to.theta.size());
  d << to.base.position - from.base.position,
      log_rotation(to.base.attitude * from.base.attitude.conjugate()), to.theta - from.theta,
      samples[i].cog - samples[k].cog;
  return d;
}

VectorXd extended(const std::vector<CommandSample>& samples, int k, int i, bool rest_ends) {
  const int last = static_cast<int>(samples.size()) - 1;
  if (i >= 0 && i <= last) return between(samples, k, i);
  if (rest_ends || last < 5) return between(samples, k, std::clamp(i, 0, last));
  const int s = i < 0 ? 1 : -1;
  const auto next = [&](int j) { return extended(samples, k, i + s * j, rest_ends); };
  return 4 * next(1) - 6 * next(2) + 4 * next(3) - next(4);
}

}  // namespace

void fill_rates(std::vector<CommandSample>& samples, double dt, bool rest_ends) {
  for (int k = 0; k < static_cast<int>(samples.size()); ++k) {
    const VectorXd a2 = extended(samples, k, k - 2, rest_ends);
    const VectorXd a1 = extended(samples, k, k - 1, rest_ends);
    const VectorXd b1 = extended(samples, k, k + 1, rest_ends);
    const VectorXd b2 = extended(samples, k, k + 2, rest_ends);
    const VectorXd rate = ((a2 - b2) + 8 * (b1 - a1)) / (12 * dt);
    const VectorXd acceleration = (16 * (a1 + b1) - (a2 + b2)) / (12 * dt * dt);
    CommandSample& sample = samples[k];
    const Eigen::Index dof = sample.state.theta.size();
    sample.state.base_velocity = rate.head<3>();
    sample.state.base_angular_velocity = rate.segment<3>(3);
    sample.state.dtheta = rate.segment(6, dof);
    sample.acceleration = acceleration.head(6 + dof);
    sample.dcog = rate.tail<3>();
    sample.ddcog = acceleration.tail<3>();
  }
}

GroundReaction full_model_reaction(const RobotModel& model, const CommandSample& sample,
                                   RobotData& data) {
  const VectorXd force = inverse_dynamics(model, sample.state, sample.acceleration, data);
  return ground_reaction(sample.state.base.position, force.head<6>(), sample.zmp.z(),
                         kZmpMinLoad * model.mass() * kGravity);
}

}  // namespace ayumi
