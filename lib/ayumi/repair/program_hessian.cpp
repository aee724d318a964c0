// Gram matrices of uniform cubic B-splines with knots h apart, by distance of the control points:
//   integral B_i B_j     = h / 5040 (2416, 1191, 120, 1)
//   integral B_i'' B_j'' = 1 / h^3 (8/3, -3/2, 0, 1/6).
#include "ayumi/repair/program_hessian.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "ayumi/base/in_parallel.hpp"
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
        // If two control points share a variable, their entry is on the diagonal, and both orders
        // count there.
        const double share = d > 0 && one == other ? 2 : 1;
        h.pattern.add(std::max(one, other), std::min(one, other));
        values.push_back(
            share * policy::change_weight::kObjectiveScale * weights[column] *
            (spacing * kValueGram[d] + smooth / (spacing * spacing * spacing) * kCurvatureGram[d]));
      }
  h.objective = Eigen::Map<VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

// The columns of base and legs are curved. On the ground, arms contribute little. In flight they
// contribute more, but there, programs with the whole curvature needed more iterations than
// programs without any.
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

// Nonzeros of all pairs of variables with curved columns, up to three control points apart, ordered
// by the later control point, by their distance, and by columns.
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

PointCurvature curvature_at(const ProgramHessian& h, const SplineWeights& w, const Curvature& all) {
  PointCurvature result;
  result.weights = w;
  if (is_flat(all)) return result;
  result.value = all.value(h.columns, h.columns);
  result.mixed = all.acceleration(h.columns, h.columns);
  result.turned = result.mixed.transpose();
  if (all.cone.isZero(0)) return result;
  result.cone = all.cone;
  for (int i = 0; i < 4; ++i)
    result.force[i] = w.value[i] * all.force_by[0](Eigen::all, h.columns) +
                      w.rate[i] * all.force_by[1](Eigen::all, h.columns) +
                      w.acceleration[i] * all.force_by[2](Eigen::all, h.columns);
  return result;
}

namespace {

// Adds the curvature by control points `later` and `later` - d, from the points where both act.
// By rate and rate it is G + G' with G by acceleration and value.
bool add_pair(const std::vector<PointCurvature>& points, size_t first, int later, int d,
              MatrixXd& pair) {
  bool any = false;
  for (size_t p = first; p < points.size() && points[p].weights.first <= later - d; ++p) {
    const PointCurvature& at = points[p];
    if (at.value.size() == 0) continue;
    const SplineWeights& w = at.weights;
    const int i = later - w.first, j = i - d;
    const double rates = w.rate[i] * w.rate[j];
    if (!any) pair.setZero(at.value.rows(), at.value.cols());
    any = true;
    pair += w.value[i] * w.value[j] * at.value +
            (w.acceleration[i] * w.value[j] + rates) * at.mixed +
            (w.value[i] * w.acceleration[j] + rates) * at.turned;
    if (at.force[0].size() > 0) pair.noalias() += at.force[i].transpose() * (at.cone * at.force[j]);
  }
  return any;
}

void add_pairs(const ProgramHessian& h, const Eigen::MatrixXi& index, int point, int d,
               const MatrixXd& pair, VectorXd& values) {
  const int columns = static_cast<int>(h.columns.size());
  int next = h.first_nonzero[static_cast<size_t>(4 * point + d)];
  for (int a = 0; a < columns; ++a)
    for (int b = 0; b < (d == 0 ? a + 1 : columns); ++b) {
      const int one = index(point, h.columns[a]), other = index(point - d, h.columns[b]);
      if (one < 0 || other < 0) continue;
      values[next++] += (d > 0 && one == other ? 2 : 1) * pair(a, b);
    }
}

}  // namespace

void add_curvature(const ProgramHessian& h, const Eigen::MatrixXi& index,
                   const std::vector<PointCurvature>& points, int threads, VectorXd& values) {
  // Number of control points that one thread takes at once. Chosen: a smaller number takes less
  // time than starting a thread.
  constexpr int kTogether = 8;
  const auto count = static_cast<int>(index.rows());
  std::atomic<bool> stop = false;
  in_parallel(
      static_cast<size_t>((count + kTogether - 1) / kTogether), threads, stop, [&](size_t part) {
        MatrixXd pair;
        const int begin = static_cast<int>(part) * kTogether;
        for (int point = begin; point < std::min(count, begin + kTogether); ++point) {
          const auto first = std::partition_point(
              points.begin(), points.end(),
              [&](const PointCurvature& at) { return at.weights.first < point - 3; });
          for (int d = 0; d < 4 && d <= point; ++d)
            if (add_pair(points, static_cast<size_t>(first - points.begin()), point, d, pair))
              add_pairs(h, index, point, d, pair, values);
        }
      });
}

}  // namespace ayumi
