#pragma once
// Rows of what a repair has to leave alone: postures at locked times and paths of locked feet.
// They belong to no limit.

#include "ayumi/limits/row_site.hpp"
#include "ayumi/repair/correction_spec.hpp"

namespace ayumi {

void place_locked_rows(RowSite& site, const CorrectionSpec& spec);

}  // namespace ayumi
