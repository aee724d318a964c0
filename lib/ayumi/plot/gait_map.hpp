#pragma once
// The map of a library of walks: for every turning rate and period a panel, in it a cell for every
// speed forward and sideways with its margin, and a bar between neighbours for the transitions.
// Seen from above: forward is up, left is left.

#include <optional>
#include <string>
#include <vector>

#include "ayumi/plot/drawing.hpp"

namespace ayumi {

struct GaitMapCell {
  std::optional<double> margin = {};  ///< margin of the ZMP [m]; none: the cell is missing
  char mark = ' ';                    ///< mark of a missing cell, one of GaitMap::marks
};

/// Transitions between two neighbours of a panel.
struct GaitMapLink {
  size_t from = 0, to = 0;  ///< cells of the panel
  int ways = 0;             ///< 2: in both directions, 1: in one direction only
};

struct GaitMapPanel {
  std::string title;
  std::vector<GaitMapCell> cells;  ///< by forward speed, and for each of them by sideways speed
  std::vector<GaitMapLink> links = {};
};

struct GaitMap {
  std::string title;
  std::vector<double> forward, sideways;  ///< [m/s], ascending
  size_t columns = 1;                     ///< number of panels in a row
  std::vector<GaitMapPanel> panels;
  std::vector<std::pair<char, std::string>> marks = {};  ///< reasons for missing cells, in words
  std::vector<std::string> remarks = {};                 ///< lines below the map
};

/// Throws Error(usage) when there is no panel or a panel has not one cell for each pair of speeds.
Drawing draw_gait_map(const GaitMap& map);

}  // namespace ayumi
