#include "ayumi/plot/drawing.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/plot/axes.hpp"

namespace ayumi {
namespace {

using Eigen::Vector2d;

TEST(Ticks, AreRoundAndInside) {
  EXPECT_EQ(nice_ticks({0, 1}, 4), (std::vector<double>{0, 0.5, 1}));
  for (const Interval& interval :
       {Interval{-0.013, 0.021}, Interval{0.2371, 0.2379}, Interval{0, 4.2}, Interval{-3, 127}}) {
    for (const int count : {3, 5, 9}) {
      const std::vector<double> ticks = nice_ticks(interval, count);
      // One number does not show a scale, so that up to four may be there instead of one.
      ASSERT_GE(ticks.size(), 2u);
      EXPECT_LE(ticks.size(), size_t(std::max(count, 4)));
      EXPECT_GE(ticks.front(), interval.low - 1e-12);
      EXPECT_LE(ticks.back(), interval.high + 1e-12);
      const double step = ticks[1] - ticks[0];
      const double lead = step / std::pow(10.0, std::floor(std::log10(step) + 1e-6));
      EXPECT_TRUE(std::abs(lead - 1) < 1e-6 || std::abs(lead - 2) < 1e-6 ||
                  std::abs(lead - 5) < 1e-6)
          << step;
    }
  }
}

TEST(Ticks, DigitsTellNeighboursApart) {
  EXPECT_EQ(tick_digits({0, 0.5, 1}), 1);
  EXPECT_EQ(tick_digits({0, 0.02}), 2);
  EXPECT_EQ(tick_digits({0, 50}), 0);
}

std::vector<DrawnPath> paths_of(const Drawing& drawing) {
  std::vector<DrawnPath> paths;
  for (const auto& item : drawing.items)
    if (const auto* path = std::get_if<DrawnPath>(&item)) paths.push_back(*path);
  return paths;
}

const Axes kAxes = {10, 20, 100, 50, {0, 10}, {-1, 1}};

TEST(Lines, AreCutAtTheFrameExactly) {
  Drawing drawing;
  draw_line(drawing, kAxes, {{0, 0}, {5, 2}, {10, 0}}, {});
  const std::vector<DrawnPath> paths = paths_of(drawing);
  ASSERT_EQ(paths.size(), 2u) << "the top is missing";
  EXPECT_TRUE(paths[0].points.back().isApprox(kAxes.at(2.5, 1), 1e-9));
  EXPECT_TRUE(paths[1].points.front().isApprox(kAxes.at(7.5, 1), 1e-9));
  EXPECT_TRUE(paths[1].points.back().isApprox(kAxes.at(10, 0), 1e-9));
}

TEST(Lines, LeaveAGapAtUnknownValues) {
  Drawing drawing;
  draw_line(drawing, kAxes, {{0, 0}, {2, 0}, {3, NAN}, {4, 0}, {6, 0}}, {});
  EXPECT_EQ(paths_of(drawing).size(), 2u);
}

TEST(Lines, ThinningKeepsTheExtremes) {
  std::vector<Vector2d> values;
  for (int k = 0; k <= 20000; ++k) values.emplace_back(k * 5e-4, k == 12345 ? 0.9 : 0.0);
  Drawing drawing;
  draw_line(drawing, kAxes, values, {});
  ASSERT_EQ(paths_of(drawing).size(), 1u);
  const DrawnPath line = paths_of(drawing)[0];
  EXPECT_LT(line.points.size(), 1700u);
  double top = 1e9;
  for (const Vector2d& p : line.points) top = std::min(top, p.y());
  EXPECT_NEAR(top, kAxes.py(0.9), 1e-9);
}

Drawing small() {
  Drawing drawing;
  drawing.width = 60;
  drawing.height = 40;
  drawing.title = "a < b & \"c\"";
  drawing.items.push_back(DrawnPath{.points = {{10, 10}, {50, 10}, {50, 30}, {10, 30}},
                                    .closed = true,
                                    .stroke = {0, 0, 0, 0},
                                    .fill = {1, 0, 0, 1}});
  drawing.items.push_back(DrawnText{.position = {5, 38}, .text = "f_z < 3"});
  return drawing;
}

TEST(Drawings, SvgEscapesAndKeepsTextAsText) {
  const std::string svg = to_svg(small());
  EXPECT_NE(svg.find("<title>a &lt; b &amp; &quot;c&quot;</title>"), std::string::npos);
  EXPECT_NE(svg.find(">f_z &lt; 3</text>"), std::string::npos);
  EXPECT_NE(svg.find("fill=\"#ff0000\""), std::string::npos);
  EXPECT_EQ(to_svg(small()), svg);
}

TEST(Drawings, PictureShowsTheSame) {
  const Image image = to_image(small(), 2);
  EXPECT_EQ(image.width, 120);
  EXPECT_EQ(image.height, 80);
  EXPECT_EQ(image.pixel(60, 40)[0], 255);
  EXPECT_EQ(image.pixel(60, 40)[1], 0);
  EXPECT_EQ(image.pixel(10, 40)[1], 255);
  EXPECT_EQ(to_image(small(), 2).rgb, image.rgb);
}

TEST(Drawings, UnknownFormatIsNamed) {
  try {
    write_drawing("x.pdf", small(), 1);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    EXPECT_STREQ(error.what(), "x.pdf: the format '.pdf' is not one of .svg, .png");
  }
}

}  // namespace
}  // namespace ayumi
