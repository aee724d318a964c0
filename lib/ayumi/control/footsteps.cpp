// dcm' = omega (dcm - Z): with Z on foothold p_k for one step, dcm - p_k grows by E. Landing on p_k
// with b_k = dcm - p_k therefore means b_k E = p_(k+1) - p_k + b_(k+1), solved backwards from the
// last foothold. In a steady walk this is b = L / (E - 1) along and -+W / (E + 1) across.
#include "ayumi/control/footsteps.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/math/elementary.hpp"
#include "ayumi/math/rotation.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

// Number of coming footholds that b takes into account. Derived: the effect of a foothold decreases
// by E = exp(2.1) = 8 with each step, so that the effect of the seventh is below 1e-5 of a step.
constexpr int kPreview = 6;

// Largest error of position that the steps correct, as a multiple of the distance of the feet.
// Chosen: with a larger error, the path is moved to the feet, so that the robot does not walk back
// fast after a push. No measured case changes between half and twice the value (constants.md).
constexpr double kLargestError = 0.35;

Vector2d turned_by(const Vector2d& v, double yaw) { return elementary::turn_in_plane(yaw) * v; }

double sign_of(Side side) { return side == Side::left ? 1.0 : -1.0; }

}  // namespace

GroundPose ground_pose(const RobotModel& model, Side side, const Isometry3d& sole) {
  const Vector2d& c = model.sole(side).center;
  return {(sole * Vector3d(c.x(), c.y(), 0)).head<2>(), matrix_to_rpy(sole.linear()).z()};
}

Isometry3d sole_frame(const RobotModel& model, Side side, const GroundPose& pose, double z) {
  Isometry3d frame = Isometry3d::Identity();
  frame.linear() = rpy_to_matrix({0, 0, pose.yaw});
  frame.translation().head<2>() = pose.position - turned_by(model.sole(side).center, pose.yaw);
  frame.translation().z() = z;
  return frame;
}

std::vector<Vector2d> landing_offsets(const std::vector<Vector2d>& footholds, double growth,
                                      const Vector2d& last) {
  std::vector<Vector2d> offsets(footholds.size(), last);
  for (size_t k = footholds.size() - 1; k-- > 0;)
    offsets[k] = (footholds[k + 1] - footholds[k] + offsets[k + 1]) / growth;
  return offsets;
}

Footsteps::Footsteps(const RobotModel& model, const std::array<Isometry3d, 2>& feet, double period,
                     double growth, double recovery, double inset)
    : period_(period), growth_(growth), recovery_(recovery), inset_(inset) {
  const GroundPose left = ground_pose(model, Side::left, feet[0]);
  const GroundPose right = ground_pose(model, Side::right, feet[1]);
  half_width_ = 0.5 * (left.position - right.position).norm();
  largest_error_ = kLargestError * 2 * half_width_;
  const double yaw = left.yaw + 0.5 * std::remainder(right.yaw - left.yaw, 2 * M_PI);
  center_ = {0.5 * (left.position + right.position), yaw};
}

GroundPose Footsteps::beside(const GroundPose& center, Side side) const {
  return {center.position + turned_by({0, sign_of(side) * half_width_}, center.yaw), center.yaw};
}

Vector2d Footsteps::zmp_on(Side side, const GroundPose& foot) const {
  return foot.position - turned_by({0, sign_of(side) * inset_}, foot.yaw);
}

// Sideways, the leading foot moves by twice the distance, and the other foot follows.
GroundPose Footsteps::moved(const GroundPose& center, const StepGoal& goal, Side swing,
                            int left) const {
  if (left <= 1) return center;
  const Side leading = goal.velocity.y() > 0 ? Side::left : Side::right;
  Vector2d move = period_ * goal.velocity;
  move.y() *= swing == leading ? 2 : 0;
  const double turn = period_ * goal.turn;
  return {center.position + turned_by(move, center.yaw + 0.5 * turn), center.yaw + turn};
}

PlannedStep Footsteps::step(const StepGoal& goal, Side stance, const GroundPose& foot, int left,
                            const Vector2d& rest) const {
  PlannedStep result{stance, zmp_on(stance, foot), {}, {}};
  Vector2d error = foot.position - beside(center_, stance).position;
  std::vector<Vector2d> zmps;  // nominal ZMPs, one on each foothold
  GroundPose center = center_;
  Side side = other(stance);
  const int count = std::min(left, kPreview);
  for (int k = 0; k < count; ++k, side = other(side)) {
    center = moved(center, goal, side, left - k);
    error *= 1 - recovery_;
    GroundPose place = beside(center, side);
    place.position += error;
    if (k == 0) result.landing = place;
    zmps.push_back(zmp_on(side, place));
  }
  const Vector2d after = count == left
                             ? Vector2d(center.position + error + turned_by(rest, center.yaw))
                             : zmp_on(side, beside(moved(center, goal, side, left - count), side));
  // At the end, the DCM stays where the robot should stand. If more steps follow, one more step is
  // assumed.
  const double share = count == left ? 1 : 1 / (growth_ + 1);
  result.offset = zmps.front() - result.landing.position +
                  landing_offsets(zmps, growth_, share * (after - zmps.back())).front();
  return result;
}

void Footsteps::meet(Side stance, const GroundPose& foot) {
  const Vector2d error = foot.position - beside(center_, stance).position;
  if (error.norm() > largest_error_)
    center_.position += error * (1 - largest_error_ / error.norm());
}

void Footsteps::advance(const StepGoal& goal, Side stance, int left) {
  center_ = moved(center_, goal, other(stance), left);
}

}  // namespace ayumi
