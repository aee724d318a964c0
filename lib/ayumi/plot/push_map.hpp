#pragma once
// The polar map of a push study: for every gait phase, the largest survivable impulse by direction,
// for each law beside open loop and the capture bound. It is seen from above, and forward is up.

#include <filesystem>
#include <string>
#include <vector>

#include "ayumi/motion/command_series.hpp"
#include "ayumi/plot/drawing.hpp"
#include "ayumi/study/push.hpp"

namespace ayumi {

/// One curve of a panel, with values by direction.
struct PushMapCurve {
  std::vector<double> impulse;    ///< impulse [N s]
  std::vector<bool> capped = {};  ///< the search ended at this value; if empty, it did so nowhere
};

struct PushMapPhase {
  std::string name;
  std::vector<double> direction;  ///< direction from forward, to the left [rad]
  std::vector<double> bound;      ///< capture bound [N s]
  /// Curves, open loop first and then in the order of PushMap::laws.
  std::vector<PushMapCurve> curves;
};

struct PushMap {
  std::string title;
  std::string baseline = "open loop";  ///< name of the first curve
  std::vector<std::string> laws;       ///< names of the other laws
  std::vector<PushMapPhase> phases;
  std::vector<std::string> remarks;  ///< lines below the map, such as the figures over all cases
};

/// The name of the baseline of a push study: "open loop", or "no feedback" for VIIP's pendulum.
std::string push_baseline(const CommandSeries& series);

/// What B means in these texts.
inline constexpr const char* kPushBoundLegend = "B = largest push that a point mass could absorb";

/// One line for each law while walking, and one for each law while standing, with its worst and
/// mean limit in capture bounds and those of the baseline.
std::vector<std::string> push_summary_lines(const std::vector<PushCase>& cases,
                                            const PushOptions& push, const CommandSeries& series);

/// A title such as "walk, hoap1, actuators hoap1: pushes of 20 ms".
std::string push_map_title(const std::string& pattern, const std::string& robot,
                           const std::string& profile, const PushOptions& push);

/// The map of a study of `series`.
PushMap push_map(const std::string& title, const std::vector<PushCase>& cases,
                 const PushOptions& push, const CommandSeries& series);

/// The layout of a map: for pages and prints, or for a telephone.
enum class PushMapLayout { wide, narrow };

/// Draws one polar panel per phase, all with the same radius. Throws Error(usage) if there is no
/// phase, if the length of a curve is not the number of its directions, or if there are more than
/// four laws. A narrow map has its panels below each other, and no title.
Drawing draw_push_map(const PushMap& map, PushMapLayout layout = PushMapLayout::wide);

/// Writes the map as .svg or .png. Throws the errors above, and Error(bad_file).
void write_push_map(const PushMap& map, const std::filesystem::path& path);

}  // namespace ayumi
