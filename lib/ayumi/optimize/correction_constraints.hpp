#pragma once
// The constraints of a corrected motion at one sample, and their exact derivatives. Values are the
// residuals of check/residuals.hpp; derivatives go by the correction's value, rate and acceleration
// at that sample (6 + dof columns: base position, base rotation vector, joints).

#include <array>
#include <vector>

#include "ayumi/check/residuals.hpp"
#include "ayumi/optimize/corrected_motion.hpp"
#include "ayumi/pattern/correction.hpp"

namespace ayumi {

/// support: f_n (ZMP inside each edge - margin) / (m g) [m]; unilateral: f_n / (m g);
/// yaw: (lever f_n -+ yaw moment about the ZMP) / (m g) [m], the lever held as it is in the motion;
/// friction: (mu f_n - f_t) / (m g) on the sides of a pyramid inside the cone, linear where the
/// cone itself would ask for its curvature; flight: ground force / (m g) and moment / (m g) about
/// the planned COG; stance: sole from its place, position [m] and rotation [rad]; swing: corner
/// heights [m]; position: joint angle [rad]; speed: joint speed / limit.
enum class ConstraintGroup {
  support,
  unilateral,
  friction,
  flight,
  yaw,
  stance,
  swing,
  position,
  speed
};
const char* name_of(ConstraintGroup group);

/// A sample at which constraints are evaluated.
struct Instant {
  int sample = 0;
  SplineWeights weights;
  SupportPlane plane;                       ///< of the planned contacts
  std::array<bool, 2> contact = {};         ///< by Side
  std::array<Eigen::Isometry3d, 2> ground;  ///< by Side: where the foot stands, or the ground below
};

/// Consecutive rows of the constraint vector that belong together.
struct ConstraintBlock {
  ConstraintGroup group = ConstraintGroup::support;
  int instant = 0;        ///< index of its Instant
  int item = 0;           ///< foot (by Side) or dof
  int row = 0, rows = 0;  ///< first and number
  double scale = 1;       ///< of yaw rows: 1 / (m g); of speed rows: 1 / limit
  double factor = 0;      ///< of yaw rows: friction times lever [m]
  Eigen::Matrix<double, Eigen::Dynamic, 6> wrench_rows;  ///< of linear ground groups
};

/// What the blocks of one instant share.
struct InstantState {
  CorrectedMotion motion;
  Vector6d wrench = Vector6d::Zero();        ///< of the ground, about the base
  std::array<Eigen::MatrixXd, 3> wrench_by;  ///< 6 x (6+dof) by value, rate, acceleration
  std::array<Eigen::Isometry3d, 2> soles;    ///< by Side
  std::array<Eigen::MatrixXd, 2> sole_by;    ///< 6 x (6+dof) by value
};
InstantState instant_state(const RobotModel& model, const CommandSample& sample,
                           const Instant& instant, const Eigen::MatrixXd& coefficients,
                           bool derivatives, RobotData& data);

/// Columns of the correction that a block depends on.
std::vector<int> block_columns(const RobotModel& model, const ConstraintBlock& block);

Eigen::VectorXd block_values(const RobotModel& model, const ConstraintBlock& block,
                             const Instant& instant, const InstantState& state);

/// By value, rate and acceleration, rows x (6+dof) each; an empty matrix where all is zero.
std::array<Eigen::MatrixXd, 3> block_derivatives(const RobotModel& model,
                                                 const ConstraintBlock& block,
                                                 const Instant& instant, const InstantState& state);

}  // namespace ayumi
