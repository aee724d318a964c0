#pragma once
// Feet that are planned to stand in one place. A correction keeps the planned places of the feet,
// so that no repair can part them.

#include <optional>
#include <string>

#include "ayumi/check/consistency.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

struct OverlappingFeet {
  Side landed = Side::left;                         ///< the foot that comes last
  double begin = 0, end = 0;                        ///< both stand [s]
  double depth = 0;                                 ///< least way that parts the soles [m]
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< of the sole that came last, world [m]
};

/// The first contacts of both feet whose planned soles overlap and whose feet the report has
/// colliding then; none where the plan parts them, or where the check lets them overlap.
std::optional<OverlappingFeet> overlapping_feet(const RobotModel& model,
                                                const CommandSeries& series,
                                                const ConsistencyReport& report);

/// What is wrong, where, and what to do.
std::string words_of(const OverlappingFeet& feet);

}  // namespace ayumi
