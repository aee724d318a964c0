#pragma once
// The places where VIIP puts the feet. They follow from a nominal path of footholds, and from the
// DCM (divergent component of motion, x + dx/omega) that the pendulum must have when a foot lands,
// so that the robot can continue on this path.

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/viip_goal.hpp"

namespace ayumi {

/// A place and a heading on the ground.
struct GroundPose {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< place of the foothold [m]
  double yaw = 0;                                      ///< heading of the foothold [rad]
};

/// Centre and heading of a sole.
GroundPose ground_pose(const RobotModel& model, Side side, const Eigen::Isometry3d& sole);
/// The level sole frame at height z [m] for a sole whose centre and heading are `pose`.
Eigen::Isometry3d sole_frame(const RobotModel& model, Side side, const GroundPose& pose, double z);

/// The offset b [m] of every foothold: the DCM minus the foothold at the moment when the foot
/// lands. During a step with the ZMP on this foothold, the distance of the DCM from it grows by the
/// factor `growth` = exp(omega T). At the end, the DCM has the offset b of the next foothold from
/// that foothold. `last` is b of the last foothold.
std::vector<Eigen::Vector2d> landing_offsets(const std::vector<Eigen::Vector2d>& footholds,
                                             double growth, const Eigen::Vector2d& last);

/// The constant ZMP that takes the DCM to `end` while its distance from the ZMP grows by the factor
/// `growth`.
inline Eigen::Vector2d zmp_to_arrive(const Eigen::Vector2d& dcm, const Eigen::Vector2d& end,
                                     double growth) {
  return (end - dcm * growth) / (1 - growth);
}

/// One coming single support: the stance foot, the landing foot, and the place where the DCM should
/// be when this foot lands.
struct PlannedStep {
  Side stance = Side::left;
  Eigen::Vector2d stance_place;  ///< nominal ZMP on the stance sole [m]
  GroundPose landing;            ///< nominal place of the landing foot
  Eigen::Vector2d offset;        ///< b of the landing foot
};

class Footsteps {
 public:
  /// `feet` are the soles at the start, `period` is the duration of a step [s], and `growth` is the
  /// growth of the DCM during a step. `recovery` is the share of an error of position that the next
  /// foothold corrects. `inset` is the distance of the nominal ZMP from a sole's centre towards the
  /// other foot [m].
  Footsteps(const RobotModel& model, const std::array<Eigen::Isometry3d, 2>& feet, double period,
            double growth, double recovery, double inset = 0);

  /// The nominal ZMP while only the foot `side` supports the robot.
  Eigen::Vector2d zmp_on(Side side, const GroundPose& foot) const;

  /// The step with the foot `stance` on the ground at its present place. `left` is the number of
  /// coming swings, including this one; the last one brings the feet together. `rest` is the wanted
  /// DCM at the end, relative to the middle of the feet [m].
  PlannedStep step(const StepGoal& goal, Side stance, const GroundPose& foot, int left,
                   const Eigen::Vector2d& rest) const;

  /// Moves the path so near to the stance foot that the steps can return to it.
  void meet(Side stance, const GroundPose& foot);

  /// Keeps the path in its place in the world when the plan is corrected by `error` [m].
  void shift(const Eigen::Vector2d& error) { center_.position -= error; }

  /// Advances the path by the step that has just begun.
  void advance(const StepGoal& goal, Side stance, int left);

 private:
  GroundPose moved(const GroundPose& center, const StepGoal& goal, Side swing, int left) const;
  GroundPose beside(const GroundPose& center, Side side) const;

  double period_, growth_, recovery_, inset_, half_width_;
  double largest_error_;  // largest error of position that the steps correct [m]
  GroundPose center_;     // place of the middle of the feet on the path
};

}  // namespace ayumi
