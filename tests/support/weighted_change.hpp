#pragma once
// The cost that a repair minimises, summed over the samples.

#include <cmath>

#include "ayumi/motion/command_series.hpp"
#include "ayumi/motion/correction.hpp"

namespace ayumi::test {

// The weighted integral of the correction and its curvature, which a repair minimises.
inline double weighted_change(const RobotModel& model, const CommandSeries& series,
                              const CorrectionTrack& track) {
  Eigen::VectorXd weight(model.velocity_count());
  weight << Eigen::VectorXd::Constant(3, 1000), Eigen::VectorXd::Constant(3, 4),
      series.joint_weight.front().value;
  double sum = 0;
  for (double t = 0; t < series.duration(); t += 0.001) {
    const SplineWeights w = correction_weights(track, t);
    const auto rows = track.coefficients.middleRows<4>(w.first);
    const Eigen::VectorXd d = rows.transpose() * w.value, dd = rows.transpose() * w.acceleration;
    for (int j = 0; j < d.size(); ++j) {
      const double wj = j < 6 ? weight[j] : weight[6 + model.find_dof(track.joints[j - 6])];
      sum += 0.001 * wj * (d[j] * d[j] + 1e-4 * dd[j] * dd[j]);
    }
  }
  return sum;
}

}  // namespace ayumi::test
