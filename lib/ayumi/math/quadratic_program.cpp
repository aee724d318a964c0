// The method is that of the primal active set. The step p with A_w p = 0 to the least value on the
// working set w is the solution of
//   [H A_w'; A_w 0] [p; l] = [-(H x + f); 0].
// If a step meets an inequality, this inequality is added to w. If p = 0, an inequality with l < 0
// is removed from w; if there is none, x is optimal. An inequality that a step meets is independent
// of those of w, since A_w p = 0.
#include "ayumi/math/quadratic_program.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>

namespace ayumi {

namespace {

// Largest number of steps; after them the search ends with a feasible x. Chosen: several times the
// number of inequalities. The program of a tick takes fewer than twenty steps, so that half and
// twice the value give the same result.
constexpr int kMostSteps = 200;

// Size below which a step, relative to that of x, or a multiplier, relative to the gradient, counts
// as zero. Chosen: thousands of times the rounding of double precision, and far below anything that
// matters for a foothold or the time of a step; this is also true of half and twice the value.
constexpr double kZero = 1e-12;

constexpr int kMostRows = 2 * kMostUnknowns;
using KktMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostRows, kMostRows>;
using KktVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostRows, 1>;

}  // namespace

ProgramSolution solve_program(const QuadraticProgram& q, const QuadraticProgram::Vector& start) {
  const Eigen::Index n = q.f.size(), rows = q.b.size();
  ProgramSolution s{start, QuadraticProgram::Bounds::Zero(rows)};
  std::array<Eigen::Index, kMostUnknowns> working{};
  Eigen::Index active = 0;
  for (int step = 0; step < kMostSteps; ++step) {
    KktMatrix kkt = KktMatrix::Zero(n + active, n + active);
    KktVector right = KktVector::Zero(n + active);
    kkt.topLeftCorner(n, n) = q.H;
    const QuadraticProgram::Vector gradient = q.H * s.x + q.f;
    right.head(n) = -gradient;
    for (Eigen::Index i = 0; i < active; ++i) {
      kkt.block(n + i, 0, 1, n) = q.A.row(working[static_cast<size_t>(i)]);
      kkt.block(0, n + i, n, 1) = kkt.block(n + i, 0, 1, n).transpose();
    }
    const KktVector solved = kkt.partialPivLu().solve(right);
    const QuadraticProgram::Vector p = solved.head(n);
    if (p.norm() <= kZero * (1 + s.x.norm())) {
      Eigen::Index worst = -1;
      double least = -kZero * (1 + gradient.norm());
      for (Eigen::Index i = 0; i < active; ++i)
        if (solved[n + i] < least) least = solved[n + i], worst = i;
      if (worst < 0) {
        for (Eigen::Index i = 0; i < active; ++i)
          s.multipliers[working[static_cast<size_t>(i)]] = std::max(0.0, solved[n + i]);
        s.optimal = true;
        return s;
      }
      working[static_cast<size_t>(worst)] = working[static_cast<size_t>(--active)];
      continue;
    }
    double length = 1;
    Eigen::Index met = -1;
    for (Eigen::Index i = 0; i < rows; ++i) {
      const auto end = working.begin() + active;
      if (std::find(working.begin(), end, i) != end) continue;
      const double rate = q.A.row(i).dot(p);
      if (rate <= kZero * q.A.row(i).norm() * p.norm()) continue;
      const double room = std::max(0.0, q.b[i] - q.A.row(i).dot(s.x)) / rate;
      if (room < length) length = room, met = i;
    }
    s.x += length * p;
    if (met < 0) continue;
    if (active == n) break;  // x is at a corner, to rounding
    working[static_cast<size_t>(active++)] = met;
  }
  return s;
}

}  // namespace ayumi
