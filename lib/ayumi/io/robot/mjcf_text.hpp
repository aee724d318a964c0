#pragma once
// Prepares the text of an MJCF model for the installed version of MuJoCo. Included files replace
// the elements that include them. Everything that does not describe the robot is left out, and
// everything that this version of MuJoCo does not know. Only files of io/robot include it.

#include <Eigen/Geometry>
#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace ayumi {

/// Name of the file that stands for every mesh in the text.
constexpr const char* kMjcfProbe = "probe.msh";

/// An asset that is a mesh. MuJoCo gets a probe in its place.
struct MjcfMesh {
  std::string file;  ///< file as found in the mesh folder, or a URL
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  Eigen::Isometry3d reference = Eigen::Isometry3d::Identity();  ///< refpos and refquat of the asset
};

struct MjcfText {
  std::string xml;
  /// Lines of the file in which the elements of `xml` begin, by their lines in `xml`; an element of
  /// an included file, or one that was added, has 0.
  std::map<int, int> lines;
  std::string files;                       ///< bytes of included files, one after the other
  std::map<std::string, MjcfMesh> meshes;  ///< assets by name
  /// fullinertia of bodies about the centre of mass, in the axes of the body [kg m^2].
  std::map<std::string, Eigen::Matrix3d> inertias;
  std::map<std::string, double> force_limits;    ///< actuatorfrcrange of joints [N m, N]
  std::map<std::string, double> damping_ratios;  ///< dampratio of actuators, by joint
  std::map<std::string, double> velocity_gains;  ///< kv of position actuators, by joint
  std::string imu_site;                     ///< site of the gyroscope, or else of the accelerometer
  std::vector<std::string> weighed_meshes;  ///< assets that give a body its mass
  std::map<std::string, std::string> fitted_meshes;  ///< assets that only give primitives their
                                                     ///< size, with the name in `meshes`
  std::vector<std::string> notes;  ///< descriptions of everything that was left out
};

/// The elements that a version of MuJoCo knows, with the attributes of each.
using MjcfSchema = std::map<std::string, std::set<std::string>>;

/// The schema that mj_printSchema() printed.
MjcfSchema mjcf_schema(const std::string& printed);

/// Whether the file of a mesh that a body names exists.
using MeshIsThere = std::function<bool(const std::string& body, const std::string& file)>;

/// Prepares the text. A primitive whose size follows from a missing mesh is left out. Throws
/// Error(bad_file) with file and line for a text that is not MJCF, for words that should be
/// numbers, and for included files that are missing or include each other.
MjcfText mjcf_text(const std::string& bytes, const std::filesystem::path& path,
                   const MjcfSchema& schema, const MeshIsThere& is_there);

}  // namespace ayumi
