#pragma once
// The part of a walk that repeats, which is two steps. It lasts from the middle of the double
// support before the swing of one foot to the middle of the double support before the next swing of
// this foot. At both times the robot has the same posture and rates, moved over the ground, if the
// cycle is so far from the start and the end of the walk that they no longer affect it.

#include <Eigen/Core>
#include <string>

#include "ayumi/author/edit/edit.hpp"

namespace ayumi {

struct GaitCycle {
  long begin = 0, end = 0;   ///< first and last sample
  Side first = Side::right;  ///< foot that swings first
  /// Displacement of the robot in one cycle, relative to its heading at the beginning [m].
  Eigen::Vector2d displacement;
  double turn = 0;  ///< turn in one cycle, left positive [rad]
  LoopGap gap;      ///< difference between the end and the beginning
};

/// The cycle that begins before swing `swing`, counted from 0. Throws Error(bad_pattern) if the
/// pattern has fewer than `swing` + 3 swings or if a foot is in the air at the beginning or the end
/// of the cycle.
GaitCycle gait_cycle(const RobotModel& model, const MotionPart& motion, int swing);

/// The samples of a walk, changed so that the end of the cycle equals its beginning (moved over the
/// ground) to the last digit. The difference is spread smoothly over the cycle and fades out after
/// it, because a sudden displacement of 0.1 um within a millisecond moves the ZMP by millimetres.
/// If the difference is too large for a loop, `gap` of the cycle still shows it.
CommandSeries with_closed_cycle(const CommandSeries& series, const GaitCycle& cycle);

/// The samples `first` to `last` of a motion, such as a cycle, as a motion of its own. The result
/// is a table of posture and base with the phases, weights and disturbances of this time; COG, ZMP
/// and f_z are those of the full model. Throws Error(usage) for samples that are not there,
/// Error(bad_pattern) if a foot is in the air at the first or the last sample, and the same errors
/// as baked().
Pattern cut(const RobotModel& model, const MotionPart& motion, long first, long last,
            const std::string& table);

}  // namespace ayumi
