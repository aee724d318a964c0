#pragma once
// Rows of the commanded ZMP, which a repair needs where it holds the planned DCM too.

#include "ayumi/limits/row_site.hpp"

namespace ayumi {

/// f_n times the offset of the ZMP from the commanded one, over the weight [m]: two rows.
WrenchRows commanded_zmp_rows(const RowSite& site, int point);

}  // namespace ayumi
