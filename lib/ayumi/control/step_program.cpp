// The pendulum is linear: an error e of the DCM grows to e g within the time log(g) / omega. A plan
// that has to arrive sooner needs its DCM ahead by (1/g - 1/G) dcm now (control/foothold_shift). So
// the error at the landing is (e + dcm / G) g - dcm, linear in g, and a ZMP that is off by c takes
// c (g - 1) of it away. `offset` follows from the equation, so the unknowns are move, g / G, taken.
#include "ayumi/control/step_program.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "ayumi/math/elementary.hpp"
#include "ayumi/math/quadratic_program.hpp"

namespace ayumi {

using Eigen::Vector2d;

void set_support(StepProblem& problem, const ConvexPolygon& about_zmp, double yaw, double height,
                 double share) {
  const std::vector<Vector2d>& v = about_zmp.vertices();
  const Eigen::Matrix2d turn = elementary::turn_in_plane(-yaw);
  problem.edges = 0;
  for (size_t i = 0; i < v.size() && problem.edges < static_cast<int>(problem.normal.size()); ++i) {
    const Vector2d edge = v[(i + 1) % v.size()] - v[i];
    if (edge.isZero(0)) continue;
    const Vector2d out = Vector2d(edge.y(), -edge.x()).normalized();
    const auto k = static_cast<size_t>(problem.edges++);
    problem.normal[k] = turn * out;
    problem.distance[k] = std::max(0.0, share * out.dot(v[i]) / height);
  }
}

StepChoice choose_step(const StepProblem& p, const StepWeights& w) {
  // x = (move, g / G, taken); offset = x_g grown - dcm - share move - taken.
  const Vector2d grown = p.growth * p.error + p.dcm;
  Eigen::Matrix<double, 2, 5> J;
  J << -p.share * Eigen::Matrix2d::Identity(), grown, -Eigen::Matrix2d::Identity();
  Eigen::Matrix<double, 5, 1> cost, centre = Eigen::Matrix<double, 5, 1>::Zero();
  cost << w.place, w.place, w.time, w.zmp, w.zmp;
  centre[2] = 1;
  QuadraticProgram q;
  Eigen::Matrix<double, 5, 5> H = w.offset * J.transpose() * J;
  H.diagonal() += cost;
  q.H = H;
  q.f = -w.offset * J.transpose() * p.dcm - cost.cwiseProduct(centre);
  q.A = QuadraticProgram::Rows::Zero(6 + p.edges, 5);
  q.b.resize(6 + p.edges);
  for (int axis = 0; axis < 2; ++axis) {
    q.A(axis, axis) = 1;
    q.b[axis] = p.high[axis];
    q.A(2 + axis, axis) = -1;
    q.b[2 + axis] = -p.low[axis];
  }
  q.A(4, 2) = 1;
  q.b[4] = p.most_growth / p.growth;
  q.A(5, 2) = -1;
  q.b[5] = -p.least_growth / p.growth;
  for (int i = 0; i < p.edges; ++i) {
    const auto k = static_cast<size_t>(i);
    q.A(6 + i, 2) = -p.growth * p.distance[k];
    q.A.row(6 + i).tail<2>() = p.normal[k].transpose();
    q.b[6 + i] = -p.distance[k];
  }
  QuadraticProgram::Vector start = centre;
  start.head<2>() = Vector2d::Zero().cwiseMax(p.low).cwiseMin(p.high);
  const QuadraticProgram::Vector x = solve_program(q, start).x;
  StepChoice choice;
  choice.move = x.head<2>();
  choice.growth = x[2] * p.growth;
  choice.taken = x.tail<2>();
  choice.offset = J * x - p.dcm;
  return choice;
}

}  // namespace ayumi
