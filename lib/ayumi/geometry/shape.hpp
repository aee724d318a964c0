#pragma once
// Shapes of links: the primitives of URDF, and triangle meshes. Lengths are in metres. Each shape
// has its own frame: primitives are centred in it, cylinders and capsules lie along z.

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace ayumi {

struct Box {
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  ///< full edge lengths [m]
};
struct Sphere {
  double radius = 0;  ///< [m]
};
struct Cylinder {
  double radius = 0;  ///< [m]
  double length = 0;  ///< along z, end to end [m]
};
struct Capsule {
  double radius = 0;  ///< [m]
  double length = 0;  ///< along z, between the centres of the two caps [m]
};

/// A piece of a mesh with one material.
struct MeshPart {
  std::vector<Eigen::Vector3f> vertices;  ///< [m], scale and node transforms applied
  std::vector<Eigen::Vector3f> normals;   ///< unit, one per vertex
  std::vector<Eigen::Vector2f> uvs;       ///< empty or one per vertex
  std::vector<std::array<std::uint32_t, 3>> triangles;
  Eigen::Vector4f color = {0.8f, 0.8f, 0.8f, 1.0f};  ///< sRGB, alpha last
  bool has_color = false;                            ///< the mesh file has a colour
  std::string texture_file;                          ///< empty when untextured
};

struct TriangleMesh {
  std::vector<MeshPart> parts;
};

/// A mesh by file. `mesh` is filled only when the robot was loaded with its meshes.
struct MeshShape {
  std::string file;                                 ///< resolved path
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();  ///< applied on loading
  TriangleMesh mesh;
};

using Shape = std::variant<Box, Sphere, Cylinder, Capsule, MeshShape>;

/// A shape fixed to a link.
struct PlacedShape {
  std::string name;
  Shape shape;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< shape frame in the link frame
  Eigen::Vector4f color = {0.8f, 0.8f, 0.8f, 1.0f};        ///< sRGB
  bool has_color = false;                                  ///< `color` replaces the mesh's own
};

}  // namespace ayumi
