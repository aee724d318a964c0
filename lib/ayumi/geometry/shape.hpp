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
  double length = 0;  ///< length along z from end to end [m]
};
struct Capsule {
  double radius = 0;  ///< [m]
  double length = 0;  ///< length along z between the centres of the two caps [m]
};

/// A piece of a mesh with one material.
struct MeshPart {
  std::vector<Eigen::Vector3f> vertices;  ///< vertices with scale and node transforms applied [m]
  std::vector<Eigen::Vector3f> normals;   ///< unit normals, one for each vertex
  std::vector<Eigen::Vector2f> uvs;       ///< empty, or one for each vertex
  std::vector<std::array<std::uint32_t, 3>> triangles;
  Eigen::Vector4f color = {0.8f, 0.8f, 0.8f, 1.0f};  ///< sRGB, with alpha last
  bool has_color = false;                            ///< whether the mesh file has a colour
  std::string texture_file;                          ///< empty if there is no texture
};

struct TriangleMesh {
  std::vector<MeshPart> parts;
};

/// A mesh from a file. `mesh` is only filled if the robot was loaded with its meshes.
struct MeshShape {
  std::string file;                                 ///< path of the file that was found
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();  ///< scale that is applied on loading
  TriangleMesh mesh;
};

using Shape = std::variant<Box, Sphere, Cylinder, Capsule, MeshShape>;

/// A shape fixed to a link.
struct PlacedShape {
  std::string name;
  Shape shape;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< frame of the shape in the link frame
  Eigen::Vector4f color = {0.8f, 0.8f, 0.8f, 1.0f};        ///< sRGB
  bool has_color = false;  ///< whether `color` replaces the mesh's own colour
};

}  // namespace ayumi
