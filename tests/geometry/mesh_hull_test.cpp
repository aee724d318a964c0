// A mesh as the convex hull of its outer vertices: faces, distances, patches.
#include "ayumi/geometry/mesh_hull.hpp"

#include <gtest/gtest.h>

#include <array>
#include <set>

#include "ayumi/geometry/contact_patch.hpp"
#include "tests/support/random_pose.hpp"

using namespace ayumi;
using namespace ayumi::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

/// The corners of a box, seen from axes against which the box is turned.
MeshShape box_mesh(const Vector3d& half, const Isometry3d& in_mesh) {
  MeshShape mesh;
  mesh.mesh.parts.resize(1);
  for (int k = 0; k < 8; ++k) {
    const Vector3d corner((k & 1 ? 1 : -1) * half.x(), (k & 2 ? 1 : -1) * half.y(),
                          (k & 4 ? 1 : -1) * half.z());
    mesh.mesh.parts[0].vertices.push_back((in_mesh * corner).cast<float>());
  }
  return mesh;
}

Collider hull_of(const MeshShape& mesh) { return {Shape{mesh}, MeshHull(mesh.mesh)}; }

MeshShape octahedron(float reach) {
  MeshShape mesh;
  mesh.mesh.parts.resize(1);
  for (int k = 0; k < 3; ++k)
    for (const float side : {-reach, reach})
      mesh.mesh.parts[0].vertices.push_back(side * Eigen::Vector3f::Unit(k));
  return mesh;
}

}  // namespace

TEST(MeshHull, FacesOfSolids) {
  Random random(3);
  for (int i = 0; i < 20; ++i) {
    const auto faces =
        hull_faces(outer_vertices(box_mesh({0.03, 0.05, 0.02}, random_pose(random, 0.2)).mesh));
    ASSERT_EQ(faces.size(), 6u);
    for (const HullFace& face : faces) EXPECT_EQ(face.corners.size(), 4u);
  }
  const auto faces = hull_faces(outer_vertices(octahedron(0.1f).mesh));
  ASSERT_EQ(faces.size(), 8u);
  for (const HullFace& face : faces) EXPECT_EQ(face.corners.size(), 3u);
}

// The vertices of a large mesh are those that are farthest out in 90 directions, whatever their
// order in the file.
TEST(MeshHull, OuterVerticesOfALargeMesh) {
  Random random(7);
  for (const int count : {100, 3000, 9000}) {
    TriangleMesh mesh;
    mesh.parts.resize(2);
    for (int i = 0; i < count; ++i)
      mesh.parts[i % 2].vertices.push_back(random.vector(0.1).cast<float>());
    std::set<std::array<double, 3>> expected, found;
    for (int i = 0; i < 90; ++i) {
      const double z = 1 - (2 * i + 1.0) / 90, turn = M_PI * (3 - std::sqrt(5.0)) * i;
      const double r = std::sqrt(1 - z * z);
      const Vector3d out(r * std::cos(turn), r * std::sin(turn), z);
      Vector3d best = mesh.parts[0].vertices[0].cast<double>();
      for (const MeshPart& part : mesh.parts)
        for (const Eigen::Vector3f& v : part.vertices)
          if (v.cast<double>().dot(out) > best.dot(out)) best = v.cast<double>();
      expected.insert({best.x(), best.y(), best.z()});
    }
    for (const Vector3d& v : outer_vertices(mesh)) found.insert({v.x(), v.y(), v.z()});
    EXPECT_EQ(found, expected);
  }
}

// For any points, each face has all of them on one side, its corners turn left as seen from
// outside, and every edge belongs to two faces (Euler's count).
TEST(MeshHull, FacesCloseAroundRandomPoints) {
  Random random(4);
  for (int i = 0; i < 10; ++i) {
    std::vector<Vector3d> points;
    for (int k = 0; k < 40; ++k) points.push_back(random.vector(0.1));
    const auto faces = hull_faces(points);
    std::set<std::array<double, 3>> corners;
    size_t ends = 0;
    for (const HullFace& face : faces) {
      ends += face.corners.size();
      for (const Vector3d& p : points) EXPECT_LT(face.normal.dot(p - face.corners[0]), 1e-6);
      for (size_t k = 0; k < face.corners.size(); ++k) {
        const Vector3d& a = face.corners[k];
        const Vector3d& b = face.corners[(k + 1) % face.corners.size()];
        const Vector3d& c = face.corners[(k + 2) % face.corners.size()];
        EXPECT_GT(face.normal.dot((b - a).cross(c - b)), 0);
        corners.insert({a.x(), a.y(), a.z()});
      }
    }
    EXPECT_EQ(corners.size() + faces.size(), ends / 2 + 2);
  }
}

TEST(MeshHull, DistanceIsThatOfTheShapeAndNotOfItsBox) {
  Random random(5);
  for (int i = 0; i < 100; ++i) {
    const Vector3d half(0.03, 0.05, 0.02);
    const Isometry3d askew = random_pose(random, 0.1), pose = random_pose(random, 0.15);
    const Isometry3d pose_b = random_pose(random, 0.15);
    const Collider mesh = hull_of(box_mesh(half, askew));
    const Collider box(Shape{Box{2 * half}}), other(Shape{Cylinder{0.02, 0.06}});
    const double expected = clearance(box, pose * askew, other, pose_b);
    EXPECT_NEAR(clearance(mesh, pose, other, pose_b), expected, 1e-7);
    const Closest near = closest(mesh, pose, other, pose_b);
    EXPECT_NEAR(clearance_along(near.normal, mesh, pose, other, pose_b), expected, 1e-7);
    EXPECT_LE(clearance_bound(mesh, pose, other, pose_b), expected + 1e-7);
  }
}

// The patch of a mesh with a box is that of the shape that the mesh represents.
TEST(MeshHull, PatchIsThatOfTheShape) {
  Random random(6);
  const Collider table(Shape{Box{{0.1, 0.1, 0.1}}});
  for (int i = 0; i < 50; ++i) {
    const Vector3d half(0.08, 0.03, 0.02);
    const Isometry3d askew = random_pose(random, 0.1);
    Isometry3d pose = Isometry3d::Identity();
    pose.translation() << 0.02 * random.vector().head<2>(), 0.0701;
    pose.linear() = exp_rotation({0, 0, random.vector().z()}).toRotationMatrix();
    const Collider mesh = hull_of(box_mesh(half, askew));
    const Collider box(Shape{Box{2 * half}});
    const Isometry3d at = Isometry3d::Identity();
    const ContactPatch expected = contact_patch(table, at, box, pose, 1e-3);
    const ContactPatch patch = contact_patch(table, at, mesh, pose * askew.inverse(), 1e-3);
    ASSERT_EQ(patch.count, expected.count);
    EXPECT_LT((patch.normal - expected.normal).norm(), 1e-6);
    for (int k = 0; k < patch.count; ++k) {
      double nearest = 1;
      for (int j = 0; j < patch.count; ++j)
        nearest = std::min(nearest, (patch.points[static_cast<size_t>(k)].position -
                                     expected.points[static_cast<size_t>(j)].position)
                                        .norm());
      EXPECT_LT(nearest, 1e-6);
      EXPECT_NEAR(patch.points[static_cast<size_t>(k)].gap, 1e-4, 1e-6);
    }
  }
}
