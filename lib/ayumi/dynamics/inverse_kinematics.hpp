#pragma once
// Legs and base from what they must reach: both sole poses, the trunk's attitude and the COG.

#include <array>
#include <string>
#include <vector>

#include "ayumi/dynamics/robot_data.hpp"

namespace ayumi {

struct PostureTarget {
  std::array<Eigen::Isometry3d, 2> feet = {Eigen::Isometry3d::Identity(),
                                           Eigen::Isometry3d::Identity()};  ///< soles, by Side
  Eigen::Vector3d cog = Eigen::Vector3d::Zero();                            ///< world [m]
  Eigen::Matrix3d trunk = Eigen::Matrix3d::Identity();                      ///< attitude, world
  /// How firmly each sole keeps its place, by Side: 1 where it carries, down to 0 in the middle of
  /// a swing. Counts only where legs have fewer than six joints.
  std::array<double, 2> hold = {1, 1};
};

struct PostureSolution {
  bool reached = false;
  double error = 0;        ///< largest residual component of the soles and the COG [m, rad]; 0
                           ///< where rounding is all that is left
  double lean = 0;         ///< of the trunk from its target; 0 unless legs lack joints [rad]
  Side foot = Side::left;  ///< that is out of reach when not reached, else the farthest off
  double missing = 0;      ///< of that foot, COG held [m]
  double turned = 0;       ///< angle of that foot from its planned attitude [rad]; 0 when reached
  std::array<double, 2> miss = {0, 0};  ///< of each sole, by Side [m]
  int at_limit = -1;          ///< joint of that leg that is at its position limit; -1: none
  bool knee_flipped = false;  ///< reached, but with a leg bent the other way
};

/// Distance by which soles may miss their places, and the same number of radians, where legs have
/// fewer than six joints [m, rad]. Chosen: three quarters of the slip that the check allows
/// (limits/stance). Half: narrower shuffles; twice: the check finds slipping soles.
inline constexpr double kLackingTolerance = 1.5e-3;

/// The same for a sole in the middle of its swing, which carries nothing. Between lift-off and the
/// middle of the swing, both are blended as PostureTarget::hold says. Chosen: a third of the lift
/// of the smallest robots, so that the sole stays clear of the ground. Half: steps of Open Duck
/// Mini in 0.25 s are refused (2.7 mm); twice: not measured.
inline constexpr double kSwingingTolerance = 5e-3;

/// Distance by which a sole that is held so firmly may miss its place [m, rad].
inline double lacking_tolerance(double hold) {
  return kLackingTolerance + (1 - hold) * (kSwingingTolerance - kLackingTolerance);
}

class InverseKinematics {
 public:
  /// `reference` is a posture whose legs bend the right way. The knee of a straight leg bends as a
  /// human knee does, so that it comes forward, where the limits of the leg leave room for it; else
  /// it bends the other way. Throws Error(bad_model) for a robot without soles or with a foot as
  /// root.
  InverseKinematics(const RobotModel& model, const Eigen::VectorXd& reference);

  /// Joints that are solved: those of one leg only. A waist above which both legs hang is not.
  const std::vector<int>& leg(Side side) const { return legs_[static_cast<int>(side)]; }
  /// A leg has fewer than six joints of its own. Then the trunk leans where the soles and the COG
  /// need it, and joints that are coupled across both legs are solved too.
  bool lacks_joints() const { return lacking_; }
  /// Joints that move both legs at once, as coupled hips do; only where legs lack joints.
  const std::vector<int>& coupled() const { return coupled_; }
  /// Joint whose body is the shank; -1: the leg has no three parallel joints across.
  int knee(Side side) const { return knees_[static_cast<int>(side)]; }
  /// Whether angles above the straight leg bring the knee forward. Only with a knee.
  bool positive_bends_forward(Side side) const { return forward_[static_cast<int>(side)] > 0; }
  bool solves(int dof) const { return solved_[dof]; }

  /// Legs bent the right way, other joints of the reference.
  const Eigen::VectorXd& start() const { return start_; }

  /// Newton on base position and leg joints, warm from `state`; other joints are read from it, the
  /// base attitude follows from `target.trunk`. Six-joint legs meet the target to 1e-13. Others are
  /// solved as damped least squares inside the position limits: legs with more joints meet the
  /// target, legs with fewer joints come within lacking_tolerance(). `state` is only meaningful
  /// when the solution says reached; `data` is a workspace.
  PostureSolution solve(const PostureTarget& target, RobotState& state, RobotData& data) const;

 private:
  struct Residual {
    Eigen::Matrix<double, 6, 1> foot[2];
    Eigen::Vector3d cog;
    Eigen::Vector3d trunk = Eigen::Vector3d::Zero();  ///< only where legs lack joints
    double largest() const;
  };
  /// The Jacobian of a leg of six joints and four right sides.
  using SixRows = Eigen::Matrix<double, 6, 10, Eigen::RowMajor>;
  /// A body that the joints of a leg move.
  struct LegBody {
    int body = -1;
    int column = -1;       ///< of its joint among the leg's; -1: not one of them
    bool carries = false;  ///< the sole
  };
  Residual residual(const PostureTarget& target, const RobotState& state, RobotData& data) const;
  bool newton(const PostureTarget& target, RobotState& state, RobotData& data, double& error,
              std::array<double, 2>& legs_bend) const;
  void damped(const PostureTarget& target, RobotState& state, RobotData& data) const;
  Eigen::MatrixXd leg_jacobian(const RobotData& data, Side side, const std::vector<int>& leg) const;
  void square_jacobian(const RobotData& data, Side side, SixRows& rows) const;
  Eigen::Matrix<double, 3, 6> leg_cog_jacobian(RobotData& data, Side side) const;
  std::array<double, 2> bend(const RobotData& data) const;
  void find_leg_bodies(Side side);
  void find_knees(RobotData& data);
  void bend_straight_legs(RobotData& data);
  double knee_bend(const RobotData& data, Side side) const;
  void set_attitude(const PostureTarget& target, RobotState& state, RobotData& data) const;

  const RobotModel* model_;
  std::array<std::vector<int>, 2> legs_;
  std::array<std::vector<LegBody>, 2> leg_bodies_;  ///< leaves first
  std::vector<int> coupled_;
  std::vector<bool> solved_;
  bool square_ = false;   ///< both legs have six joints
  bool lacking_ = false;  ///< a leg has fewer
  std::array<int, 2> knees_ = {-1, -1};
  std::array<int, 2> knee_feet_ = {-1, -1};  ///< bodies of the joints across below the knees
  std::array<int, 2> knee_hips_ = {-1, -1};  ///< and above them
  std::array<double, 2> forward_ = {0, 0};
  Eigen::VectorXd start_;
  double largest_bend_rate_ = 0;         ///< change of those determinants per radian
  std::array<double, 2> bend_ = {0, 0};  ///< sign of the leg Jacobian's determinant, of the knee
};

}  // namespace ayumi
