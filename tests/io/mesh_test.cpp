#include "ayumi/io/robot/mesh.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <sstream>

#include "ayumi/base/error.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ayumi {
namespace {

using test::TemporaryFolder;

// A tetrahedron with corners at 0 and at 1, 2 and 3 along the axes; its volume is 1.
const char* const kTetrahedron =
    "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

// The enclosed volume by the divergence theorem, which is positive if the triangles face outwards.
double volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (const MeshPart& part : mesh.parts)
    for (const auto& [a, b, c] : part.triangles)
      sum += part.vertices[a].cast<double>().dot(
                 part.vertices[b].cast<double>().cross(part.vertices[c].cast<double>())) /
             6;
  return sum;
}

// The smallest cosine between a triangle's face normal and the normals of its corners.
double worst_normal(const TriangleMesh& mesh) {
  double worst = 1;
  for (const MeshPart& part : mesh.parts)
    for (const auto& t : part.triangles) {
      const Eigen::Vector3f face = (part.vertices[t[1]] - part.vertices[t[0]])
                                       .cross(part.vertices[t[2]] - part.vertices[t[0]])
                                       .normalized();
      for (const auto corner : t) worst = std::min<double>(worst, face.dot(part.normals[corner]));
    }
  return worst;
}

TEST(Mesh, ReadsObjAndMakesMissingNormals) {
  const TemporaryFolder folder;
  const TriangleMesh mesh = load_mesh(folder.write("t.obj", kTetrahedron));
  EXPECT_NEAR(volume(mesh), 1, 1e-6);
  EXPECT_GT(worst_normal(mesh), 0.99);  // its edges are sharper than the crease angle
  EXPECT_FALSE(mesh.parts[0].has_color);
}

TEST(Mesh, ScalesAndKeepsFacingOutwardsWhenMirrored) {
  const TemporaryFolder folder;
  const auto path = folder.write("t.obj", kTetrahedron);
  const TriangleMesh mesh = load_mesh(path, {0.5, -1, 2});
  EXPECT_NEAR(volume(mesh), 1, 1e-6);
  EXPECT_GT(worst_normal(mesh), 0.99);
  Eigen::Vector3f low = Eigen::Vector3f::Zero(), high = low;
  for (const Eigen::Vector3f& vertex : mesh.parts[0].vertices) {
    low = low.cwiseMin(vertex);
    high = high.cwiseMax(vertex);
  }
  EXPECT_TRUE(low.isApprox(Eigen::Vector3f(0, -2, 0)));
  EXPECT_TRUE(high.isApprox(Eigen::Vector3f(0.5f, 0, 6)));
}

TEST(Mesh, ReadsColoursOfObjMaterials) {
  const TemporaryFolder folder;
  folder.write("m.mtl", "newmtl a\nKd 0.1 0.2 0.3\nnewmtl b\nKd 0.9 0.8 0.7\n");
  const TriangleMesh mesh = load_mesh(folder.write(
      "t.obj", std::string("mtllib m.mtl\nusemtl a\n") + kTetrahedron + "usemtl b\nf 1 2 4\n"));
  ASSERT_EQ(mesh.parts.size(), 2u);
  EXPECT_TRUE(mesh.parts[0].has_color);
  EXPECT_TRUE(mesh.parts[0].color.isApprox(Eigen::Vector4f(0.1f, 0.2f, 0.3f, 1)));
  EXPECT_TRUE(mesh.parts[1].color.isApprox(Eigen::Vector4f(0.9f, 0.8f, 0.7f, 1)));
}

TEST(Mesh, ReadsBinaryStlAndRefusesACutOne) {
  std::string bytes(84, '\0');
  bytes[80] = 1;  // the file has one triangle
  const float numbers[12] = {0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0};
  bytes.append(reinterpret_cast<const char*>(numbers), sizeof numbers);
  bytes.append(2, '\0');
  const TemporaryFolder folder;
  const TriangleMesh mesh = load_mesh(folder.write("a.stl", bytes));
  ASSERT_EQ(mesh.parts.size(), 1u);
  EXPECT_EQ(mesh.parts[0].triangles.size(), 1u);
  EXPECT_FALSE(mesh.parts[0].has_color);
  EXPECT_THROW(load_mesh(folder.write("b.stl", bytes.substr(0, 100))), Error);
  bytes[83] = 127;  // the file claims to have two thousand million triangles
  EXPECT_THROW(load_mesh(folder.write("c.stl", bytes)), Error);
}

TEST(Mesh, AnStlWithoutNormalsKeepsItsEdges) {
  // Two squares at a right angle; the file says 0 0 0 for every normal.
  std::string words = "solid corner\n";
  for (const char* facet : {"0 0 0  1 0 0  1 1 0", "0 0 0  1 1 0  0 1 0", "0 0 0  0 1 0  0 1 1",
                            "0 0 0  0 1 1  0 0 1"}) {
    std::istringstream places(facet);
    words += "facet normal 0 0 0\nouter loop\n";
    for (std::string x, y, z; places >> x >> y >> z;)
      words += "vertex " + x + " " + y + " " + z + "\n";
    words += "endloop\nendfacet\n";
  }
  const TemporaryFolder folder;
  const TriangleMesh mesh = load_mesh(folder.write("a.stl", words + "endsolid corner\n"));
  ASSERT_EQ(mesh.parts.size(), 1u);
  const MeshPart& part = mesh.parts[0];
  ASSERT_EQ(part.triangles.size(), 4u);
  for (const auto& triangle : part.triangles) {
    const Eigen::Vector3f face = (part.vertices[triangle[1]] - part.vertices[triangle[0]])
                                     .cross(part.vertices[triangle[2]] - part.vertices[triangle[0]])
                                     .normalized();
    for (const std::uint32_t corner : triangle)
      EXPECT_NEAR(part.normals[corner].dot(face), 1, 1e-5) << "not rounded over the edge";
  }
}

TEST(Mesh, AppliesColladaUnitsAndIgnoresItsUpAxis) {
  const TemporaryFolder folder;
  const std::string text = R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="millimeter" meter="0.001"/><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="pa" count="12">
0 0 0 1000 0 0 0 2000 0 0 0 3000</float_array><technique_common>
<accessor source="#pa" count="4" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/>
<p>0 2 1 0 1 3 1 2 3 2 0 3</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><translate>0 0 500</translate>
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
  const TriangleMesh mesh = load_mesh(folder.write("t.dae", text));
  EXPECT_NEAR(volume(mesh), 1, 1e-6);
  float low = 10, high = -10;
  for (const Eigen::Vector3f& vertex : mesh.parts[0].vertices) {
    low = std::min(low, vertex.z());
    high = std::max(high, vertex.z());
  }
  EXPECT_NEAR(low, 0.5, 1e-6);  // the shift of the node itself, in the unit of the file
  EXPECT_NEAR(high, 3.5, 1e-6);
  std::string wrong = text;
  wrong.replace(wrong.find("1 2 3 2 0 3"), 1, "-1");
  try {
    load_mesh(folder.write("u.dae", wrong));
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("u.dae: '-1' is not a valid count or index"),
              std::string::npos);
  }
}

// The project's own meshes are closed, face outwards, and have normals that follow their faces.
TEST(Mesh, Hoap1FacesOutwards) {
  const RobotModel model = load_robot("hoap1", {{AYUMI_SOURCE_DIR "/robots"}}, {.meshes = true});
  for (const Link& link : model.links()) {
    ASSERT_EQ(link.visuals.size(), 1u) << link.name;
    const TriangleMesh& mesh = std::get<MeshShape>(link.visuals[0].shape).mesh;
    EXPECT_GT(volume(mesh), 1e-6) << link.name;
    EXPECT_GT(worst_normal(mesh), 0.7) << link.name;
    size_t triangles = 0;
    for (const MeshPart& part : mesh.parts) {
      EXPECT_TRUE(part.has_color) << link.name;
      triangles += part.triangles.size();
    }
    EXPECT_GT(triangles, 300u) << link.name;
    EXPECT_LT(triangles, 1500u) << link.name;
  }
}

}  // namespace
}  // namespace ayumi
