#include "ayumi/geometry/distance.hpp"

#include <gtest/gtest.h>

#include <random>

#include "ayumi/math/rotation.hpp"
#include "tests/support/random_pose.hpp"

using namespace ayumi;
using namespace ayumi::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

/// The distance between the segments a0-a1 and b0-b1, by capsules about them.
double segment_distance(const Vector3d& a0, const Vector3d& a1, const Vector3d& b0,
                        const Vector3d& b1) {
  const auto about = [](const Vector3d& from, const Vector3d& to) {
    Isometry3d pose = Isometry3d::Identity();
    pose.translation() = 0.5 * (from + to);
    if (to != from)
      pose.linear() = rotation_between(Vector3d::UnitZ(), to - from).toRotationMatrix();
    return pose;
  };
  constexpr double kRadius = 0.25;
  return clearance(Collider(Capsule{kRadius, (a1 - a0).norm()}), about(a0, a1),
                   Collider(Capsule{kRadius, (b1 - b0).norm()}), about(b0, b1)) +
         2 * kRadius;
}

TEST(Distance, SegmentsAgainstSampling) {
  Random random(1);
  for (int i = 0; i < 50; ++i) {
    const Vector3d a0 = random.vector(), a1 = random.vector(), b0 = random.vector(),
                   b1 = random.vector();
    double nearest = 1e9;
    for (int s = 0; s <= 200; ++s)
      for (int t = 0; t <= 200; ++t)
        nearest =
            std::min(nearest, (a0 + s / 200.0 * (a1 - a0) - b0 - t / 200.0 * (b1 - b0)).norm());
    const double d = segment_distance(a0, a1, b0, b1);
    EXPECT_LE(d, nearest + 1e-12);
    EXPECT_GE(d, nearest - 0.03);
  }
  const Vector3d X = Vector3d::UnitX(), Y = Vector3d::UnitY();
  EXPECT_NEAR(segment_distance({0, 0, 0}, X, Y, X + Y), 1, 1e-15);      // the segments are parallel
  EXPECT_NEAR(segment_distance({0, 0, 0}, X, 3 * X, 2 * X), 1, 1e-15);  // the segments are in line
  EXPECT_NEAR(segment_distance(Y, Y, {-1, 0, 0}, {1, 0, 0}), 1, 1e-15);  // one segment is a point
}

TEST(Distance, BoxesFaceToFace) {
  const Collider a(Box{{0.2, 0.1, 0.1}}), b(Box{{0.1, 0.1, 0.1}});
  Isometry3d A = Isometry3d::Identity(), B = A;
  B.translation().x() = 0.18;
  EXPECT_NEAR(clearance(a, A, b, B), 0.03, 1e-12);
  B.translation().x() = 0.14;
  EXPECT_NEAR(clearance(a, A, b, B), -0.01, 1e-9);
}

// Boxes overlap with almost parallel faces: the depth is known in closed form, and the rounding of
// faces in one plane must not change it. The tilt of up to e moves corners by less than 3 e half
// edges.
TEST(Distance, OverlapOfNearlyParallelBoxes) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto vector = [&] {
    const double z = uniform(generator), y = uniform(generator), x = uniform(generator);
    return Vector3d(x, y, z);
  };
  for (int i = 0; i < 40000; ++i) {
    const Vector3d half_a = 0.1 * vector().cwiseAbs() + Vector3d::Constant(0.01);
    Vector3d half_b = 0.1 * vector().cwiseAbs() + Vector3d::Constant(0.01);
    if (i % 3 == 0) half_b = half_a;
    const double e = std::pow(10.0, -4 - i % 12);
    Isometry3d A = Isometry3d::Identity(), B = A;
    B.translation() = 0.9 * vector().cwiseProduct(half_a + half_b);
    if (i % 2) B.translation()[i % 3] = 0;
    const double depth = (half_a + half_b - B.translation().cwiseAbs()).minCoeff();
    const Vector3d tilt = e * vector();
    B.linear() =
        Eigen::Quaterniond(1, tilt.x(), tilt.y(), tilt.z()).normalized().toRotationMatrix();
    const Vector3d turn = vector();
    const double w = uniform(generator);
    Isometry3d world = Isometry3d::Identity();
    world.linear() =
        Eigen::Quaterniond(w, turn.x(), turn.y(), turn.z()).normalized().toRotationMatrix();
    world.translation() = vector();
    const Collider a(Box{2 * half_a}), b(Box{2 * half_b});
    EXPECT_NEAR(clearance(a, world * A, b, world * B), -depth, 3 * e * 0.3 + 1e-9) << i;
  }
}

// For a sphere and a box, the distance of a point from a box is known in closed form, minus the
// radius.
TEST(Distance, SphereAndBoxInClosedForm) {
  Random random(2);
  const Vector3d half(0.1, 0.05, 0.07);
  const Collider box(Box{2 * half}), sphere(Sphere{0.03});
  for (int i = 0; i < 100; ++i) {
    const Isometry3d A = random_pose(random, 0.2), B = random_pose(random, 0.2);
    const Vector3d p = A.inverse() * B.translation();
    const double outside = (p.cwiseAbs() - half).cwiseMax(0).norm();
    if (outside <= 1e-6) continue;
    EXPECT_NEAR(clearance(box, A, sphere, B), outside - 0.03, 1e-9);
  }
}

// Capsules use the closed form, and cylinders the general method: a thin capsule and a thin
// cylinder of the same length have nearly the same shape.
TEST(Distance, CapsulesAgreeWithCylinders) {
  Random random(3);
  const Collider capsule(Capsule{0.001, 0.2}), cylinder(Cylinder{0.001, 0.2}),
      other(Capsule{0.02, 0.1});
  for (int i = 0; i < 100; ++i) {
    const Isometry3d A = random_pose(random, 0.2), B = random_pose(random, 0.2);
    const double closed = clearance(capsule, A, other, B);
    if (closed < 0) continue;
    EXPECT_NEAR(closed, clearance(cylinder, A, other, B), 0.0012);
  }
}

TEST(Distance, BoundIsNeverAboveTheClearance) {
  Random random(4);
  MeshShape mesh;
  mesh.mesh.parts.emplace_back();
  for (int i = 0; i < 20; ++i)
    mesh.mesh.parts[0].vertices.push_back((random.vector(0.1) + Vector3d(0.2, 0, 0)).cast<float>());
  std::vector<Collider> shapes;
  shapes.emplace_back(Box{{0.1, 0.2, 0.05}});
  shapes.emplace_back(Sphere{0.06});
  shapes.emplace_back(Cylinder{0.05, 0.2});
  shapes.emplace_back(Capsule{0.05, 0.2});
  shapes.emplace_back(mesh);
  for (int i = 0; i < 300; ++i) {
    const Collider& a = shapes[i % 5];
    const Collider& b = shapes[(i / 5) % 5];
    const Isometry3d A = random_pose(random, 0.4), B = random_pose(random, 0.4);
    const double d = clearance(a, A, b, B);
    EXPECT_LE(clearance_bound(a, A, b, B), d + 1e-9);
    EXPECT_NEAR(d, clearance(b, B, a, A), 1e-8);
  }
}

TEST(Distance, MeshIsItsBox) {
  MeshShape mesh;
  mesh.mesh.parts.emplace_back();
  for (float x : {0.f, 0.1f})
    for (float y : {0.f, 0.1f})
      for (float z : {0.f, 0.1f}) mesh.mesh.parts[0].vertices.emplace_back(x, y, z);
  const Collider a(Shape{mesh}), b(Sphere{0.01});
  Isometry3d A = Isometry3d::Identity(), B = A;
  B.translation() = Vector3d(0.15, 0.05, 0.05);
  EXPECT_NEAR(clearance(a, A, b, B), 0.04, 1e-6);
}

// The depth by which two boxes overlap: the smallest of the overlaps along the faces' normals and
// the cross products of the edges (separating axes).
TEST(Distance, DepthOfBoxesBySeparatingAxes) {
  Random random(5);
  int meeting = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector3d ha = Vector3d(0.1, 0.05, 0.07), hb(0.03, 0.08, 0.06);
    const Isometry3d A = random_pose(random, 0.1), B = random_pose(random, 0.1);
    std::vector<Vector3d> axes;
    for (int j = 0; j < 3; ++j) {
      axes.push_back(A.linear().col(j));
      axes.push_back(B.linear().col(j));
      for (int k = 0; k < 3; ++k) axes.push_back(A.linear().col(j).cross(B.linear().col(k)));
    }
    double depth = 1e9;
    for (const Vector3d& axis : axes) {
      if (axis.norm() < 1e-6) continue;
      const Vector3d n = axis.normalized();
      const double reach = (A.linear().transpose() * n).cwiseAbs().dot(ha) +
                           (B.linear().transpose() * n).cwiseAbs().dot(hb);
      depth = std::min(depth, reach - std::abs(n.dot(B.translation() - A.translation())));
    }
    const double d = clearance(Collider(Box{2 * ha}), A, Collider(Box{2 * hb}), B);
    if (depth > 1e-6) {
      ++meeting;
      EXPECT_NEAR(d, -depth, 1e-8);
    } else {
      EXPECT_GE(d, -depth - 1e-9);  // an axis gives a lower bound of the distance
    }
  }
  EXPECT_GT(meeting, 200);
}

// If bodies overlap deeply, nearest points lie opposite each other along the normal, even if the
// deepest facet is made of several triangles.
TEST(Distance, PointsOfDeepBoxesLieAcross) {
  Random random(9);
  const Collider a(Box{{0.1, 0.05, 0.07}}), b(Box{{0.03, 0.08, 0.06}});
  int deep = 0;
  for (int i = 0; i < 2000; ++i) {
    const Isometry3d A = random_pose(random, 0.05), B = random_pose(random, 0.05);
    const Closest c = closest(a, A, b, B);
    if (c.clearance > -1e-4) continue;
    ++deep;
    EXPECT_LT((c.on_a + c.clearance * c.normal - c.on_b).norm(), 1e-8) << i;
  }
  EXPECT_GT(deep, 500);
}

// The nearest points have the clearance between them, and their normal is its gradient, for bodies
// apart and overlapping.
TEST(Distance, SlopeOfTheClearance) {
  Random random(6);
  std::vector<Collider> shapes;
  shapes.emplace_back(Box{{0.1, 0.2, 0.05}});
  shapes.emplace_back(Sphere{0.06});
  shapes.emplace_back(Cylinder{0.05, 0.2});
  shapes.emplace_back(Capsule{0.05, 0.2});
  int rough = 0;
  for (int i = 0; i < 400; ++i) {
    const Collider &a = shapes[i % 4], &b = shapes[(i / 4) % 4];
    const Isometry3d A = random_pose(random, 0.15), B = random_pose(random, 0.15);
    const Closest c = closest(a, A, b, B);
    EXPECT_NEAR(c.normal.norm(), 1, 1e-12);
    EXPECT_NEAR(c.normal.dot(c.on_b - c.on_a), c.clearance, 1e-8);
    const Vector3d way = random.vector(1.0), turn = random.vector(1.0);
    auto moved = [&](double h) {
      Isometry3d M = B;
      M.translation() = B.translation() + h * way;
      M.linear() = exp_rotation(h * turn).toRotationMatrix() * B.linear();
      return clearance(a, A, b, M);
    };
    const double slope = c.normal.dot(way + turn.cross(c.on_b - B.translation()));
    const double h = 1e-5;
    if (std::abs((moved(h) - moved(-h)) / (2 * h) - slope) > 2e-3) ++rough;
  }
  EXPECT_LE(rough, 8);  // a few of the poses have a kink between two features
}
