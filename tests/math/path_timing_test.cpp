// The quickest timing agrees with bang-bang motions in closed form and with a search by brute
// force.

#include "ayumi/math/path_timing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ayumi/math/random.hpp"

namespace ayumi {
namespace {

// Points of the path s in [0, length], with |s''| <= most_u.
std::vector<TimingPoint> straight(double length, int steps, double most_u, double most_speed) {
  std::vector<TimingPoint> points;
  for (int i = 0; i <= steps; ++i)
    points.push_back(
        {length * i / steps, {{1, 0, most_u}, {-1, 0, most_u}}, 0, most_speed * most_speed});
  return points;
}

void rest_at_ends(std::vector<TimingPoint>& points) {
  points.front().most = 0;
  points.back().most = 0;
}

double duration(const std::vector<TimingPoint>& points) {
  const PathTiming timing = quickest_timing(points);
  EXPECT_EQ(timing.stuck, -1);
  return timing.x.empty() ? -1 : times_along(points, timing.x).back();
}

}  // namespace

// From rest to rest over a length L with |s''| <= a, the motion speeds up over half of the length
// and slows down over the other half, and takes 2 sqrt(L / a).
TEST(PathTiming, OneAxisFromRestToRest) {
  auto points = straight(0.8, 200, 5, 100);
  rest_at_ends(points);
  EXPECT_NEAR(duration(points), 2 * std::sqrt(0.8 / 5), 1e-9);
}

// With a largest speed v below sqrt(L a), the time is L / v + v / a.
TEST(PathTiming, OneAxisWithALargestSpeed) {
  auto points = straight(0.8, 400, 5, 1);
  rest_at_ends(points);
  EXPECT_NEAR(duration(points), 0.8 / 1 + 1.0 / 5, 1e-3);
}

// A joint that follows q = L (1 - cos(pi s)) / 2 has rates q_s s' and accelerations q_s s'' + q_ss
// s'^2; its quickest motion is that of the straight path, whatever the path's own pace was.
TEST(PathTiming, TheOwnPaceOfThePathDoesNotMatter) {
  const double length = 0.8, most = 5;
  std::vector<TimingPoint> points;
  for (int i = 0; i <= 2000; ++i) {
    // q = L s^2 (3 - 2 s).
    const double s = i / 2000.0, rate = length * 6 * s * (1 - s), bend = length * (6 - 12 * s);
    points.push_back({s, {{rate, bend, most}, {-rate, -bend, most}}, 0, 1e4});
  }
  EXPECT_NEAR(duration(points), 2 * std::sqrt(length / most), 2e-3);
}

// Where the limits of speed have a narrow place, the timing slows down before it and speeds up
// after it.
TEST(PathTiming, SlowsOnlyAroundANarrowPlace) {
  auto points = straight(1, 1000, 4, 10);
  const double slow = 0.2;
  points[500].most = slow * slow;
  const PathTiming timing = quickest_timing(points);
  ASSERT_EQ(timing.stuck, -1);
  for (size_t i = 0; i < points.size(); ++i) {
    // x = slow^2 + 2 a |s - 0.5|.
    const double expected = slow * slow + 8 * std::abs(points[i].at - 0.5);
    EXPECT_NEAR(timing.x[i], expected, 1e-9) << i;
  }
}

// Rows may also require a smallest pace, such as a foot that cannot carry the standing robot.
TEST(PathTiming, ALeastPaceIsKept) {
  auto points = straight(1, 100, 4, 10);
  points[50].rows.push_back({0, -1, -2});
  points[40].most = 1;
  const PathTiming timing = quickest_timing(points);
  EXPECT_EQ(timing.stuck, 40) << "from x = 1, s'' = 4 over 0.1 gives 1.8, not 2";
  points[40].most = 1.3;
  EXPECT_EQ(quickest_timing(points).stuck, -1);
}

TEST(PathTiming, ARowThatNoPaceKeepsIsNamed) {
  auto points = straight(1, 100, 4, 10);
  points[30].rows.push_back({0, 0, -1});
  EXPECT_EQ(quickest_timing(points).stuck, 30);
}

// For random rows, every timing that satisfies the rows, found by a grid over (x, u) from the end,
// is as slow or slower at every point.
TEST(PathTiming, NoTimingOnAGridIsQuicker) {
  Random random(7);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * random.uniform();
  };
  for (int trial = 0; trial < 20; ++trial) {
    const int count = 25;
    std::vector<TimingPoint> points;
    for (int i = 0; i < count; ++i) {
      TimingPoint point{0.02 * i, {}, 0, 4};
      for (int r = 0; r < 6; ++r)
        point.rows.push_back({uniform(-1, 1), uniform(-3, 3), uniform(1, 4)});
      point.rows.push_back({1, 0, 30});
      point.rows.push_back({-1, 0, 30});
      points.push_back(point);
    }
    const auto keeps = [](const TimingPoint& point, double u, double x) {
      return x <= point.most + 1e-12 &&
             std::all_of(point.rows.begin(), point.rows.end(), [&](const TimingRow& row) {
               return row.u * u + row.x * x <= row.most + 1e-9;
             });
    };
    const PathTiming timing = quickest_timing(points);
    ASSERT_EQ(timing.stuck, -1) << trial;
    for (int i = 0; i + 1 < count; ++i) {
      const double u = (timing.x[i + 1] - timing.x[i]) / 0.04;
      EXPECT_TRUE(keeps(points[i], u, timing.x[i])) << trial << " " << i;
      EXPECT_TRUE(keeps(points[i + 1], u, timing.x[i + 1])) << trial << " " << i;
    }
    // Finds which x of the grid lead to the end.
    const int cells = 400;
    const auto x_of = [&](int cell) { return 4.0 * cell / cells; };
    std::vector<std::vector<char>> leads(count, std::vector<char>(cells + 1, 0));
    for (int cell = 0; cell <= cells; ++cell) leads[count - 1][cell] = 1;
    for (int i = count - 2; i >= 0; --i)
      for (int cell = 0; cell <= cells; ++cell)
        for (int to = 0; to <= cells && !leads[i][cell]; ++to) {
          const double u = (x_of(to) - x_of(cell)) / 0.04;
          leads[i][cell] = leads[i + 1][to] && keeps(points[i], u, x_of(cell)) &&
                           keeps(points[i + 1], u, x_of(to));
        }
    int cell = cells;
    while (cell > 0 && !leads[0][cell]) --cell;
    EXPECT_LE(x_of(cell), timing.x[0] + 1e-9) << trial;
    EXPECT_GE(x_of(cell), timing.x[0] - 0.2) << trial << ": the grid finds nearly the same";
  }
}

}  // namespace ayumi
