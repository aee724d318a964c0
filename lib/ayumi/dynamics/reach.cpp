#include "ayumi/dynamics/reach.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/dynamics/kinematics.hpp"

namespace ayumi {

namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

// Rounds of the iteration. Chosen: a quadratic iteration needs ten; beside limits and stretched
// arms it takes more.
constexpr int kRounds = 200;
// A point that is this near its place is there [m]. Chosen: a hundredth of a millimetre, which no
// hand has.
constexpr double kThere = 1e-5;
// Largest change of a joint in a round [rad, m]. Chosen: so that the linear model holds.
constexpr double kLongestStep = 0.2;

// What hangs on a body reaches less than this share of its limb's length: then these are parts of
// its end. Chosen: fingers reach a fifth of an arm, and arms twice as far as a chest.
constexpr double kPartOfLimb = 0.5;

}  // namespace

std::vector<int> limb_ends(const RobotModel& model) {
  const auto& bodies = model.bodies();
  std::vector<int> children(bodies.size(), 0);
  std::vector<double> carried(bodies.size(), 0);  // to the farthest joint that hangs on it [m]
  for (size_t b = bodies.size(); b-- > 1;) {
    const auto parent = static_cast<size_t>(bodies[b].parent);
    ++children[parent];
    carried[parent] =
        std::max(carried[parent], carried[b] + bodies[b].placement.translation().norm());
  }
  std::vector<double> limb(bodies.size(), 0);  // from where it branches off [m]
  std::vector<bool> beyond(bodies.size(), false);
  std::vector<int> ends;
  for (size_t b = 1; b < bodies.size(); ++b) {
    const auto parent = static_cast<size_t>(bodies[b].parent);
    beyond[b] = beyond[parent];
    if (beyond[b]) continue;
    limb[b] = (children[parent] > 1 ? 0 : limb[parent]) + bodies[b].placement.translation().norm();
    if (children[b] == 0 || (children[b] > 1 && carried[b] < kPartOfLimb * limb[b])) {
      ends.push_back(static_cast<int>(b));
      beyond[b] = true;
    }
  }
  return ends;
}

std::vector<int> limb_dofs(const RobotModel& model, int body) {
  const auto& bodies = model.bodies();
  std::vector<int> ends_above(bodies.size(), 0);  // ends that a body carries, itself included
  for (const int end : limb_ends(model)) ++ends_above[static_cast<size_t>(end)];
  for (size_t b = bodies.size(); b-- > 1;)
    ends_above[static_cast<size_t>(bodies[b].parent)] += ends_above[b];
  const int own = ends_above[static_cast<size_t>(body)];
  std::vector<int> dofs;
  for (int b = body; b > 0 && ends_above[static_cast<size_t>(b)] == own;
       b = bodies[static_cast<size_t>(b)].parent) {
    const int dof = bodies[static_cast<size_t>(b)].dof;
    if (dof >= 0 && std::find(dofs.begin(), dofs.end(), dof) == dofs.end()) dofs.push_back(dof);
  }
  return dofs;
}

ReachSolution reach(const RobotModel& model, const RobotState& state, int body,
                    const Vector3d& point, const Vector3d& place, const std::vector<int>& dofs,
                    double room) {
  RobotState now = state;
  RobotData data(model);
  const auto there = [&] {
    update_positions(model, now, data);
    return Vector3d(data.pose(body) * point);
  };
  Vector3d at = there();
  ReachSolution best = {now.theta, (place - at).norm()};
  double damping = 1e-4;  // of the normal equations [m^2]
  std::vector<bool> held(dofs.size(), false);
  for (int round = 0; round < kRounds && best.missing > kThere; ++round) {
    const MatrixXd whole = body_jacobian(model, data, body, at).topRows<3>();
    MatrixXd jacobian = MatrixXd::Zero(3, static_cast<Eigen::Index>(dofs.size()));
    for (size_t i = 0; i < dofs.size(); ++i)
      if (!held[i]) jacobian.col(static_cast<Eigen::Index>(i)) = whole.col(6 + dofs[i]);
    const Eigen::Matrix3d normal =
        jacobian * jacobian.transpose() + damping * Eigen::Matrix3d::Identity();
    VectorXd step = jacobian.transpose() * normal.ldlt().solve(place - at);
    const double longest = step.size() ? step.cwiseAbs().maxCoeff() : 0;
    if (longest > kLongestStep) step *= kLongestStep / longest;
    now.theta = best.theta;
    bool blocked = false;
    for (size_t i = 0; i < dofs.size(); ++i) {
      const Dof& dof = model.dofs()[static_cast<size_t>(dofs[i])];
      const double wanted = now.theta[dofs[i]] + step[static_cast<Eigen::Index>(i)];
      const double kept = std::min(room, 0.5 * (dof.upper - dof.lower));
      now.theta[dofs[i]] = std::clamp(wanted, dof.lower + kept, dof.upper - kept);
      // A joint at its limit is left out, so that the others make up for it.
      if (now.theta[dofs[i]] != wanted && !held[i]) held[i] = blocked = true;
    }
    at = there();
    const double missing = (place - at).norm();
    if (missing < best.missing) {
      best = {now.theta, missing};
      damping = std::max(1e-9, damping / 4);
      if (!blocked) std::fill(held.begin(), held.end(), false);
    } else if (!blocked) {
      if (damping > 1) break;  // no step brings it nearer
      damping *= 8;
      now.theta = best.theta;
      at = there();
    }
  }
  return best;
}

}  // namespace ayumi
