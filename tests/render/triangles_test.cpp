#include "ayumi/render/triangles.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace ayumi {
namespace {

const Eigen::Vector4f kWhite = {1, 1, 1, 1};

double volume(const Triangles& s) {
  double sum = 0;
  for (size_t i = 0; i < s.indices.size(); i += 3)
    sum += s.vertices[s.indices[i]].position.dot(
               s.vertices[s.indices[i + 1]].position.cross(s.vertices[s.indices[i + 2]].position)) /
           6;
  return sum;
}

void expect_outward(const Triangles& s) {
  for (size_t i = 0; i < s.indices.size(); i += 3) {
    const RenderVertex &a = s.vertices[s.indices[i]], &b = s.vertices[s.indices[i + 1]],
                       &c = s.vertices[s.indices[i + 2]];
    const Eigen::Vector3f face = (b.position - a.position).cross(c.position - a.position);
    if (face.norm() < 1e-12f) continue;
    for (const RenderVertex* v : {&a, &b, &c}) {
      EXPECT_NEAR(v->normal.norm(), 1, 1e-5);
      EXPECT_GT(face.normalized().dot(v->normal), 0.5f);
    }
  }
}

TEST(Triangles, PrimitivesHaveTheirVolumeAndFaceOutwards) {
  using std::numbers::pi;
  const struct {
    Shape shape;
    double expected;
  } cases[] = {{Box{{0.1, 0.2, 0.3}}, 0.006},
               {Sphere{0.5}, 4.0 / 3 * pi * 0.125},
               {Cylinder{0.2, 0.7}, pi * 0.04 * 0.7},
               {Capsule{0.2, 0.7}, pi * 0.04 * 0.7 + 4.0 / 3 * pi * 0.008}};
  for (const auto& c : cases) {
    Triangles surface = tessellate(c.shape, kWhite);
    EXPECT_NEAR(volume(surface) / c.expected, 1, 0.02) << c.shape.index();
    expect_outward(surface);
    EXPECT_EQ(orient(surface), SurfaceKind::closed);
  }
}

/// A tetrahedron around the origin, as it would come from a mesh file.
MeshPart tetrahedron(bool inside_out, bool open) {
  MeshPart part;
  part.vertices = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  part.triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
  if (inside_out)
    for (auto& t : part.triangles) std::swap(t[1], t[2]);
  if (open) part.triangles.pop_back();
  return part;
}

TEST(Triangles, AnInsideOutMeshIsTurned) {
  for (const bool inside_out : {false, true}) {
    Triangles surface = tessellate(tetrahedron(inside_out, false), kWhite);
    EXPECT_EQ(orient(surface), SurfaceKind::closed);
    EXPECT_GT(volume(surface), 0);
    expect_outward(surface);
  }
}

TEST(Triangles, AMeshWithAHoleIsOpen) {
  Triangles surface = tessellate(tetrahedron(false, true), kWhite);
  EXPECT_EQ(orient(surface), SurfaceKind::open);
}

TEST(Triangles, BrokenMeshDataIsLeftOut) {
  MeshPart part = tetrahedron(false, false);
  part.triangles.push_back({0, 1, 99});
  part.triangles.push_back({2, 2, 2});
  EXPECT_EQ(tessellate(part, kWhite).indices.size(), 12u);
}

TEST(Triangles, BandAndRingFaceTheirNormal) {
  Triangles marks;
  add_band(marks, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, {kWhite, kWhite, kWhite},
           Eigen::Vector3d::UnitZ(), 0.1);
  add_ring(marks, {0, 0, 0}, Eigen::Vector3d::UnitZ(), 0.1, 0.2, kWhite);
  add_polygon(marks, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, kWhite);
  ASSERT_FALSE(marks.indices.empty());
  for (size_t i = 0; i < marks.indices.size(); i += 3) {
    const Eigen::Vector3f& a = marks.vertices[marks.indices[i]].position;
    const Eigen::Vector3f& b = marks.vertices[marks.indices[i + 1]].position;
    const Eigen::Vector3f& c = marks.vertices[marks.indices[i + 2]].position;
    EXPECT_GT((b - a).cross(c - a).z(), 0);
  }
}

TEST(Triangles, AnArrowEndsAtItsTip) {
  Triangles arrow;
  add_arrow(arrow, {0, 0, 0}, {0, 0.3, 0}, 0.01, kWhite);
  const Eigen::AlignedBox3d box = bounds(arrow);
  EXPECT_NEAR(box.max().y(), 0.3, 1e-6);
  EXPECT_NEAR(box.min().y(), 0.0, 1e-6);
  Triangles nothing;
  add_arrow(nothing, {0, 0, 0}, {0, 0, 0}, 0.01, kWhite);
  EXPECT_TRUE(nothing.indices.empty());
}

TEST(Triangles, WeldingKeepsEveryTriangleAndSharesItsCorners) {
  const Triangles box = tessellate(Shape(Box{{1, 2, 3}}), {1, 0, 0, 1});
  Triangles loose;
  for (const std::uint32_t index : box.indices) {
    loose.indices.push_back(static_cast<std::uint32_t>(loose.vertices.size()));
    loose.vertices.push_back(box.vertices[index]);
  }
  const Triangles joined = welded(loose);
  EXPECT_EQ(joined.vertices.size(), 24u) << "four per face: their normals differ";
  ASSERT_EQ(joined.indices.size(), loose.indices.size());
  for (size_t i = 0; i < loose.indices.size(); ++i) {
    const RenderVertex &a = joined.vertices[joined.indices[i]], &b = loose.vertices[i];
    EXPECT_EQ(a.position, b.position);
    EXPECT_EQ(a.normal, b.normal);
    EXPECT_EQ(a.color, b.color);
  }
}

}  // namespace
}  // namespace ayumi
