#pragma once
// Distance of a planned motion from its limits over time, for a picture: the worst sample of each
// short stretch of time. The verdict is that of check_consistency().

#include <vector>

#include "ayumi/limits/limit.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

/// One value per stretch, the first from t = 0 on; NaN where the quantity does not exist, as the
/// ZMP in flight and beside its edges.
struct StabilitySeries {
  double dt = 0.01;                ///< length of a stretch [s]
  std::vector<double> zmp_margin;  ///< of the motion's ZMP inside the support, least [m]
  /// Of the DCM inside the support that the robot has or gets next, least [m]: the hull of the
  /// soles on the ground and of those that land in the next phase. The DCM is p_G + dp_G/omega with
  /// omega = sqrt(g/z), z the height of the COG over the ground.
  std::vector<double> dcm_margin;
  std::vector<double> normal_force;        ///< of the ground, least [N]
  std::vector<double> friction;            ///< share of the friction cone, largest [1]
  std::vector<double> speed, torque;       ///< joint with the largest share of its limit [1]
  std::vector<int> speed_dof, torque_dof;  ///< that joint; -1: no joint has a limit
};

/// For `size` stretches of `dt` [s], without a value yet.
StabilitySeries empty_stability(size_t size, double dt);

// Of several samples of a stretch the worst; NaN: none yet.
void keep_least(double& kept, double value);
void keep_largest(double& kept, double value);
/// The joint with the largest share of its limit; joints without a limit do not count.
void keep_worst(double& kept, int& dof, const Eigen::VectorXd& value, const Eigen::VectorXd& limit);

/// Throws as check_consistency().
StabilitySeries stability_series(const RobotModel& model, const CommandSeries& series,
                                 const CheckOptions& options, double dt = 0.01);

}  // namespace ayumi
