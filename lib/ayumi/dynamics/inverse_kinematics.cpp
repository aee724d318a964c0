// Unknowns: base position p and leg joints q_s. With e_s the error twist of sole s, A_s its
// Jacobian over its leg, E = [1; 0] that over p, C_s the COG Jacobian over q_s (over p it is 1):
//   E dp + A_s dq_s = e_s,   dp + sum C_s dq_s = e_c
// gives (1 - sum C_s A_s^-1 E) dp = e_c - sum C_s A_s^-1 e_s, then dq_s = A_s^-1 (e_s - E dp).
#include "ayumi/dynamics/inverse_kinematics.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/dynamics/cog_jacobian.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/rotation.hpp"

namespace ayumi {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

namespace {

constexpr std::array<Side, 2> kSides = {Side::left, Side::right};

// Residual at which Newton stops [m, rad]. Chosen: above the rounding of a leg's kinematics.
constexpr double kNewtonTolerance = 1e-12;

// Residual that is accepted when rounding keeps it above kNewtonTolerance [m, rad]. Chosen: far
// below the tolerances of the check.
constexpr double kAcceptedResidual = 1e-10;

// Largest step of a joint in one iteration [rad]. Chosen: Newton stays on its side of a straight
// knee.
constexpr double kLargestJointStep = 0.3;

// Weight of the COG against the feet in the damped solve. Chosen: large, so that what is out of
// reach shows at the feet and not at the COG.
constexpr double kCogWeight = 100;

bool contains(const std::vector<int>& list, int value) {
  return std::find(list.begin(), list.end(), value) != list.end();
}

}  // namespace

InverseKinematics::InverseKinematics(const RobotModel& model, const VectorXd& reference)
    : model_(&model), solved_(model.dof_count(), false), start_(reference) {
  for (const Side side : kSides) {
    auto& leg = legs_[static_cast<int>(side)];
    for (const int dof : model.leg(side))
      if (!contains(model.leg(other(side)), dof)) leg.push_back(dof);
    if (leg.empty())
      fail(ErrorCode::bad_model, model.name() + ": no joint moves the " + name_of(side) +
                                     " sole against the other; legs cannot be solved");
    for (const int dof : leg) solved_[dof] = true;
  }
  square_ = legs_[0].size() == 6 && legs_[1].size() == 6;
  if (!square_) return;
  RobotData data(model);
  RobotState state = model.rest_state();
  for (const Side side : kSides) {
    state.theta = start_;
    update_positions(model, state, data);
    const int knee = legs_[static_cast<int>(side)][3];
    const Dof& dof = model.dofs()[knee];
    const double length =
        (sole_pose(model, data, side).translation() - data.pose(dof.body).translation()).norm();
    // A straight leg has determinant 0: bend it towards the middle of the knee's range.
    if (std::abs(bend(data)[static_cast<int>(side)]) < 1e-2 * length * length * length) {
      const double middle = dof.limited ? 0.5 * (dof.lower + dof.upper) : 1.0;
      start_[knee] += std::copysign(0.3, middle - start_[knee]);
    }
  }
  state.theta = start_;
  update_positions(model, state, data);
  bend_ = bend(data);
}

double InverseKinematics::Residual::largest() const {
  return std::max(
      {foot[0].cwiseAbs().maxCoeff(), foot[1].cwiseAbs().maxCoeff(), cog.cwiseAbs().maxCoeff()});
}

InverseKinematics::Residual InverseKinematics::residual(const PostureTarget& target,
                                                        const RobotState& state,
                                                        RobotData& data) const {
  update_positions(*model_, state, data);
  Residual e;
  for (const Side side : kSides) {
    const int s = static_cast<int>(side);
    const Eigen::Isometry3d sole = sole_pose(*model_, data, side);
    e.foot[s].head<3>() = target.feet[s].translation() - sole.translation();
    e.foot[s].tail<3>() =
        log_rotation(Eigen::Quaterniond(target.feet[s].linear() * sole.linear().transpose()));
  }
  e.cog = target.cog - data.cog;
  return e;
}

// 6 x leg joints: twist of the sole, written for speed (body_jacobian has all columns).
MatrixXd InverseKinematics::leg_jacobian(const RobotData& data, Side side) const {
  const auto& leg = legs_[static_cast<int>(side)];
  const Sole& sole = model_->sole(side);
  const Vector3d p = data.position[sole.body] + data.rotation[sole.body] * sole.frame.translation();
  MatrixXd J = MatrixXd::Zero(6, static_cast<Eigen::Index>(leg.size()));
  for (int i = sole.body; i > 0; i = model_->bodies()[i].parent) {
    const Body& body = model_->bodies()[i];
    const auto found = std::find(leg.begin(), leg.end(), body.dof);
    if (found == leg.end()) continue;
    const auto column = found - leg.begin();
    const Vector3d a = body.ratio * data.axis[i];
    if (body.prismatic) {
      J.block<3, 1>(0, column) += a;
    } else {
      J.block<3, 1>(0, column) += a.cross(p - data.position[i]);
      J.block<3, 1>(3, column) += a;
    }
  }
  return J;
}

std::array<double, 2> InverseKinematics::bend(const RobotData& data) const {
  return {Matrix6d(leg_jacobian(data, Side::left)).determinant(),
          Matrix6d(leg_jacobian(data, Side::right)).determinant()};
}

void InverseKinematics::set_attitude(const PostureTarget& target, RobotState& state,
                                     RobotData& data) const {
  update_positions(*model_, state, data);
  const int trunk = model_->trunk_body();
  const Eigen::Matrix3d trunk_in_root = data.rotation[0].transpose() * data.rotation[trunk];
  state.base.attitude = Eigen::Quaterniond(target.trunk * trunk_in_root.transpose()).normalized();
}

bool InverseKinematics::newton(const PostureTarget& target, RobotState& state,
                               RobotData& data) const {
  double before = INFINITY;
  for (int iteration = 0; iteration < 25; ++iteration) {
    const Residual e = residual(target, state, data);
    const double largest = e.largest();
    if (largest <= kNewtonTolerance) return true;
    if (iteration > 3 && largest > 0.5 * before) return largest <= kAcceptedResidual;
    before = iteration > 1 ? largest : INFINITY;
    const MatrixXd C = cog_jacobian_floating(*model_, data);
    Eigen::Matrix<double, 6, 4> solved[2];  // A^-1 [E, e]
    Eigen::Matrix3d S = Eigen::Matrix3d::Identity();
    Vector3d right = e.cog;
    for (int s = 0; s < 2; ++s) {
      Eigen::Matrix<double, 6, 4> B = Eigen::Matrix<double, 6, 4>::Zero();
      B.topLeftCorner<3, 3>().setIdentity();
      B.col(3) = e.foot[s];
      solved[s] = Matrix6d(leg_jacobian(data, kSides[s])).partialPivLu().solve(B);
      for (int i = 0; i < 6; ++i) {
        const Vector3d c = C.col(6 + legs_[s][i]);
        S -= c * solved[s].row(i).head<3>();
        right -= c * solved[s](i, 3);
      }
    }
    const Vector3d dp = S.partialPivLu().solve(right);
    Eigen::Matrix<double, 6, 1> dq[2];
    double longest = 0;
    for (int s = 0; s < 2; ++s) {
      dq[s] = solved[s].col(3) - solved[s].leftCols<3>() * dp;
      longest = std::max(longest, dq[s].cwiseAbs().maxCoeff());
    }
    if (!std::isfinite(longest) || !dp.allFinite()) return false;
    const double scale = std::min(1.0, kLargestJointStep / std::max(longest, 1e-300));
    state.base.position += scale * dp;
    for (int s = 0; s < 2; ++s)
      for (int i = 0; i < 6; ++i) state.theta[legs_[s][i]] += scale * dq[s][i];
  }
  return false;
}

// Levenberg-Marquardt on all residuals, the COG weighted; returns the largest residual.
double InverseKinematics::damped(const PostureTarget& target, RobotState& state,
                                 RobotData& data) const {
  const auto n0 = static_cast<Eigen::Index>(legs_[0].size());
  const auto n1 = static_cast<Eigen::Index>(legs_[1].size());
  const auto stack = [](const Residual& e) {
    VectorXd r(15);
    r << e.foot[0], e.foot[1], kCogWeight * e.cog;
    return r;
  };
  Residual e = residual(target, state, data);
  double lambda = 1e-6;
  for (int iteration = 0; iteration < 200 && e.largest() > kNewtonTolerance; ++iteration) {
    MatrixXd J = MatrixXd::Zero(15, 3 + n0 + n1);
    J.block<3, 3>(0, 0).setIdentity();
    J.block<3, 3>(6, 0).setIdentity();
    J.block<3, 3>(12, 0) = kCogWeight * Eigen::Matrix3d::Identity();
    J.block(0, 3, 6, n0) = leg_jacobian(data, Side::left);
    J.block(6, 3 + n0, 6, n1) = leg_jacobian(data, Side::right);
    const MatrixXd C = cog_jacobian_floating(*model_, data);
    for (Eigen::Index i = 0; i < n0; ++i)
      J.block<3, 1>(12, 3 + i) = kCogWeight * C.col(6 + legs_[0][i]);
    for (Eigen::Index i = 0; i < n1; ++i)
      J.block<3, 1>(12, 3 + n0 + i) = kCogWeight * C.col(6 + legs_[1][i]);
    const VectorXd r = stack(e);
    MatrixXd H = J.transpose() * J;
    H.diagonal().array() += lambda;
    VectorXd d = H.ldlt().solve(J.transpose() * r);
    const double longest = d.tail(n0 + n1).cwiseAbs().maxCoeff();
    if (longest > kLargestJointStep) d *= kLargestJointStep / longest;
    RobotState trial = state;
    trial.base.position += d.head<3>();
    for (Eigen::Index i = 0; i < n0; ++i) trial.theta[legs_[0][i]] += d[3 + i];
    for (Eigen::Index i = 0; i < n1; ++i) trial.theta[legs_[1][i]] += d[3 + n0 + i];
    const Residual next = residual(target, trial, data);
    const double gain = r.squaredNorm() - stack(next).squaredNorm();
    if (gain > 0) {
      state = trial;
      e = next;
      lambda = std::max(1e-14, 0.2 * lambda);
      if (gain < 1e-14 * r.squaredNorm()) break;
    } else {
      lambda *= 8;
      residual(target, state, data);
      if (lambda > 1e6) break;
    }
  }
  return e.largest();
}

PostureSolution InverseKinematics::solve(const PostureTarget& target, RobotState& state,
                                         RobotData& data) const {
  PostureSolution solution;
  set_attitude(target, state, data);
  const VectorXd warm = state.theta;
  if (square_) solution.reached = newton(target, state, data);
  if (!solution.reached) {
    for (int dof = 0; dof < model_->dof_count(); ++dof)
      state.theta[dof] = solved_[dof] && square_ ? start_[dof] : warm[dof];
    if (square_) state.base.position = target.cog - (data.cog - data.base_position);
    solution.reached = damped(target, state, data) <= kAcceptedResidual;
  }
  const Residual e = residual(target, state, data);
  solution.error = e.largest();
  const double miss[2] = {e.foot[0].head<3>().norm(), e.foot[1].head<3>().norm()};
  solution.foot = miss[0] >= miss[1] ? Side::left : Side::right;
  solution.missing = std::max(miss[0], miss[1]);
  if (solution.reached && square_) {
    const auto now = bend(data);
    for (int s = 0; s < 2; ++s)
      if (now[s] * bend_[s] <= 0) {
        solution.knee_flipped = true;
        solution.foot = kSides[s];
      }
  }
  return solution;
}

}  // namespace ayumi
