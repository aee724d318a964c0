#pragma once
// The changes from one motion to another: which joints changed, when and by how much, and the
// changes of COG, ZMP and feet.

#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

struct JointChange {
  std::string joint;
  double most = 0;            ///< largest change with its sign [rad], for sliding joints [m]
  double at = 0;              ///< time of the largest change [s]
  double begin = 0, end = 0;  ///< times between which the change exceeds a tenth of the largest [s]
};

/// The largest change of a quantity, and its time [s].
struct LargestChange {
  double size = 0, at = 0;
};

struct MotionChange {
  /// Joints that move by more than 1e-6 rad, the largest change first.
  std::vector<JointChange> joints;
  LargestChange joint;  ///< largest change of any joint [rad]
  LargestChange cog;    ///< change of the COG of the postures [m]
  LargestChange zmp;    ///< change of the commanded ZMP [m]
  LargestChange fz;     ///< change of the commanded vertical force [N]
  LargestChange foot;   ///< change of the origin of a sole [m]
  double compared = 0;  ///< length of the time that both motions have [s]
};

/// Both series must be sampled at the same rate; the rest of the longer one is ignored. Throws
/// Error(usage) if the rates differ.
MotionChange motion_change(const RobotModel& model, const CommandSeries& before,
                           const CommandSeries& after);

}  // namespace ayumi
