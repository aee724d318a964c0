// The map of a library of walks: the cells are at the places of their speeds, and missing ones have
// marks.

#include "ayumi/plot/gait_map.hpp"

#include <gtest/gtest.h>

#include "ayumi/base/error.hpp"

namespace ayumi {
namespace {

Eigen::Vector2d place_of(const Drawing& drawing, const std::string& text) {
  for (const auto& item : drawing.items)
    if (const auto* words = std::get_if<DrawnText>(&item); words && words->text == text)
      return words->position;
  ADD_FAILURE() << text << " is not there";
  return {};
}

GaitMap two_by_two() {
  GaitMap map;
  map.title = "walks";
  map.forward = {0, 0.05};
  map.sideways = {-0.02, 0.02};
  map.panels = {{"straight",
                 {{.margin = 0.011}, {.margin = 0.012}, {.margin = 0.013}, {.mark = 'r'}},
                 {{0, 1, 2}, {0, 2, 1}, {1, 3, 0}}}};
  map.marks = {{'r', "there is no repair"}};
  return map;
}

TEST(GaitMap, ForwardIsUpAndLeftIsLeft) {
  const Drawing drawing = draw_gait_map(two_by_two());
  const auto slow_right = place_of(drawing, "11.0"), slow_left = place_of(drawing, "12.0");
  const auto fast_right = place_of(drawing, "13.0"), fast_left = place_of(drawing, "r");
  EXPECT_LT(slow_left.x(), slow_right.x());
  EXPECT_LT(fast_right.y(), slow_right.y());
  EXPECT_EQ(fast_left.x(), slow_left.x());
  EXPECT_EQ(fast_left.y(), fast_right.y());
  place_of(drawing, "r: there is no repair");
  EXPECT_EQ(place_of(drawing, "0.05").y(), fast_right.y());
  size_t bars = 0;
  for (const auto& item : drawing.items)
    if (const auto* path = std::get_if<DrawnPath>(&item)) bars += !path->closed;
  EXPECT_EQ(bars, 2u) << "a pair without a transition has no bar";
}

TEST(GaitMap, EveryCellIsNeeded) {
  GaitMap map = two_by_two();
  map.panels[0].cells.pop_back();
  EXPECT_THROW(draw_gait_map(map), Error);
  map.panels.clear();
  EXPECT_THROW(draw_gait_map(map), Error);
}

}  // namespace
}  // namespace ayumi
