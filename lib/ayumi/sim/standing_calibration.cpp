#include "ayumi/sim/standing_calibration.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

// A sole stands on an edge if the distance of the centre of pressure from the nearest edge is less
// than this share of the largest possible distance. Chosen: as in control/whole_body; a floor that
// slopes by 5 degrees leaves HOAP-1 a share of 0.6.
constexpr double kOnEdge = 0.15;

// An ankle turns until the centre of pressure of its sole is at this share of the largest possible
// distance from the edges; from the smaller share on, the sole counts as at rest. Chosen: half of
// the distance, and a smaller share for rest, so that the noise of the load cells does not end the
// rest.
constexpr double kInside = 0.5;
constexpr double kAtRest = 0.3;

// Tilt and distance of a sole of the planned posture from its planned place that count as zero
// [rad], [m]. Chosen: solved postures are a thousand times closer, and recorded postures are off by
// more.
constexpr double kPlanned = 1e-3;
constexpr double kNear = 1e-3;

// Smallest share of the weight on a standing foot. Chosen: as in control/estimator.
constexpr double kLeastLoad = 0.05;

// Rate at which an ankle turns while its sole stands on its edge [rad/s]. Chosen: one degree takes
// 0.6 s, which is slow compared with the rocking of the robot.
constexpr double kTurnRate = 0.03;

// Rate at which a common tilt of both soles is removed [1/s]. Chosen: tilts below 0.01 rad are
// removed more slowly than with kTurnRate.
constexpr double kLevelRate = 3;

// Time constant of the low pass of the centre of pressure [s]. Chosen: a period of the rocking at
// 30 Hz.
constexpr double kFilter = 0.03;

// Time constant of the low pass of the tilt of the soles [s]. Chosen: the noise of an IMU of 3 mrad
// then becomes 0.2 mrad, far below kLevel; it is also a third of the time constant of levelling.
constexpr double kTiltFilter = 0.1;

// Tilt of the soles that counts as level [rad], and time for which the soles have to be at rest
// [s]. Chosen: 0.2 degrees, by which the estimate of the attitude drifts; the time is 1.8 times the
// time constant of levelling, so that a sixth of the tilt is left.
constexpr double kLevel = 0.0035;
constexpr double kRest = 0.6;

// Smallest offset that is reported [rad]. Chosen: a third of a degree, more than the bias of
// HOAP-1's IMU of 5 mrad, by which all ankles turn.
constexpr double kReported = 0.006;

constexpr int kAnkleJoints = 2;  // Definition: the joints of a leg that are nearest to the foot

}  // namespace

StandingCalibration::StandingCalibration(const RobotModel& model, double dt)
    : model_(&model),
      dt_(dt),
      data_(model),
      offsets_(Eigen::VectorXd::Zero(model.dof_count())),
      turn_{Vector3d::Zero(), Vector3d::Zero()},
      cop_{Vector2d::Zero(), Vector2d::Zero()} {
  for (const Side side : {Side::left, Side::right}) {
    const auto s = static_cast<size_t>(side);
    sole_[s] = ConvexPolygon(model.sole(side).polygon);
    widest_[s] = sole_[s].margin(model.sole(side).center);
  }
}

double StandingCalibration::inside(Side side, const FootLoad& load) const {
  const auto s = static_cast<size_t>(side);
  return sole_[s].margin(load.cop) / widest_[s];
}

bool StandingCalibration::needed(const Measurement& m, const CommandSample& plan) {
  if (plan.support != Support::both) return false;
  update_positions(*model_, plan.state, data_);
  std::vector<Vector2d> corners;
  for (const Side side : {Side::left, Side::right}) {
    const auto s = static_cast<size_t>(side);
    const Isometry3d& foot = plan.feet[s];
    const Isometry3d sole = sole_pose(*model_, data_, side);
    const Vector3d turn = log_rotation(
        Eigen::Quaterniond(Eigen::Matrix3d(sole.linear() * foot.linear().transpose())));
    if (turn.head<2>().norm() > kPlanned ||
        (sole.translation() - foot.translation()).norm() > kNear)
      return false;
    for (const Vector2d& corner : model_->sole(side).polygon)
      corners.push_back((foot * Vector3d(corner.x(), corner.y(), 0)).head<2>());
  }
  if (ConvexPolygon(corners).margin(plan.zmp.head<2>()) < kInside * widest_[0]) return false;
  const double least = kLeastLoad * model_->mass() * kGravity;
  for (const Side side : {Side::left, Side::right}) {
    const FootLoad& load = m.feet[static_cast<size_t>(side)];
    if (load.fz < least || inside(side, load) < kOnEdge) return true;
  }
  return false;
}

// If a sole stands on its toes, the force of the ground turns it back, and the ankle follows. If
// the body leans over flat soles, it becomes upright when the soles turn further in the direction
// of the lean.
void StandingCalibration::update(const Measurement& m, const Estimate& e,
                                 const std::array<Isometry3d, 2>& feet) {
  const double least = kLeastLoad * model_->mass() * kGravity;
  update_positions(*model_, e.state, data_);
  std::array<Vector3d, 2> turn = {Vector3d::Zero(), Vector3d::Zero()};
  Vector3d tilt = Vector3d::Zero();
  bool rests = true;
  for (const Side side : {Side::left, Side::right}) {
    const auto s = static_cast<size_t>(side);
    const FootLoad& load = m.feet[s];
    const Eigen::Matrix3d sole = sole_pose(*model_, data_, side).linear();
    tilt += 0.5 *
            log_rotation(Eigen::Quaterniond(Eigen::Matrix3d(sole * feet[s].linear().transpose())));
    if (load.fz < least) {
      rests = false;
      continue;
    }
    cop_[s] += std::min(1.0, dt_ / kFilter) * (load.cop - model_->sole(side).center - cop_[s]);
    const FootLoad filtered = {load.fz, cop_[s] + model_->sole(side).center};
    const double share = inside(side, filtered);
    if (share >= kInside) continue;
    rests = rests && share >= kAtRest;
    turn[s] = sole * Vector3d(cop_[s].y(), -cop_[s].x(), 0) * (kTurnRate / cop_[s].norm());
  }
  tilt.z() = 0;
  tilt_ += std::min(1.0, dt_ / kTiltFilter) * (tilt - tilt_);
  rests = rests && tilt_.norm() < kLevel;
  at_rest_ = rests ? at_rest_ + dt_ : 0;
  for (const Side side : {Side::left, Side::right}) {
    const Vector3d rate = turn[static_cast<size_t>(side)] + kLevelRate * tilt_;
    turn_[static_cast<size_t>(side)] += dt_ * rate;
    const std::vector<int>& leg = model_->leg(side);
    for (size_t i = leg.size() >= kAnkleJoints ? leg.size() - kAnkleJoints : 0; i < leg.size(); ++i)
      offsets_[leg[i]] += dt_ * data_.axis[model_->dofs()[leg[i]].body].dot(rate);
  }
}

bool StandingCalibration::found() const { return (turn_[0] - turn_[1]).norm() >= kReported; }

bool StandingCalibration::done() const { return at_rest_ >= kRest; }

std::vector<std::string> StandingCalibration::lines() const {
  std::vector<std::string> lines;
  for (int j = 0; j < model_->dof_count(); ++j) {
    const double degrees = offsets_[j] * 180 / M_PI;
    if (std::abs(offsets_[j]) >= kReported)
      lines.push_back(
          "the encoder of " + model_->dofs()[j].name + " reads " +
          text::fixed(std::abs(degrees), 2) + " deg too " + (degrees > 0 ? "much" : "little") +
          (found() ? "; this was estimated while the robot stood, and is taken into account"
                   : ", or the ground slopes; the readings are used without a correction"));
  }
  return lines;
}

}  // namespace ayumi
