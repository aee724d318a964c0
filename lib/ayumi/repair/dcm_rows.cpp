#include "ayumi/repair/dcm_rows.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/limits/command_rows.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

namespace policy = repair_policy;

using Eigen::Vector2d;

namespace {

const RowKind kDcmRows = {.name = "dcm",
                          .unit = &RowPrices::length,
                          .soft_goal = &RowPrices::dcm,
                          .relaxed = &RowPrices::dcm,
                          .beyond_check = true,
                          .order = {8, 0}};

double pendulum_time(const CommandSample& plan) {  // 1 / omega [s]
  return std::sqrt((plan.cog.z() - plan.zmp.z()) / kGravity);
}

Vector2d planned_dcm(const CommandSample& plan) {
  return (plan.cog + pendulum_time(plan) * plan.dcog).head<2>();
}

// Whether the ground carries the robot at this point, so that the plan has a DCM.
bool has_dcm(const CollocationPoint& at, const CommandSample& plan) {
  return at.stands() && plan.cog.z() > plan.zmp.z();
}

// For each point, whether the DCM is held there: these are times around a posture that moves the
// DCM off a correct plan. If plan and posture agree and the motion still has an error, the DCM has
// to move.
std::vector<bool> where_dcm_is_held(const RowSite& site, const CorrectionSpec& spec) {
  std::vector<bool> held(site.points.size(), false);
  if (!spec.swing_goals || spec.trust != Trust::posture) return held;
  RobotData data(site.model);
  std::vector<double> times, off;
  for (int i = 0; i < site.count(); ++i) {
    const CommandSample& plan = site.given(i);
    const double t = site.points[i].sample * site.series.dt;
    times.push_back(t);
    if (!has_dcm(site.points[i], plan) || within(spec.wrong_plan, t)) continue;
    update_positions(site.model, plan.state, data);
    update_velocities(site.model, plan.state, data);
    const Vector2d dcm = (data.cog + pendulum_time(plan) * data.dcog).head<2>();
    if ((dcm - planned_dcm(plan)).norm() >
        spec.watched_share * policy::dcm::kOff * (plan.cog.z() - plan.zmp.z()))
      off.push_back(t);
  }
  for (size_t i = 0; i < times.size(); ++i)
    held[i] =
        std::any_of(off.begin(), off.end(),
                    [&](double t) { return std::abs(t - times[i]) <= policy::dcm::kAround; }) &&
        !within(spec.wrong_plan, times[i]);
  return held;
}

}  // namespace

void place_dcm_rows(RowSite& site, const CorrectionSpec& spec) {
  const std::vector<bool> held = where_dcm_is_held(site, spec);
  const Eigen::Vector4d slack(spec.dcm_slack, spec.dcm_slack, spec.zmp_slack, spec.zmp_slack);
  for (int i = 0; i < site.count(); ++i) {
    const CommandSample& plan = site.given(i);
    if (!held[static_cast<size_t>(i)] || !has_dcm(site.points[i], plan)) continue;
    site.add(kDcmRows, i, 0,
             DcmRows{planned_dcm(plan), pendulum_time(plan), commanded_zmp_rows(site, i)}, -slack,
             slack);
  }
}

}  // namespace ayumi
