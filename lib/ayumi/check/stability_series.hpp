#pragma once
// Distance of a planned motion from its limits over time, for a picture. It has the worst sample of
// each short interval of time, which is called a stretch here. The verdict is that of
// check_consistency().

#include <vector>

#include "ayumi/limits/judged_motion.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

/// One value for each stretch; the first stretch begins at t = 0. A value is NaN if the quantity
/// does not exist, such as the ZMP in flight and near the beginning and end of a flight.
struct StabilitySeries {
  double dt = 0.01;                ///< length of a stretch [s]
  std::vector<double> zmp_margin;  ///< smallest distance of the motion's ZMP inside the support [m]
  /// The smallest distance of the DCM inside the support that the robot has now or gets next [m].
  /// This support is the hull of the soles on the ground and of those that land in the next phase.
  /// The DCM is p_G + dp_G/omega with omega = sqrt(g/z), where z is the height of the COG over the
  /// ground.
  std::vector<double> dcm_margin;
  std::vector<double> normal_force;  ///< smallest normal force of the ground [N]
  std::vector<double> friction;      ///< largest share of the friction cone [1]
  /// Value of the joint with the largest share of its limit [1].
  std::vector<double> speed, torque;
  std::vector<int> speed_dof, torque_dof;  ///< index of this joint; -1 if no joint has a limit
};

/// A series with `size` stretches of `dt` [s], still without values.
StabilitySeries empty_stability(size_t size, double dt);

// Keeps the worse of two values of a stretch; NaN means that there is no value yet.
void keep_least(double& kept, double value);
void keep_largest(double& kept, double value);
/// Keeps the joint with the largest share of its limit; joints without a limit do not count.
void keep_worst(double& kept, int& dof, const Eigen::VectorXd& value, const Eigen::VectorXd& limit);

/// Gathers the series while the motion is judged, so that its dynamics are evaluated only once.
class StabilityNotes {
 public:
  /// The arguments must outlive this object. Throws the same errors as check_consistency().
  StabilityNotes(const RobotModel& model, const CommandSeries& series, const CheckOptions& options,
                 double dt = 0.01);

  /// Notes one sample. Several threads may note different samples at the same time.
  void note(const JudgedSample& sample, const RobotData& data);

  StabilitySeries series() const;  ///< the series, after all samples were noted

 private:
  struct Note {
    double zmp_margin, dcm_margin, normal_force, friction, speed, torque;
    int speed_dof = -1, torque_dof = -1;
  };

  const RobotModel& model_;
  const CommandSeries& series_;
  const ActuatorLimits& limits_;
  double friction_;
  int stretch_;                     // samples of a stretch
  std::vector<int> next_contacts_;  // by sample
  std::vector<Note> notes_;         // by sample
};

/// Throws the same errors as check_consistency().
StabilitySeries stability_series(const RobotModel& model, const CommandSeries& series,
                                 const CheckOptions& options, double dt = 0.01);

}  // namespace ayumi
