#pragma once
// Choreonoid .pseq: key poses with joints, places of links, contacts and the ZMP, read as the keys
// of a pattern.

#include "ayumi/io/formats/motion_file.hpp"

namespace ayumi {

std::string recognize_pose_sequence(const MotionInput& source);

/// The keyframes have the joints, feet, trunk, COG height and ZMP of every key, and the phases say
/// which feet stand still between the keys. If the file places feet, the legs follow from these
/// places, otherwise from their joints. `notes` says what was assumed and left out. Throws
/// Error(bad_file).
Pattern read_pose_sequence(const MotionInput& source, std::vector<std::string>& notes);

}  // namespace ayumi
