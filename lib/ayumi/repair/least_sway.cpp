// The COG c of the linear pendulum at the times t_k = k h gives the ZMP
//   z_k = c_k - (c_{k-1} - 2 c_k + c_{k+1}) / (h^2 w2_k).
// With the heading e of the feet, its normal n, the middle m of both soles and the ZMP p of the
// plan, the quadratic program
//   min sum_k (n.(c_k - m_k))^2 + (e.(z_k - p_k))^2 + (s / h)^2 |z_k - z_{k-1}|^2
// keeps every z_k inside the support. The motion begins and ends at rest in the COG of the plan.
#include "ayumi/repair/least_sway.hpp"

#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "ayumi/demand/ground_demand.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/repair/nlp/nlp.hpp"

namespace ayumi {

using Eigen::Index;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace policy = repair_policy;

namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;
using Triplets = std::vector<Eigen::Triplet<double>>;

// One grid point of the plan.
struct GridPoint {
  long sample = 0;
  double w2 = 0;                                // omega^2 of the pendulum [1/s^2]
  Vector2d heading = Vector2d::UnitX();         // unit vector
  Vector2d middle = Vector2d::Zero();           // of the soles [m]
  std::vector<std::pair<Vector2d, double>> in;  // edges (n, d): n.z <= d

  Vector2d across() const { return {-heading.y(), heading.x()}; }
};

void add_edges(const RobotModel& model, const CommandSample& sample, GridPoint& point) {
  const SupportPlane plane = support_plane(model, sample.support, sample.feet);
  const ConvexPolygon& polygon = plane.polygon;
  double inside = std::numeric_limits<double>::infinity();  // radius of the narrowest sole
  for (const Side side : {Side::left, Side::right}) {
    const ConvexPolygon sole(model.sole(side).polygon);
    inside = std::min(inside, sole.margin(model.sole(side).center));
  }
  const std::vector<Vector2d>& v = polygon.vertices();
  for (size_t i = 0; i < v.size(); ++i) {
    const Vector3d from = plane.frame * Vector3d(v[i].x(), v[i].y(), 0);
    const Vector2d& next = v[(i + 1) % v.size()];
    const Vector3d to = plane.frame * Vector3d(next.x(), next.y(), 0);
    const Vector2d along = (to - from).head<2>();
    if (along.norm() == 0) continue;
    const Vector2d out = Vector2d(along.y(), -along.x()).normalized();
    point.in.emplace_back(out, out.dot(from.head<2>()) - policy::generation::kInsideShare * inside);
  }
}

GridPoint grid_point(const RobotModel& model, const CommandSeries& plan, long k) {
  const CommandSample& sample = plan.samples[static_cast<size_t>(k)];
  GridPoint point;
  point.sample = k;
  point.w2 = (sample.ddcog.z() + kGravity) / std::max(1e-3, sample.cog.z() - sample.zmp.z());
  const Vector2d e = (sample.feet[0].linear().col(0) + sample.feet[1].linear().col(0)).head<2>();
  if (e.norm() > 0) point.heading = e.normalized();
  for (const Side side : {Side::left, Side::right}) {
    const Vector2d& c = model.sole(side).center;
    point.middle +=
        0.5 * (sample.feet[static_cast<size_t>(side)] * Vector3d(c.x(), c.y(), 0)).head<2>();
  }
  add_edges(model, sample, point);
  return point;
}

// At a change of support, the ZMP has to be inside both supports.
std::vector<GridPoint> grid_of(const RobotModel& model, const CommandSeries& plan) {
  const long last = static_cast<long>(plan.samples.size()) - 1;
  // Several samples of a fine plan make one step; of a coarse plan, each sample is a point.
  const long step = std::max(1L, std::lround(policy::generation::kZmpStep / plan.dt));
  const long count = std::min(
      last, std::max(2L, std::lround(static_cast<double>(last) / static_cast<double>(step))));
  std::vector<GridPoint> grid;
  for (long i = 0; i <= count; ++i) grid.push_back(grid_point(model, plan, i * last / count));
  for (size_t i = 1; i + 1 < grid.size(); ++i)
    for (long k = grid[i - 1].sample + 1; k < grid[i + 1].sample; ++k) {
      const Support support = plan.samples[static_cast<size_t>(k)].support;
      if (support == Support::both ||
          support == plan.samples[static_cast<size_t>(grid[i].sample)].support)
        continue;
      add_edges(model, plan.samples[static_cast<size_t>(k)], grid[i]);
      break;
    }
  return grid;
}

// The program in the COG at all grid points: x, y, x, y, ... The rows of `zmp` give the ZMP.
struct SwayProgram {
  std::vector<GridPoint> grid;
  SparseMatrix zmp, hessian, edges;
  VectorXd linear, edge_bound;
};

SparseMatrix sparse(Index rows, Index columns, const Triplets& entries) {
  SparseMatrix matrix(rows, columns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

// z = zmp c; before the first and after the last point, the COG is that of these points.
SparseMatrix zmp_rows(const std::vector<GridPoint>& grid, double h) {
  const Index n = static_cast<Index>(grid.size());
  Triplets entries;
  for (Index k = 0; k < n; ++k) {
    const double share = 1 / (h * h * grid[static_cast<size_t>(k)].w2);
    for (Index axis = 0; axis < 2; ++axis) {
      const Index row = 2 * k + axis;
      entries.emplace_back(row, row, 1 + 2 * share);
      entries.emplace_back(row, 2 * std::max<Index>(0, k - 1) + axis, -share);
      entries.emplace_back(row, 2 * std::min(n - 1, k + 1) + axis, -share);
    }
  }
  return sparse(2 * n, 2 * n, entries);
}

SwayProgram sway_program(const RobotModel& model, const CommandSeries& plan, double smooth) {
  SwayProgram program;
  program.grid = grid_of(model, plan);
  const std::vector<GridPoint>& grid = program.grid;
  const Index n = static_cast<Index>(grid.size());
  const double h = plan.duration() / static_cast<double>(n - 1);
  program.zmp = zmp_rows(grid, h);

  // The terms of the sum as rows of a least-squares problem.
  Triplets cog, zmp, change, edge;
  VectorXd middle(n), along(n);
  std::vector<double> bound;
  for (Index k = 0; k < n; ++k) {
    const GridPoint& point = grid[static_cast<size_t>(k)];
    const Vector2d across = point.across();
    const Vector2d given = plan.samples[static_cast<size_t>(point.sample)].zmp.head<2>();
    middle[k] = across.dot(point.middle);
    along[k] = point.heading.dot(given);
    for (Index axis = 0; axis < 2; ++axis) {
      cog.emplace_back(k, 2 * k + axis, across[axis]);
      zmp.emplace_back(k, 2 * k + axis, point.heading[axis]);
      if (k == 0) continue;
      change.emplace_back(2 * k + axis, 2 * k + axis, smooth / h);
      change.emplace_back(2 * k + axis, 2 * (k - 1) + axis, -smooth / h);
    }
    for (const auto& [out, distance] : point.in) {
      for (Index axis = 0; axis < 2; ++axis)
        edge.emplace_back(static_cast<Index>(bound.size()), 2 * k + axis, out[axis]);
      bound.push_back(distance);
    }
  }
  const SparseMatrix c = sparse(n, 2 * n, cog), z = sparse(n, 2 * n, zmp) * program.zmp,
                     d = sparse(2 * n, 2 * n, change) * program.zmp;
  program.hessian = SparseMatrix(c.transpose() * c) + SparseMatrix(z.transpose() * z) +
                    SparseMatrix(d.transpose() * d);
  program.linear = -(c.transpose() * middle + z.transpose() * along);
  program.edges = sparse(static_cast<Index>(bound.size()), 2 * n, edge) * program.zmp;
  program.edge_bound = Eigen::Map<VectorXd>(bound.data(), static_cast<Index>(bound.size()));
  return program;
}

Nlp nlp_of(const SwayProgram& program, const CommandSeries& plan) {
  const Index n = static_cast<Index>(program.grid.size());
  Nlp nlp;
  nlp.start.resize(2 * n);
  for (Index k = 0; k < n; ++k)
    nlp.start.segment<2>(2 * k) =
        plan.samples[static_cast<size_t>(program.grid[static_cast<size_t>(k)].sample)]
            .cog.head<2>();
  nlp.lower = VectorXd::Constant(2 * n, -kNoBound);
  nlp.upper = VectorXd::Constant(2 * n, kNoBound);
  for (const Index end : {Index(0), n - 1}) {
    nlp.lower.segment<2>(2 * end) = nlp.start.segment<2>(2 * end);
    nlp.upper.segment<2>(2 * end) = nlp.start.segment<2>(2 * end);
  }
  nlp.constraint_lower = VectorXd::Constant(program.edges.rows(), -kNoBound);
  nlp.constraint_upper = program.edge_bound;
  VectorXd edge_values(program.edges.nonZeros());
  Index at = 0;
  for (Index column = 0; column < program.edges.outerSize(); ++column)
    for (SparseMatrix::InnerIterator e(program.edges, column); e; ++e) {
      nlp.jacobian.add(static_cast<int>(e.row()), static_cast<int>(e.col()));
      edge_values[at++] = e.value();
    }
  std::vector<double> hessian_values;
  for (Index column = 0; column < program.hessian.outerSize(); ++column)
    for (SparseMatrix::InnerIterator e(program.hessian, column); e; ++e) {
      if (e.row() < e.col()) continue;
      nlp.hessian.add(static_cast<int>(e.row()), static_cast<int>(e.col()));
      hessian_values.push_back(e.value());
    }
  nlp.objective = [&program](const VectorXd& x) {
    return 0.5 * x.dot(program.hessian * x) + program.linear.dot(x);
  };
  nlp.gradient = [&program](const VectorXd& x, VectorXd& gradient) {
    gradient = program.hessian * x + program.linear;
  };
  nlp.constraints = [&program](const VectorXd& x, VectorXd& values) { values = program.edges * x; };
  nlp.jacobian_values = [edge_values](const VectorXd&, VectorXd& values) { values = edge_values; };
  nlp.hessian_values = [hessian_values](const VectorXd&, double scale, const VectorXd&,
                                        VectorXd& values) {
    values = scale * Eigen::Map<const VectorXd>(hessian_values.data(),
                                                static_cast<Index>(hessian_values.size()));
  };
  return nlp;
}

}  // namespace

std::optional<std::array<Track, 3>> zmp_of_least_sway(const RobotModel& model,
                                                      const CommandSeries& plan, double smooth,
                                                      const Progress& progress) {
  const bool flies = std::any_of(plan.samples.begin(), plan.samples.end(),
                                 [](const CommandSample& s) { return s.support == Support::none; });
  if (flies) return std::nullopt;
  const SwayProgram program = sway_program(model, plan, smooth);
  const NlpSolution solution =
      solve(nlp_of(program, plan), {}, progress, "looking for the smallest sway");
  if (solution.status != NlpStatus::solved) return std::nullopt;
  const VectorXd z = program.zmp * solution.x;
  std::array<std::vector<TrackKey>, 3> keys;
  for (size_t k = 0; k < program.grid.size(); ++k) {
    const long sample = program.grid[k].sample;
    const double t = plan.dt * static_cast<double>(sample);
    for (size_t axis = 0; axis < 3; ++axis)
      keys[axis].push_back({t,
                            axis < 2 ? z[static_cast<Index>(2 * k + axis)]
                                     : plan.samples[static_cast<size_t>(sample)].zmp.z(),
                            Interpolation::linear});
  }
  return std::array<Track, 3>{Track(keys[0]), Track(keys[1]), Track(keys[2])};
}

}  // namespace ayumi
