#pragma once
// The rows of a program: those that the limits place where the motion, or an earlier result, is
// near them, and the repair's own, which belong to no limit of the check. The check of the result
// looks at the rest.

#include <vector>

#include "ayumi/limits/row_site.hpp"
#include "ayumi/repair/correction_spec.hpp"

namespace ayumi {

/// The rows of the program.
struct PlacedRows {
  std::vector<RowBlock> blocks;           ///< in order of their points, there by RowOrder
  std::vector<std::vector<int>> columns;  ///< by block: on which it depends
  Eigen::VectorXd lower, upper;           ///< bounds of the rows
};

/// All rows, and the fields of `points` that go with them.
PlacedRows place_rows(const RobotModel& model, const CommandSeries& series,
                      const CorrectionSpec& spec, const ContactPlan& plan,
                      std::vector<CollocationPoint>& points);

/// The prices of policy.hpp.
RowPrices row_prices();

}  // namespace ayumi
