#pragma once
// Rows of the program that a repair solves. A row is a function g of one quantity q of the
// corrected motion at one sample, and the program keeps lower <= g(q) <= upper. For each row, a
// limit gives the quantity, the value, the derivative by the quantity and, if the program uses it,
// the curvature. The repair knows the quantities and their derivatives by the correction; it knows
// nothing about limits.

#include <Eigen/Geometry>
#include <functional>
#include <limits>
#include <variant>

#include "ayumi/demand/clearance_points.hpp"
#include "ayumi/demand/ground_demand.hpp"

namespace ayumi {

/// A bound that a row does not have.
inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();

// ---- the quantities, and the rows for each of them

/// Rows of the ground wrench (force, moment) about the support plane, in the axes of this plane
/// [N], [N m]. In flight, the plane is that of the world through the commanded COG.
struct WrenchRows {
  std::function<Eigen::VectorXd(const Vector6d& wrench)> value;
  std::function<Eigen::MatrixXd(const Vector6d& wrench)> gradient;  ///< rows x 6
  /// Second derivative by the tangential force, times a multiplier; empty if the rows are linear,
  /// or if their curvature is left out.
  std::function<Eigen::Matrix2d(const Vector6d& wrench, double multiplier)> curvature = {};
};
WrenchRows linear_rows(const Eigen::Matrix<double, Eigen::Dynamic, 6>& rows);

/// Second derivatives of rows of a sole's pose, times their multipliers: c is the weight of the
/// position, and K that of the rotation. Two rotations, about a and about b nearer to the root,
/// contribute a' K b - tr(K) a . b.
struct PoseCurvature {
  Eigen::Vector3d c = Eigen::Vector3d::Zero();
  Eigen::Matrix3d K = Eigen::Matrix3d::Zero();
  Eigen::Vector3d height = Eigen::Vector3d::Zero();  ///< direction whose squared height counts
  double square = 0;                                 ///< weight of this square
};

/// Rows of the pose of a sole.
struct SoleRows {
  Side side = Side::left;
  std::function<Eigen::VectorXd(const Eigen::Isometry3d& sole)> value;
  /// Rates of the rows when the sole moves. For each motion, `motion` has a column with the linear
  /// and angular velocity (world).
  std::function<Eigen::MatrixXd(const Eigen::Isometry3d& sole, const Eigen::MatrixXd& motion)> rate;
  std::function<void(const Eigen::Isometry3d& sole, const Eigen::VectorXd& multipliers,
                     PoseCurvature& sum)>
      add_curvature;
};

enum class JointQuantity { angle, speed, acceleration, motor_torque };

/// One row: a factor times a quantity of one joint. Before the factor, its unit is [rad] or [m],
/// the same per [s] or [s^2], or [N m] or [N]. For an angle or a speed, its own rate times the time
/// `lead` is added, as for servo targets.
struct JointRow {
  JointQuantity of = JointQuantity::angle;
  int dof = 0;
  double scale = 1;
  double lead = 0;  ///< time by which servo targets lead [s]
};

/// Rows of the clearance_points() of two shapes [m].
struct ClearanceRows {
  const CollisionModel* collisions = nullptr;
  ShapePair shapes;
};

/// Rows of the COG's offset from a point [m].
struct CogRows {
  Eigen::Vector3d from = Eigen::Vector3d::Zero();
};

/// Rows of the correction itself: base position [m], base rotation vector [rad], joints [rad] or
/// [m].
struct CorrectionRows {};

/// Rows of the horizontal offset of the DCM, COG + time * COG rate, from the point `from` [m],
/// followed by rows of the ground wrench.
struct DcmRows {
  Eigen::Vector2d from = Eigen::Vector2d::Zero();
  double time = 0;  ///< 1 / omega [s]
  WrenchRows zmp;
};

using RowRule =
    std::variant<WrenchRows, SoleRows, JointRow, ClearanceRows, CogRows, CorrectionRows, DcmRows>;

// ---- common properties of rows

/// The prices of violations, and the units in which violations are measured. The price of a
/// violation is its weight in the cost that the program minimizes. The repair fills in the values
/// from its policy.
struct RowPrices {
  double length = 0, angle = 0, share = 0;      ///< units: [m], [rad], 1
  double zmp_margin = 0, landing = 0, dcm = 0;  ///< prices of soft goals
  /// Price of a limit when the program is relaxed to find the reasons against a repair.
  double limit = 0;
  double foot = 0;  ///< price of feet in contact and of flight in this case; they are violated last
};

/// The place of rows among those of one sample: by group, then by item, then by line. The order
/// affects how the solver rounds its sums, so another order changes the last digits of a result.
struct RowOrder {
  int group = 99;
  int line = 0;
};

/// The properties of all rows that belong to the same rule. Rows of one kind and item share a slack
/// variable within a window of time if they may be violated at a price.
struct RowKind {
  const char* name = "";
  double RowPrices::*unit = &RowPrices::share;  ///< unit of a violation
  /// Price as a soft goal; null if the rows may not be violated.
  double RowPrices::*soft_goal = nullptr;
  /// Price if limits are relaxed; null if the rows may not be violated.
  double RowPrices::*relaxed = &RowPrices::limit;
  /// Whether it requires more than the check; then it counts as cost of robustness.
  bool beyond_check = false;
  RowOrder order = {};
};

/// Consecutive rows of one kind at one collocation point.
struct RowBlock {
  const RowKind* kind = nullptr;
  int point = 0;  ///< index of the CollocationPoint
  int item = 0;   ///< foot (by Side), dof, or pair of bodies
  RowRule rule;
  Eigen::VectorXd lower, upper;  ///< bounds of the rows
  /// If a single row is nearer to its bounds than this, it counts as active, and the repair places
  /// rows of its kind next to it; 0 if this never happens.
  double active = 0;
  /// Largest violation of a soft goal, in the unit of the rows.
  double most_violation = kUnbounded;
  int row = 0;  ///< index of the first row in the program; set by the repair

  int rows() const { return static_cast<int>(lower.size()); }
};

}  // namespace ayumi
