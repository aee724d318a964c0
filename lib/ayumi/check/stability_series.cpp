#include "ayumi/check/stability_series.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ayumi/base/error.hpp"
#include "ayumi/demand/motion_demand.hpp"
#include "ayumi/limits/friction.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::Vector3d;

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

}  // namespace

void keep_least(double& kept, double value) {
  if (std::isnan(kept) || value < kept) kept = value;
}

void keep_largest(double& kept, double value) {
  if (std::isnan(kept) || value > kept) kept = value;
}

void keep_worst(double& kept, int& dof, const Eigen::VectorXd& value,
                const Eigen::VectorXd& limit) {
  for (Eigen::Index i = 0; i < value.size(); ++i) {
    if (!std::isfinite(limit[i]) || limit[i] <= 0) continue;
    const double share = std::abs(value[i]) / limit[i];
    if (!std::isnan(kept) && share <= kept) continue;
    kept = share;
    dof = static_cast<int>(i);
  }
}

StabilitySeries empty_stability(size_t size, double dt) {
  StabilitySeries out;
  out.dt = dt;
  for (auto* values : {&out.zmp_margin, &out.dcm_margin, &out.normal_force, &out.friction,
                       &out.speed, &out.torque})
    values->assign(size, kNone);
  out.speed_dof.assign(size, -1);
  out.torque_dof.assign(size, -1);
  return out;
}

namespace {

// For each sample: the index of the first sample of the next phase of contacts, or -1.
std::vector<int> next_contacts(const CommandSeries& series) {
  const int count = static_cast<int>(series.samples.size());
  std::vector<int> next(series.samples.size(), -1);
  for (int k = count - 2; k >= 0; --k)
    next[k] = series.samples[k].support != series.samples[k + 1].support ? k + 1 : next[k + 1];
  return next;
}

// The distance of the DCM inside the hull of the soles that stand now and of those that land next,
// in the plane of the present support.
double dcm_margin(const RobotModel& model, const CommandSample& now, const CommandSample* next,
                  const SupportPlane& plane, const Vector3d& cog, const Vector3d& dcog) {
  std::vector<Eigen::Vector2d> corners;
  for (const Side side : {Side::left, Side::right}) {
    const auto s = static_cast<size_t>(side);
    const bool stands = supports(now.support, side);
    if (!stands && !(next && supports(next->support, side))) continue;
    const Eigen::Isometry3d sole = plane.frame.inverse() * (stands ? now : *next).feet[s];
    for (const Eigen::Vector2d& corner : model.sole(side).polygon)
      corners.push_back((sole * Vector3d(corner.x(), corner.y(), 0)).head<2>());
  }
  const Vector3d place = plane.frame.inverse() * cog;
  if (place.z() <= 0) return kNone;
  const double omega = std::sqrt(kGravity / place.z());
  const Vector3d rate = plane.frame.linear().transpose() * dcog;
  const ConvexPolygon support(corners);
  return support.margin((place + rate / omega).head<2>());
}

}  // namespace

StabilitySeries stability_series(const RobotModel& model, const CommandSeries& series,
                                 const CheckOptions& options, double dt) {
  if (series.samples.empty())
    fail(ErrorCode::bad_pattern,
         "the motion has no samples, so there is nothing to show; sample a pattern first");
  const ActuatorLimits& limits = model.limits(options.profile);
  const ContactPlan plan = contact_plan(series);
  MotionDynamics dynamics(model, limits, series, plan);
  const std::vector<int> next = next_contacts(series);
  const int count = static_cast<int>(series.samples.size());
  const int stretch = std::max(1, static_cast<int>(std::lround(dt / series.dt)));
  const auto size = static_cast<size_t>((count + stretch - 1) / stretch);
  StabilitySeries out = empty_stability(size, stretch * series.dt);
  for (int k = 0; k < count; ++k) {
    const auto i = static_cast<size_t>(k / stretch);
    const CommandSample& sample = series.samples[static_cast<size_t>(k)];
    keep_worst(out.speed[i], out.speed_dof[i], sample.state.dtheta, limits.speed);
    if (at_flight_edge(series, k)) continue;
    const SampleDynamics& now = dynamics.at(k);
    keep_worst(out.torque[i], out.torque_dof[i], now.torque, limits.peak_torque);
    const SupportPlane& plane = dynamics.plane();
    if (plane.empty()) continue;
    keep_least(out.normal_force[i], now.use.normal_force);
    if (!now.use.has_zmp) continue;
    keep_least(out.zmp_margin[i], now.use.margin);
    keep_largest(out.friction[i], friction_ratio(now.use, options.friction));
    const int after = next[static_cast<size_t>(k)];
    const double dcm =
        dcm_margin(model, sample, after < 0 ? nullptr : &series.samples[static_cast<size_t>(after)],
                   plane, dynamics.data().cog, dynamics.data().dcog);
    if (!std::isnan(dcm)) keep_least(out.dcm_margin[i], dcm);
  }
  return out;
}

}  // namespace ayumi
