#pragma once
// What changed from one motion to another: which joints, when and by how much, and COG, ZMP and
// feet.

#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

struct JointChange {
  std::string joint;
  double most = 0;            ///< largest change, signed [rad], of sliding joints [m]
  double at = 0;              ///< time of the largest change [s]
  double begin = 0, end = 0;  ///< between these the change exceeds a tenth of it [s]
};

/// The largest change of a quantity, and its time [s].
struct LargestChange {
  double size = 0, at = 0;
};

struct MotionChange {
  std::vector<JointChange> joints;  ///< those that move more than 1e-6 rad, the most first
  LargestChange joint;              ///< of any joint [rad]
  LargestChange cog;                ///< COG of the postures [m]
  LargestChange zmp;                ///< commanded ZMP [m]
  LargestChange fz;                 ///< commanded vertical force [N]
  LargestChange foot;               ///< origin of a sole [m]
  double compared = 0;              ///< length of the time that both motions have [s]
};

/// Both series are sampled at one rate; the rest of the longer one is left out. Throws Error(usage)
/// when the rates differ.
MotionChange motion_change(const RobotModel& model, const CommandSeries& before,
                           const CommandSeries& after);

}  // namespace ayumi
