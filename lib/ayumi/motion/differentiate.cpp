// All values are taken relative to sample k, so that the rotation vector r of q_i q_k^-1 is zero
// there, and w = r', dw = r''. With the time h between samples,
//   x'  = (x_-2 - 8 x_-1 + 8 x_1 - x_2) / 12 h,
//   x'' = (-x_-2 + 16 x_-1 - 30 x_0 + 16 x_1 - x_2) / 12 h^2.
#include "ayumi/motion/differentiate.hpp"

#include <algorithm>

#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::VectorXd;

namespace {

/// Fraction of the weight below which the ZMP has no meaning, as in flight, because it is divided
/// by the ground force. Chosen: 5 %, above the force of a foot that only touches.
constexpr double kZmpMinLoad = 0.05;

// Writes [position; rotation vector; theta; COG] of sample i relative to sample k into d.
void put_between(const std::vector<CommandSample>& samples, int k, int i, VectorXd& d) {
  const RobotState& from = samples[k].state;
  const RobotState& to = samples[i].state;
  const Eigen::Index dof = to.theta.size();
  d.resize(9 + dof);
  d.head<3>() = to.base.position - from.base.position;
  if (to.base.attitude.coeffs() == from.base.attitude.coeffs())
    d.segment<3>(3).setZero();
  else
    d.segment<3>(3) = log_rotation(to.base.attitude * from.base.attitude.conjugate());
  d.segment(6, dof) = to.theta - from.theta;
  d.tail<3>() = samples[i].cog - samples[k].cog;
}

// Writes the same for a sample i that may lie outside the motion.
void put_extended(const std::vector<CommandSample>& samples, int k, int i, bool rest_ends,
                  VectorXd& d) {
  const int last = static_cast<int>(samples.size()) - 1;
  if ((i >= 0 && i <= last) || rest_ends || last < 5)
    return put_between(samples, k, std::clamp(i, 0, last), d);
  const int s = i < 0 ? 1 : -1;
  VectorXd next[4];
  for (int j = 0; j < 4; ++j) put_extended(samples, k, i + s * (j + 1), rest_ends, next[j]);
  d = 4 * next[0] - 6 * next[1] + 4 * next[2] - next[3];
}

}  // namespace

void fill_rates(std::vector<CommandSample>& samples, double dt, bool rest_ends) {
  fill_rates(samples, 0, static_cast<int>(samples.size()), dt, rest_ends);
}

void fill_rates(std::vector<CommandSample>& samples, int first, int end, double dt,
                bool rest_ends) {
  VectorXd a2, a1, b1, b2, rate, acceleration;
  for (int k = first; k < end; ++k) {
    put_extended(samples, k, k - 2, rest_ends, a2);
    put_extended(samples, k, k - 1, rest_ends, a1);
    put_extended(samples, k, k + 1, rest_ends, b1);
    put_extended(samples, k, k + 2, rest_ends, b2);
    rate = ((a2 - b2) + 8 * (b1 - a1)) / (12 * dt);
    acceleration = (16 * (a1 + b1) - (a2 + b2)) / (12 * dt * dt);
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

void full_model_reactions(const RobotModel& model, std::span<const CommandSample> samples,
                          TreeDynamics& dynamics, std::vector<GroundReaction>& reactions) {
  std::vector<TreeDynamics::Motion> motions;
  for (const CommandSample& s : samples) motions.push_back({&s.state, &s.acceleration});
  Eigen::MatrixXd force;
  dynamics.inverse(motions, force);
  reactions.resize(samples.size());
  for (size_t k = 0; k < samples.size(); ++k)
    reactions[k] = ground_reaction(samples[k].state.base.position,
                                   force.col(static_cast<Eigen::Index>(k)).head<6>(),
                                   samples[k].zmp.z(), kZmpMinLoad * model.mass() * kGravity);
}

}  // namespace ayumi
