#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "ayumi/demand/clearance_points.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "tests/support/biped.hpp"
#include "tests/support/hoap1.hpp"
#include "tests/support/random_robot.hpp"

using namespace ayumi;
using namespace ayumi::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

// The pair of two bodies' shapes with their edges.
ShapePair pair_of(const CollisionModel& collisions, const char* one, const char* other) {
  const int a = hoap1().links()[hoap1().find_link(one)].body;
  const int b = hoap1().links()[hoap1().find_link(other)].body;
  for (size_t i = 0; i < collisions.pairs().size(); ++i)
    if (collisions.pairs()[i].a == std::min(a, b) && collisions.pairs()[i].b == std::max(a, b))
      return {.pair = static_cast<int>(i), .edges = true};
  ADD_FAILURE() << one << " and " << other << " are not watched";
  return {};
}

// A state in which the legs of a walk are near each other.
RobotState near_state(Random& random) {
  RobotState state = hoap1().rest_state();
  for (const Side side : {Side::left, Side::right})
    for (const int i : hoap1().leg(side)) state.theta[i] += random.uniform(-0.25, 0.25);
  return state;
}

// Two arms of three joints each on a base, with every kind of shape.
RobotModel shapely_arms() {
  RobotDescription d;
  d.name = "arms";
  d.links.push_back(box_link("base", 1, {0, 0, 0}, {0.02, 0.02, 0.02}));
  for (const bool left : {true, false}) {
    const std::string s = left ? "l_" : "r_";
    const double y = left ? 0.13 : -0.13;
    std::string parent = "base";
    for (const char* axis : {"x", "y", "z"}) {
      d.links.push_back(box_link(s + axis, 0.2, {0, 0, -0.05}, {0.02, 0.02, 0.1}));
      const Vector3d along(axis[0] == 'x', axis[0] == 'y', axis[0] == 'z');
      const Vector3d at = parent == "base" ? Vector3d(0, y, 0) : Vector3d(0, 0, -0.02);
      d.joints.push_back(hinge(s + "to_" + axis, parent, s + axis, at, along, -2, 2));
      parent = s + axis;
    }
    auto add = [&](const Shape& shape, const Vector3d& place) {
      PlacedShape placed;
      placed.shape = shape;
      placed.pose.translation() = place;
      placed.pose.linear() =
          Eigen::AngleAxisd(left ? 0.7 : -0.5, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
      d.links.back().collisions.push_back(placed);
    };
    add(Box{{0.12, 0.02, 0.03}}, {0.01, left ? -0.05 : 0.05, -0.05});
    if (!left) add(Cylinder{0.015, 0.06}, {0.02, 0.06, -0.10});
    add(Capsule{0.012, 0.05}, {-0.02, left ? -0.06 : 0.06, -0.10});
    add(Sphere{0.02}, {0, left ? -0.02 : 0.02, -0.16});
  }
  return RobotModel(d);
}

}  // namespace

// The distance of a point from a box is compared with the general distance of two shapes: the box
// and a ball around the point.
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
  const ShapePair feet = pair_of(collisions, "l_foot", "r_foot");
  ASSERT_EQ(clearance_point_count(collisions, feet), 17);
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
  const ShapePair feet = pair_of(collisions, "l_foot", "r_foot");
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
    EXPECT_LT(by.leftCols<3>().norm(), 1e-12);  // if both move as one body, their distance stays
  }
}

// Ends of capsules and cylinders, against boxes and each other.
TEST(ClearanceRows, GradientOfEveryShapeAgainstDifferences) {
  const RobotModel model = shapely_arms();
  const CollisionModel collisions(model);
  ASSERT_EQ(collisions.pairs().size(), 1u);
  std::vector<ShapePair> shapes = shape_pairs(collisions, 0);
  ASSERT_EQ(shapes.size(), 12u);
  Random random(9);
  RobotData data(model);
  int near = 0;
  for (int i = 0; i < 40; ++i) {
    RobotState state = model.rest_state();
    for (double& angle : state.theta) angle = random.uniform(-0.8, 0.8);
    for (const ShapePair& each : shapes) {
      update_positions(model, state, data);
      const auto points = clearance_points(collisions, each, data);
      ASSERT_EQ(static_cast<int>(points.size()), clearance_point_count(collisions, each));
      const double least = shape_clearance(collisions, each, data, 1);
      const Eigen::MatrixXd by = clearance_gradient(model, collisions, each, data);
      for (size_t row = 0; row < points.size(); ++row) {
        if (least < 1e-3) continue;  // where cores meet, there is no gradient at their surface
        ++near;
        EXPECT_GE(points[row].clearance, least - 1e-7);
        for (int joint = 0; joint < model.dof_count(); ++joint) {
          constexpr double h = 1e-6;
          double moved[2];
          for (const int k : {0, 1}) {
            RobotState other = state;
            other.theta[joint] += k == 0 ? -h : h;
            update_positions(model, other, data);
            moved[k] = clearance_points(collisions, each, data)[row].clearance;
          }
          EXPECT_NEAR(by(static_cast<Eigen::Index>(row), 6 + joint),
                      (moved[1] - moved[0]) / (2 * h), 2e-5)
              << each.a << " " << each.b << " " << row;
        }
      }
    }
  }
  EXPECT_GT(near, 500);
}

// Two long boxes are crossed on their edges: no corner tells how near they are.
TEST(ClearanceRows, EdgesAreARowWhereNoCornerIsNearer) {
  const RobotModel model = shapely_arms();
  const CollisionModel collisions(model);
  RobotData data(model);
  int edges = 0, corners = 0;
  Random random(4);
  for (int i = 0; i < 200; ++i) {
    RobotState state = model.rest_state();
    for (double& angle : state.theta) angle = random.uniform(-0.8, 0.8);
    update_positions(model, state, data);
    ShapePair boxes;  // each is the first shape of its body
    EXPECT_EQ(clearance_point_count(collisions, boxes), 16);
    const bool meet = edges_meet(collisions, boxes, data, 1e-6);
    double least = 1;
    for (const Closest& c : clearance_points(collisions, boxes, data))
      least = std::min(least, c.clearance);
    const double all = shape_clearance(collisions, boxes, data, 1);
    if (least > 0) {
      EXPECT_EQ(meet, least > all + 1e-6) << least << " " << all;
    }
    (meet ? edges : corners) += 1;
  }
  EXPECT_GT(edges, 5);
  EXPECT_GT(corners, 5);
}

TEST(ClearanceRows, RowsByWhatShapesEndIn) {
  const RobotModel model = shapely_arms();
  const CollisionModel collisions(model);
  // One body has a box, a capsule and a sphere; the other has a box, a cylinder, a capsule and a
  // sphere.
  const int ends_a[] = {8, 2, 0}, ends_b[] = {8, 2, 2, 0};
  for (ShapePair each : shape_pairs(collisions, 0)) {
    const int count = ends_a[each.a] + ends_b[each.b];
    EXPECT_EQ(clearance_point_count(collisions, each), std::max(1, count));
    each.edges = true;
    EXPECT_EQ(clearance_point_count(collisions, each), 1 + count);
  }
}
