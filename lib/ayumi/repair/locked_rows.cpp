#include "ayumi/repair/locked_rows.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/limits/sole_rows.hpp"

namespace ayumi {

namespace policy = repair_policy;

namespace {

// The correction must be 0, and this row is never relaxed.
const RowKind kPoseRows = {
    .name = "pose", .unit = &RowPrices::length, .relaxed = nullptr, .order = {1, 0}};

// The pose of a sole must be that of the given motion.
const RowKind kPathRows = {
    .name = "path", .unit = &RowPrices::length, .relaxed = &RowPrices::foot, .order = {2, 1}};

// The COG must follow the commanded COG when a motion is generated.
const RowKind kGoalRows = {.name = "cog_goal",
                           .unit = &RowPrices::length,
                           .soft_goal = &RowPrices::dcm,
                           .relaxed = &RowPrices::dcm,
                           .order = {8, 1}};

// A swinging sole must stay on its planned path.
void place_planned_foot(RowSite& site, int i, Side side) {
  const int foot = static_cast<int>(side);
  if (site.points[i].contact[foot] || site.settings.locked_feet[foot]) return;
  Eigen::VectorXd band(6);
  band << Eigen::Vector3d::Constant(policy::stance::kPosition),
      Eigen::Vector3d::Constant(policy::stance::kAngle);
  site.add(kPathRows, i, foot, deviation_rows(side, site.given(i).feet[foot]), -band, band);
}

void place_planned_cog(RowSite& site, int i, const std::array<bool, 3>& axes) {
  const double share = policy::kTrustedShare * site.tolerance(FindingKind::cog_residual);
  Eigen::VectorXd band(3);
  for (int k = 0; k < 3; ++k) band[k] = axes[k] ? share : kUnbounded;
  site.add(kGoalRows, i, 0, CogRows{site.given(i).cog}, -band, band);
}

bool is_kept(const CorrectionSpec& spec, int sample, double dt) {
  return std::any_of(spec.kept_times.begin(), spec.kept_times.end(),
                     [&](double t) { return std::lround(t / dt) == sample; });
}

}  // namespace

void place_locked_rows(RowSite& site, const CorrectionSpec& spec) {
  constexpr double kPose = policy::stance::kLockedPose, kPath = policy::stance::kLockedFoot;
  for (int i = 0; i < site.count(); ++i) {
    const CollocationPoint& at = site.points[i];
    if (is_kept(spec, at.sample, site.series.dt))
      site.add(kPoseRows, i, 0, CorrectionRows{}, site.model.velocity_count(), -kPose, kPose);
    if (spec.planned_cog[0] || spec.planned_cog[1] || spec.planned_cog[2])
      place_planned_cog(site, i, spec.planned_cog);
    for (Side side : {Side::left, Side::right}) {
      if (spec.planned_feet) place_planned_foot(site, i, side);
      const int foot = static_cast<int>(side);
      if (spec.locked_feet[foot])
        site.add(kPathRows, i, foot, deviation_rows(side, at.path[foot]), 6, -kPath, kPath);
    }
  }
}

}  // namespace ayumi
