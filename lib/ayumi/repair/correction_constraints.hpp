#pragma once
// The constraints of a corrected motion at one sample, and their exact derivatives. Values are the
// residuals of check/residuals.hpp; derivatives go by the correction's value, rate and acceleration
// at that sample (6 + dof columns: base position, base rotation vector, joints).

#include <array>
#include <vector>

#include "ayumi/demand/ground_demand.hpp"
#include "ayumi/dynamics/self_collision.hpp"
#include "ayumi/dynamics/tree_dynamics.hpp"
#include "ayumi/motion/correction.hpp"
#include "ayumi/repair/clearance_rows.hpp"
#include "ayumi/repair/corrected_motion.hpp"

namespace ayumi {

/// support: f_n (ZMP inside each edge - margin) / (m g) [m]; unilateral: f_n / (m g);
/// friction: (mu f_n - f_t) / (m g), f_t the root of a sum of squares with 1e-4 m g; flight: ground
/// force / (m g) and moment / (m g) about the planned COG; zmp: f_n (ZMP - commanded ZMP) / (m g)
/// [m]; yaw: (lever f_n -+ yaw moment about the ZMP) / (m g) [m], the lever held as it is in the
/// motion; stance: sole from its place, position [m] and rotation [rad]; path: the same from where
/// the motion has it; swing: corner heights [m]; foot_clearance: the same; landing: factor h^2 less
/// the way of a sole from its place, along it or, times half its size, around three axes, either
/// way, h its height [m]; position: joint angle [rad]; speed: joint speed / limit; acceleration:
/// joint acceleration / limit; torque: motor torque / limit; clearance: clearance_rows.hpp [m];
/// cog: from the commanded COG [m]; pose: the correction itself, base position [m], base rotation
/// vector and joints [rad]; capture: xi, COG + its rate / omega, from the planned one along the
/// ground [m], then as zmp.
enum class ConstraintGroup {
  support,
  unilateral,
  friction,
  flight,
  zmp,
  yaw,
  stance,
  path,
  swing,
  landing,
  foot_clearance,
  position,
  speed,
  acceleration,
  torque,
  clearance,
  cog,
  pose,
  capture
};
const char* name_of(ConstraintGroup group);

/// A sample at which constraints are evaluated.
struct CollocationPoint {
  int sample = 0;
  SplineWeights weights;
  bool at_knot = false;                     ///< of the spline; else between two
  bool known = true;                        ///< no flight edge: what it asks of the ground is told
  SupportPlane plane;                       ///< of the planned contacts
  std::array<bool, 2> contact = {};         ///< by Side
  std::array<Eigen::Isometry3d, 2> ground;  ///< by Side: where the foot stands, or the ground below
  std::array<Eigen::Isometry3d, 2> path;    ///< by Side: where the motion has it
  std::array<Eigen::Isometry3d, 2> place;   ///< by Side: where a swing leaves or lands, the nearer
  Eigen::Vector3d cog = Eigen::Vector3d::Zero();  ///< commanded [m]
  Eigen::Vector2d xi = Eigen::Vector2d::Zero();   ///< planned, of capture blocks [m]
  bool torques = false;                           ///< some block asks for them
  const CollisionModel* collisions = nullptr;     ///< of clearance blocks
};

/// Consecutive rows of the constraint vector that belong together.
struct ConstraintBlock {
  ConstraintGroup group = ConstraintGroup::support;
  int instant = 0;        ///< index of its CollocationPoint
  int item = 0;           ///< foot (by Side), dof, or pair of bodies
  ShapePair shapes;       ///< of clearance blocks
  int row = 0, rows = 0;  ///< first and number
  double scale = 1;       ///< of yaw and friction rows: 1 / (m g); of joint rows: 1 / limit
  double factor = 0;      ///< of yaw rows: friction times lever [m]; mu; of landing rows [1/m];
                          ///< of capture rows: 1 / omega [s]
  Eigen::Matrix<double, Eigen::Dynamic, 6> wrench_rows;  ///< of linear ground groups
};

/// Without what only some groups have.
ConstraintBlock block_of(ConstraintGroup group, int instant, int item, int rows, double scale = 1);

/// What the blocks of one instant share.
struct PointState {
  Eigen::VectorXd change;  ///< value of the correction (6 + dof)
  CorrectedMotion motion;
  Vector6d wrench = Vector6d::Zero();        ///< of the ground, about the base
  std::array<Eigen::MatrixXd, 3> wrench_by;  ///< 6 x (6+dof) by value, rate, acceleration
  std::array<Eigen::Isometry3d, 2> soles;    ///< by Side
  std::array<Eigen::MatrixXd, 2> sole_by;    ///< 6 x (6+dof) by value
  Eigen::MatrixXd cog_by;                    ///< 3 x (6+dof) by value
  Eigen::VectorXd torque;                    ///< where the instant asks for it [dof]
  std::array<Eigen::MatrixXd, 3> torque_by;  ///< dof x (6+dof)
  /// The workspace it was computed in; holds until the next point_state().
  RobotData* data = nullptr;
};
/// `derivatives`: what computes them; null: values alone.
PointState point_state(const RobotModel& model, const CommandSample& sample,
                       const CollocationPoint& instant, const Eigen::MatrixXd& coefficients,
                       TreeDynamics* derivatives, RobotData& data);

/// Position [m] and rotation [rad], world axes, of a sole from where it should be: a stance row.
Vector6d sole_deviation(const Eigen::Isometry3d& actual, const Eigen::Isometry3d& planned);

/// How a sole is off its place but for its height over it, the rows of a landing with factor 0:
/// along the ground and, times half the sole's size, around three axes [m].
Eigen::Matrix<double, 5, 1> landing_way(const RobotModel& model, Side side,
                                        const Eigen::Isometry3d& actual,
                                        const Eigen::Isometry3d& place);

/// From the deviation of a sole to landing_way().
Eigen::Matrix<double, 5, 6> landing_rows(const RobotModel& model, Side side,
                                         const Eigen::Isometry3d& place);

/// Whether rows are functions of the ground wrench; then their derivative by the plane wrench.
bool is_of_ground(ConstraintGroup group);
Eigen::MatrixXd ground_gradient(const ConstraintBlock& block, const Vector6d& plane_wrench);

/// f_t of a friction row, without a kink at 0 [N].
double cone_size(const ConstraintBlock& block, const Vector6d& plane_wrench);

/// Columns of the correction that a block depends on.
std::vector<int> block_columns(const RobotModel& model, const ConstraintBlock& block,
                               const CollocationPoint& instant);

Eigen::VectorXd block_values(const RobotModel& model, const ConstraintBlock& block,
                             const CollocationPoint& instant, const PointState& state);

/// By value, rate and acceleration, rows x (6+dof) each; an empty matrix where all is zero.
std::array<Eigen::MatrixXd, 3> block_derivatives(const RobotModel& model,
                                                 const ConstraintBlock& block,
                                                 const CollocationPoint& instant,
                                                 const PointState& state);

}  // namespace ayumi
