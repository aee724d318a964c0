// Gram matrices of uniform cubic B-splines with knots h apart, by distance of the control points:
//   integral B_i B_j     = h / 5040 (2416, 1191, 120, 1)
//   integral B_i'' B_j'' = 1 / h^3 (8/3, -3/2, 0, 1/6).
#include "ayumi/repair/program_hessian.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "ayumi/math/elementary.hpp"

namespace ayumi {

namespace policy = repair_policy;

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// Integrals of the products of a cubic B-spline, and of its second derivative, with the one 0 to 3
// knots later, in units of the spacing. Derived from the polynomials.
constexpr double kValueGram[] = {2416.0 / 5040, 1191.0 / 5040, 120.0 / 5040, 1.0 / 5040};
constexpr double kCurvatureGram[] = {8.0 / 3, -1.5, 0, 1.0 / 6};

void place_objective(const VectorXd& weights, const CorrectionVariables& v, ProgramHessian& h) {
  const double spacing = v.zero.spacing;
  const double smooth = elementary::power<4>(policy::change_weight::kSmoothTime);
  std::vector<double> values;
  for (int point = 0; point < v.index.rows(); ++point)
    for (int column = 0; column < v.index.cols(); ++column)
      for (int d = 0; d < 4 && point - d >= 0; ++d) {
        const int one = v.index(point, column), other = v.index(point - d, column);
        if (one < 0 || other < 0) continue;
        // Two control points that share a variable meet on the diagonal, where both orders count.
        const double share = d > 0 && one == other ? 2 : 1;
        h.pattern.add(std::max(one, other), std::min(one, other));
        values.push_back(
            share * policy::change_weight::kObjectiveScale * weights[column] *
            (spacing * kValueGram[d] + smooth / (spacing * spacing * spacing) * kCurvatureGram[d]));
      }
  h.objective = Eigen::Map<VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

// Base and legs curve; arms add little on the ground. In flight they do not add little, and there
// the whole curvature needed more iterations than none.
std::vector<int> curved_columns(const RobotModel& model,
                                const std::vector<CollocationPoint>& points) {
  if (!model.has_soles() ||
      std::any_of(points.begin(), points.end(),
                  [](const CollocationPoint& at) { return at.plane.empty(); }))
    return {};
  std::set<int> columns = {0, 1, 2, 3, 4, 5};
  for (const Side side : {Side::left, Side::right})
    for (const int dof : model.leg(side)) columns.insert(6 + dof);
  return {columns.begin(), columns.end()};
}

// Nonzeros of all pairs of variables that curve, up to three control points apart: by the later
// point, by their distance, by columns.
void place_curvature(const CorrectionVariables& v, ProgramHessian& h) {
  const int columns = static_cast<int>(h.columns.size());
  if (columns == 0) return;
  for (int point = 0; point < v.index.rows(); ++point)
    for (int d = 0; d < 4; ++d) {
      h.first_nonzero.push_back(h.pattern.size());
      for (int a = 0; a < columns && d <= point; ++a)
        for (int b = 0; b < (d == 0 ? a + 1 : columns); ++b) {
          const int one = v.index(point, h.columns[a]), other = v.index(point - d, h.columns[b]);
          if (one >= 0 && other >= 0) h.pattern.add(std::max(one, other), std::min(one, other));
        }
    }
}

Curvature restricted(const Curvature& all, const std::vector<int>& columns) {
  Curvature some = all;
  some.value = all.value(columns, columns);
  some.acceleration = all.acceleration(columns, columns);
  for (int k = 0; k < 3; ++k)
    if (all.force_by[k].size() > 0) some.force_by[k] = all.force_by[k](Eigen::all, columns);
  return some;
}

}  // namespace

ProgramHessian program_hessian(const RobotModel& model, const VectorXd& weights,
                               const CorrectionVariables& variables,
                               const std::vector<CollocationPoint>& points) {
  ProgramHessian h;
  place_objective(weights, variables, h);
  h.columns = curved_columns(model, points);
  place_curvature(variables, h);
  return h;
}

void objective_gradient(const ProgramHessian& h, const VectorXd& x, VectorXd& g) {
  g.setZero();
  for (int i = 0; i < h.objective.size(); ++i) {
    const int a = h.pattern.rows[i], b = h.pattern.columns[i];
    g[a] += h.objective[i] * x[b];
    if (a != b) g[b] += h.objective[i] * x[a];
  }
}

void spread_curvature(const ProgramHessian& h, const SplineWeights& w, const Curvature& all,
                      ControlPointPairs& pairs) {
  const Curvature curvature = restricted(all, h.columns);
  const MatrixXd &V = curvature.value, &G = curvature.acceleration;
  const MatrixXd Gt = G.transpose(), S = G + Gt;
  const bool cone = !curvature.cone.isZero(0);
  std::array<MatrixXd, 4> force;
  for (int i = 0; i < 4 && cone; ++i)
    force[i] = w.value[i] * curvature.force_by[0] + w.rate[i] * curvature.force_by[1] +
               w.acceleration[i] * curvature.force_by[2];
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j <= i; ++j) {
      MatrixXd& pair = pairs[static_cast<size_t>(4 * (w.first + i) + i - j)];
      if (pair.size() == 0) pair = MatrixXd::Zero(V.rows(), V.cols());
      pair += w.value[i] * w.value[j] * V + w.acceleration[i] * w.value[j] * G +
              w.value[i] * w.acceleration[j] * Gt + w.rate[i] * w.rate[j] * S;
      if (cone) pair.noalias() += force[i].transpose() * (curvature.cone * force[j]);
    }
}

void add_pairs(const ProgramHessian& h, const Eigen::MatrixXi& index,
               const ControlPointPairs& pairs, VectorXd& values) {
  const int columns = static_cast<int>(h.columns.size());
  for (int point = 0; point < index.rows(); ++point)
    for (int d = 0; d < 4; ++d) {
      const auto pair = static_cast<size_t>(4 * point + d);
      if (pairs[pair].size() == 0) continue;
      int next = h.first_nonzero[pair];
      for (int a = 0; a < columns; ++a)
        for (int b = 0; b < (d == 0 ? a + 1 : columns); ++b) {
          const int one = index(point, h.columns[a]), other = index(point - d, h.columns[b]);
          if (one < 0 || other < 0) continue;
          values[next++] += (d > 0 && one == other ? 2 : 1) * pairs[pair](a, b);
        }
    }
}

}  // namespace ayumi
