#pragma once
// Rows of what a repair has to leave alone: postures at locked times and paths of locked feet; and
// of what it has to follow where it generates a motion: planned feet and COG. They belong to no
// limit.

#include "ayumi/limits/row_site.hpp"
#include "ayumi/repair/correction_spec.hpp"

namespace ayumi {

void place_locked_rows(RowSite& site, const CorrectionSpec& spec);

}  // namespace ayumi
