#pragma once
// What the program of a repair may move, and which conditions it must fulfil. This is plain data,
// which repair_setup fills and which changes from round to round.

#include <Eigen/Core>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "ayumi/dynamics/self_collision.hpp"
#include "ayumi/limits/limit.hpp"
#include "ayumi/limits/row.hpp"
#include "ayumi/math/windows.hpp"
#include "ayumi/motion/command_series.hpp"
#include "ayumi/repair/policy.hpp"

namespace ayumi {

/// A limit that gets a row at one sample between two collocation points.
struct ActiveLimit {
  int sample = 0;
  const RowKind* kind = nullptr;
  int item = 0;  ///< item of the limit, as in its RowBlock
};

struct CorrectionSpec {
  // These members say what may move.
  double spacing = repair_policy::knots::kSpacing;  ///< time between the knots [s]
  std::vector<TimeWindow> windows;         ///< windows in which control points are free [s]
  std::array<bool, 2> free_ends = {};      ///< whether the first and the last posture may move
  std::vector<bool> locked;                ///< locked joints by dof; empty if there is none
  std::vector<TimeWindow> locked_windows;  ///< windows in which nothing may move [s]
  /// Windows of each dof in which it may not move, because it rests at a limit [s]; empty if none.
  std::vector<std::vector<TimeWindow>> resting;
  std::vector<double> kept_times;        ///< times at which the posture may not change [s]
  std::array<bool, 2> locked_feet = {};  ///< feet that keep their paths, by Side
  Eigen::VectorXd weights;  ///< factors on the weights of the joints by dof; empty if all are 1
  Eigen::MatrixXd initial;  ///< initial control points; empty for no correction

  // These members say what is judged, as in the check.
  Trust trust = Trust::posture;
  /// Shapes whose clearances are watched; null if there is none.
  const CollisionModel* collisions = nullptr;
  std::vector<int> near_pairs;            ///< pairs of bodies that are watched
  std::string profile;                    ///< limits of the actuators
  Tolerances tolerance = tolerances({});  ///< tolerances of the check
  double friction = 0.8;                  ///< friction coefficient of the ground

  // These are the distances that are kept from the check's limits.
  bool at_check_limits = false;  ///< if true, every limit is exactly that of the check
  double joint_margin =
      repair_policy::kFirstBackoff.joint_position;  ///< distance inside soft limits [rad]
  /// Share of the limits of speed, torque and friction that may be used.
  double limit_share = repair_policy::kFirstBackoff.limit_share;
  double zmp_margin =
      repair_policy::zmp::kLeastMargin;  ///< smallest ZMP margin inside the support [m]
  double least_normal_force =
      repair_policy::kLeastNormalForce;  ///< smallest normal force as a share of the weight
  double sole_position =
      repair_policy::stance::kPosition;               ///< half the band of a sole's position [m]
  double sole_angle = repair_policy::stance::kAngle;  ///< half the band of a sole's attitude [rad]
  double sole_at_knots = repair_policy::stance::kShareAtKnots;  ///< share of these bands at knots
  double clearance = repair_policy::clearance::kKept;  ///< smallest distance between bodies [m]

  // These are soft goals beyond the check.
  /// Wanted margin of the ZMP if the motion's own margin is below the smallest allowed one [m].
  double safe_margin = 0;
  bool swing_goals =
      true;  ///< low soles are level and over their places, and the others are high enough
  double dcm_slack = repair_policy::dcm::kSlack;  ///< half the band of the DCM [m]
  double zmp_slack =
      repair_policy::dcm::kZmpSlack;  ///< half the band of the ZMP while the DCM is held [m]
  std::vector<TimeWindow>
      wrong_plan;  ///< windows in which the commanded COG or ZMP is at fault [s]

  // These members say where rows are placed.
  int points_per_knot = repair_policy::collocation::kPerKnot;
  double watched_share = repair_policy::collocation::kWatchedShare;
  std::vector<double> extra_times;         ///< additional collocation points [s]
  std::vector<ActiveLimit> active;         ///< limits that get rows at single samples
  std::vector<const CommandSeries*> seen;  ///< earlier results, the latest one last

  /// Number of threads for functions and derivatives; 0 for all cores. Results do not depend on it.
  int threads = 0;
};

}  // namespace ayumi
