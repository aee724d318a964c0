#include "ayumi/plot/gait_map.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"

namespace ayumi {

namespace {

using Eigen::Vector2d;
using Eigen::Vector4f;

constexpr double kGaitWidth = 44, kGaitHeight = 24;  // size of a cell [pixel]
constexpr double kGaitGap = 12;  // distance between two cells, with room for a bar [pixel]
constexpr double kGaitEdge = 16, kGaitHead = 46,
                 kGaitName = 26;   // margin, head, and title of a panel [pixel]
constexpr double kGaitScale = 52;  // room for the numbers beside a panel [pixel]
constexpr double kGaitBelow = 40;  // room for the numbers below a panel [pixel]
constexpr double kGaitLine = 18;   // height of text [pixel]
constexpr double kGaitText = 11;   // font size [pixel]
const Vector4f kGaitInk = {0.1f, 0.1f, 0.12f, 1}, kGaitGrey = {0.42f, 0.44f, 0.48f, 1};
const Vector4f kLeastMargin = {0.93f, 0.95f, 0.98f, 1}, kMostMargin = {0.08f, 0.33f, 0.68f, 1};
const Vector4f kMissingCell = {0.94f, 0.94f, 0.94f, 1}, kBothWays = {0.42f, 0.44f, 0.48f, 1};
const Vector4f kOneWay = {0.86f, 0.45f, 0.10f, 1};

DrawnText map_text(const Vector2d& at, const std::string& text,
                   TextAnchor anchor = TextAnchor::left, const Vector4f& color = kGaitInk) {
  return {.position = at, .text = text, .size = kGaitText, .anchor = anchor, .color = color};
}

// The places of the cells. Forward is up, and left is left.
struct CellPlaces {
  Vector2d corner;
  size_t rows, columns;

  Vector2d low(size_t cell) const {
    const size_t row = rows - 1 - cell / columns, column = columns - 1 - cell % columns;
    return corner + Vector2d(static_cast<double>(column) * (kGaitWidth + kGaitGap),
                             static_cast<double>(row) * (kGaitHeight + kGaitGap));
  }
  Vector2d middle(size_t cell) const { return low(cell) + 0.5 * Vector2d(kGaitWidth, kGaitHeight); }
};

std::string speed_text(double value) { return text::brief(value, 3); }

void draw_cells(Drawing& drawing, const GaitMap& map, const GaitMapPanel& panel,
                const CellPlaces& place, double most) {
  drawing.items.push_back(DrawnText{
      .position = place.corner - Vector2d(0, 10), .text = panel.title, .size = 12, .bold = true});
  for (const GaitMapLink& link : panel.links) {
    DrawnPath bar;
    bar.points = {place.middle(link.from), place.middle(link.to)};
    bar.stroke = link.ways == 2 ? kBothWays : kOneWay;
    bar.width = link.ways == 2 ? 4 : 2;
    if (link.ways > 0) drawing.items.push_back(bar);
  }
  for (size_t i = 0; i < panel.cells.size(); ++i) {
    const GaitMapCell& cell = panel.cells[i];
    const Vector2d low = place.low(i), high = low + Vector2d(kGaitWidth, kGaitHeight);
    const float share =
        cell.margin ? static_cast<float>(std::clamp(*cell.margin / most, 0.0, 1.0)) : 0;
    const Vector4f color =
        cell.margin ? Vector4f((1 - share) * kLeastMargin + share * kMostMargin) : kMissingCell;
    drawing.items.push_back(filled_box(low, high, color));
    drawing.items.push_back(
        map_text(place.middle(i) + Vector2d(0, 4),
                 cell.margin ? text::fixed(1e3 * *cell.margin, 1) : std::string(1, cell.mark),
                 TextAnchor::center,
                 !cell.margin  ? kGaitGrey
                 : share > 0.5 ? Vector4f(1, 1, 1, 1)
                               : kGaitInk));
  }
  const size_t columns = map.sideways.size();
  for (size_t f = 0; f < map.forward.size(); ++f)
    drawing.items.push_back(map_text({place.corner.x() - 8, place.middle(f * columns).y() + 4},
                                     speed_text(map.forward[f]), TextAnchor::right, kGaitGrey));
  for (size_t s = 0; s < columns; ++s)
    drawing.items.push_back(map_text({place.middle(s).x(), place.low(0).y() + kGaitHeight + 16},
                                     speed_text(map.sideways[s]), TextAnchor::center, kGaitGrey));
}

}  // namespace

Drawing draw_gait_map(const GaitMap& map) {
  if (map.panels.empty()) fail(ErrorCode::usage, "gait map: there is nothing to draw");
  double most = 0;
  for (const GaitMapPanel& panel : map.panels) {
    if (panel.cells.size() != map.forward.size() * map.sideways.size())
      fail(ErrorCode::usage, "gait map: " + panel.title + ": a cell is missing");
    for (const GaitMapCell& cell : panel.cells) most = std::max(most, cell.margin.value_or(0));
  }
  if (!(most > 0)) most = 1;
  std::vector<std::string> below = {
      "A cell shows the smallest distance of the ZMP from the edge of the support [mm]. The "
      "speed forward [m/s] increases upwards, and the speed to the left [m/s] to the left.",
      "A grey bar joins two gaits with transitions in both directions, and an orange bar joins two "
      "gaits with a transition in one direction only."};
  for (const auto& [mark, text] : map.marks) below.push_back(std::string(1, mark) + ": " + text);
  below.insert(below.end(), map.remarks.begin(), map.remarks.end());

  const auto rows = static_cast<double>(map.forward.size());
  const auto columns = static_cast<double>(map.sideways.size());
  double panel_width = columns * (kGaitWidth + kGaitGap) - kGaitGap;
  for (const GaitMapPanel& panel : map.panels)
    panel_width = std::max(panel_width, text_width(panel.title, 12, true));
  const Vector2d size(kGaitScale + panel_width + kGaitEdge,
                      kGaitName + rows * (kGaitHeight + kGaitGap) - kGaitGap + kGaitBelow);
  const size_t across = std::clamp<size_t>(map.columns, 1, map.panels.size());
  const size_t down = (map.panels.size() + across - 1) / across;
  Drawing drawing;
  drawing.width = std::max(2 * kGaitEdge + size.x() * static_cast<double>(across),
                           2 * kGaitEdge + text_width(map.title, 15, true));
  for (const std::string& line : below)
    drawing.width = std::max(drawing.width, 2 * kGaitEdge + text_width(line, kGaitText));
  const double panels = kGaitHead + size.y() * static_cast<double>(down);
  drawing.height = panels + kGaitLine * static_cast<double>(below.size()) + kGaitEdge;
  drawing.title = map.title;
  drawing.description = "margin of the ZMP by speed forward, speed sideways and turning rate";
  drawing.items.push_back(
      DrawnText{.position = {kGaitEdge, 26}, .text = map.title, .size = 15, .bold = true});
  for (size_t i = 0; i < map.panels.size(); ++i) {
    const Vector2d corner(kGaitEdge + kGaitScale + size.x() * static_cast<double>(i % across),
                          kGaitHead + kGaitName + size.y() * static_cast<double>(i / across));
    draw_cells(drawing, map, map.panels[i], {corner, map.forward.size(), map.sideways.size()},
               most);
  }
  double y = panels + kGaitLine;
  for (const std::string& line : below) {
    drawing.items.push_back(map_text({kGaitEdge, y}, line));
    y += kGaitLine;
  }
  return drawing;
}

}  // namespace ayumi
