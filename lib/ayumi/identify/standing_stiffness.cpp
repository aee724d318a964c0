#include "ayumi/identify/standing_stiffness.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/identify/joint_loads.hpp"
#include "ayumi/identify/servo_fit.hpp"
#include "ayumi/math/linear_solve.hpp"

namespace ayumi {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// Shortest time for which a leg has to stand, and to swing [s]. Chosen: two steps of a small
// humanoid.
constexpr double kLeastStanding = 0.5;

// Rate of the command below which friction has no direction [rad/s]. Chosen: a count of a small
// servo in 4 ms.
constexpr double kNoDirection = 0.02;

double direction_of(double rate) {
  return rate > kNoDirection ? 1.0 : rate < -kNoDirection ? -1.0 : 0.0;
}

bool stands_and_swings(const JointRecording& joint) {
  const double standing = joint.dt * static_cast<double>(std::count_if(
                                         joint.settled.begin(), joint.settled.end(),
                                         [&](Index k) { return joint.own_share[k] > 0.5; }));
  const double swinging = joint.dt * static_cast<double>(joint.settled.size()) - standing;
  return standing > kLeastStanding && swinging > kLeastStanding;
}

// The parts of which the distance of a joint from its late command consists, by row: torque,
// friction, rate.
struct SlowParts {
  VectorXd distance;
  MatrixXd causes;
};

SlowParts slow_parts(const JointRecording& joint, double lag) {
  const Index rows = joint.measured.size();
  VectorXd distance(rows), direction(rows), rate(rows);
  for (Index k = 0; k < rows; ++k) {
    const double t = joint.dt * static_cast<double>(k) - lag;
    distance[k] = joint.measured[k] - command_at(joint, t);
    rate[k] = (command_at(joint, t + joint.dt) - command_at(joint, t - joint.dt)) / (2 * joint.dt);
    direction[k] = direction_of(rate[k]);
  }
  const auto slow = [&](const VectorXd& x) { return low_pass(x, joint.dt, kQuickLoad); };
  SlowParts parts{slow(distance)(joint.settled),
                  MatrixXd(static_cast<Index>(joint.settled.size()), 3)};
  parts.causes << -slow(joint.torque)(joint.settled), -slow(direction)(joint.settled),
      slow(rate)(joint.settled);
  return parts;
}

}  // namespace

StandingCompliance standing_compliance(const std::vector<JointRecording>& joints, double lag,
                                       double load_error) {
  const auto count = static_cast<Index>(joints.size());
  Index rows = 0;
  for (const JointRecording& joint : joints) {
    if (!stands_and_swings(joint)) return {};
    rows += static_cast<Index>(joint.settled.size());
  }
  // The first columns are the causes; then there is one for the offset of each joint.
  MatrixXd jacobian = MatrixXd::Zero(rows, 3 + count);
  VectorXd distance(rows);
  double change = 0;  // largest change of the load [N m]
  Index at = 0;
  for (Index j = 0; j < count; ++j) {
    const SlowParts parts = slow_parts(joints[static_cast<size_t>(j)], lag);
    const Index size = parts.distance.size();
    distance.segment(at, size) = parts.distance;
    jacobian.block(at, 0, size, 3) = parts.causes;
    jacobian.block(at, 3 + j, size, 1).setOnes();
    const VectorXd torque = parts.causes.col(0);
    change = std::max(change, std::sqrt((torque.array() - torque.mean()).square().mean()));
    at += size;
  }
  const VectorXd size = jacobian.colwise().norm().transpose().cwiseMax(1e-12);
  jacobian = jacobian * size.cwiseInverse().asDiagonal();
  const VectorXd x = solve_least_squares(jacobian, distance);
  const VectorXd left = distance - jacobian * x;
  std::vector<VectorXd> residuals;
  at = 0;
  for (const JointRecording& joint : joints) {
    residuals.emplace_back(left.segment(at, static_cast<Index>(joint.settled.size())));
    at += residuals.back().size();
  }
  double factor = 0;
  const MatrixXd covariance = covariance_of(jacobian, residuals, factor);
  StandingCompliance result{true, x[0] / size[0], 0};
  // The torque may be wrong while the leg stands, and right while it swings: its loads then differ
  // by twice their standard deviation.
  const double share = load_error / std::max(2 * change, 1e-9);
  result.half_width =
      factor * std::sqrt(covariance(0, 0)) / size[0] + share * std::abs(result.value);
  result.found = result.value > result.half_width;
  return result;
}

}  // namespace ayumi
