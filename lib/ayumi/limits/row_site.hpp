#pragma once
// The data with which limits place their rows: the motion that is repaired, the samples at which
// the program evaluates rows, the earlier results that show which limits are near, and the
// distances that rows keep from the check's limits.

#include <array>
#include <map>
#include <utility>
#include <vector>

#include "ayumi/demand/contact_plan.hpp"
#include "ayumi/dynamics/robot_data.hpp"
#include "ayumi/limits/limit.hpp"
#include "ayumi/limits/row.hpp"
#include "ayumi/motion/correction.hpp"
#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// A sample at which rows are evaluated.
struct CollocationPoint {
  int sample = 0;
  SplineWeights weights;  ///< weights of the four control points that act there
  /// Whether the sample is at a knot of the spline; otherwise it is between two.
  bool at_knot = false;
  bool forces_known = true;  ///< false at the beginning and end of a flight, where rates jump
  SupportPlane plane;        ///< support plane of the planned contacts
  std::array<bool, 2> contact = {};  ///< planned contacts by Side
  /// Place of the sole, or of the ground below it, by Side.
  std::array<Eigen::Isometry3d, 2> ground;
  std::array<Eigen::Isometry3d, 2> path;  ///< pose of the sole in the given motion, by Side
  /// The nearer one of the places where a swing begins and ends, by Side.
  std::array<Eigen::Isometry3d, 2> place;
  /// The kinds and items that have rows here; empty if all of them have.
  std::vector<std::pair<const RowKind*, int>> only;
  bool torques = false;  ///< whether a row depends on motor torques; set when all rows are placed

  bool stands() const { return forces_known && !plane.empty(); }
  bool flies() const { return forces_known && plane.empty(); }
};

/// The ground wrench on each foot at a collocation point, about the base origin, by Side.
std::array<Vector6d, 2> shared_load(const RobotModel& model, const CollocationPoint& point,
                                    const Eigen::Vector3d& base, const Vector6d& base_wrench);

/// The values with which a repair places the rows. Their reasons and sources are in
/// repair/policy.hpp.
struct RowSettings {
  Trust trust = Trust::posture;
  /// Shapes of the robot; if null, there are no rows of clearances.
  const CollisionModel* collisions = nullptr;
  std::vector<int> near_pairs;           ///< pairs of bodies that are watched
  std::vector<bool> locked;              ///< locked joints by dof; empty if there is none
  std::array<bool, 2> locked_feet = {};  ///< feet that keep their paths, by Side
  /// Whether low soles should be level and over their places, and the others high enough.
  bool swing_goals = true;
  bool own_roughness = true;  ///< whether a joint may accelerate as much as in the given motion
  double watched_share =
      0;  ///< share of a limit that a watched sample must exceed for the limit to have rows
  double limit_share = 1;  ///< share of a limit that may be used
  double active = 0;  ///< value of RowBlock::active for most rows, a share of the limit or [rad]
  double trusted_share =
      0;  ///< share of the check's tolerance by which a trusted COG or ZMP may deviate
  double joint_margin = 0;   ///< distance inside the soft limits of a joint [rad]
  double sole_position = 0;  ///< half the band of a sole's position [m]

  // Values for single limits, which are named by their files.
  struct {
    double least = 0, safe = 0;  ///< smallest margin inside the support, and safe margin [m]
    /// Margin that is wanted near a margin below `least`; not less than `least` [m].
    double mended = 0;
    double safe_around = 0;  ///< time around a margin below `least` in which `mended` is wanted [s]
    double own_share = 0;    ///< share of its own margin that a motion keeps elsewhere
  } support;
  struct {
    double least = 0;  ///< smallest normal force as a share of the weight
    double light = 0;  ///< share of the weight below which the normal force has rows
  } normal_force;
  struct {
    /// Largest share of a step by which the row of its rate is made stricter because of a kink.
    double most_beyond = 0;
  } exported_table;
  struct {
    double cone_share = 1;  ///< a further factor on the friction that may be used
    /// Tangential force as a share of the weight at which the tip of the cone is rounded.
    double rounding = 0;
    double active = 0;  ///< RowBlock::active, as a share of the available friction
  } friction;
  struct {
    double own_share =
        0;            ///< share of the check's limit up to which the motion keeps its own rates
    double band = 0;  ///< half the band as a share of the check's limit, for three axes
  } flight;
  struct {
    double angle = 0;            ///< half the band of a sole's attitude [rad]
    double share_at_knots = 0;   ///< share of the band at knots
    double tolerance_share = 0;  ///< share of the check's tolerances that the band may use
    double corner_share =
        0;  ///< share of the tolerances by which a corner may rise or sink when the sole turns
    /// Time after landing and before lift-off in which a sole may deviate [s].
    double soft_time = 0;
    /// Share of the check's tolerance by which the motion may deviate in this time.
    double soft_share = 0;
    double soft_upwards = 0;  ///< share of the band upwards in this time
    /// Share of the height at which a swing may continue that a sole may have at a contact's edge.
    double edge_share = 0;
  } stance;
  struct {
    /// Time before landing and after lift-off in which a sole should be near its place [s].
    double near_place = 0;
    double place_slack = 0;           ///< offset that is always allowed for a low sole [m]
    double least_landing_height = 0;  ///< height as a share of the COG height
    double own_landing_factor = 0;    ///< factor on the median of the motion's own swings
    double lowest_measured = 0;       ///< smallest height of a sole that counts in this median [m]
    double landing_period = 0, height_period = 0;  ///< periods at which the swings are measured [s]
    double height_share = 0;                       ///< share of the swings' median height
    double watched_height = 0;  ///< height below which a sole has rows for the ground [m]
    /// Height by which a corner that scraped the ground passes above the check's limit [m].
    double scrape_backoff = 0;
  } swing;
  struct {
    double touch = 0;           ///< smaller clearances of the given motion are enlarged [m]
    double kept = 0;            ///< distance that bodies keep [m]
    double watched_bodies = 0;  ///< largest distance of a pair of bodies that has rows [m]
    double watched_shapes = 0;  ///< largest distance of shapes of such a pair that have rows [m]
    /// Distance by which a row of edges may be below the rows of corners [m].
    double edge_allowance = 0;
    double same_distance = 0;  ///< distance that edges_meet() receives [m]
  } clearance;
};

/// A range of angles [rad] or [m].
struct AngleRange {
  double lower = 0, upper = 0;
};

/// The range of a row: `kept`, which is inside `allowed` by a distance that keeps the motion
/// between two points inside, too. If the given value is between the two, the row only requires
/// this value. Otherwise, a joint that rests at its limit would have to move away from it.
AngleRange range_with_given(AngleRange kept, const AngleRange& allowed, double given,
                            double tolerance);

struct RowSite {
  const RobotModel& model;
  const CommandSeries& series;  ///< the given motion
  const ContactPlan& plan;
  const std::vector<CollocationPoint>& points;
  const std::vector<const CommandSeries*>& seen;  ///< earlier results, the latest one last
  const Tolerances& tolerances;                   ///< tolerances of the check
  const ActuatorLimits& actuators;
  double friction;  ///< friction coefficient of the ground
  RowSettings settings;
  std::vector<RowBlock> rows = {};  ///< rows that are placed so far
  /// Ground demands that watched_demand() keeps.
  std::map<int, std::vector<GroundDemand>> demand_of = {};
  RobotData data = RobotData(model);  ///< workspace of the inverse dynamics

  int count() const { return static_cast<int>(points.size()); }
  double tolerance(FindingKind kind) const { return tolerances[kind]; }
  double weight() const;  ///< weight [N]
  bool is_locked(int dof) const { return !settings.locked.empty() && settings.locked[dof]; }
  const CommandSample& given(int point) const { return series.samples[points[point].sample]; }

  /// The samples that decide whether a limit is near: first those of the given motion, and then
  /// those of every earlier result. If only the last result counted, a limit that its rows have
  /// corrected would lose these rows and be violated again.
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
  /// Adds a row for a quantity of a joint whose absolute value may reach `share` of `largest`. The
  /// row is only added if the watched samples reach `watched` and this is near enough to the limit.
  void add_largest(const RowKind& kind, int point, JointQuantity of, int dof, double watched,
                   double largest, double share, double active = 0);
};

}  // namespace ayumi
