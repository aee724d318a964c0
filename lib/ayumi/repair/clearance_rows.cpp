#include "ayumi/repair/clearance_rows.hpp"

#include <algorithm>

#include "ayumi/dynamics/kinematics.hpp"

namespace ayumi {

namespace policy = repair_policy;

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

void add_path_columns(const RobotModel& model, int body, std::vector<int>& columns) {
  for (int i = body; i > 0; i = model.bodies()[i].parent)
    columns.push_back(6 + model.bodies()[i].dof);
}

// `own`: what the given motion keeps between the bodies [m].
void add_clearance(RowPlacement& p, int point, const ShapePair& shapes, double own) {
  const double kept = p.spec.clearance;
  const double least = own > policy::clearance::kTouch ? std::min(kept, own) : kept;
  const int rows = clearance_point_count(*p.spec.collisions, shapes);
  ConstraintBlock block = block_of(ConstraintGroup::clearance, point, shapes.pair, rows);
  block.shapes = shapes;
  VectorXd lower = VectorXd::Constant(rows, least);
  if (shapes.edges) lower[0] -= std::min(policy::clearance::kEdgeAllowance, 0.5 * least);
  p.add(std::move(block), lower, VectorXd::Constant(rows, kNoBound));
}

}  // namespace

std::vector<int> clearance_columns(const RobotModel& model, const CollisionModel& collisions,
                                   const ShapePair& shapes) {
  const CollisionModel::Pair& pair = collisions.pairs()[shapes.pair];
  std::vector<int> columns;
  add_path_columns(model, pair.a, columns);
  add_path_columns(model, pair.b, columns);
  std::sort(columns.begin(), columns.end());
  columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
  return columns;
}

VectorXd clearance_values(const ConstraintBlock& block, const CollocationPoint& point,
                          const PointState& state) {
  const auto points = clearance_points(*point.collisions, block.shapes, *state.data);
  VectorXd values(block.rows);
  for (int i = 0; i < block.rows; ++i) values[i] = points[static_cast<size_t>(i)].clearance;
  return values;
}

MatrixXd clearance_derivatives(const RobotModel& model, const ConstraintBlock& block,
                               const CollocationPoint& point, const PointState& state) {
  MatrixXd by = clearance_gradient(model, *point.collisions, block.shapes, *state.data);
  by.middleCols<3>(3) = (by.middleCols<3>(3) * state.motion.tangent).eval();
  return by;
}

void place_clearance_rows(RowPlacement& p, int point) {
  constexpr double kShapes = policy::clearance::kWatchedShapes;
  RobotData data(p.model);
  const std::vector<const CommandSample*> samples = p.watched(point);
  for (const int pair : p.spec.near_pairs) {
    std::vector<ShapePair> shapes = shape_pairs(*p.spec.collisions, pair);
    std::vector<double> least(shapes.size(), kNoBound);
    double own = kNoBound;
    for (const CommandSample* sample : samples) {
      update_positions(p.model, sample->state, data);
      for (size_t i = 0; i < shapes.size(); ++i) {
        const double here = shape_clearance(*p.spec.collisions, shapes[i], data, kShapes);
        least[i] = std::min(least[i], here);
        if (sample == samples.front()) own = std::min(own, here);
        shapes[i].edges =
            shapes[i].edges || (here < kShapes && edges_meet(*p.spec.collisions, shapes[i], data));
      }
    }
    if (*std::min_element(least.begin(), least.end()) >= policy::clearance::kWatchedBodies)
      continue;
    for (size_t i = 0; i < shapes.size(); ++i)
      if (least[i] < kShapes) add_clearance(p, point, shapes[i], own);
  }
}

}  // namespace ayumi
