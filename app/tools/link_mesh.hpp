#pragma once
// Meshes of robots' housings: every part is a loft, rings of points stacked along an axis and
// closed by two caps. Measures in millimetres in the link's frame (x forward, y left, z up).

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

/// A rounded rectangle across the axis: at `at` along it, centred at (u, v), half sizes a, b.
/// Across x lie (y, z), across y (z, x), across z (x, y).
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

  /// From the left side to the right.
  void mirror();

  const std::vector<Part>& parts() const { return parts_; }

 private:
  void add(const std::string& material, const std::vector<Ring>& rings);

  std::vector<Part> parts_;
};

/// A link of the left side, or one of the middle.
struct NamedMesh {
  std::string link;
  LinkMesh mesh;
};

using Materials = std::vector<std::pair<std::string, Vector3d>>;

/// The links of a robot: `sided` links are written as l_ and, mirrored, r_.
struct RobotMeshes {
  std::string title;   ///< of the robot, for the files' first line
  std::string source;  ///< file that made them
  std::string name;    ///< of the MTL
  std::vector<NamedMesh> middle, sided;
  Materials materials;
};

/// Writes one OBJ per link and one shared MTL, and prints the number of triangles of each. Returns
/// the exit status.
int write_meshes(int argc, char** argv, const RobotMeshes& robot);

}  // namespace ayumi::tools
