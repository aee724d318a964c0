#pragma once
// The unknowns of the program, which are the free control points of the correction's spline, and
// the collocation points, which are the samples at which its rows are evaluated.

#include <Eigen/Geometry>
#include <array>
#include <set>
#include <utility>
#include <vector>

#include "ayumi/demand/contact_plan.hpp"
#include "ayumi/demand/ground_demand.hpp"
#include "ayumi/motion/correction.hpp"
#include "ayumi/repair/correction_spec.hpp"

namespace ayumi {

/// Which control points are free: a uniform cubic B-spline over base position, base rotation vector
/// and joints. Its first and last three control points stay zero, so that the motion starts and
/// ends as it did, or move as one where the posture there is at fault.
struct CorrectionVariables {
  CorrectionTrack zero;   ///< the track with zero coefficients
  Eigen::MatrixXi index;  ///< variable of control point (row) and column, or -1
  int count = 0;

  Eigen::MatrixXd coefficients(const Eigen::VectorXd& x) const;       ///< control points of x
  Eigen::VectorXd values(const Eigen::MatrixXd& coefficients) const;  ///< x of control points
  bool act_at(const SplineWeights& weights) const;  ///< whether a free one acts there
};
CorrectionVariables correction_variables(const RobotModel& model, const CommandSeries& series,
                                         const CorrectionSpec& spec);

/// A sample at which rows are evaluated.
struct CollocationPoint {
  int sample = 0;
  SplineWeights weights;                    ///< of the four control points that act there
  bool at_knot = false;                     ///< of the spline; else between two
  bool forces_known = true;                 ///< not at the edge of a flight, where rates jump
  SupportPlane plane;                       ///< of the planned contacts
  std::array<bool, 2> contact = {};         ///< by Side
  std::array<Eigen::Isometry3d, 2> ground;  ///< by Side: where the sole stands, or the ground below
  std::array<Eigen::Isometry3d, 2> path;    ///< by Side: where the given motion has the sole
  std::array<Eigen::Isometry3d, 2> place;   ///< by Side: where a swing leaves or lands, the nearer
  Eigen::Vector3d cog = Eigen::Vector3d::Zero();  ///< commanded [m]
  const CollisionModel* collisions = nullptr;     ///< of clearance rows
  /// Limits that alone have rows here, by group and item; empty: all have.
  std::set<std::pair<ConstraintGroup, int>> only;

  // Written while rows are placed.
  double zmp_margin = 0;                          ///< wanted, the least one included [m]
  Eigen::Vector2d dcm = Eigen::Vector2d::Zero();  ///< planned, of dcm rows [m]
  bool torques = false;                           ///< some row needs motor torques
};

/// At the knots and between them, at both ends of every contact interval, beside the edges of
/// flights, and at the times and limits that `spec` names; those that no variable moves are left
/// out. In order of time.
std::vector<CollocationPoint> collocation_points(const RobotModel& model,
                                                 const CommandSeries& series,
                                                 const ContactPlan& plan,
                                                 const CorrectionSpec& spec,
                                                 const CorrectionVariables& variables);

}  // namespace ayumi
