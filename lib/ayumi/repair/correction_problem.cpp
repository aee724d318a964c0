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
                               const Eigen::MatrixXi& index, std::vector<int>& first_nonzero) {
  SparsePattern pattern;
  for (size_t b = 0; b < rows.blocks.size(); ++b) {
    const RowBlock& block = rows.blocks[b];
    const int first = points[block.point].weights.first;
    first_nonzero.push_back(pattern.size());
    for (int i = 0; i < 4; ++i)
      for (int column : rows.columns[b]) {
        const int variable = index(first + i, column);
        if (variable < 0) continue;
        for (int row = 0; row < block.rows(); ++row) pattern.add(block.row + row, variable);
      }
  }
  return pattern;
}

std::vector<size_t> first_blocks(const std::vector<RowBlock>& blocks, size_t points) {
  std::vector<size_t> first(points + 1, blocks.size());
  for (size_t b = blocks.size(); b-- > 0;) first[static_cast<size_t>(blocks[b].point)] = b;
  for (size_t i = points; i-- > 0;) first[i] = std::min(first[i], first[i + 1]);
  return first;
}

}  // namespace

CorrectionProblem::CorrectionProblem(const RobotModel& model, const CommandSeries& series,
                                     const CorrectionSpec& spec)
    : model_(model),
      actuators_(model.limits(spec.profile)),
      spec_(spec),
      plan_(contact_plan(series)),
      variables_(correction_variables(model, series, spec_)),
      points_(collocation_points(model, series, plan_, spec_, variables_)),
      rows_(place_rows(model, series, spec_, plan_, points_)),
      first_block_(first_blocks(rows_.blocks, points_.size())),
      jacobian_(jacobian_pattern(rows_, points_, variables_.index, first_nonzero_)),
      hessian_(program_hessian(model, change_weights(model, series, spec_.weights), variables_,
                               points_)),
      states_(model, actuators_, series, points_, spec_.threads),
      curvature_(points_.size()) {}

std::span<const RowBlock> CorrectionProblem::blocks_of(size_t point) const {
  return std::span(rows_.blocks)
      .subspan(first_block_[point], first_block_[point + 1] - first_block_[point]);
}

VectorXd CorrectionProblem::constraints(const VectorXd& x) const {
  return values(states_, variables_.coefficients(x));
}

VectorXd CorrectionProblem::constraints_of(const CommandSeries& motion) const {
  PointStates states(model_, actuators_, motion, points_, spec_.threads);
  return values(states, variables_.zero.coefficients);
}

VectorXd CorrectionProblem::values(PointStates& states, const MatrixXd& c) const {
  VectorXd g(constraint_count());
  states.for_each(c, false, [&](size_t i, const PointState& state, DerivativeWorkspace&) {
    for (const RowBlock& block : blocks_of(i))
      g.segment(block.row, block.rows()) = block_values(model_, block, points_[i], state);
  });
  return g;
}

// The derivatives by a control point: its weights times the derivatives by value, rate and
// acceleration.
void CorrectionProblem::jacobian_values(const VectorXd& x, VectorXd& values) const {
  const auto fill = [&](size_t at, const PointState& state, DerivativeWorkspace&) {
    const SplineWeights& w = points_[at].weights;
    const Eigen::Vector4d* weights[] = {&w.value, &w.rate, &w.acceleration};
    MatrixXd sum;
    for (size_t b = first_block_[at]; b < first_block_[at + 1]; ++b) {
      const RowBlock& block = rows_.blocks[b];
      const auto by = block_derivatives(model_, block, points_[at], state);
      double* next = values.data() + first_nonzero_[b];
      for (int i = 0; i < 4; ++i) {
        sum.setZero(block.rows(), model_.velocity_count());
        for (int k = 0; k < 3; ++k)
          if (by[k].size() > 0) sum += (*weights[k])[i] * by[k];
        for (const int column : rows_.columns[b])
          if (variables_.index(w.first + i, column) >= 0)
            next = std::copy_n(sum.col(column).data(), block.rows(), next);
      }
    }
  };
  states_.for_each(variables_.coefficients(x), true, fill);
}

void CorrectionProblem::add_curvature(const VectorXd& x, const VectorXd& multipliers,
                                      VectorXd& values) const {
  if (hessian_.columns.empty()) return;
  const auto fill = [&](size_t i, const PointState& state, DerivativeWorkspace& workspace) {
    curvature_[i] =
        curvature_at(hessian_, points_[i].weights,
                     curvature_of(model_, blocks_of(i), multipliers, points_[i], state, workspace));
  };
  states_.for_each(variables_.coefficients(x), true, fill);
  ayumi::add_curvature(hessian_, variables_.index, curvature_, spec_.threads, values);
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
