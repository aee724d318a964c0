#include "ayumi/repair/weighted_change.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/repair/policy.hpp"

namespace ayumi {

namespace policy = repair_policy;

using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

Vector3d base_rotation_change(const CommandSample& a, const CommandSample& b) {
  return log_rotation(b.state.base.attitude * a.state.base.attitude.conjugate());
}

// The second differences. The ends of the motion get the values of their neighbours.
std::vector<Vector3d> turning_accelerations(const std::vector<Vector3d>& r, double dt) {
  std::vector<Vector3d> dd(r.size(), Vector3d::Zero());
  if (r.size() < 3) return dd;
  for (size_t k = 1; k + 1 < r.size(); ++k) dd[k] = (r[k + 1] - 2 * r[k] + r[k - 1]) / (dt * dt);
  dd.front() = dd[1];
  dd.back() = dd[r.size() - 2];
  return dd;
}

}  // namespace

VectorXd change_weights(const RobotModel& model, const CommandSeries& series,
                        const VectorXd& factors) {
  const int dof = model.dof_count();
  VectorXd weight(model.velocity_count());
  weight.head<3>().setConstant(policy::change_weight::kBasePosition);
  weight.segment<3>(3).setConstant(policy::change_weight::kBaseRotation);
  weight.tail(dof) = series.joint_weight.empty() ? model.joint_weight() : VectorXd::Zero(dof);
  for (const JointWeight& w : series.joint_weight)
    weight.tail(dof) = weight.tail(dof).cwiseMax(w.value);
  if (factors.size() == dof) weight.tail(dof) = weight.tail(dof).cwiseProduct(factors);
  return weight;
}

VectorXd weight_factors(const RobotModel& model, const std::map<std::string, double>& weights) {
  VectorXd factors = VectorXd::Ones(model.dof_count());
  for (const auto& [joint, factor] : weights) {
    const int dof = model.find_dof(joint);
    if (dof < 0)
      fail(ErrorCode::usage, "weighted joint '" + joint + "': the robot '" + model.name() +
                                 "' has no such joint" +
                                 text::suggestion(joint, model.dof_names()));
    if (!(factor > 0) || !std::isfinite(factor))
      fail(ErrorCode::usage, "weight of joint '" + joint + "': " + text::exact(factor) +
                                 " is not possible. A weight must be above 0. To keep the joint "
                                 "still, lock the joint");
    factors[dof] = factor;
  }
  return factors;
}

WeightedChange weighted_change(const RobotModel& model, const CommandSeries& before,
                               const CommandSeries& after, const VectorXd& factors) {
  if (std::abs(before.dt - after.dt) > 1e-12)
    fail(ErrorCode::usage, "motions sampled every " + text::exact(before.dt) + " s and every " +
                               text::exact(after.dt) + " s cannot be compared");
  const size_t count = std::min(before.samples.size(), after.samples.size());
  const double smooth = elementary::power<4>(policy::change_weight::kSmoothTime);
  std::vector<Vector3d> r;
  for (size_t k = 0; k < count; ++k)
    r.push_back(base_rotation_change(before.samples[k], after.samples[k]));
  const std::vector<Vector3d> ddr = turning_accelerations(r, before.dt);
  VectorXd sum = VectorXd::Zero(model.velocity_count()), d = sum, dd = sum;
  for (size_t k = 0; k < count; ++k) {
    const CommandSample &a = before.samples[k], &b = after.samples[k];
    d << b.state.base.position - a.state.base.position, r[k], b.state.theta - a.state.theta;
    dd = b.acceleration - a.acceleration;
    dd.segment<3>(3) = ddr[k];
    const double share = k == 0 || k + 1 == count ? 0.5 : 1;  // trapezoidal rule
    sum += share * before.dt * (d.cwiseAbs2() + smooth * dd.cwiseAbs2());
  }
  const VectorXd weight = change_weights(model, before, factors);
  sum = sum.cwiseProduct(weight);
  WeightedChange change;
  auto add = [&](const std::string& what, double part, double each) {
    change.change += part;
    if (part > policy::change_weight::kRounding) change.parts.push_back({what, each, part});
  };
  add("base position", sum.head<3>().sum(), policy::change_weight::kBasePosition);
  add("base rotation", sum.segment<3>(3).sum(), policy::change_weight::kBaseRotation);
  for (int i = 0; i < model.dof_count(); ++i) add(model.dofs()[i].name, sum[6 + i], weight[6 + i]);
  std::stable_sort(change.parts.begin(), change.parts.end(),
                   [](const auto& a, const auto& b) { return a.change > b.change; });
  return change;
}

}  // namespace ayumi
