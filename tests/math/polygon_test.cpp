#include "ayumi/math/polygon.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/random_robot.hpp"

namespace ayumi {
namespace {

using Eigen::Vector2d;

std::vector<Vector2d> random_points(test::Random& random, int count) {
  std::vector<Vector2d> points;
  for (int i = 0; i < count; ++i) points.emplace_back(random.uniform(), random.uniform());
  return points;
}

class RandomPolygons : public testing::TestWithParam<unsigned> {
 protected:
  RandomPolygons()
      : random(GetParam()),
        points(random_points(random, 1 + static_cast<int>(GetParam() % 12))),
        polygon(points) {}
  test::Random random;
  std::vector<Vector2d> points;
  ConvexPolygon polygon;
};

TEST_P(RandomPolygons, HoldTheirPoints) {
  for (const Vector2d& p : points) EXPECT_GE(polygon.margin(p), -1e-12);
  for (size_t i = 0; i < polygon.vertices().size(); ++i) {
    const size_t n = polygon.vertices().size();
    if (n < 3) break;
    const Vector2d a = polygon.vertices()[i], b = polygon.vertices()[(i + 1) % n],
                   c = polygon.vertices()[(i + 2) % n];
    const Vector2d u = b - a, v = c - b;
    EXPECT_GT(u.x() * v.y() - u.y() * v.x(), 0) << "counter-clockwise, no flat corners";
  }
}

TEST_P(RandomPolygons, ProjectionIsInsideNearestAndIdempotent) {
  for (int i = 0; i < 30; ++i) {
    const Vector2d p = 3 * Vector2d(random.uniform(), random.uniform());
    const Vector2d q = polygon.project(p);
    EXPECT_GE(polygon.margin(q), -1e-12);
    EXPECT_LT((polygon.project(q) - q).norm(), 1e-12);
    // The point is nearest: no point of the polygon lies beyond the line through q perpendicular to
    // p - q.
    if ((p - q).norm() > 1e-9) {
      EXPECT_LE(polygon.support((p - q).normalized()), (p - q).normalized().dot(q) + 1e-9);
      EXPECT_NEAR(polygon.margin(p), -(p - q).norm(), 1e-9);
    } else {
      EXPECT_EQ(p, q);
    }
  }
}

TEST_P(RandomPolygons, ShrinkingKeepsTheMargin) {
  const double distance = 0.05;
  const ConvexPolygon inner = polygon.shrunk(distance);
  if (inner.vertices().size() < 3) return;
  for (const Vector2d& p : inner.vertices()) EXPECT_NEAR(polygon.margin(p), distance, 1e-9);
}

TEST_P(RandomPolygons, SupportIsTheFarthestPoint) {
  for (int i = 0; i < 10; ++i) {
    const Vector2d n(random.uniform(), random.uniform());
    double farthest = -std::numeric_limits<double>::infinity();
    for (const Vector2d& p : points) farthest = std::max(farthest, n.dot(p));
    EXPECT_NEAR(polygon.support(n), farthest, 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomPolygons, testing::Range(1u, 25u));

TEST(ConvexPolygon, OfASquare) {
  const ConvexPolygon square({{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 1}, {1, 0}});
  EXPECT_EQ(square.vertices().size(), 4u);
  EXPECT_DOUBLE_EQ(square.margin({1, 0.25}), 0.25);
  EXPECT_DOUBLE_EQ(square.margin({3, 3}), -std::sqrt(2.0));
  EXPECT_EQ(square.project({3, 1}), Vector2d(2, 1));
  EXPECT_LT((square.centroid() - Vector2d(1, 1)).norm(), 1e-15);
  EXPECT_EQ(square.shrunk(1.5).vertices().size(), 1u);
}

TEST(ConvexPolygon, EmptyHasNoMargin) {
  EXPECT_EQ(ConvexPolygon().margin({0, 0}), -std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace ayumi
