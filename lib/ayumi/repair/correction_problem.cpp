#include "ayumi/repair/correction_problem.hpp"

#include <algorithm>
#include <span>

#include "ayumi/repair/weighted_change.hpp"

namespace ayumi {

namespace policy = repair_policy;

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// A row depends on the four control points that act at its collocation point.
SparsePattern jacobian_pattern(const PlacedRows& rows, const std::vector<CollocationPoint>& points,
                               const Eigen::MatrixXi& index) {
  SparsePattern pattern;
  for (size_t b = 0; b < rows.blocks.size(); ++b) {
    const RowBlock& block = rows.blocks[b];
    const int first = points[block.point].weights.first;
    for (int i = 0; i < 4; ++i)
      for (int column : rows.columns[b]) {
        const int variable = index(first + i, column);
        if (variable < 0) continue;
        for (int row = 0; row < block.rows(); ++row) pattern.add(block.row + row, variable);
      }
  }
  return pattern;
}

}  // namespace

CorrectionProblem::CorrectionProblem(const RobotModel& model, const CommandSeries& series,
                                     const CorrectionSpec& spec)
    : model_(model),
      actuators_(model.limits(spec.profile)),
      series_(series),
      spec_(spec),
      plan_(contact_plan(series)) {
  variables_ = correction_variables(model, series, spec_);
  points_ = collocation_points(model, series, plan_, spec_, variables_);
  rows_ = place_rows(model, series, spec_, plan_, points_);
  jacobian_ = jacobian_pattern(rows_, points_, variables_.index);
  hessian_ =
      program_hessian(model, change_weights(model, series, spec_.weights), variables_, points_);
}

VectorXd CorrectionProblem::constraints(const VectorXd& x) const {
  return values(series_, variables_.coefficients(x));
}

VectorXd CorrectionProblem::constraints_of(const CommandSeries& motion) const {
  return values(motion, variables_.zero.coefficients);
}

VectorXd CorrectionProblem::values(const CommandSeries& motion, const MatrixXd& c) const {
  VectorXd g(constraint_count());
  RobotData data(model_);
  PointState state;
  int at = -1;
  for (const RowBlock& block : rows_.blocks) {
    const CollocationPoint& point = points_[block.point];
    if (block.point != at)
      state =
          point_state(model_, actuators_, motion.samples[point.sample], point, c, nullptr, data);
    at = block.point;
    g.segment(block.row, block.rows()) = block_values(model_, block, point, state);
  }
  return g;
}

void CorrectionProblem::jacobian_values(const VectorXd& x, VectorXd& values) const {
  const MatrixXd c = variables_.coefficients(x);
  RobotData data(model_);
  TreeDynamics dynamics(model_);
  PointState state;
  int at = -1;
  Eigen::Index next = 0;
  for (size_t b = 0; b < rows_.blocks.size(); ++b) {
    const RowBlock& block = rows_.blocks[b];
    const CollocationPoint& point = points_[block.point];
    if (block.point != at)
      state =
          point_state(model_, actuators_, series_.samples[point.sample], point, c, &dynamics, data);
    at = block.point;
    const auto by = block_derivatives(model_, block, point, state);
    const SplineWeights& w = point.weights;
    const Eigen::Vector4d* weights[] = {&w.value, &w.rate, &w.acceleration};
    for (int i = 0; i < 4; ++i)
      for (int column : rows_.columns[b]) {
        if (variables_.index(w.first + i, column) < 0) continue;
        for (int row = 0; row < block.rows(); ++row) {
          double sum = 0;
          for (int k = 0; k < 3; ++k)
            if (by[k].size() > 0) sum += (*weights[k])[i] * by[k](row, column);
          values[next++] = sum;
        }
      }
  }
}

void CorrectionProblem::add_curvature(const VectorXd& x, const VectorXd& multipliers,
                                      VectorXd& values) const {
  if (hessian_.columns.empty()) return;
  const MatrixXd c = variables_.coefficients(x);
  RobotData data(model_);
  TreeDynamics dynamics(model_);
  ControlPointPairs pairs(hessian_.first_nonzero.size());
  size_t first = 0;
  for (size_t at = 0; at < points_.size(); ++at) {
    size_t end = first;
    while (end < rows_.blocks.size() && rows_.blocks[end].point == static_cast<int>(at)) ++end;
    const std::span<const RowBlock> blocks(&rows_.blocks[0] + first, end - first);
    first = end;
    const CollocationPoint& point = points_[at];
    const PointState state =
        point_state(model_, actuators_, series_.samples[point.sample], point, c, &dynamics, data);
    const Curvature curvature = curvature_of(model_, blocks, multipliers, point, state, dynamics);
    if (!is_flat(curvature)) spread_curvature(hessian_, point.weights, curvature, pairs);
  }
  add_pairs(hessian_, variables_.index, pairs, values);
}

std::vector<ActiveLimit> CorrectionProblem::beside_active(const VectorXd& x) const {
  constexpr int kParts = policy::collocation::kBesideActive;
  const VectorXd g = constraints(x);
  std::vector<ActiveLimit> limits;
  for (const RowBlock& b : rows_.blocks) {
    if (b.active <= 0) continue;
    const double room = std::min(g[b.row] - rows_.lower[b.row], rows_.upper[b.row] - g[b.row]);
    if (room > b.active) continue;
    const int here = points_[b.point].sample;
    for (const int beside : {b.point - 1, b.point + 1}) {
      if (beside < 0 || beside >= static_cast<int>(points_.size())) continue;
      const int there = points_[beside].sample;
      for (int part = 1; part <= kParts; ++part)
        limits.push_back({here + (there - here) * part / kParts, b.kind, b.item});
    }
  }
  return limits;
}

Nlp CorrectionProblem::nlp() const {
  Nlp nlp;
  nlp.start = spec_.initial.rows() == variables_.zero.coefficients.rows()
                  ? point(spec_.initial)
                  : VectorXd::Zero(variable_count());
  nlp.lower = VectorXd::Constant(variable_count(), -kNoBound);
  nlp.upper = VectorXd::Constant(variable_count(), kNoBound);
  nlp.constraint_lower = rows_.lower;
  nlp.constraint_upper = rows_.upper;
  nlp.jacobian = jacobian_;
  nlp.hessian = hessian_.pattern;
  nlp.gradient = [this](const VectorXd& x, VectorXd& g) { objective_gradient(hessian_, x, g); };
  nlp.objective = [this](const VectorXd& x) {
    VectorXd g(x.size());
    objective_gradient(hessian_, x, g);
    return 0.5 * g.dot(x);
  };
  nlp.constraints = [this](const VectorXd& x, VectorXd& g) { g = constraints(x); };
  nlp.jacobian_values = [this](const VectorXd& x, VectorXd& values) { jacobian_values(x, values); };
  nlp.hessian_values = [this](const VectorXd& x, double scale, const VectorXd& multipliers,
                              VectorXd& values) {
    values.setZero();
    values.head(hessian_.objective.size()) = scale * hessian_.objective;
    add_curvature(x, multipliers, values);
  };
  return nlp;
}

VectorXd CorrectionProblem::point(const MatrixXd& coefficients) const {
  return variables_.values(coefficients);
}

CorrectionTrack CorrectionProblem::track(const VectorXd& x) const {
  CorrectionTrack track = variables_.zero;
  track.coefficients = variables_.coefficients(x);
  return track;
}

}  // namespace ayumi
