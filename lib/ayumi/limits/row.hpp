#pragma once
// Rows of the program that a repair solves. A row is a function g of one quantity q of the
// corrected motion at one sample, and the program keeps  lower <= g(q) <= upper.  A limit says
// which quantity a row is a function of, its value, its derivative by that quantity and, where the
// program uses it, its curvature. The repair knows the quantities and their derivatives by the
// correction; it knows nothing of limits.

#include <Eigen/Geometry>
#include <functional>
#include <limits>
#include <variant>

#include "ayumi/demand/clearance_points.hpp"
#include "ayumi/demand/ground_demand.hpp"

namespace ayumi {

/// A bound that a row does not have.
inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();

// ---- quantities, and what a row may be of each

/// Of the ground wrench about the support plane, in its axes (force, moment) [N], [N m]. In flight
/// the plane is that of the world through the commanded COG.
struct WrenchRows {
  std::function<Eigen::VectorXd(const Vector6d& wrench)> value;
  std::function<Eigen::MatrixXd(const Vector6d& wrench)> gradient;  ///< rows x 6
  /// Second derivative by the tangential force, times a multiplier; empty: the rows are linear, or
  /// their curvature is left out.
  std::function<Eigen::Matrix2d(const Vector6d& wrench, double multiplier)> curvature = {};
};
WrenchRows linear_rows(const Eigen::Matrix<double, Eigen::Dynamic, 6>& rows);

/// Second derivatives of rows of a sole's pose, times their multipliers: c weighs the position, K
/// the rotation. Two turns, one about a and one about b nearer to the root, add
/// a' K b - tr(K) a . b.
struct PoseCurvature {
  Eigen::Vector3d c = Eigen::Vector3d::Zero();
  Eigen::Matrix3d K = Eigen::Matrix3d::Zero();
  Eigen::Vector3d height = Eigen::Vector3d::Zero();  ///< direction whose squared height counts
  double square = 0;                                 ///< weight of that square
};

/// Of the pose of a sole.
struct SoleRows {
  Side side = Side::left;
  std::function<Eigen::VectorXd(const Eigen::Isometry3d& sole)> value;
  /// Rates of the rows when the sole moves: `motion` has a column of velocity and turn (world) for
  /// each motion.
  std::function<Eigen::MatrixXd(const Eigen::Isometry3d& sole, const Eigen::MatrixXd& motion)> rate;
  std::function<void(const Eigen::Isometry3d& sole, const Eigen::VectorXd& multipliers,
                     PoseCurvature& sum)>
      add_curvature;
};

enum class JointQuantity { angle, speed, acceleration, motor_torque };

/// One row: scale times a quantity of one joint, [rad] or [m], per [s], [s^2], or [N m], [N]. An
/// angle or a speed may lead: its own rate times a time is added, as for servo targets.
struct JointRow {
  JointQuantity of = JointQuantity::angle;
  int dof = 0;
  double scale = 1;
  double lead = 0;  ///< [s]
};

/// The clearance_points() of two shapes [m].
struct ClearanceRows {
  const CollisionModel* collisions = nullptr;
  ShapePair shapes;
};

/// The COG's offset from a point [m].
struct CogRows {
  Eigen::Vector3d from = Eigen::Vector3d::Zero();
};

/// The correction itself: base position [m], base rotation vector [rad], joints [rad] or [m].
struct CorrectionRows {};

/// The offset of the DCM, COG + time * COG rate, from a point along the ground [m], then rows of
/// the ground wrench.
struct DcmRows {
  Eigen::Vector2d from = Eigen::Vector2d::Zero();
  double time = 0;  ///< 1 / omega [s]
  WrenchRows zmp;
};

using RowRule =
    std::variant<WrenchRows, SoleRows, JointRow, ClearanceRows, CogRows, CorrectionRows, DcmRows>;

// ---- what rows have in common

/// Prices of violations, all in one unit, and what counts as 1 of a violation. The repair fills
/// them from its policy.
struct RowPrices {
  double length = 0, angle = 0, share = 0;      ///< units: [m], [rad], 1
  double zmp_margin = 0, landing = 0, dcm = 0;  ///< of soft goals
  double limit = 0;  ///< of a limit, where the program is relaxed to find what stands in the way
  double foot = 0;   ///< of feet in contact and of flight there: the last to be violated
};

/// The place of rows among those of one sample: by group, then by item, then by line. The order
/// decides how the solver rounds its sums, so that another order changes last digits of a result.
struct RowOrder {
  int group = 99;
  int line = 0;
};

/// Of all rows that keep the same rule. Rows of one kind and item share a slack variable within a
/// window of time, where they may be violated at a price.
struct RowKind {
  const char* name = "";
  double RowPrices::*unit = &RowPrices::share;     ///< of a violation
  double RowPrices::*soft_goal = nullptr;          ///< its price; null: hard, never violated
  double RowPrices::*relaxed = &RowPrices::limit;  ///< price where limits are relaxed; null: hard
  bool beyond_check = false;  ///< asks for more than the check: counts as cost of robustness
  RowOrder order = {};
};

/// Consecutive rows of one kind at one collocation point.
struct RowBlock {
  const RowKind* kind = nullptr;
  int point = 0;  ///< index of the CollocationPoint
  int item = 0;   ///< foot (by Side), dof, or pair of bodies
  RowRule rule;
  Eigen::VectorXd lower, upper;  ///< bounds of the rows
  /// Room to its bounds below which a single row counts as active, so that the repair puts rows of
  /// its kind beside it; 0: never.
  double active = 0;
  double most_violation = kUnbounded;  ///< of a soft goal, in the unit of the rows
  int row = 0;                         ///< index of the first row in the program; of the repair

  int rows() const { return static_cast<int>(lower.size()); }
};

}  // namespace ayumi
