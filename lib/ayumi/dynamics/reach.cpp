#include "ayumi/dynamics/reach.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/linear_solve.hpp"
#include "ayumi/model/foot_bodies.hpp"
#include "ayumi/model/outline.hpp"

namespace ayumi {

namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

// Largest number of iterations. Chosen: an iteration that converges quadratically needs ten; near
// limits and with stretched arms it takes more.
constexpr int kRounds = 200;
// A point has reached its place if it is this near [m]. Chosen: a hundredth of a millimetre; no
// hand is more accurate.
constexpr double kThere = 1e-5;
// Largest change of a joint in a round [rad, m]. Chosen: small enough for the linear model to hold.
constexpr double kLongestStep = 0.2;

// A body from which several chains of joints branch off is the end of its limb if the longest of
// these chains is shorter than this share of the limb's length up to this body. Chosen: fingers are
// a fifth as long as the arm that carries them, but arms are twice as long as the chest that
// carries them.
constexpr double kPartOfLimb = 0.5;

}  // namespace

std::vector<int> limb_ends(const RobotModel& model) {
  const auto& bodies = model.bodies();
  std::vector<int> children(bodies.size(), 0);
  // Distance from each body's joint to the farthest joint that it carries [m].
  std::vector<double> carried(bodies.size(), 0);
  for (size_t b = bodies.size(); b-- > 1;) {
    const auto parent = static_cast<size_t>(bodies[b].parent);
    ++children[parent];
    carried[parent] =
        std::max(carried[parent], carried[b] + bodies[b].placement.translation().norm());
  }
  // Length from the place where the limb branches off [m].
  std::vector<double> limb(bodies.size(), 0);
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
  std::vector<int> ends_above(bodies.size(), 0);  // number of ends that a body carries, with itself
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

namespace {

// A limb whose end is nearer than this to the middle plane, in the rest posture, is not an arm [m].
// Chosen: necks lie within it.
constexpr double kMiddle = 0.02;

// The ends of limbs that are not feet, and the positions of their joints at rest [m].
std::vector<std::pair<int, Vector3d>> free_ends(const RobotModel& model) {
  RobotData data(model);
  update_positions(model, model.rest_state(), data);
  std::vector<std::pair<int, Vector3d>> ends;
  for (const int body : limb_ends(model))
    if (!is_of_foot(model, body)) ends.emplace_back(body, data.position[static_cast<size_t>(body)]);
  return ends;
}

}  // namespace

int hand_body(const RobotModel& model, Side side) {
  int best = -1;
  size_t most = 2;
  for (const auto& [body, place] : free_ends(model)) {
    const size_t joints = limb_dofs(model, body).size();
    if ((side == Side::left ? place.y() : -place.y()) < kMiddle || joints <= most) continue;
    best = body;
    most = joints;
  }
  return best;
}

int head_body(const RobotModel& model) {
  RobotData data(model);
  update_positions(model, model.rest_state(), data);
  int best = -1;
  double height = data.position[static_cast<size_t>(model.trunk_body())].z();
  for (const auto& [body, place] : free_ends(model)) {
    if (std::abs(place.y()) > kMiddle || place.z() < height) continue;
    best = body;
    height = place.z();
  }
  return best;
}

Vector3d gaze_axis(const RobotModel& model, int head) {
  RobotState state = model.rest_state();
  state.theta.setZero();
  RobotData data(model);
  update_positions(model, state, data);
  return data.rotation[head].transpose() * data.rotation[model.trunk_body()].col(0);
}

Vector3d limb_point(const RobotModel& model, int body) {
  Eigen::AlignedBox3d box;
  for (const Link& link : model.links()) {
    if (link.body != body) continue;
    for (const PlacedShape& placed : link.collisions)
      for (const Vector3d& point : outline(placed.shape))
        box.extend(Vector3d(link.pose * placed.pose * point));
  }
  if (box.isEmpty()) return 2 * model.bodies()[static_cast<size_t>(body)].inertia.com;
  Vector3d end = box.center();
  const Vector3d reach = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs());
  Eigen::Index along = 0;
  reach.maxCoeff(&along);
  end[along] =
      std::abs(box.min()[along]) > std::abs(box.max()[along]) ? box.min()[along] : box.max()[along];
  return end;
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
  double damping = 1e-4;  // damping of the normal equations [m^2]
  std::vector<bool> held(dofs.size(), false);
  for (int round = 0; round < kRounds && best.missing > kThere; ++round) {
    const MatrixXd whole = body_jacobian(model, data, body, at).topRows<3>();
    MatrixXd jacobian = MatrixXd::Zero(3, static_cast<Eigen::Index>(dofs.size()));
    for (size_t i = 0; i < dofs.size(); ++i)
      if (!held[i]) jacobian.col(static_cast<Eigen::Index>(i)) = whole.col(6 + dofs[i]);
    const Eigen::Matrix3d normal =
        jacobian * jacobian.transpose() + damping * Eigen::Matrix3d::Identity();
    VectorXd step = jacobian.transpose() * solve_symmetric(normal, place - at);
    const double longest = step.size() ? step.cwiseAbs().maxCoeff() : 0;
    if (longest > kLongestStep) step *= kLongestStep / longest;
    now.theta = best.theta;
    bool blocked = false;
    for (size_t i = 0; i < dofs.size(); ++i) {
      const Dof& dof = model.dofs()[static_cast<size_t>(dofs[i])];
      const double wanted = now.theta[dofs[i]] + step[static_cast<Eigen::Index>(i)];
      const double kept = std::min(room, 0.5 * (dof.upper - dof.lower));
      now.theta[dofs[i]] = std::clamp(wanted, dof.lower + kept, dof.upper - kept);
      // A joint at its limit is left out, so that the other joints do its part.
      if (now.theta[dofs[i]] != wanted && !held[i]) held[i] = blocked = true;
    }
    at = there();
    const double missing = (place - at).norm();
    if (missing < best.missing) {
      best = {now.theta, missing};
      damping = std::max(1e-9, damping / 4);
      if (!blocked) std::fill(held.begin(), held.end(), false);
    } else if (!blocked) {
      if (damping > 1) break;  // no step brings the point nearer any more
      damping *= 8;
      now.theta = best.theta;
      at = there();
    }
  }
  return best;
}

}  // namespace ayumi
