#include "ayumi/io/robot/robot_file.hpp"

#include <algorithm>
#include <map>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/robot/mesh.hpp"
#include "ayumi/io/robot/robot_guess.hpp"
#include "ayumi/io/robot/robot_source.hpp"
#include "ayumi/io/robot/sidecar.hpp"

namespace ayumi {

namespace {

namespace fs = std::filesystem;

constexpr const char* kSidecarName = "robot.json";

// The robot.json of a folder, or the only other robot in it; empty if it has neither.
fs::path file_in_folder(const fs::path& folder) {
  std::error_code ignored;
  // A named pipe or a link to nothing is also returned. read_file() then reports it, and the robot
  // is not read without its sidecar.
  const fs::path sidecar = folder / kSidecarName;
  if (fs::exists(fs::symlink_status(sidecar, ignored)) && !fs::is_directory(sidecar, ignored))
    return sidecar;
  std::vector<fs::path> robots;
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (has_robot_ending(entry.path()) && !entry.is_directory(ignored))
      robots.push_back(entry.path());
  return robots.size() == 1 ? robots[0] : fs::path();
}

fs::path find_file(const std::string& name, const RobotSearch& search) {
  const fs::path path = name;
  const bool named = has_robot_ending(path) || path.extension() == ".json";
  std::error_code ignored;
  // The name of a folder may end like the name of a file, for example my.urdf/.
  const bool folder = fs::is_directory(path, ignored);
  if (folder)
    if (const fs::path file = file_in_folder(path); !file.empty()) return file;
  if (!folder && (fs::exists(path, ignored) || named)) return path;
  std::vector<std::string> known;
  for (const RobotEntry& entry : find_robots(search)) {
    if (entry.name == name) return entry.sidecar;
    known.push_back(entry.name);
  }
  if (folder)
    fail(ErrorCode::bad_file, {name},
         std::string("this folder holds neither a ") + kSidecarName +
             " nor exactly one robot file in another format; name the file of the robot");
  fail(ErrorCode::bad_file, "robot '" + name + "': no such file, folder or bundled robot" +
                                (known.empty() ? "" : "; known: " + text::join(known, ", ")) +
                                text::suggestion(name, known));
}

// Shapes for contacts are always read. Shapes for pictures are read only where something is drawn.
void fill_meshes(RobotDescription& robot, bool visuals, const Progress& progress) {
  std::vector<MeshRequest> requests;    // each mesh only once
  std::vector<std::string> first_link;  // the first link that needs it
  std::map<std::string, size_t> known;
  std::vector<std::pair<MeshShape*, size_t>> wanted;
  const auto want = [&](std::vector<PlacedShape>& shapes, const std::string& link) {
    for (PlacedShape& placed : shapes) {
      auto* shape = std::get_if<MeshShape>(&placed.shape);
      if (!shape || !shape->mesh.parts.empty()) continue;  // some formats contain their triangles
      const std::string key = shape->file + " " + text::exact(shape->scale.x()) + " " +
                              text::exact(shape->scale.y()) + " " + text::exact(shape->scale.z());
      const auto [place, fresh] = known.emplace(key, requests.size());
      if (fresh) {
        requests.push_back({shape->file, shape->scale});
        first_link.push_back(link);
      }
      wanted.emplace_back(shape, place->second);
    }
  };
  for (LinkDescription& link : robot.links) {
    if (visuals) want(link.visuals, link.name);
    want(link.collisions, link.name);
  }
  MeshFailure failure;
  const std::vector<TriangleMesh> meshes = load_meshes(requests, failure, {}, progress);
  if (failure.error) try {
      std::rethrow_exception(failure.error);
    } catch (const Error& error) {
      const std::string mesh = requests[failure.request].path.string();
      // Where the mesh reader itself fails, the error does not name the mesh.
      const bool names_mesh = error.place().file == mesh;
      fail(error.code(), {robot.urdf_file, "link " + first_link[failure.request]},
           "mesh " + (names_mesh ? std::string() : mesh + " cannot be read: ") + error.what());
    }
  for (const auto& [shape, request] : wanted) shape->mesh = meshes[request];
}

// Some readers of URDF ignore the mass of the root link; readers of the other formats do not.
void note_mass_of_root(RobotDescription& robot) {
  for (const LinkDescription& link : robot.links) {
    const bool is_root =
        std::none_of(robot.joints.begin(), robot.joints.end(),
                     [&](const JointDescription& joint) { return joint.child == link.name; });
    if (is_root && link.inertia.mass > 0)
      robot.assumptions.push_back("the mass of the root link " + link.name + " (" +
                                  text::brief(link.inertia.mass) +
                                  " kg) is part of the robot's mass. Some URDF readers ignore the "
                                  "mass of the root link and compute a smaller total mass");
  }
}

}  // namespace

std::vector<RobotEntry> find_robots(const RobotSearch& search) {
  std::map<std::string, fs::path> found;
  for (const fs::path& folder : search.folders) {
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder, ignored))
      if (fs::is_regular_file(entry.path() / kSidecarName, ignored))
        found.emplace(entry.path().filename().string(), entry.path() / kSidecarName);
  }
  std::vector<RobotEntry> entries;
  for (const auto& [name, sidecar] : found) entries.push_back({name, sidecar});
  return entries;
}

RobotDescription load_robot_description(const std::string& name_or_path, const RobotSearch& search,
                                        const LoadOptions& options) {
  if (name_or_path.empty())
    fail(ErrorCode::bad_file, "robot '': a name, folder, sidecar or robot file is needed");
  const fs::path file = find_file(name_or_path, search);
  const std::string bytes = read_file(file);
  const RobotFormat format = robot_format(bytes, file);
  const bool sidecar = format == RobotFormat::sidecar;
  const auto find = [&](const std::string& name) { return find_file(name, search); };
  RobotDescription robot = sidecar ? read_sidecar(file, search.folders, search.packages, find)
                                   : parse_robot(bytes, file, search.packages);
  fill_meshes(robot, options.meshes, options.progress);
  if (format == RobotFormat::urdf) note_mass_of_root(robot);
  std::error_code ignored;
  if (!sidecar && fs::is_regular_file(file.parent_path() / kSidecarName, ignored))
    robot.assumptions.push_back("the " + std::string(kSidecarName) +
                                " in the folder of this file is not used; to use both files, name "
                                "the folder");
  if (!options.guess) return robot;
  if (!sidecar) {
    hold_joints_without_mass(robot);
    hold_play_of_gears(robot);
  }
  for (const std::string& gap : gaps_of_the_files(robot, robot.missing_meshes.size()))
    robot.assumptions.push_back(gap);
  return guess_robot(std::move(robot)).robot;
}

RobotModel load_robot(const std::string& name_or_path, const RobotSearch& search,
                      const LoadOptions& options) {
  return RobotModel(load_robot_description(name_or_path, search, options));
}

}  // namespace ayumi
