#pragma once
// Rows that keep the DCM near its plan. They are a soft goal and belong to no limit. Minimum change
// alone would leave the DCM displaced where a posture is wrong. The supports stay as planned, so
// with a displaced DCM the robot survives only smaller pushes in the direction of the displacement.
// The ZMP is held together with the DCM, because a ZMP that compensates for a swinging limb acts
// like a push on a controller that follows COG and feet.

#include "ayumi/limits/row_site.hpp"
#include "ayumi/repair/correction_spec.hpp"

namespace ayumi {

void place_dcm_rows(RowSite& site, const CorrectionSpec& spec);

}  // namespace ayumi
