#pragma once
// Where VIIP puts the feet: a nominal path of footholds, and the DCM (divergent component of
// motion, x + dx/omega) that the pendulum must have when a foot lands so that the robot can
// continue on this path.

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/viip_goal.hpp"

namespace ayumi {

/// Place and heading on the ground.
struct GroundPose {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< [m]
  double yaw = 0;                                      ///< [rad]
};

/// Centre and heading of a sole.
GroundPose ground_pose(const RobotModel& model, Side side, const Eigen::Isometry3d& sole);
/// Level sole frame at height z [m] whose sole has its centre and heading at `pose`.
Eigen::Isometry3d sole_frame(const RobotModel& model, Side side, const GroundPose& pose, double z);

/// b of every foothold: the DCM less the foothold when the foot lands, so that the pendulum reaches
/// the next foothold's b after `growth` = exp(omega T) with its ZMP on this one; `last` is b of the
/// last foothold.
std::vector<Eigen::Vector2d> landing_offsets(const std::vector<Eigen::Vector2d>& footholds,
                                             double growth, const Eigen::Vector2d& last);

/// The ZMP that, held, takes the DCM to `end` while its distance from the ZMP grows by `growth`.
inline Eigen::Vector2d zmp_to_arrive(const Eigen::Vector2d& dcm, const Eigen::Vector2d& end,
                                     double growth) {
  return (end - dcm * growth) / (1 - growth);
}

/// One single support to come: stance foot, landing foot, and where the DCM is to be when it lands.
struct PlannedStep {
  Side stance = Side::left;
  Eigen::Vector2d stance_place;  ///< nominal ZMP on the stance sole [m]
  GroundPose landing;            ///< nominal
  Eigen::Vector2d offset;        ///< b of the landing foot
};

class Footsteps {
 public:
  /// `feet`: soles at the start; `period` of a step [s], `growth` of the DCM during it; `recovery`:
  /// share of an error of position that the next foothold takes back; `inset`: distance of the
  /// nominal ZMP from a sole's centre towards the other foot [m].
  Footsteps(const RobotModel& model, const std::array<Eigen::Isometry3d, 2>& feet, double period,
            double growth, double recovery, double inset = 0);

  /// Nominal ZMP while `side` supports alone.
  Eigen::Vector2d zmp_on(Side side, const GroundPose& foot) const;

  /// The step with `stance` on the ground where it now is. `left`: swings to come, this one
  /// included; the last one closes. `rest`: DCM wanted at the end, from the middle of the feet [m].
  PlannedStep step(const StepGoal& goal, Side stance, const GroundPose& foot, int left,
                   const Eigen::Vector2d& rest) const;

  /// Moves the path so that the stance foot is close enough to it to return.
  void meet(Side stance, const GroundPose& foot);

  /// Keeps the path in its place in the world when the plan is corrected by `error` [m].
  void shift(const Eigen::Vector2d& error) { center_.position -= error; }

  /// Advances the path by the step that has just begun.
  void advance(const StepGoal& goal, Side stance, int left);

 private:
  GroundPose moved(const GroundPose& center, const StepGoal& goal, Side swing, int left) const;
  GroundPose beside(const GroundPose& center, Side side) const;

  double period_, growth_, recovery_, inset_, half_width_;
  double largest_error_;  // of position that is taken back [m]
  GroundPose center_;     // of the feet on the path
};

}  // namespace ayumi
