#include "ayumi/plot/compare_plot.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/plot/axes.hpp"

namespace ayumi {

namespace {

using Eigen::Vector2d;
using Eigen::Vector4f;

// Width of the plot, and heights of its panels [pixel].
constexpr double kComparedWidth = 1000, kCurveHeight = 104, kErrorHeight = 62;
// Margins of the plot [pixel].
constexpr double kComparedLeft = 96, kComparedRight = 24, kComparedTop = 60;
// Space between a curve and its difference, so that the names at their sides do not touch, and
// space between curves.
constexpr double kErrorGap = 20, kCurveGap = 26;  // [pixel]

const Vector4f kMeasured = {0.10f, 0.10f, 0.12f, 1}, kSimulated = {0.86f, 0.45f, 0.10f, 1},
               kDifference = {0.62f, 0.12f, 0.24f, 1};

struct ShownCurve {
  const ComparedCurve* curve;
  double unit;
  std::string name;
};

std::vector<ShownCurve> shown_curves(const Comparison& comparison) {
  constexpr double kDegree = M_PI / 180;
  std::vector<ShownCurve> shown;
  for (const ComparedCurve& joint : comparison.joints) {
    const auto [low, high] = std::minmax_element(joint.simulated.begin(), joint.simulated.end());
    const bool angle = joint.unit == "rad";
    if (*high - *low > (angle ? 0.5 * kDegree : 0.0005))
      shown.push_back({&joint, angle ? kDegree : 1, joint.name + (angle ? " [deg]" : " [m]")});
  }
  for (const auto* curves : {&comparison.loads, &comparison.imu})
    for (const ComparedCurve& curve : *curves)
      shown.push_back(
          {&curve, 1, curve.name + (curve.unit.empty() ? "" : " [" + curve.unit + "]")});
  return shown;
}

Interval range_of(const std::vector<Vector2d>& a, const std::vector<Vector2d>& b) {
  Interval range{HUGE_VAL, -HUGE_VAL};
  for (const auto* values : {&a, &b})
    for (const Vector2d& value : *values) {
      range.low = std::min(range.low, value.y());
      range.high = std::max(range.high, value.y());
    }
  const double room = std::max(1e-6, 0.06 * range.span());
  return {range.low - room, range.high + room};
}

void draw_curve(Drawing& drawing, const Comparison& comparison, const ShownCurve& shown, double top,
                bool last) {
  std::vector<Vector2d> measured, simulated, difference;
  for (size_t k = 0; k < comparison.times.size(); ++k) {
    const double t = comparison.times[k];
    const double m = shown.curve->measured[k] / shown.unit,
                 s = shown.curve->simulated[k] / shown.unit;
    measured.emplace_back(t, m);
    simulated.emplace_back(t, s);
    difference.emplace_back(t, m - s);
  }
  Axes axes{kComparedLeft,
            top,
            kComparedWidth - kComparedLeft - kComparedRight,
            kCurveHeight,
            {comparison.begin, comparison.end},
            range_of(measured, simulated)};
  draw_axes(drawing, axes, shown.name, false);
  draw_line(drawing, axes, simulated, {kSimulated, 2.2});
  draw_line(drawing, axes, measured, {kMeasured, 1});
  axes.top += kCurveHeight + kErrorGap;
  axes.height = kErrorHeight;
  axes.y = range_of(difference, difference);
  draw_axes(drawing, axes, "difference", last);
  draw_line(drawing, axes, difference, {kDifference, 1});
}

}  // namespace

Drawing draw_comparison(const Comparison& comparison, const std::string& title) {
  const std::vector<ShownCurve> shown = shown_curves(comparison);
  if (shown.empty())
    fail(ErrorCode::usage,
         "no joint moves in the compared time, and there are no other curves, so there is nothing "
         "to draw");
  Drawing drawing;
  drawing.width = kComparedWidth;
  const double step = kCurveHeight + kErrorGap + kErrorHeight + kCurveGap;
  drawing.height = kComparedTop + step * static_cast<double>(shown.size()) + 20;
  drawing.title = title;
  drawing.description =
      "Measured (black), simulated (orange), and the difference between the two (red)";
  drawing.items.push_back(
      DrawnText{.position = {kComparedLeft, 24}, .text = title, .size = 16, .bold = true});
  drawing.items.push_back(DrawnText{
      .position = {kComparedLeft, 44}, .text = drawing.description + "; time [s]", .size = 12});
  for (size_t i = 0; i < shown.size(); ++i)
    draw_curve(drawing, comparison, shown[i], kComparedTop + step * static_cast<double>(i),
               i + 1 == shown.size());
  return drawing;
}

void write_comparison_plot(const Comparison& comparison, const std::string& title,
                           const std::filesystem::path& path) {
  write_drawing(path, draw_comparison(comparison, title), 1.5);
}

}  // namespace ayumi
