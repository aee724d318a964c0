#pragma once
// Moves a point of a link to a place by some of the joints only, such as a hand by the joints of
// its arm. The base and all other joints stay.

#include <vector>

#include "ayumi/dynamics/robot_data.hpp"

namespace ayumi {

struct ReachSolution {
  /// Positions of all joints; those that may move are within their limits [rad, m].
  Eigen::VectorXd theta;
  double missing = 0;  ///< distance of the point from its place [m]
};

/// Bodies at which the limbs end. These are bodies that carry no other body, and bodies from which
/// several chains of joints, such as fingers, branch off. All these chains must be less than half
/// as long as the limb up to this body.
std::vector<int> limb_ends(const RobotModel& model);

/// The joints that move this body and no other end of a limb, listed from the body towards the
/// root, up to the first joint that also moves another foot, hand or head.
std::vector<int> limb_dofs(const RobotModel& model, int body);

/// The end of a limb on this side that is no foot and has at least three joints of its own. If
/// there are several, it is the one with most joints; if there is none, -1.
int hand_body(const RobotModel& model, Side side);

/// The highest end of a limb in the middle plane, above the trunk; -1 if the robot has no neck.
int head_body(const RobotModel& model);

/// The direction in which a head looks: forward when all joints are 0 (frame of the body).
Eigen::Vector3d gaze_axis(const RobotModel& model, int head);

/// The far end of a body as seen from its joint, in the body frame: the middle of the far side of
/// the box around its collision shapes. For a body without shapes it is the point twice as far away
/// as its centre of mass.
Eigen::Vector3d limb_point(const RobotModel& model, int body);

/// Damped least squares from the posture of `state`. Of all postures near it, the result is one
/// that brings `point` (frame of `body`) to `place` (world), or as near as the limits of `dofs`
/// allow. The joints keep `room` [rad, m] from these limits where their range is wide enough.
ReachSolution reach(const RobotModel& model, const RobotState& state, int body,
                    const Eigen::Vector3d& point, const Eigen::Vector3d& place,
                    const std::vector<int>& dofs, double room = 0);

}  // namespace ayumi
