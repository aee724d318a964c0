#pragma once
// What moved from one motion to another, in words, as JSON and as a plot: repair and diff.

#include <filesystem>
#include <string>

#include "ayumi/check/consistency.hpp"
#include "ayumi/optimize/motion_change.hpp"
#include "ayumi/optimize/weighted_change.hpp"
#include "commands.hpp"

namespace ayumi::app {

/// A few indented lines: joints, how much and when; COG, feet, ZMP, f_z; the ZMP margin before and
/// after.
std::string motion_words(const RobotModel& model, const MotionChange& change,
                         const ConsistencyReport& before, const ConsistencyReport& after);

/// "  weighted change 0.17 and 0.003 for the safety that is missing".
std::string cost_words(const WeightedChange& cost);

/// COG, ZMP and f_z of both motions against time, with what the first one commands, as .svg or
/// .png.
void plot_motions(const RobotModel& model, const CommandSeries& before, const CommandSeries& after,
                  const std::string& title, const std::filesystem::path& path);

}  // namespace ayumi::app
