#pragma once
// One panel of a plot: its frame, ticks at round numbers, and lines that are cut off at its edges.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "ayumi/plot/drawing.hpp"

namespace ayumi {

/// The unit of lengths in plots and in the tables and the readout of reports, a millimetre [m].
inline constexpr double kMillimetre = 1e-3;

struct Interval {
  double low = 0, high = 1;
  double span() const { return high - low; }
};

/// The multiples of 1, 2 or 5 times a power of ten within the interval: about `count` of them, but
/// at least 2.
std::vector<double> nice_ticks(const Interval& interval, int count);

/// The number of digits after the point that ticks of this distance need.
int tick_digits(const std::vector<double>& ticks);

/// A rectangle of the drawing [pixel] and the values at its edges. Values of y grow upwards.
struct Axes {
  double left = 0, top = 0, width = 100, height = 100;
  Interval x, y;

  double px(double value) const { return left + width * (value - x.low) / x.span(); }
  double py(double value) const { return top + height * (1 - (value - y.low) / y.span()); }
  Eigen::Vector2d at(double vx, double vy) const { return {px(vx), py(vy)}; }
};

struct LineStyle {
  Eigen::Vector4f color = {0, 0, 0, 1};
  double width = 1.4;               ///< width of the line [pixel]
  std::vector<double> dashes = {};  ///< lengths of dashes and gaps [pixel]
};

/// Draws grid, tick numbers, frame, and the name of y on the left, and the numbers of x if they are
/// asked for.
void draw_axes(Drawing& drawing, const Axes& axes, const std::string& y_name, bool x_numbers);

/// Draws the polyline of (x, y) values, cut off at the frame and thinned to within about a tenth of
/// a pixel (the extremes stay). Non-finite values leave a gap.
void draw_line(Drawing& drawing, const Axes& axes, const std::vector<Eigen::Vector2d>& values,
               const LineStyle& style);

/// Draws a cross at a value, moved to the nearest place inside the frame.
void draw_cross(Drawing& drawing, const Axes& axes, const Eigen::Vector2d& value,
                const Eigen::Vector4f& color);

}  // namespace ayumi
