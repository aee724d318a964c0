#pragma once
// Which rows stand at which collocation point: a row for every limit that the motion, or an earlier
// result, is near. The check of the result looks at the rest.

#include <vector>

#include "ayumi/repair/constraint_rows.hpp"
#include "ayumi/repair/nlp/nlp.hpp"

namespace ayumi {

/// The rows of the program.
struct PlacedRows {
  std::vector<ConstraintBlock> blocks;    ///< in order of their points
  std::vector<std::vector<int>> columns;  ///< by block: on which it depends
  Eigen::VectorXd lower, upper;           ///< bounds of the rows
};

/// What decides where rows are placed, and the rows placed so far.
struct RowPlacement {
  const RobotModel& model;
  const CommandSeries& series;
  const CorrectionSpec& spec;
  const ContactPlan& plan;
  std::vector<CollocationPoint>& points;
  PlacedRows rows = {};

  double tolerance(FindingKind kind) const { return spec.tolerance[kind]; }

  /// The samples that decide whether a limit is near: of the motion as given, which is the first,
  /// and of every earlier result. With the last result alone, a limit that its rows have mended
  /// would lose them and be violated again.
  std::vector<const CommandSample*> watched(int point) const;

  /// Adds a block with the same bounds for all its rows, or with one for each, unless its point has
  /// rows of other limits only.
  void add(ConstraintBlock block, double lower, double upper);
  void add(ConstraintBlock block, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);
};

/// All rows, and the fields of `points` that go with them.
PlacedRows place_rows(const RobotModel& model, const CommandSeries& series,
                      const CorrectionSpec& spec, const ContactPlan& plan,
                      std::vector<CollocationPoint>& points);

}  // namespace ayumi
