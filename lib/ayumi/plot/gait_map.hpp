#pragma once
// The map of a library of walks. There is a panel for every turning rate and period, with a cell
// for every speed forward and sideways that shows its margin, and with bars between neighbours for
// the transitions. It is seen from above: forward is up, and left is left.

#include <optional>
#include <string>
#include <vector>

#include "ayumi/plot/drawing.hpp"

namespace ayumi {

struct GaitMapCell {
  std::optional<double> margin = {};  ///< margin of the ZMP [m]; without it, the cell is missing
  char mark = ' ';                    ///< mark of a missing cell, one of GaitMap::marks
};

/// Transitions between two neighbours of a panel.
struct GaitMapLink {
  size_t from = 0, to = 0;  ///< cells of the panel
  int ways = 0;             ///< 2 for both directions, 1 for one direction only
};

struct GaitMapPanel {
  std::string title;
  /// Cells by forward speed, and for each of these by sideways speed.
  std::vector<GaitMapCell> cells;
  std::vector<GaitMapLink> links = {};
};

struct GaitMap {
  std::string title;
  std::vector<double> forward, sideways;  ///< speeds [m/s] in rising order
  size_t columns = 1;                     ///< number of panels in a row
  std::vector<GaitMapPanel> panels;
  std::vector<std::pair<char, std::string>> marks = {};  ///< reasons for missing cells, in words
  std::vector<std::string> remarks = {};                 ///< lines below the map
};

/// Throws Error(usage) if there is no panel, or if a panel does not have one cell for each pair of
/// speeds.
Drawing draw_gait_map(const GaitMap& map);

}  // namespace ayumi
