#pragma once
// What the program of a repair may move and what must hold: plain data, set up by repair_setup and
// changed from round to round.

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
  int item = 0;  ///< as in its RowBlock
};

struct CorrectionSpec {
  // What may move.
  double spacing = repair_policy::knots::kSpacing;  ///< of the knots [s]
  std::vector<TimeWindow> windows;                  ///< in which control points are free [s]
  std::array<bool, 2> free_ends = {};               ///< the first, the last posture may move
  std::vector<bool> locked;                         ///< by dof; empty: none
  std::vector<TimeWindow> locked_windows;           ///< in which nothing may move [s]
  std::vector<double> kept_times;                   ///< at which the posture may not change [s]
  std::array<bool, 2> locked_feet = {};             ///< by Side: keep their paths
  Eigen::VectorXd weights;  ///< factors on the weights of the joints [dof]; empty: 1
  Eigen::MatrixXd initial;  ///< control points to start from; empty: no correction

  bool planned_feet = false;  ///< swinging feet follow the planned ones, not the given motion

  // What is judged, as in the check.
  Trust trust = Trust::posture;
  const CollisionModel* collisions = nullptr;  ///< null: clearances are not watched
  std::vector<int> near_pairs;                 ///< pairs of bodies that are watched
  std::string profile;                         ///< of the actuators
  Tolerances tolerance = tolerances({});       ///< of the check
  double friction = 0.8;                       ///< coefficient of the ground

  // How far inside the check's limits.
  bool at_check_limits = false;  ///< every limit is where the check has it
  double joint_margin = repair_policy::kFirstBackoff.joint_position;  ///< inside soft limits [rad]
  double limit_share = repair_policy::kFirstBackoff.limit_share;  ///< of speed, torque, friction
  double zmp_margin = repair_policy::zmp::kLeastMargin;           ///< least, inside the support [m]
  double least_normal_force = repair_policy::kLeastNormalForce;   ///< over the weight
  double sole_position = repair_policy::stance::kPosition;        ///< half the band of a sole [m]
  double sole_angle = repair_policy::stance::kAngle;              ///< the same [rad]
  double sole_at_knots = repair_policy::stance::kShareAtKnots;    ///< share of that band at knots
  double clearance = repair_policy::clearance::kKept;             ///< between bodies [m]

  // Soft goals, beyond the check.
  double safe_margin = 0;   ///< of the ZMP where the motion's own is below the least [m]
  bool swing_goals = true;  ///< low soles level and over their places, the others high enough
  double dcm_slack = repair_policy::dcm::kSlack;     ///< half the band of the DCM [m]
  double zmp_slack = repair_policy::dcm::kZmpSlack;  ///< half the band of the ZMP with it [m]
  std::array<bool, 3> planned_cog = {};  ///< axes of the COG that stay near the commanded one
  std::vector<TimeWindow> wrong_plan;    ///< in which the commanded COG or ZMP is at fault [s]

  // Where rows are placed.
  int points_per_knot = repair_policy::collocation::kPerKnot;
  double watched_share = repair_policy::collocation::kWatchedShare;
  std::vector<double> extra_times;         ///< more collocation points [s]
  std::vector<ActiveLimit> active;         ///< rows of their own
  std::vector<const CommandSeries*> seen;  ///< earlier results, the last one last

  int threads = 0;  ///< of functions and derivatives; 0: all cores. They change no result.
};

}  // namespace ayumi
