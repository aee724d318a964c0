#include "ayumi/check/stability_series.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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
  corners.reserve(model.sole(Side::left).polygon.size() + model.sole(Side::right).polygon.size());
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
  const ConvexPolygon support(std::move(corners));
  return support.margin((place + rate / omega).head<2>());
}

}  // namespace

StabilityNotes::StabilityNotes(const RobotModel& model, const CommandSeries& series,
                               const CheckOptions& options, double dt)
    : model_(model),
      series_(series),
      limits_(model.limits(options.profile)),
      friction_(options.friction),
      stretch_(std::max(1, static_cast<int>(std::lround(dt / series.dt)))) {
  if (series.samples.empty())
    fail(ErrorCode::bad_pattern,
         "the motion has no samples, so there is nothing to show. Sample a pattern first");
  next_contacts_ = next_contacts(series);
  notes_.assign(series.samples.size(), {kNone, kNone, kNone, kNone, kNone, kNone});
}

void StabilityNotes::note(const JudgedSample& sample, const RobotData& data) {
  const auto k = static_cast<size_t>(sample.k);
  Note& note = notes_[k];
  keep_worst(note.speed, note.speed_dof, sample.command.state.dtheta, limits_.speed);
  if (!sample.known) return;
  keep_worst(note.torque, note.torque_dof, sample.demand.torque, limits_.peak_torque);
  if (sample.flies()) return;
  const GroundDemand& use = sample.demand.use;
  note.normal_force = use.normal_force;
  if (!use.has_zmp) return;
  note.zmp_margin = use.margin;
  note.friction = friction_ratio(use, friction_);
  const int next = next_contacts_[k];
  note.dcm_margin = dcm_margin(model_, sample.command,
                               next < 0 ? nullptr : &series_.samples[static_cast<size_t>(next)],
                               sample.plane, data.cog, data.dcog);
}

StabilitySeries StabilityNotes::series() const {
  const auto stretch = static_cast<size_t>(stretch_);
  StabilitySeries out =
      empty_stability((notes_.size() + stretch - 1) / stretch, stretch_ * series_.dt);
  const auto keep_joint = [](double& kept, int& dof, double share, int of) {
    if (std::isnan(share) || share <= kept) return;
    kept = share;
    dof = of;
  };
  for (size_t k = 0; k < notes_.size(); ++k) {
    const Note& note = notes_[k];
    const size_t i = k / stretch;
    keep_joint(out.speed[i], out.speed_dof[i], note.speed, note.speed_dof);
    keep_joint(out.torque[i], out.torque_dof[i], note.torque, note.torque_dof);
    if (!std::isnan(note.normal_force)) keep_least(out.normal_force[i], note.normal_force);
    if (!std::isnan(note.zmp_margin)) keep_least(out.zmp_margin[i], note.zmp_margin);
    if (!std::isnan(note.friction)) keep_largest(out.friction[i], note.friction);
    if (!std::isnan(note.dcm_margin)) keep_least(out.dcm_margin[i], note.dcm_margin);
  }
  return out;
}

StabilitySeries stability_series(const RobotModel& model, const CommandSeries& series,
                                 const CheckOptions& options, double dt) {
  StabilityNotes notes(model, series, options, dt);
  const ContactPlan plan = contact_plan(series);
  MotionDynamics dynamics(model, model.limits(options.profile), series, plan);
  for (int k = 0; k < static_cast<int>(series.samples.size()); ++k) {
    const SampleDynamics& demand = dynamics.at(k);
    notes.note({k, series.samples[static_cast<size_t>(k)], demand, dynamics.plane(),
                !at_flight_edge(series, k)},
               dynamics.data());
  }
  return notes.series();
}

}  // namespace ayumi
