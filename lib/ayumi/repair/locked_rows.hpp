#pragma once
// Rows for what a repair must not change: postures at locked times, and paths of locked feet. When
// a motion is generated, there are also rows for the planned feet and the planned COG. These rows
// belong to no limit.

#include "ayumi/limits/row_site.hpp"
#include "ayumi/repair/correction_spec.hpp"

namespace ayumi {

void place_locked_rows(RowSite& site, const CorrectionSpec& spec);

}  // namespace ayumi
