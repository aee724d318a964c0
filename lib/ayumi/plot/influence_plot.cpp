#include "ayumi/plot/influence_plot.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/plot/axes.hpp"

namespace ayumi {

namespace {

using Eigen::Vector2d;
using Eigen::Vector4f;

// Height of a row, height of the head, and margin [pixel].
constexpr double kRow = 22, kTop = 84, kEdge = 16;
constexpr double kPanelWidth = 280, kPanelGap = 40;  // width and gap of the two panels [pixel]
constexpr double kTextSize = 11;                     // font size [pixel]
const Vector4f kLine = {0.86f, 0.87f, 0.89f, 1}, kGrey = {0.42f, 0.44f, 0.48f, 1};
const Vector4f kWorse = {0.86f, 0.45f, 0.10f, 1}, kBetter = {0.08f, 0.33f, 0.68f, 1};

DrawnPath line(const Vector2d& from, const Vector2d& to, const Vector4f& color, double width = 1) {
  DrawnPath path;
  path.points = {from, to};
  path.stroke = color;
  path.width = width;
  return path;
}

DrawnText words(const Vector2d& at, const std::string& text, TextAnchor anchor = TextAnchor::left,
                const Vector4f& color = {0.1f, 0.1f, 0.12f, 1}) {
  return {.position = at, .text = text, .size = kTextSize, .anchor = anchor, .color = color};
}

}  // namespace

Drawing draw_influences(const std::string& title, const std::vector<ValueInfluence>& given) {
  if (given.empty()) fail(ErrorCode::usage, "there is no uncertain value to draw");
  std::vector<ValueInfluence> rows = given;
  std::stable_sort(rows.begin(), rows.end(), [](const ValueInfluence& a, const ValueInfluence& b) {
    return std::abs(a.correlation) > std::abs(b.correlation);
  });
  double names = 0, most = 0;
  for (const ValueInfluence& row : rows) {
    names = std::max(names, text_width(row.name, kTextSize));
    for (const RateInterval& rate : row.rate) most = std::max(most, rate.high);
  }
  const std::vector<double> ticks = nice_ticks({0, std::max(most, 1e-6)}, 4);
  most = std::max(most, ticks.back());
  const double left = kEdge + names + 14, right = left + kPanelWidth + kPanelGap;
  const double bottom = kTop + kRow * static_cast<double>(rows.size());
  Drawing drawing;
  drawing.width = std::max(right + kPanelWidth + kEdge, 2 * kEdge + text_width(title, 15, true));
  drawing.height = bottom + 34;
  drawing.title = title;
  drawing.description = "rank correlation and failure rates by uncertain value";
  drawing.items.push_back(
      DrawnText{.position = {kEdge, 26}, .text = title, .size = 15, .bold = true});
  drawing.items.push_back(words({left, 52}, "rank correlation with the severity of the run"));
  drawing.items.push_back(words({right, 52}, "failure rate for the lower half of the values"));
  drawing.items.push_back(words({right, 68}, "and for the upper half, each with its interval"));
  drawing.items.push_back(filled_box({right - 12, 44}, {right - 4, 52}, kBetter));
  drawing.items.push_back(filled_box({right - 12, 60}, {right - 4, 68}, kWorse));
  const double middle = left + 0.5 * kPanelWidth;
  for (const double tick : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
    const double x = middle + 0.5 * kPanelWidth * tick;
    drawing.items.push_back(line({x, kTop}, {x, bottom}, kLine));
    drawing.items.push_back(
        words({x, bottom + 16}, text::fixed(tick, 1), TextAnchor::center, kGrey));
  }
  const auto at = [&](double rate) { return right + kPanelWidth * rate / most; };
  const int digits = std::max(0, tick_digits(ticks) - 2);
  for (const double tick : ticks) {
    drawing.items.push_back(line({at(tick), kTop}, {at(tick), bottom}, kLine));
    drawing.items.push_back(words({at(tick), bottom + 16}, text::fixed(100 * tick, digits) + " %",
                                  TextAnchor::center, kGrey));
  }
  for (size_t i = 0; i < rows.size(); ++i) {
    const double y = kTop + kRow * (static_cast<double>(i) + 0.5);
    drawing.items.push_back(words({left - 8, y + 4}, rows[i].name, TextAnchor::right));
    drawing.items.push_back(filled_box({middle, y - 6},
                                       {middle + 0.5 * kPanelWidth * rows[i].correlation, y + 6},
                                       rows[i].correlation > 0 ? kWorse : kBetter));
    for (size_t half = 0; half < 2; ++half) {
      const double row = y + (half == 0 ? -4 : 4);
      const Vector4f& color = half == 0 ? kBetter : kWorse;
      const double rate = rows[i].runs[half] > 0 ? static_cast<double>(rows[i].failures[half]) /
                                                       static_cast<double>(rows[i].runs[half])
                                                 : 0.0;
      const RateInterval& interval = rows[i].rate[half];
      drawing.items.push_back(line({at(interval.low), row}, {at(interval.high), row}, color, 1.4));
      drawing.items.push_back(
          filled_box({at(rate) - 2.5, row - 2.5}, {at(rate) + 2.5, row + 2.5}, color));
    }
  }
  return drawing;
}

}  // namespace ayumi
