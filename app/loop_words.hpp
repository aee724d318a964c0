#pragma once
// Differences between the end of a motion and its beginning, in words and as JSON.

#include <nlohmann/json.hpp>
#include <string>

#include "ayumi/author/edit/edit.hpp"

namespace ayumi::app {

/// The differences in words, such as "feet 0.01 mm, base 0.02 mm, posture 0.10 deg (l_knee), joint
/// speeds 0.00 deg/s".
std::string gap_words(const LoopGap& gap);
/// The same, with the limits below which a motion counts as closed.
std::string gap_and_limits(const LoopGap& gap);

nlohmann::ordered_json gap_json(const LoopGap& gap);

}  // namespace ayumi::app
