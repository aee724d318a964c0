#pragma once
// The polar map of a push study: for every gait phase the largest survivable impulse by direction,
// each law beside open loop and the capture bound. Seen from above, forward is up.

#include <filesystem>
#include <string>
#include <vector>

#include "ayumi/motion/command_series.hpp"
#include "ayumi/plot/drawing.hpp"
#include "ayumi/study/push.hpp"

namespace ayumi {

/// One curve of a panel; values by direction.
struct PushMapCurve {
  std::vector<double> impulse;    ///< [N s]
  std::vector<bool> capped = {};  ///< the search ended at this value; empty: nowhere
};

struct PushMapPhase {
  std::string name;
  std::vector<double> direction;     ///< direction from forward, to the left [rad]
  std::vector<double> bound;         ///< capture bound [N s]
  std::vector<PushMapCurve> curves;  ///< open loop first, then the order of PushMap::laws
};

struct PushMap {
  std::string title;
  std::string baseline = "open loop";  ///< name of the first curve
  std::vector<std::string> laws;       ///< names of the other laws
  std::vector<PushMapPhase> phases;
  std::vector<std::string> remarks;  ///< lines below the map, e.g. the figures over all cases
};

/// The baseline of a push study: "open loop", or "no feedback" for VIIP's pendulum.
std::string push_baseline(const CommandSeries& series);

/// One line for each law while walking, and one for each law while standing: its worst and mean
/// limit in capture bounds, with those of the baseline.
std::vector<std::string> push_summary_lines(const std::vector<PushCase>& cases,
                                            const PushOptions& push, const CommandSeries& series);

/// "walk, hoap1, actuators hoap1: pushes of 20 ms"
std::string push_map_title(const std::string& pattern, const std::string& robot,
                           const std::string& profile, const PushOptions& push);

/// The map of a study of `series`.
PushMap push_map(const std::string& title, const std::vector<PushCase>& cases,
                 const PushOptions& push, const CommandSeries& series);

/// A map for pages and prints, or for a telephone.
enum class PushMapLayout { wide, narrow };

/// One polar panel per phase, all with the same radius. Throws Error(usage) when there is no phase,
/// a curve has another length than its directions, or more than four laws.
/// A narrow map has its panels below each other, and no title.
Drawing draw_push_map(const PushMap& map, PushMapLayout layout = PushMapLayout::wide);

/// Writes the map as .svg or .png. Throws as above, and Error(bad_file).
void write_push_map(const PushMap& map, const std::filesystem::path& path);

}  // namespace ayumi
