#pragma once
// Finds base and leg joints from what they must reach: both sole poses, the trunk's attitude and
// the COG.

#include <array>
#include <string>
#include <vector>

#include "ayumi/dynamics/robot_data.hpp"

namespace ayumi {

struct PostureTarget {
  /// Poses of the soles, by Side.
  std::array<Eigen::Isometry3d, 2> feet = {Eigen::Isometry3d::Identity(),
                                           Eigen::Isometry3d::Identity()};
  Eigen::Vector3d cog = Eigen::Vector3d::Zero();        ///< world position of the COG [m]
  Eigen::Matrix3d trunk = Eigen::Matrix3d::Identity();  ///< attitude of the trunk in the world
  /// How firmly each sole keeps its place, by Side: 1 for a sole that carries, down to 0 in the
  /// middle of a swing. It only counts where legs have fewer than six joints.
  std::array<double, 2> hold = {1, 1};
  /// Whether the nearest posture with knees bent in the right direction is wanted if the target is
  /// only reached with a knee bent in the other direction.
  bool nearest = false;
};

struct PostureSolution {
  bool reached = false;
  /// Largest residual component of the soles and the COG [m, rad]; 0 if only rounding is left.
  double error = 0;
  double lean = 0;  ///< angle of the trunk from its target; 0 unless legs lack joints [rad]
  /// The foot that is out of reach if the target is not reached; otherwise the foot that is
  /// farthest from its place.
  Side foot = Side::left;
  double missing = 0;  ///< distance of that foot from its place while the COG is held [m]
  double turned = 0;   ///< angle of that foot from its planned attitude [rad]; 0 when reached
  std::array<double, 2> miss = {0, 0};  ///< distance of each sole from its place, by Side [m]
  int at_limit = -1;  ///< joint of that leg that is at its position limit; -1 if there is none
  bool knee_flipped = false;  ///< the target is reached, but a leg is bent in the other direction
};

/// Distance by which soles may miss their places, and the same number of radians, where legs have
/// fewer than six joints [m, rad]. Chosen: three quarters of the slip that the check allows
/// (limits/stance). With half of the value, shuffles become narrower; with twice, the check finds
/// slipping soles.
inline constexpr double kLackingTolerance = 1.5e-3;

/// Value of kLackingTolerance for a sole in the middle of its swing, which carries nothing. Between
/// lift-off and the middle of the swing, the two values are blended as PostureTarget::hold says.
/// Chosen: a third of the lift of the smallest robots, so that the sole stays clear of the ground.
/// With half of the value, steps of Open Duck Mini in 0.25 s are refused (they miss by 2.7 mm);
/// twice the value was not measured.
inline constexpr double kSwingingTolerance = 5e-3;

/// Distance by which a sole that is held with this firmness may miss its place [m, rad].
inline double lacking_tolerance(double hold) {
  return kLackingTolerance + (1 - hold) * (kSwingingTolerance - kLackingTolerance);
}

class InverseKinematics {
 public:
  /// `reference` is a posture whose legs bend in the right direction. The knee of a straight leg
  /// bends as a human knee does, so that it comes forward, if the limits of the leg leave room for
  /// it; otherwise it bends in the other direction. Throws Error(bad_model) for a robot without
  /// soles or with a foot as root.
  InverseKinematics(const RobotModel& model, const Eigen::VectorXd& reference);

  /// The solved joints of a leg, at most six. A waist above both legs is not solved.
  const std::vector<int>& leg(Side side) const { return legs_[static_cast<int>(side)]; }
  /// Whether a leg has fewer than six joints of its own. Then the trunk leans as far as the soles
  /// and the COG require, and joints that are coupled across both legs are solved too.
  bool lacks_joints() const { return lacking_; }
  /// Joints that move both legs at once, as coupled hips do. The list is only filled where legs
  /// lack joints.
  const std::vector<int>& coupled() const { return coupled_; }
  /// Joint whose body is the shank; -1 if the leg does not have three parallel joints across the
  /// trunk.
  int knee(Side side) const { return knees_[static_cast<int>(side)]; }
  /// Whether angles above that of the straight leg bring the knee forward. It is only defined for a
  /// leg with a knee.
  bool positive_bends_forward(Side side) const { return forward_[static_cast<int>(side)] > 0; }
  bool solves(int dof) const { return solved_[dof]; }

  /// A posture with legs bent in the right direction and the other joints as in the reference.
  const Eigen::VectorXd& start() const { return start_; }

  /// Newton's method on base position and leg joints, which starts from `state`. Other joints are
  /// read from `state`, and the base attitude follows from `target.trunk`. Legs of six joints meet
  /// the target to 1e-13. In legs of more than six joints, those that leg() does not list keep
  /// their angles in `state`. Legs of fewer joints are solved by damped least squares and come
  /// within lacking_tolerance(). If the target is not reached, `state` is the nearest posture
  /// within the position limits that damped least squares found. `data` is a workspace.
  PostureSolution solve(const PostureTarget& target, RobotState& state, RobotData& data) const;

 private:
  struct Residual {
    Eigen::Matrix<double, 6, 1> foot[2];
    Eigen::Vector3d cog;
    /// Error of the trunk's attitude, only where legs lack joints.
    Eigen::Vector3d trunk = Eigen::Vector3d::Zero();
    double largest() const;
  };
  /// The Jacobian of a leg of six joints and four right sides.
  using SixRows = Eigen::Matrix<double, 6, 10, Eigen::RowMajor>;
  /// A body that the joints of a leg move.
  struct LegBody {
    int body = -1;
    int column = -1;  ///< column of its joint among those of the leg; -1 if it is not one of them
    bool carries = false;  ///< this body carries the sole
  };
  Residual residual(const PostureTarget& target, const RobotState& state, RobotData& data) const;
  /// The residual of the posture that `data` holds. The attitude of the trunk is part of it if legs
  /// lack joints.
  Residual residual(const PostureTarget& target, const RobotData& data) const;
  bool newton(const PostureTarget& target, RobotState& state, RobotData& data, double& error,
              std::array<double, 2>& legs_bend) const;
  void damped(const PostureTarget& target, RobotState& state, RobotData& data) const;
  template <class Jacobian>
  void add_sole_columns(const RobotData& data, Side side, const std::vector<LegBody>& chain,
                        Jacobian&& J) const;
  void square_jacobian(const RobotData& data, Side side, SixRows& rows) const;
  Eigen::Matrix<double, 3, 6> leg_cog_jacobian(RobotData& data, Side side) const;
  std::array<double, 2> bend(const RobotData& data) const;
  std::vector<LegBody> sole_chain(Side side, const std::vector<int>& joints) const;
  void find_leg_bodies(Side side);
  void find_knees(RobotData& data);
  void bend_straight_legs(RobotData& data);
  double knee_bend(const RobotData& data, Side side) const;
  void set_attitude(const PostureTarget& target, RobotState& state, RobotData& data) const;

  const RobotModel* model_;
  std::array<std::vector<int>, 2> legs_;
  std::array<std::vector<LegBody>, 2> leg_bodies_;  ///< bodies of each leg, leaves first
  std::vector<int> coupled_;
  std::vector<int> damped_joints_;  ///< unknown joints of damped(): those of the legs, coupled ones
  /// Per sole: the bodies up to the root that damped_joints_ move, and the index of each in
  /// damped_joints_.
  std::array<std::vector<LegBody>, 2> sole_chains_;
  std::vector<bool> solved_;
  bool lacking_ = false;  ///< a leg has fewer than six joints; otherwise both have six
  std::array<int, 2> knees_ = {-1, -1};
  /// Bodies of the joints across the trunk below the knees.
  std::array<int, 2> knee_feet_ = {-1, -1};
  std::array<int, 2> knee_hips_ = {-1, -1};  ///< bodies of the joints across the trunk above the
                                             ///< knees
  std::array<double, 2> forward_ = {0, 0};
  Eigen::VectorXd start_;
  double largest_bend_rate_ = 0;  ///< largest change of the determinants below per radian
  /// Determinants of the leg Jacobians in the reference posture, by Side. Legs that bend in the
  /// right direction have determinants with these signs.
  std::array<double, 2> bend_ = {0, 0};
};

}  // namespace ayumi
