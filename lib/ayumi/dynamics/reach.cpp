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

// Whether each body is an end of the robot: none hangs on it.
std::vector<bool> ends_of(const RobotModel& model) {
  std::vector<bool> end(model.bodies().size(), true);
  for (const Body& body : model.bodies())
    if (body.parent >= 0) end[static_cast<size_t>(body.parent)] = false;
  return end;
}

}  // namespace

std::vector<int> limb_dofs(const RobotModel& model, int body) {
  const auto& bodies = model.bodies();
  const std::vector<bool> end = ends_of(model);
  std::vector<int> ends_above(bodies.size(), 0);  // ends that a body carries, itself included
  for (size_t b = bodies.size(); b-- > 0;) {
    if (end[b]) ++ends_above[b];
    if (bodies[b].parent >= 0) ends_above[static_cast<size_t>(bodies[b].parent)] += ends_above[b];
  }
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
                    const Vector3d& point, const Vector3d& place, const std::vector<int>& dofs) {
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
      now.theta[dofs[i]] = std::clamp(wanted, dof.lower, dof.upper);
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
