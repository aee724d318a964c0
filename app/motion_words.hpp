#pragma once
// The differences between two motions in words, as JSON and as a plot, for repair and diff.

#include <filesystem>
#include <string>

#include "ayumi/check/consistency.hpp"
#include "ayumi/repair/motion_change.hpp"
#include "ayumi/repair/weighted_change.hpp"
#include "commands.hpp"

namespace ayumi::app {

/// A margin in words, such as "7.1 mm inside the support" or "10.0 mm outside the support".
std::string margin_words(double margin);

/// A few indented lines: which joints changed, by how much and when; COG, feet, ZMP and f_z; the
/// ZMP margin before and after. With names, the words compare two motions, such as two files, in
/// place of one motion before and after a change.
struct MotionNames {
  std::string first, second;
};
std::string motion_words(const RobotModel& model, const MotionChange& change,
                         const ConsistencyReport& before, const ConsistencyReport& after,
                         const MotionNames& names = {});

/// A line such as
///   "  weighted change of base and joints 0.17, cost of missing safety 0.003".
std::string cost_words(const WeightedChange& cost);

struct MotionPlot {
  std::string title, profile;
  std::string before = "before", after = "after";
};

/// Plots both motions over the time in which they differ: the joints that changed most with their
/// limits, the speed of those that were too fast, COG, ZMP, its margin and f_z, and the command
/// before the change if it differs from the motion. The file is .svg or .png.
void plot_motions(const RobotModel& model, const CommandSeries& before, const CommandSeries& after,
                  const MotionPlot& plot, const std::filesystem::path& path);

/// Column at which the second column of origin_words() begins.
inline constexpr size_t kOriginHang = 16;

/// The origin of each track of a sampled pattern, one line for each below a heading: what drives
/// the joints (of the legs above all) and the base, and what the COG, the ZMP and f_z follow.
std::string origin_words(const std::map<std::string, std::string>& origin);

}  // namespace ayumi::app
