#include "ayumi/plot/axes.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/text.hpp"

namespace ayumi {
namespace {

using Eigen::Vector2d;
using Eigen::Vector4f;

const Vector4f kGrid = {0.5f, 0.5f, 0.55f, 0.28f};
const Vector4f kFrame = {0.25f, 0.25f, 0.28f, 1};
constexpr double kNumbers = 11;  // font size of numbers [pixel]
// Font size of the name of y, and the length by which the name extends to the left of the numbers
// [pixel].
constexpr double kName = 13, kNameOverhang = 8;

/// Keeps the first, the lowest, the highest and the last point of every stretch of a quarter pixel.
std::vector<Vector2d> thinned(const std::vector<Vector2d>& points) {
  if (points.size() < 8) return points;
  std::vector<Vector2d> out;
  for (size_t begin = 0; begin < points.size();) {
    const double column = std::floor(4 * points[begin].x());
    size_t end = begin, low = begin, high = begin;
    for (; end < points.size() && std::floor(4 * points[end].x()) == column; ++end) {
      if (points[end].y() < points[low].y()) low = end;
      if (points[end].y() > points[high].y()) high = end;
    }
    std::vector<size_t> keep = {begin, low, high, end - 1};
    std::sort(keep.begin(), keep.end());
    keep.erase(std::unique(keep.begin(), keep.end()), keep.end());
    for (const size_t index : keep) out.push_back(points[index]);
    begin = end;
  }
  return out;
}

/// Leaves out points that are nearer than a tenth of a pixel to the line that remains (by Ramer,
/// Douglas and Peucker, with an explicit stack).
std::vector<Vector2d> simplified(const std::vector<Vector2d>& points) {
  if (points.size() < 3) return points;
  std::vector<bool> keep(points.size(), false);
  keep.front() = keep.back() = true;
  std::vector<std::pair<size_t, size_t>> open = {{0, points.size() - 1}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    const Vector2d chord = points[last] - points[first];
    double worst = 0.1;
    size_t at = 0;
    for (size_t i = first + 1; i < last; ++i) {
      const Vector2d away = points[i] - points[first];
      const double share =
          std::clamp(away.dot(chord) / std::max(chord.squaredNorm(), 1e-12), 0.0, 1.0);
      const double distance = (away - share * chord).norm();
      if (distance > worst) {
        worst = distance;
        at = i;
      }
    }
    if (at == 0) continue;
    keep[at] = true;
    open.emplace_back(first, at);
    open.emplace_back(at, last);
  }
  std::vector<Vector2d> out;
  for (size_t i = 0; i < points.size(); ++i)
    if (keep[i]) out.push_back(points[i]);
  return out;
}

/// Narrows `share` to the values for which a + share * step lies between low and high. If there are
/// none, high < low.
void narrow(Interval& share, double a, double step, double low, double high) {
  if (step == 0) {
    if (a < low || a > high) share = {1, 0};
    return;
  }
  const double first = (low - a) / step, second = (high - a) / step;
  share.low = std::max(share.low, std::min(first, second));
  share.high = std::min(share.high, std::max(first, second));
}

/// The pieces of the polyline that are inside the frame.
std::vector<std::vector<Vector2d>> cut(const std::vector<Vector2d>& points, const Axes& axes) {
  std::vector<std::vector<Vector2d>> pieces;
  bool open = false;
  for (size_t i = 0; i + 1 < points.size(); ++i) {
    const Vector2d& from = points[i];
    const Vector2d step = points[i + 1] - from;
    Interval share = {0, 1};
    narrow(share, from.x(), step.x(), axes.left, axes.left + axes.width);
    narrow(share, from.y(), step.y(), axes.top, axes.top + axes.height);
    if (share.high < share.low) {
      open = false;
      continue;
    }
    if (!open || share.low > 0) pieces.push_back({from + share.low * step});
    pieces.back().push_back(from + share.high * step);
    open = share.high == 1;
  }
  return pieces;
}

}  // namespace

std::vector<double> nice_ticks(const Interval& interval, int count) {
  const double rough = interval.span() / std::max(1, count);
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  std::vector<double> ticks;
  const auto take = [&](double step) {
    ticks.clear();
    const double first = std::ceil(interval.low / step - 1e-9);
    const double last = std::floor(interval.high / step + 1e-9);
    for (double k = first; k <= last; ++k) ticks.push_back(k * step + 0.0);
  };
  const std::vector<double> steps = {10 * power, 5 * power,   2 * power,
                                     power,      0.5 * power, 0.2 * power};
  size_t chosen = 0;
  for (size_t i = 0; i < steps.size() && steps[i] >= rough * (1 - 1e-9); ++i) {
    take(steps[i]);
    if (ticks.size() > static_cast<size_t>(std::max(2, count))) break;
    chosen = i;
  }
  // A single number on an axis would not show a scale.
  for (take(steps[chosen]); ticks.size() < 2 && chosen + 1 < steps.size();) take(steps[++chosen]);
  return ticks;
}

int tick_digits(const std::vector<double>& ticks) {
  if (ticks.size() < 2) return 2;
  const double step = ticks[1] - ticks[0];
  return std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-6)));
}

void draw_axes(Drawing& drawing, const Axes& axes, const std::string& y_name, bool x_numbers) {
  const double right = axes.left + axes.width, bottom = axes.top + axes.height;
  const std::vector<double> y_ticks =
      nice_ticks(axes.y, std::max(2, static_cast<int>(axes.height / 26)));
  const std::vector<double> x_ticks =
      nice_ticks(axes.x, std::max(2, static_cast<int>(axes.width / 60)));
  for (const double tick : y_ticks) {
    const double y = axes.py(tick);
    drawing.items.push_back(DrawnPath{.points = {{axes.left, y}, {right, y}}, .stroke = kGrid});
    drawing.items.push_back(DrawnText{.position = {axes.left - 6, y + 0.36 * kNumbers},
                                      .text = text::fixed(tick, tick_digits(y_ticks)),
                                      .size = kNumbers,
                                      .anchor = TextAnchor::right});
  }
  for (const double tick : x_ticks) {
    const double x = axes.px(tick);
    drawing.items.push_back(DrawnPath{.points = {{x, axes.top}, {x, bottom}}, .stroke = kGrid});
    if (x_numbers)
      drawing.items.push_back(DrawnText{.position = {x, bottom + 1.4 * kNumbers},
                                        .text = text::fixed(tick, tick_digits(x_ticks)),
                                        .size = kNumbers,
                                        .anchor = TextAnchor::center});
  }
  drawing.items.push_back(DrawnPath{
      .points = {{axes.left, axes.top}, {right, axes.top}, {right, bottom}, {axes.left, bottom}},
      .closed = true,
      .stroke = kFrame});
  // A long name is written in smaller letters, so that it does not extend into the next panel.
  const double wide = text_width(y_name, kName);
  const double size = kName * std::min(1.0, (axes.height + kNameOverhang) / std::max(1.0, wide));
  drawing.items.push_back(DrawnText{.position = {axes.left - 58, axes.top + axes.height / 2},
                                    .text = y_name,
                                    .size = size,
                                    .anchor = TextAnchor::center,
                                    .upwards = true});
}

void draw_line(Drawing& drawing, const Axes& axes, const std::vector<Vector2d>& values,
               const LineStyle& style) {
  std::vector<Vector2d> run;
  const auto flush = [&] {
    for (std::vector<Vector2d>& piece : cut(simplified(thinned(run)), axes))
      drawing.items.push_back(DrawnPath{.points = std::move(piece),
                                        .stroke = style.color,
                                        .width = style.width,
                                        .dashes = style.dashes});
    run.clear();
  };
  for (const Vector2d& value : values) {
    if (value.allFinite())
      run.push_back(axes.at(value.x(), value.y()));
    else
      flush();
  }
  flush();
}

void draw_cross(Drawing& drawing, const Axes& axes, const Vector2d& value, const Vector4f& color) {
  constexpr double kArm = 5;  // length of an arm of the cross [pixel]
  Vector2d center = axes.at(value.x(), value.y());
  center.x() = std::clamp(center.x(), axes.left, axes.left + axes.width);
  center.y() = std::clamp(center.y(), axes.top + kArm, axes.top + axes.height - kArm);
  for (const double turn : {-1.0, 1.0})
    drawing.items.push_back(DrawnPath{
        .points = {center - Vector2d(kArm, turn * kArm), center + Vector2d(kArm, turn * kArm)},
        .stroke = color,
        .width = 2.2});
}

}  // namespace ayumi
