#include "ayumi/plot/push_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"

namespace ayumi {
namespace {

PushMap four_directions() {
  PushMap map;
  map.title = "walk";
  map.laws = {"dtad"};
  map.remarks = {"walking: dtad worst 1.02 B"};
  PushMapPhase phase;
  phase.name = "standing";
  for (int i = 0; i < 4; ++i) phase.direction.push_back(i * M_PI / 2);
  phase.bound = {2, 3, 2, 3};
  phase.curves = {{{1, 1, 1, 1}}, {{2, 4, 1, 2}, {false, true, false, false}}};
  map.phases = {phase, phase};
  return map;
}

std::vector<DrawnPath> paths(const Drawing& drawing, double width) {
  std::vector<DrawnPath> found;
  for (const auto& item : drawing.items)
    if (const auto* path = std::get_if<DrawnPath>(&item))
      if (path->width == width) found.push_back(*path);
  return found;
}

bool has_text(const Drawing& drawing, const std::string& wanted) {
  return std::any_of(drawing.items.begin(), drawing.items.end(), [&](const auto& item) {
    const auto* text = std::get_if<DrawnText>(&item);
    return text && text->text == wanted;
  });
}

TEST(PushMap, ForwardIsUpAndLengthsAreImpulses) {
  const std::vector<DrawnPath> curves = paths(draw_push_map(four_directions()), 1.8);
  ASSERT_EQ(curves.size(), 4u) << "open loop and one law in two panels";
  const std::vector<Eigen::Vector2d>& open = curves[0].points;
  const Eigen::Vector2d center = (open[0] + open[2]) / 2;
  const double unit = (open[0] - center).norm();  // length of 1 N s
  const std::vector<Eigen::Vector2d>& law = curves[1].points;
  // The push forward.
  EXPECT_NEAR((law[0] - (center + Eigen::Vector2d(0, -2 * unit))).norm(), 0, 1e-9);
  // The push to the left.
  EXPECT_NEAR((law[1] - (center + Eigen::Vector2d(-4 * unit, 0))).norm(), 0, 1e-9);
  // The push to the right.
  EXPECT_NEAR((law[3] - (center + Eigen::Vector2d(2 * unit, 0))).norm(), 0, 1e-9);
}

TEST(PushMap, SaysWhatItShows) {
  const Drawing drawing = draw_push_map(four_directions());
  for (const char* text : {"walk", "standing", "capture bound B", "open loop", "dtad", "forward",
                           "left", "walking: dtad worst 1.02 B",
                           "N s, through the COG; hollow point: the robot survives even the "
                           "largest push that was tried"})
    EXPECT_TRUE(has_text(drawing, text)) << text;
  for (const auto& item : drawing.items)
    if (const auto* path = std::get_if<DrawnPath>(&item)) {
      for (const Eigen::Vector2d& p : path->points)
        EXPECT_TRUE(p.x() >= 0 && p.x() <= drawing.width && p.y() >= 0 && p.y() <= drawing.height);
    }
}

// The dot of a largest value lies on the outer ring, beside the name of its direction. In an
// earlier version, the number of a ring was covered by dots of pushes forward.
TEST(PushMap, NamesOfDirectionsAndRingsStandBesideTheDots) {
  PushMap map = four_directions();
  map.phases[0].curves[1] = {{5, 5, 5, 5}, {false, false, false, false}};
  const Drawing drawing = draw_push_map(map);
  const std::vector<DrawnPath> dots = paths(drawing, 1.2);
  ASSERT_FALSE(dots.empty());
  for (const auto& item : drawing.items) {
    const auto* text = std::get_if<DrawnText>(&item);
    if (!text) continue;
    const std::string& words = text->text;
    const bool is_number = words.find_first_not_of("0123456789.") == std::string::npos;
    if (!is_number && words != "forward" && words != "back" && words != "left" && words != "right")
      continue;
    const double wide = text_width(text->text, text->size), x = text->position.x();
    const double left = text->anchor == TextAnchor::left    ? x
                        : text->anchor == TextAnchor::right ? x - wide
                                                            : x - wide / 2;
    // Letters reach three quarters of their size above the base line and a quarter below it.
    const double top = text->position.y() - 0.75 * text->size,
                 bottom = text->position.y() + 0.25 * text->size;
    for (const DrawnPath& dot : dots)
      for (const Eigen::Vector2d& p : dot.points) {
        const double across = std::max({left - p.x(), p.x() - left - wide, 0.0});
        const double along = std::max({top - p.y(), p.y() - bottom, 0.0});
        EXPECT_GT(std::hypot(across, along), 2) << text->text;  // distance [pixel]
      }
  }
}

// On a page of 390 pixels, nothing is cut off, and letters have 11 pixels or more.
TEST(PushMap, ANarrowMapFitsOnATelephone) {
  const Drawing drawing = draw_push_map(four_directions(), PushMapLayout::narrow);
  EXPECT_LE(drawing.width, 350);
  EXPECT_GT(drawing.height, draw_push_map(four_directions()).height) << "panels below each other";
  for (const auto& item : drawing.items)
    if (const auto* text = std::get_if<DrawnText>(&item)) {
      EXPECT_GE(text->size, 11) << text->text;
      const double wide = text_width(text->text, text->size, text->bold);
      const double left = text->position.x() - (text->anchor == TextAnchor::right    ? wide
                                                : text->anchor == TextAnchor::center ? wide / 2
                                                                                     : 0);
      EXPECT_GE(left, 0) << text->text;
      EXPECT_LE(left + wide, drawing.width) << text->text;
      EXPECT_LE(text->position.y(), drawing.height) << text->text;
    }
}

TEST(PushMap, LongRemarksFit) {
  PushMap map = four_directions();
  map.remarks.push_back(std::string(200, 'x'));
  EXPECT_GT(draw_push_map(map).width, text_width(map.remarks.back(), 11));
}

TEST(PushMap, RefusesWhatItCannotDraw) {
  const auto message = [](const PushMap& map) -> std::string {
    try {
      draw_push_map(map);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message({}).find("there is no phase to draw"), std::string::npos);
  PushMap map = four_directions();
  map.phases[1].curves[1].impulse.pop_back();
  EXPECT_NE(message(map).find(
                "standing: the number of values of a curve is not the number of directions"),
            std::string::npos);
  map = four_directions();
  map.laws = {"a", "b", "c", "d", "e"};
  EXPECT_NE(message(map).find("more than four"), std::string::npos);
}

// A motion on one foot whose other foot lands `ahead` of its place [m].
CommandSeries on_one_foot(double ahead, bool both_in_turn = false) {
  CommandSeries series;
  series.samples.resize(50);
  for (size_t k = 10; k < 20; ++k) series.samples[k].support = Support::left;
  for (size_t k = 30; both_in_turn && k < 40; ++k) series.samples[k].support = Support::right;
  for (size_t k = 20; k < 50; ++k) series.samples[k].feet[1].translation().x() = ahead;
  return series;
}

std::string label_of(const CommandSeries& series) {
  PushCase push;
  push.bound = 1;
  push.limits.resize(1);
  PushOptions options;
  options.controllers.resize(1);
  const std::string line = push_summary_lines({push}, options, series).front();
  return line.substr(0, line.find(", "));
}

TEST(PushMap, TheLabelFitsTheMotion) {
  EXPECT_EQ(label_of(on_one_foot(0.03)), "pushes while walking");
  EXPECT_EQ(label_of(on_one_foot(0)), "pushes during the motion") << "a kick is no walk";
  EXPECT_EQ(label_of(on_one_foot(0, true)), "pushes while stepping in place");
  CommandSeries still;
  still.samples.resize(2);
  EXPECT_EQ(label_of(still), "pushes during the motion");
}

}  // namespace
}  // namespace ayumi
