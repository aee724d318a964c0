#pragma once
// Random robots and states for property tests, and a two-legged test robot.

#include <random>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/model/robot_state.hpp"

namespace ayumi::test {

struct Random {
  explicit Random(unsigned seed) : engine(seed) {}
  double uniform(double low = -1, double high = 1) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  }
  Eigen::Vector3d vector(double scale = 1);
  Eigen::VectorXd vector(int n, double scale);
  std::mt19937 engine;
};

/// A random tree with revolute, prismatic, fixed and (optionally) mimic joints.
RobotDescription random_tree(unsigned seed, int links, bool mimic = true);

/// A random tree with everything that the reader knows: continuous joints, chains of mimic joints
/// anywhere (not only at a leaf), axes of any length, some of them along the axes of their frame,
/// and joints out of order.
RobotDescription odd_tree(unsigned seed, int links);

/// The same tree with its mimic joints set free, and the map between the two:
///   theta of the free tree = G theta + offset.
struct FreedTree {
  explicit FreedTree(const RobotModel& tied);
  static RobotDescription freed(RobotDescription d);
  RobotState state(const RobotState& s) const;
  /// The generalised velocity of the free tree for that of the tied tree.
  Eigen::MatrixXd map() const;
  RobotModel model;
  Eigen::MatrixXd G;
  Eigen::VectorXd offset;
};

RobotState random_state(const RobotModel& model, Random& random);

/// Moves a state along a generalised velocity for a time h: p += h v, R <- exp(h w) R.
RobotState integrate(const RobotState& s, const Eigen::VectorXd& v, double h);

}  // namespace ayumi::test
