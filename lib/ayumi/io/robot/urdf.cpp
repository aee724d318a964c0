#include "ayumi/io/robot/urdf.hpp"

#include <console_bridge/console.h>
#include <tinyxml.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <mutex>
#include <optional>

#include "ayumi/base/error.hpp"
#include "ayumi/io/robot/mesh_place.hpp"
#include "ayumi/io/robot/urdf_check.hpp"
#include "ayumi/io/run/sha256.hpp"
#include "ayumi/model/validate.hpp"

namespace ayumi {

namespace {

namespace fs = std::filesystem;

// Keeps urdfdom's complaints from stderr. Its logger is global, so a lock is needed.
class QuietLog : public console_bridge::OutputHandler {
 public:
  QuietLog() : lock_(mutex()) { console_bridge::useOutputHandler(this); }
  ~QuietLog() override { console_bridge::restorePreviousOutputHandler(); }
  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) first_ = first_.empty() ? text : first_;
  }
  const std::string& first() const { return first_; }

 private:
  static std::mutex& mutex() {
    static std::mutex only;
    return only;
  }
  std::lock_guard<std::mutex> lock_;
  std::string first_;
};

Eigen::Vector3d vector(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

Eigen::Isometry3d isometry(const urdf::Pose& pose) {
  const urdf::Rotation& q = pose.rotation;
  const Eigen::Quaterniond turn = Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized();
  return Eigen::Translation3d(vector(pose.position)) * turn;
}

Inertia inertia_of(const urdf::Inertial& inertial) {
  Eigen::Matrix3d tensor;
  tensor << inertial.ixx, inertial.ixy, inertial.ixz,  //
      inertial.ixy, inertial.iyy, inertial.iyz,        //
      inertial.ixz, inertial.iyz, inertial.izz;
  const Eigen::Isometry3d origin = isometry(inertial.origin);
  return {inertial.mass, origin.translation(),
          origin.linear() * tensor * origin.linear().transpose()};
}

class Converter {
 public:
  explicit Converter(MeshPlaces& meshes) : meshes_(meshes) {}

  LinkDescription link(const urdf::Link& source) {
    LinkDescription link;
    link.name = source.name;
    link.has_inertial = source.inertial != nullptr;
    if (source.inertial) link.inertia = inertia_of(*source.inertial);
    for (const auto& visual : source.visual_array) {
      if (!place(*visual, link.name, link.visuals) || !visual->material) continue;
      const urdf::Color& color = visual->material->color;
      const bool textured = !visual->material->texture_filename.empty();
      link.visuals.back().color = {color.r, color.g, color.b, color.a};
      link.visuals.back().has_color = !textured;
    }
    for (const auto& collision : source.collision_array)
      place(*collision, link.name, link.collisions);
    return link;
  }

  JointDescription joint(const urdf::Joint& source, const UrdfText& text) const {
    JointDescription joint;
    joint.name = source.name;
    joint.type = type_of(source.type);
    joint.parent = source.parent_link_name;
    joint.child = source.child_link_name;
    joint.origin = isometry(source.parent_to_joint_origin_transform);
    joint.axis = vector(source.axis);
    if (source.limits) {
      joint.has_limits = !text.unlimited.contains(source.name);
      joint.lower = source.limits->lower;
      joint.upper = source.limits->upper;
      joint.velocity = source.limits->velocity;
      joint.effort = source.limits->effort;
    }
    if (source.dynamics) {
      joint.damping = source.dynamics->damping;
      joint.friction = source.dynamics->friction;
    }
    if (source.mimic) {
      joint.mimic = source.mimic->joint_name;
      joint.mimic_multiplier = source.mimic->multiplier;
      joint.mimic_offset = source.mimic->offset;
    }
    return joint;
  }

 private:
  static JointType type_of(int type) {
    switch (type) {
      case urdf::Joint::REVOLUTE:
        return JointType::revolute;
      case urdf::Joint::CONTINUOUS:
        return JointType::continuous;
      case urdf::Joint::PRISMATIC:
        return JointType::prismatic;
      case urdf::Joint::FLOATING:
        return JointType::floating;
      default:
        return JointType::fixed;
    }
  }

  // Returns false if the mesh is missing; then the shape is left out.
  template <typename Source>  // urdf::Visual or urdf::Collision
  bool place(const Source& source, const std::string& link, std::vector<PlacedShape>& shapes) {
    const std::optional<Shape> found = shape(*source.geometry, link);
    if (!found) return false;
    PlacedShape& placed = shapes.emplace_back();
    placed.name = source.name;
    placed.pose = isometry(source.origin);
    placed.shape = *found;
    return true;
  }

  std::optional<Shape> shape(const urdf::Geometry& geometry, const std::string& link) {
    switch (geometry.type) {
      case urdf::Geometry::BOX:
        return Box{vector(static_cast<const urdf::Box&>(geometry).dim)};
      case urdf::Geometry::SPHERE:
        return Sphere{static_cast<const urdf::Sphere&>(geometry).radius};
      case urdf::Geometry::CYLINDER: {
        const auto& cylinder = static_cast<const urdf::Cylinder&>(geometry);
        return Cylinder{cylinder.radius, cylinder.length};
      }
      default: {
        const auto& mesh = static_cast<const urdf::Mesh&>(geometry);
        const std::string file = meshes_.find(link, mesh.filename);
        if (file.empty()) return {};
        return MeshShape{file, vector(mesh.scale), {}};
      }
    }
  }

  MeshPlaces& meshes_;
};

// Puts links and joints into the order of the file, because urdfdom keeps them in maps by name.
template <typename Item>
void sort_by_place(std::vector<Item>& items, const std::map<std::string, int>& place) {
  std::stable_sort(items.begin(), items.end(), [&](const Item& a, const Item& b) {
    return place.at(a.name) < place.at(b.name);
  });
}

}  // namespace

RobotDescription parse_urdf(const std::string& bytes, const fs::path& path,
                            const std::vector<fs::path>& packages) {
  const UrdfText text = check_urdf(bytes, path.string());
  urdf::ModelInterfaceSharedPtr source;
  std::string complaint;
  {
    QuietLog log;
    try {
      source = urdf::parseURDF(text.xml);
    } catch (const std::exception& error) {
      complaint = error.what();
    }
    if (complaint.empty()) complaint = log.first();
  }
  if (!source)
    fail(ErrorCode::bad_file, {path.string()},
         "the URDF cannot be read: " +
             (complaint.empty() ? "the reader gave no reason" : complaint));
  RobotDescription robot;
  robot.name = source->getName();
  robot.urdf_file = path.string();
  robot.sha256 = sha256(bytes);
  MeshPlaces meshes(path, packages);
  Converter converter(meshes);
  for (const auto& [name, link] : source->links_) robot.links.push_back(converter.link(*link));
  for (const auto& [name, joint] : source->joints_)
    robot.joints.push_back(converter.joint(*joint, text));
  sort_by_place(robot.links, text.link_place);
  sort_by_place(robot.joints, text.joint_place);
  robot.assumptions = meshes.notes();
  robot.missing_meshes = meshes.missing();
  return robot;
}

}  // namespace ayumi
