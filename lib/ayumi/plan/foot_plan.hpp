#pragma once
// The planned places of the feet: constant while they support, from foothold to foothold while they
// swing. They are computed from the feet at the start, the swings of the phases, and foot keys.

#include <array>
#include <optional>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// Index of arrays by Side; the left side is first.
inline int index(Side side) { return static_cast<int>(side); }
/// The single support by the foot `side`.
inline Support on(Side side) { return side == Side::left ? Support::left : Support::right; }

/// Fraction at both ends of a swing in which the foot moves only up or down. Chosen: the lift at 8
/// % is 2.5 % of its maximum, 0.5 mm of 20 mm, so that the foot is off the ground when it moves.
/// Between half and twice the value, figures change by less than 5 %.
inline constexpr double kSwingMargin = 0.08;

/// Pose of the sole frame at a foothold.
Eigen::Isometry3d pose_of(const Foothold& foothold);

/// Footholds at t = 0: those of the pattern. If it gives none, they come from its default posture:
/// on z = 0, with the middle of both sole frames at the origin. If it gives one, the other foot has
/// its place in the default posture relative to the given one.
std::array<Eigen::Isometry3d, 2> start_feet(const RobotModel& model, const Pattern& pattern);

/// Time over which the feet take up the COG's speed in a flight [s]. Chosen: shorter than half of a
/// flight, longer than a servo's delay. With half of the value, the case "jump" is inconsistent;
/// with twice, the moment in flight changes from 0.0353 to 0.00372 N m.
inline constexpr double kFlightRamp = 0.04;

class FootPlan {
 public:
  /// Throws Error(bad_pattern) that names the phase or key if there are no phases, if times do not
  /// increase, if a supporting foot swings, or if a foot key moves a supporting foot.
  FootPlan(const RobotModel& model, const Pattern& pattern, double flight_ramp = kFlightRamp);

  /// Pose of the sole frame in the world. A swing is minimum jerk along the ground with an added
  /// lift of 64 h (s (1 - s))^3, so that speed and acceleration are zero at both ends. A foot that
  /// neither swings nor has keys in a flight follows the COG's parabola, faded in and out over
  /// `flight_ramp` [s], and rises as high as the COG.
  Eigen::Isometry3d pose(Side side, double t) const;
  /// Poses of both soles.
  std::array<Eigen::Isometry3d, 2> poses(double t) const {
    return {pose(Side::left, t), pose(Side::right, t)};
  }

  /// Weight with which a foot keeps its place. It is 1 while the foot carries the robot and in
  /// flights. While only the other foot carries the robot, the weight falls to 0 in the middle of
  /// this time and returns to 1. Its first two derivatives are zero at both ends.
  double hold(Side side, double t) const;

  /// Mean height of both soles without lifts, which is the ground under the robot [m].
  double ground(double t) const;

  /// Centre of the sole polygon, world [m].
  Eigen::Vector3d sole_center(Side side, double t) const;
  /// Mean of the centres of the supporting soles. In flight, the mean of both soles.
  Eigen::Vector3d support_center(double t) const;

  /// Index of the phase at t; the end of a phase belongs to the next one.
  int phase(double t) const;
  Support support(double t) const;
  double begin(int phase) const { return phase > 0 ? phases_[phase - 1].until : 0.0; }
  /// The phases of the pattern, with footholds instead of steps.
  const std::vector<Phase>& phases() const { return phases_; }
  double duration() const { return phases_.back().until; }

 private:
  struct Move {
    double begin = 0, end = 0;   ///< begin and end of the swing [s]
    Eigen::Isometry3d from, to;  ///< poses of the sole frame in the world
    double lift = 0;             ///< largest height above the path from `from` to `to` [m]
    Eigen::Vector3d turn;  ///< rotation vector from `from` to `to`, in the axes of `from` [rad]
  };
  struct KeyedFoot {
    std::array<Track, 3> position, rpy;
    std::vector<double> times;  // times of the keys of this foot [s]
  };
  void read_phases(const Pattern& pattern);
  /// World pose of the sole after a step. `now` are the soles before the step.
  Eigen::Isometry3d landing_of(const Swing& swing, const RelativeStep& step,
                               const std::array<Eigen::Isometry3d, 2>& now) const;
  void read_foot_keys(const Pattern& pattern, Side side);
  const Move* move_at(Side side, double t) const;
  double swing_lift(Side side, double t) const;
  double flight_lift(Side side, double t) const;
  Eigen::Isometry3d pose_without_flight(Side side, double t) const;

  std::vector<Phase> phases_;
  double flight_ramp_;
  std::array<Eigen::Isometry3d, 2> start_;
  std::array<Eigen::Vector3d, 2> center_;  ///< centres of the sole polygons, in the sole frame [m]
  std::array<std::vector<Move>, 2> moves_;
  std::array<std::optional<KeyedFoot>, 2> keyed_;
};

}  // namespace ayumi
