#pragma once
// Rows of the commanded ZMP. A repair also needs them to keep the planned DCM.

#include "ayumi/limits/row_site.hpp"

namespace ayumi {

/// f_n times the offset of the ZMP from the commanded ZMP, divided by the weight [m]; there are two
/// rows.
WrenchRows commanded_zmp_rows(const RowSite& site, int point);

}  // namespace ayumi
