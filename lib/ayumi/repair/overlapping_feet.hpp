#pragma once
// Feet that are planned to stand at the same place. A correction keeps the planned places of the
// feet, so no repair can separate them.

#include <optional>
#include <string>

#include "ayumi/check/consistency.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

struct OverlappingFeet {
  Side landed = Side::left;   ///< the foot that lands later
  double begin = 0, end = 0;  ///< time in which both stand [s]
  double depth = 0;           ///< smallest displacement that separates the soles [m]
  Eigen::Vector3d place =
      Eigen::Vector3d::Zero();  ///< place of the sole that landed later, world [m]
};

/// The first contacts of both feet whose planned soles overlap, if the report says that the feet
/// collide then. Nothing if the plan separates the soles, or if the check allows the overlap.
std::optional<OverlappingFeet> overlapping_feet(const RobotModel& model,
                                                const CommandSeries& series,
                                                const ConsistencyReport& report);

/// The message: what is wrong, where it is wrong, and what to do.
std::string words_of(const OverlappingFeet& feet);

}  // namespace ayumi
