// Which shapes are kept apart at an instant.
#include <algorithm>

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/repair/correction_problem.hpp"

namespace ayumi {

// Not nearer than the margin, or than the motion comes by itself without meeting. Shapes are
// watched from farther away than the bodies whose nearest ones count: the next ones are not far.
void CorrectionProblem::place_clearance_blocks(int instant) {
  constexpr double kNear = 0.005, kNearShapes = 0.010;  // [m]
  RobotData data(model_);
  const std::vector<const CommandSample*> samples = watched(instant);
  for (const int pair : spec_.near_pairs) {
    std::vector<ShapePair> shapes = shape_pairs(*spec_.collisions, pair);
    std::vector<double> least(shapes.size(), kNoBound);
    double own = kNoBound;
    for (const CommandSample* sample : samples) {
      update_positions(model_, sample->state, data);
      for (size_t i = 0; i < shapes.size(); ++i) {
        const double here = shape_clearance(*spec_.collisions, shapes[i], data, kNearShapes);
        least[i] = std::min(least[i], here);
        if (sample == samples.front()) own = std::min(own, here);
        shapes[i].edges = shapes[i].edges ||
                          (here < kNearShapes && edges_meet(*spec_.collisions, shapes[i], data));
      }
    }
    if (*std::min_element(least.begin(), least.end()) >= kNear) continue;
    for (size_t i = 0; i < shapes.size(); ++i)
      if (least[i] < kNearShapes) place_clearance_block(instant, shapes[i], own);
  }
}

void CorrectionProblem::place_clearance_block(int instant, const ShapePair& shapes, double own) {
  constexpr double kTouch = 0.0005;  // [m]
  const double least = own > kTouch ? std::min(spec_.clearance, own) : spec_.clearance;
  const int rows = clearance_rows(*spec_.collisions, shapes);
  ConstraintBlock block = block_of(ConstraintGroup::clearance, instant, shapes.pair, rows);
  block.shapes = shapes;
  add_block(std::move(block), least, kNoBound);
  if (shapes.edges) lower_[lower_.size() - rows] -= std::min(kEdgeAllowance, 0.5 * least);
}

}  // namespace ayumi
