#pragma once
// Where the feet are planned to be: constant while they carry, from foothold to foothold while they
// swing. Built from the start feet, the phases' swings and foot keys.

#include <array>
#include <optional>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// Of what is kept by Side, left first.
inline int index(Side side) { return static_cast<int>(side); }
/// That foot alone.
inline Support on(Side side) { return side == Side::left ? Support::left : Support::right; }

/// A swing moves over the ground between these shares of its phase: it lifts straight off and
/// comes down straight.
inline constexpr double kSwingMargin = 0.08;

/// Pose of the sole frame named by a foothold.
Eigen::Isometry3d pose_of(const Foothold& foothold);

/// Footholds at t = 0: those of the pattern, else of its default posture set level on z = 0 with
/// the middle of both sole frames at the origin (beside the given foot when one is given).
std::array<Eigen::Isometry3d, 2> start_feet(const RobotModel& model, const Pattern& pattern);

class FootPlan {
 public:
  /// Throws Error(bad_pattern) naming the phase or key: no phases, times not increasing, a swing of
  /// a supporting foot, a foot key that moves a supporting foot.
  FootPlan(const RobotModel& model, const Pattern& pattern);

  /// Pose of the sole frame in the world. A swing is minimum jerk along the ground with a lift
  /// 64 h (s (1 - s))^3 on top: speed and acceleration are zero at both ends. In flight a foot that
  /// neither swings nor has keys on the way takes up the COG's parabola within 40 ms and gives it
  /// back before it lands: it rises as high as the COG does.
  Eigen::Isometry3d pose(Side side, double t) const;

  /// Mean height of both soles, lifts left out: the ground under the robot [m].
  double ground(double t) const;

  /// Centre of the sole polygon, world [m].
  Eigen::Vector3d sole_center(Side side, double t) const;
  /// Middle of the centres of the supporting soles; of both in flight.
  Eigen::Vector3d support_center(double t) const;

  /// Phase in force at t; at its end the next one already is.
  int phase(double t) const;
  Support support(double t) const;
  double begin(int phase) const { return phase > 0 ? phases_[phase - 1].until : 0.0; }
  const std::vector<Phase>& phases() const { return phases_; }
  double duration() const { return phases_.back().until; }

 private:
  struct Move {
    double begin = 0, end = 0;
    Eigen::Isometry3d from, to;
    double lift = 0;
  };
  struct KeyedFoot {
    std::array<Track, 3> position, rpy;
    std::vector<double> times;  // of its keys [s]
  };
  void read_phases(const Pattern& pattern);
  void read_foot_keys(const Pattern& pattern, Side side);
  const Move* move_at(Side side, double t) const;
  double swing_lift(Side side, double t) const;
  double flight_lift(Side side, double t) const;
  Eigen::Isometry3d pose_without_flight(Side side, double t) const;

  std::vector<Phase> phases_;
  std::array<Eigen::Isometry3d, 2> start_;
  std::array<Eigen::Vector3d, 2> center_;  ///< of the sole polygons, sole frame
  std::array<std::vector<Move>, 2> moves_;
  std::array<std::optional<KeyedFoot>, 2> keyed_;
};

}  // namespace ayumi
