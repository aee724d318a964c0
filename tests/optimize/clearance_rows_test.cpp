#include "ayumi/optimize/clearance_rows.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <variant>
#include <vector>

#include "ayumi/dynamics/kinematics.hpp"
#include "tests/support/hoap1.hpp"
#include "tests/support/random_robot.hpp"

using namespace ayumi;
using namespace ayumi::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

int pair_of(const CollisionModel& collisions, const char* one, const char* other) {
  const int a = hoap1().links()[hoap1().find_link(one)].body;
  const int b = hoap1().links()[hoap1().find_link(other)].body;
  for (size_t i = 0; i < collisions.pairs().size(); ++i)
    if (collisions.pairs()[i].a == std::min(a, b) && collisions.pairs()[i].b == std::max(a, b))
      return static_cast<int>(i);
  ADD_FAILURE() << one << " and " << other << " are not watched";
  return 0;
}

// Legs of a walk anywhere near each other.
RobotState near_state(Random& random) {
  RobotState state = hoap1().rest_state();
  for (const Side side : {Side::left, Side::right})
    for (const int i : hoap1().leg(side)) state.theta[i] += random.uniform(-0.25, 0.25);
  return state;
}

}  // namespace

// Second route: a ball about the point against the box by the general distance of two shapes.
TEST(ClearanceRows, PointFromBoxIsThatOfASmallBall) {
  Random random(3);
  const Vector3d half(0.05, 0.03, 0.01);
  const double radius = 1e-3;
  const Collider box(Box{2 * half}), ball(Sphere{radius});
  int inside = 0;
  for (int i = 0; i < 300; ++i) {
    Isometry3d pose = Isometry3d::Identity(), at = pose;
    pose.linear() = Eigen::AngleAxisd(random.uniform(-3, 3), Vector3d(1, 2, -1).normalized())
                        .toRotationMatrix();
    pose.translation() = Vector3d(0.2, -0.1, 0.3);
    const Vector3d local(random.uniform(-0.1, 0.1), random.uniform(-0.06, 0.06),
                         random.uniform(-0.02, 0.02));
    at.translation() = pose * local;
    const Closest c = point_from_box(at.translation(), pose, half);
    inside += c.clearance < 0;
    EXPECT_NEAR(c.clearance, clearance(box, pose, ball, at) + radius, 1e-7);
    EXPECT_LT((c.on_a + c.clearance * c.normal - c.on_b).norm(), 1e-12);
    EXPECT_NEAR(c.normal.norm(), 1, 1e-12);
  }
  EXPECT_GT(inside, 5);
  EXPECT_LT(inside, 295);
}

TEST(ClearanceRows, FeetHaveTheirCornersTooAndNoneIsNearerThanTheFeet) {
  const CollisionModel collisions(hoap1());
  const int feet = pair_of(collisions, "l_foot", "r_foot");
  ASSERT_EQ(clearance_rows(collisions, feet), 17);
  Random random(5);
  RobotData data(hoap1());
  int touching = 0, by_corner = 0;
  for (int i = 0; i < 200; ++i) {
    update_positions(hoap1(), near_state(random), data);
    const auto points = clearance_points(collisions, feet, data);
    ASSERT_EQ(points.size(), 17u);
    if (points[0].clearance < 0) {
      ++touching;
      continue;
    }
    double least = points[1].clearance;
    for (const Closest& c : points) {
      EXPECT_GE(c.clearance, points[0].clearance - 1e-7);
      if (&c != &points[0]) least = std::min(least, c.clearance);
    }
    by_corner += least < points[0].clearance + 1e-7;
  }
  EXPECT_LT(touching, 150);
  EXPECT_GT(by_corner, 10);
}

TEST(ClearanceRows, GradientAgainstDifferences) {
  const CollisionModel collisions(hoap1());
  const int feet = pair_of(collisions, "l_foot", "r_foot");
  Random random(7);
  RobotData data(hoap1());
  for (int i = 0; i < 20; ++i) {
    const RobotState state = near_state(random);
    update_positions(hoap1(), state, data);
    const Eigen::MatrixXd by = clearance_gradient(hoap1(), collisions, feet, data);
    ASSERT_EQ(by.rows(), 17);
    for (const Side side : {Side::left, Side::right})
      for (const int joint : hoap1().leg(side)) {
        constexpr double h = 1e-6;
        std::array<std::vector<Closest>, 2> moved;
        for (int k = 0; k < 2; ++k) {
          RobotState other = state;
          other.theta[joint] += k == 0 ? -h : h;
          update_positions(hoap1(), other, data);
          moved[k] = clearance_points(collisions, feet, data);
        }
        for (size_t row = 1; row < 17; ++row)
          EXPECT_NEAR(by(static_cast<Eigen::Index>(row), 6 + joint),
                      (moved[1][row].clearance - moved[0][row].clearance) / (2 * h), 1e-5)
              << row;
      }
    EXPECT_LT(by.leftCols<3>().norm(), 1e-12);  // moved as one they stay as far apart
  }
}

// A body of several shapes, or of another than a box, has the one row.
TEST(ClearanceRows, OthersHaveTheirDistanceAlone) {
  const CollisionModel collisions(hoap1());
  std::vector<int> shapes(hoap1().bodies().size()), boxes = shapes;
  for (const Link& link : hoap1().links())
    for (const PlacedShape& shape : link.collisions) {
      ++shapes[static_cast<size_t>(link.body)];
      boxes[static_cast<size_t>(link.body)] += std::holds_alternative<Box>(shape.shape);
    }
  auto one_box = [&](int body) {
    return shapes[static_cast<size_t>(body)] == 1 && boxes[static_cast<size_t>(body)] == 1;
  };
  int single = 0;
  for (int i = 0; i < static_cast<int>(collisions.pairs().size()); ++i) {
    const CollisionModel::Pair& p = collisions.pairs()[i];
    EXPECT_EQ(clearance_rows(collisions, i), one_box(p.a) && one_box(p.b) ? 17 : 1) << i;
    single += clearance_rows(collisions, i) == 1;
  }
  EXPECT_GT(single, 0);
}
