#pragma once
// Meshes of robots' housings. Every part is a loft: rings of points that are stacked along an axis
// and closed by two caps. Lengths are in millimetres in the link's frame (x forward, y left, z up).

#include <Eigen/Geometry>
#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace ayumi::tools {

using Eigen::Vector3d;
using Ring = std::vector<Vector3d>;
using Triangle = std::array<Vector3d, 3>;

enum class Axis { x, y, z };

/// A rounded rectangle across the axis. It is at `at` along the axis, its centre is (u, v), and its
/// half sizes are a and b. The coordinates u and v are (y, z) across x, (z, x) across y, and (x, y)
/// across z.
struct Section {
  double at, u, v, a, b, radius;
};

/// A ring of a turned part.
struct Turn {
  double at, radius;
};

struct Part {
  std::string material;
  std::vector<Triangle> triangles;
};

class LinkMesh {
 public:
  void loft(const std::string& material, Axis axis, const std::vector<Section>& sections);

  /// A box with rounded edges along `axis` and bevelled ends.
  void box(const std::string& material, Axis axis, const Vector3d& low, const Vector3d& high,
           double round = 5, double bevel = 2.5);

  void turned(const std::string& material, Axis axis, const Vector3d& center,
              const std::vector<Turn>& turns);

  /// A motor housing: a cylinder with bevelled ends from `low` to `high` along the axis.
  void motor(const std::string& material, Axis axis, const Vector3d& center, double radius,
             double low, double high, double bevel = 2.5);

  /// Mirrors the mesh from the left side to the right.
  void mirror();

  const std::vector<Part>& parts() const { return parts_; }

 private:
  void add(const std::string& material, const std::vector<Ring>& rings);

  std::vector<Part> parts_;
};

/// The mesh of a link of the left side or of the middle.
struct NamedMesh {
  std::string link;
  LinkMesh mesh;
};

using Materials = std::vector<std::pair<std::string, Vector3d>>;

/// The links of a robot. Each of the `sided` links is written twice: as l_ and, mirrored, as r_.
struct RobotMeshes {
  std::string title;   ///< title of the robot, for the first line of the files
  std::string source;  ///< source file of the program that makes them
  std::string name;    ///< name of the MTL file
  std::vector<NamedMesh> middle, sided;
  Materials materials;
};

/// Writes one OBJ file for each link and one shared MTL file, and prints the number of triangles of
/// each link. Returns the exit status.
int write_meshes(int argc, char** argv, const RobotMeshes& robot);

}  // namespace ayumi::tools
