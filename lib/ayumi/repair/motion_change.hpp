#pragma once
// What changed from one motion to another: which joints, when, how much; COG and ZMP.

#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

struct JointChange {
  std::string joint;
  double most = 0;            ///< signed [rad], sliding joints [m]
  double at = 0;              ///< of it [s]
  double begin = 0, end = 0;  ///< where it is more than a tenth of that [s]
};

/// The largest distance of a quantity, and when.
struct LargestChange {
  double size = 0, at = 0;
};

struct MotionChange {
  std::vector<JointChange> joints;  ///< those that move more than 1e-6 rad, the most first
  LargestChange joint;              ///< over all joints [rad]
  LargestChange cog;                ///< of the postures [m]
  LargestChange zmp;                ///< of the commanded ZMP [m]
  LargestChange fz;                 ///< of the commanded force [N]
  LargestChange foot;               ///< of a sole's origin [m]
  double compared = 0;              ///< time that both motions have [s]
};

/// Both series sampled at one rate; the longer one's rest is not looked at. Throws Error(usage)
/// when the rates differ.
MotionChange motion_change(const RobotModel& model, const CommandSeries& before,
                           const CommandSeries& after);

}  // namespace ayumi
