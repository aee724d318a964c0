#pragma once
// The rows of a program. The limits place rows where the motion, or an earlier result, is near the
// limit. The repair itself places further rows, which belong to no limit of the check. The check of
// the result covers everything else.

#include <vector>

#include "ayumi/limits/row_site.hpp"
#include "ayumi/repair/correction_spec.hpp"

namespace ayumi {

/// The rows of the program.
struct PlacedRows {
  std::vector<RowBlock> blocks;  ///< ordered by their points, and within a point by RowOrder
  std::vector<std::vector<int>> columns;  ///< for each block, the columns on which it depends
  Eigen::VectorXd lower, upper;           ///< bounds of the rows
};

/// Places all rows, and fills the fields of `points` that the rows need.
PlacedRows place_rows(const RobotModel& model, const CommandSeries& series,
                      const CorrectionSpec& spec, const ContactPlan& plan,
                      std::vector<CollocationPoint>& points);

/// The prices of policy.hpp.
RowPrices row_prices();

}  // namespace ayumi
