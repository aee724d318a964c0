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
    for (Side side : {Side::left, Side::right}) {
      const int foot = static_cast<int>(side);
      if (spec.locked_feet[foot])
        site.add(kPathRows, i, foot, deviation_rows(side, at.path[foot]), 6, -kPath, kPath);
    }
  }
}

}  // namespace ayumi
