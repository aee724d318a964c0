#pragma once
// The robot's own sensors on top of the plant's truth: encoders, IMU, and load cells at the corners
// of each sole, with the sidecar's noise, bias, resolution and latency when asked for.

#include <deque>

#include "ayumi/control/estimator.hpp"
#include "ayumi/math/random.hpp"
#include "ayumi/sim/plant.hpp"

namespace ayumi {

class Sensors {
 public:
  Sensors(const RobotModel& model, double dt, bool noise, std::uint64_t seed);

  /// Reads after a plant step; `feet` soles' forces are those of that step.
  Measurement read(const RobotState& state, const StepReport& report);

 private:
  Measurement measure(const RobotState& state, const StepReport& report);

  const RobotModel* model_;
  RobotData data_;
  double dt_;
  bool noise_;
  Random random_;
  Eigen::VectorXd previous_theta_;
  std::deque<Measurement> delayed_;
  size_t delay_ = 0;  // ticks
};

}  // namespace ayumi
