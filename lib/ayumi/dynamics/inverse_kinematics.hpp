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
};

struct PostureSolution {
  bool reached = false;
  double error = 0;           ///< largest residual component [m, rad]
  Side foot = Side::left;     ///< that is out of reach when not reached
  double missing = 0;         ///< of that foot, COG held [m]
  bool knee_flipped = false;  ///< reached, but with a leg bent the other way
};

class InverseKinematics {
 public:
  /// `reference` is a posture whose legs bend the right way (straight legs: the knee, the middle
  /// joint of the chain, is taken to bend towards the middle of its range). Throws
  /// Error(bad_model) for a robot without soles or with a foot as root.
  InverseKinematics(const RobotModel& model, const Eigen::VectorXd& reference);

  /// Joints that are solved: those of one leg only. A waist above which both legs hang is not.
  const std::vector<int>& leg(Side side) const { return legs_[static_cast<int>(side)]; }
  bool solves(int dof) const { return solved_[dof]; }

  /// Legs bent the right way, other joints of the reference.
  const Eigen::VectorXd& start() const { return start_; }

  /// Newton on base position and leg joints, warm from `state`; other joints are read from it, the
  /// base attitude follows from `target.trunk`. Six-joint legs meet the target to 1e-12; others
  /// as damped least squares. `state` is only meaningful when the solution says reached.
  PostureSolution solve(const PostureTarget& target, RobotState& state, RobotData& data) const;

 private:
  struct Residual {
    Eigen::Matrix<double, 6, 1> foot[2];
    Eigen::Vector3d cog;
    double largest() const;
  };
  Residual residual(const PostureTarget& target, const RobotState& state, RobotData& data) const;
  bool newton(const PostureTarget& target, RobotState& state, RobotData& data) const;
  double damped(const PostureTarget& target, RobotState& state, RobotData& data) const;
  Eigen::MatrixXd leg_jacobian(const RobotData& data, Side side) const;
  std::array<double, 2> bend(const RobotData& data) const;
  void set_attitude(const PostureTarget& target, RobotState& state, RobotData& data) const;

  const RobotModel* model_;
  std::array<std::vector<int>, 2> legs_;
  std::vector<bool> solved_;
  bool square_ = false;  ///< both legs have six joints
  Eigen::VectorXd start_;
  std::array<double, 2> bend_ = {0, 0};  ///< sign of the leg Jacobian's determinant
};

}  // namespace ayumi
