#pragma once
// The weighted change between two motions, which a repair minimizes:
//   sum_c w_c integral (d_c^2 + tau^4 d_c''^2) dt,   tau = 0.1 s,
// with d the differences of base position, base rotation (vector of R_b R_a') and joints.

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

struct ChangePart {
  std::string what;  ///< "base position", "base rotation" or a joint
  /// Weight w; for a joint its W times the factor of the options [1/rad^2, 1/m^2].
  double weight = 0;
  double change = 0;  ///< share of the part in the sum [s]
};

struct WeightedChange {
  double change = 0;              ///< the sum of the formula above [s]
  double safety = 0;              ///< robustness cost (robustness_cost.hpp) [s]
  std::vector<ChangePart> parts;  ///< parts that are not 0, the largest first
  double total() const { return change + safety; }
};

/// The weights w by column: base position and base rotation (policy.hpp), then W of the motion
/// times `factors` by joint (1 if it is empty). If the motion has no W, that of the robot is used.
Eigen::VectorXd change_weights(const RobotModel& model, const CommandSeries& series,
                               const Eigen::VectorXd& factors = {});

/// One factor for each joint, which is 1 if `weights` does not name it. Throws Error(usage) for a
/// joint that the robot does not have and for a factor that is not above 0.
Eigen::VectorXd weight_factors(const RobotModel& model,
                               const std::map<std::string, double>& weights);

/// The change without the robustness cost, over the time that both motions have. Throws
/// Error(usage) if their rates differ.
WeightedChange weighted_change(const RobotModel& model, const CommandSeries& before,
                               const CommandSeries& after, const Eigen::VectorXd& factors = {});

}  // namespace ayumi
