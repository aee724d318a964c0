#pragma once
// Rows that hold the DCM to its plan, a soft goal of no limit: minimum change alone would leave the
// DCM displaced where a posture is thrown off its plan, which costs push tolerance. The supports
// stay as planned, so that what a displaced DCM gains in one direction it loses in the opposite
// one. The ZMP is held with it, because a ZMP that holds the swing of a limb acts as a push on a
// controller that follows COG and feet.

#include "ayumi/limits/row_site.hpp"
#include "ayumi/repair/correction_spec.hpp"

namespace ayumi {

void place_dcm_rows(RowSite& site, const CorrectionSpec& spec);

}  // namespace ayumi
