#include "ayumi/io/robot/urdf.hpp"

#include <console_bridge/console.h>
#include <tinyxml.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <mutex>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/io/robot/urdf_check.hpp"
#include "ayumi/io/run/sha256.hpp"
#include "ayumi/model/validate.hpp"

namespace ayumi {

namespace {

namespace fs = std::filesystem;

// Keeps urdfdom's complaints from stderr. Its logger is global, hence the lock.
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

bool names_package(const fs::path& package_xml, const std::string& name) {
  TiXmlDocument document;
  if (!document.LoadFile(package_xml.string())) return false;
  const TiXmlElement* root = document.RootElement();
  const TiXmlElement* tag = root ? root->FirstChildElement("name") : nullptr;
  return tag && tag->GetText() && name == tag->GetText();
}

// The folder of a package, looked for beside the URDF and upwards; empty when there is none.
fs::path package_folder(const fs::path& urdf, const std::string& name) {
  std::error_code ignored;
  for (fs::path folder = fs::absolute(urdf).lexically_normal().parent_path();;
       folder = folder.parent_path()) {
    if (folder.filename() == name) return folder;
    if (fs::is_directory(folder / name, ignored)) return folder / name;
    if (fs::is_regular_file(folder / "package.xml", ignored) &&
        names_package(folder / "package.xml", name))
      return folder;
    if (folder == folder.root_path()) return {};
  }
}

// The file whose name differs from `file` by capitals alone; empty when there is none.
fs::path with_other_capitals(const fs::path& file) {
  const auto lower = [](std::string name) {
    for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return name;
  };
  fs::path found = file.is_absolute() ? file.root_path() : fs::path(".");
  std::error_code ignored;
  for (const fs::path& part : file.relative_path()) {
    fs::path next = found / part;
    if (!fs::exists(next, ignored)) {
      next.clear();
      for (const auto& entry : fs::directory_iterator(found, ignored))
        if (lower(entry.path().filename().string()) == lower(part.string())) next = entry.path();
    }
    if (next.empty()) return {};
    found = next;
  }
  return found.lexically_normal();
}

std::string resolve_mesh(const RobotDescription& robot, const fs::path& urdf,
                         const std::string& link, const std::string& name) {
  fs::path file = urdf.parent_path() / name;
  if (name.starts_with("file://")) file = name.substr(7);
  for (const std::string scheme : {"package://", "model://"}) {
    if (!name.starts_with(scheme)) continue;
    const std::string rest = name.substr(scheme.size());
    const size_t slash = std::min(rest.find('/'), rest.size());
    const std::string package = rest.substr(0, slash);
    const fs::path folder = package_folder(urdf, package);
    if (folder.empty())
      complain_urdf(robot, "link " + link + ": mesh " + name + ": no package '" + package +
                               "' in the URDF's folder or above it; put the URDF inside its "
                               "package or name the mesh relative to the URDF");
    file = folder / rest.substr(std::min(slash + 1, rest.size()));
  }
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) {
    if (fs::is_directory(file, ignored))
      complain_urdf(robot, "link " + link + ": mesh " + name + ": " +
                               file.lexically_normal().string() + " is a folder; name its file");
    const fs::path other = with_other_capitals(file.lexically_normal());
    complain_urdf(robot,
                  "link " + link + ": mesh " + name + ": there is no file " +
                      file.lexically_normal().string() +
                      (other.empty() ? "; add it or correct the name"
                                     : ", but there is " + other.string() +
                                           "; upper and lower case must match, correct the name"));
  }
  return file.lexically_normal().string();
}

class Converter {
 public:
  Converter(RobotDescription& robot, const fs::path& urdf) : robot_(robot), urdf_(urdf) {}

  template <typename Source>  // urdf::Visual or urdf::Collision
  PlacedShape placed(const Source& source, const std::string& link) const {
    PlacedShape placed;
    placed.name = source.name;
    placed.pose = isometry(source.origin);
    placed.shape = shape(*source.geometry, link);
    return placed;
  }

  LinkDescription link(const urdf::Link& source) const {
    LinkDescription link;
    link.name = source.name;
    link.has_inertial = source.inertial != nullptr;
    if (source.inertial) link.inertia = inertia_of(*source.inertial);
    for (const auto& visual : source.visual_array) {
      link.visuals.push_back(placed(*visual, link.name));
      if (!visual->material) continue;
      const urdf::Color& color = visual->material->color;
      const bool textured = !visual->material->texture_filename.empty();
      link.visuals.back().color = {color.r, color.g, color.b, color.a};
      link.visuals.back().has_color = !textured;
    }
    for (const auto& collision : source.collision_array)
      link.collisions.push_back(placed(*collision, link.name));
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

  Shape shape(const urdf::Geometry& geometry, const std::string& link) const {
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
        return MeshShape{resolve_mesh(robot_, urdf_, link, mesh.filename), vector(mesh.scale), {}};
      }
    }
  }

  RobotDescription& robot_;
  const fs::path& urdf_;
};

// urdfdom keeps links and joints in maps by name: put them back into the file's order.
template <typename Item>
void sort_by_place(std::vector<Item>& items, const std::map<std::string, int>& place) {
  std::stable_sort(items.begin(), items.end(), [&](const Item& a, const Item& b) {
    return place.at(a.name) < place.at(b.name);
  });
}

}  // namespace

RobotDescription parse_urdf(const std::string& bytes, const fs::path& path) {
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
    fail(ErrorCode::bad_file, path.string() + ": not a usable URDF: " +
                                  (complaint.empty() ? "the reader gave no reason" : complaint));
  RobotDescription robot;
  robot.name = source->getName();
  robot.urdf_file = path.string();
  robot.sha256 = sha256(bytes);
  const Converter converter(robot, path);
  for (const auto& [name, link] : source->links_) robot.links.push_back(converter.link(*link));
  for (const auto& [name, joint] : source->joints_)
    robot.joints.push_back(converter.joint(*joint, text));
  sort_by_place(robot.links, text.link_place);
  sort_by_place(robot.joints, text.joint_place);
  return robot;
}

RobotDescription read_urdf(const fs::path& path) { return parse_urdf(read_file(path), path); }

}  // namespace ayumi
