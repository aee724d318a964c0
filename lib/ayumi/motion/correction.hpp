#pragma once
// Correction tracks: smooth changes that are added to a sampled motion. A repair writes them.

#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

/// Values of the four cubic B-spline basis functions that are not zero at time t, the index of the
/// first one, and their first and second time derivatives. All are zero outside the track.
struct SplineWeights {
  int first = 0;
  Eigen::Vector4d value = Eigen::Vector4d::Zero();
  Eigen::Vector4d rate = Eigen::Vector4d::Zero();          ///< first derivatives [1/s]
  Eigen::Vector4d acceleration = Eigen::Vector4d::Zero();  ///< second derivatives [1/s^2]
};
SplineWeights correction_weights(const CorrectionTrack& track, double t);

/// The series with the correction. It is first made smooth in the windows of the track
/// (motion/smooth_motion.hpp). Then the track is added to base and joints (the rotation R of the
/// base becomes exp(r) R). Velocities and accelerations follow from the sum, and COG, ZMP and f_z
/// from the full model. Contacts do not change. Throws Error(bad_pattern) for an unknown joint, a
/// wrong number of columns, a spacing that is not above 0, or a coefficient that is not finite.
CommandSeries apply_correction(const RobotModel& model, const CommandSeries& series,
                               const CorrectionTrack& track);

/// The series with smooth curves in these windows, as apply_correction() makes it if nothing else
/// changes. The windows are in order and do not overlap.
CommandSeries apply_smoothing(const RobotModel& model, const CommandSeries& series,
                              const std::vector<SmoothWindow>& windows);

}  // namespace ayumi
