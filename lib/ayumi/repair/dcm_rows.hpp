#pragma once
// Rows that hold the DCM to its plan. They are a soft goal and belong to no limit: minimum change
// alone would leave the DCM displaced where a posture is wrong, which costs push tolerance. The
// supports stay as planned, so a displaced DCM withstands smaller pushes in the opposite direction.
// The ZMP is held with the DCM, because a ZMP that compensates for a swinging limb acts as a push
// on a controller that follows COG and feet.

#include "ayumi/limits/row_site.hpp"
#include "ayumi/repair/correction_spec.hpp"

namespace ayumi {

void place_dcm_rows(RowSite& site, const CorrectionSpec& spec);

}  // namespace ayumi
