#pragma once
// Where limits place their rows: the motion to be repaired, the samples at which the program
// evaluates rows, the earlier results that decide which limits are near, and how far inside the
// check's limits rows keep.

#include <array>
#include <map>
#include <utility>
#include <vector>

#include "ayumi/demand/contact_plan.hpp"
#include "ayumi/limits/limit.hpp"
#include "ayumi/limits/row.hpp"
#include "ayumi/motion/correction.hpp"
#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// A sample at which rows are evaluated.
struct CollocationPoint {
  int sample = 0;
  SplineWeights weights;  ///< weights of the four control points that act there
  bool at_knot = false;   ///< whether the sample is at a knot of the spline; else it is between two
  bool forces_known = true;                 ///< not at the edge of a flight, where rates jump
  SupportPlane plane;                       ///< support plane of the planned contacts
  std::array<bool, 2> contact = {};         ///< by Side
  std::array<Eigen::Isometry3d, 2> ground;  ///< by Side: where the sole stands, or the ground below
  std::array<Eigen::Isometry3d, 2> path;    ///< by Side: where the given motion has the sole
  std::array<Eigen::Isometry3d, 2> place;   ///< by Side: where a swing leaves or lands, the nearer
  /// Kinds and items that alone have rows here; empty: all have.
  std::vector<std::pair<const RowKind*, int>> only;
  bool torques = false;  ///< whether a row depends on motor torques; set when all rows are placed

  bool stands() const { return forces_known && !plane.empty(); }
  bool flies() const { return forces_known && plane.empty(); }
};

/// The ground wrench shared between the feet at a collocation point, about the base origin, by
/// Side.
std::array<Vector6d, 2> shared_load(const RobotModel& model, const CollocationPoint& point,
                                    const Eigen::Vector3d& base, const Vector6d& base_wrench);

/// What a repair requires of the rows. The values, their reasons and their sources are in
/// repair/policy.hpp.
struct RowSettings {
  Trust trust = Trust::posture;
  const CollisionModel* collisions = nullptr;  ///< null: there are no rows of clearances
  std::vector<int> near_pairs;                 ///< pairs of bodies that are watched
  std::vector<bool> locked;                    ///< locked joints by dof; empty: none
  std::array<bool, 2> locked_feet = {};        ///< feet that keep their paths, by Side
  bool swing_goals =
      true;  ///< low soles are level and over their places, the others are high enough
  bool own_roughness = true;  ///< a joint may accelerate as much as in the given motion
  double watched_share =
      0;  ///< a limit has rows where a watched sample uses a larger share than this
  double limit_share = 1;  ///< share of a limit that may be used
  double active = 0;       ///< RowBlock::active of most rows, a share of the limit or [rad]
  double trusted_share =
      0;  ///< share of the check's tolerance by which a trusted COG or ZMP may be off
  double joint_margin = 0;   ///< distance inside the soft limits of a joint [rad]
  double sole_position = 0;  ///< half the band of a sole's position [m]

  // Values for single limits, by the name of their file.
  struct {
    double least = 0, safe = 0;  ///< margins inside the support [m]
    double mended = 0;           ///< wanted around a margin below `least`; at least that [m]
    double safe_around = 0;      ///< time around too small a margin in which `safe` is wanted [s]
    double own_share = 0;        ///< share of its own margin that a motion keeps elsewhere
  } support;
  struct {
    double least = 0;  ///< normal force over the weight
    double light = 0;  ///< normal force over the weight: rows where the motion presses with less
  } normal_force;
  struct {
    double cone_share = 1;  ///< a further factor on the friction that may be used
    double rounding = 0;    ///< tangential force over the weight at which the cone's tip is rounded
    double active = 0;      ///< RowBlock::active, a share of the friction available
  } friction;
  struct {
    double own_share =
        0;            ///< share of the check's limit up to which the motion keeps its own rates
    double band = 0;  ///< half the band as a share of the check's limit, for three axes
  } flight;
  struct {
    double angle = 0;            ///< half the band of a sole's attitude [rad]
    double share_at_knots = 0;   ///< share of the band at knots
    double tolerance_share = 0;  ///< share of the check's tolerances that the band may have
    double corner_share =
        0;                 ///< share of them by which a corner may rise or sink when the sole turns
    double soft_time = 0;  ///< time beside landing and lift-off [s]
    double soft_share = 0;  ///< share of the check's tolerance by which the motion may be off then
    double soft_upwards = 0;  ///< share of the band upwards then
  } stance;
  struct {
    double near_place = 0;            ///< time beside landing and lift-off [s]
    double place_slack = 0;           ///< offset that a low sole may always have [m]
    double least_landing_height = 0;  ///< height as a share of the COG height
    double own_landing_factor = 0;    ///< factor on the median of the motion's own swings
    double lowest_measured = 0;       ///< height of a sole in that median [m]
    double landing_period = 0, height_period = 0;  ///< period of measuring the swings [s]
    double height_share = 0;                       ///< share of the swings' median height
    double watched_height = 0;  ///< height below which a sole has rows against the ground [m]
  } swing;
  struct {
    double touch = 0;           ///< clearances of the given motion below this are enlarged [m]
    double kept = 0;            ///< distance that bodies keep [m]
    double watched_bodies = 0;  ///< distance of a pair of bodies that has rows [m]
    double watched_shapes = 0;  ///< distance of shapes of such a pair [m]
    double edge_allowance = 0;  ///< distance of a row of edges below the rows of corners [m]
    double same_distance = 0;   ///< see edges_meet() [m]
  } clearance;
};

struct RowSite {
  const RobotModel& model;
  const CommandSeries& series;  ///< the motion as given
  const ContactPlan& plan;
  const std::vector<CollocationPoint>& points;
  const std::vector<const CommandSeries*>& seen;  ///< earlier results, the latest one last
  const Tolerances& tolerances;                   ///< tolerances of the check
  const ActuatorLimits& actuators;
  double friction;  ///< friction coefficient of the ground
  RowSettings settings;
  std::vector<RowBlock> rows = {};                          ///< rows that are placed so far
  std::map<int, std::vector<GroundDemand>> demand_of = {};  ///< see watched_demand()

  int count() const { return static_cast<int>(points.size()); }
  double tolerance(FindingKind kind) const { return tolerances[kind]; }
  double weight() const;  ///< weight [N]
  bool is_locked(int dof) const { return !settings.locked.empty() && settings.locked[dof]; }
  const CommandSample& given(int point) const { return series.samples[points[point].sample]; }

  /// The samples that decide whether a limit is near: of the motion as given, which is the first,
  /// and of every earlier result. With the last result alone, a limit that its rows have mended
  /// would lose them and be violated again.
  std::vector<const CommandSample*> watched(int point) const;
  /// The demands on the ground at a point with support.
  const std::vector<GroundDemand>& watched_demand(int point);
  /// The largest value of a figure over the watched samples, at least 0.
  double most(int point, const std::function<double(const CommandSample&)>& figure) const;

  /// Adds rows, with the same bounds for all of them or with one bound for each.
  RowBlock& add(const RowKind& kind, int point, int item, RowRule rule,
                const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);
  RowBlock& add(const RowKind& kind, int point, int item, RowRule rule, int rows, double lower,
                double upper);
  /// Adds a row for a quantity of a joint that may reach `share` of `largest` in both directions.
  /// The row is added only if the watched samples reach `watched` and this is near enough.
  void add_largest(const RowKind& kind, int point, JointQuantity of, int dof, double watched,
                   double largest, double share, double active = 0);
};

}  // namespace ayumi
