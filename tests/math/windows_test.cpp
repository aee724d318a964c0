#include "ayumi/math/windows.hpp"

#include <gtest/gtest.h>

namespace ayumi {
namespace {

TEST(Windows, ThatOverlapOrTouchAreOne) {
  using Windows = std::vector<TimeWindow>;
  EXPECT_EQ(merged({{3, 4}, {0, 1}, {1, 2}, {3.5, 3.7}, {5, 6}}),
            (Windows{{0, 2}, {3, 4}, {5, 6}}));
  EXPECT_EQ(merged({{0, 9}, {2, 3}, {8, 10}}), (Windows{{0, 10}}));
  EXPECT_TRUE(merged({}).empty());
}

TEST(Windows, HoldTheirEnds) {
  const std::vector<TimeWindow> windows = {{0, 1}, {2, 3}};
  for (const double t : {0.0, 0.5, 1.0, 2.0, 3.0}) EXPECT_TRUE(within(windows, t)) << t;
  for (const double t : {-0.1, 1.1, 1.9, 3.1}) EXPECT_FALSE(within(windows, t)) << t;
}

}  // namespace
}  // namespace ayumi
