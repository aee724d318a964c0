// Frames of Choreonoid: the joint of a link is at the link's origin, `translation` and `rotation`
// place it in the parent link, and a rotation is an axis and an angle. Cylinders, capsules and
// cones stand along y.
#include "ayumi/io/robot/choreonoid_body.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/base/utf8.hpp"
#include "ayumi/io/robot/mesh_place.hpp"
#include "ayumi/io/run/sha256.hpp"
#include "ayumi/io/table/comma_cells.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/model/validate.hpp"

namespace ayumi {

namespace {

namespace fs = std::filesystem;
using Eigen::Isometry3d;
using Eigen::Vector3d;

// Largest number of elements of a body. Elements behind an alias count each time that the alias is
// used. Chosen: a robot has a few thousand; without a bound, aliases inside aliases would never
// end.
constexpr int kMostBodyElements = 20000;
// Largest depth of nested elements. Chosen: the same as in the parsers of other formats.
constexpr int kDeepestBodyElement = 100;

class BodyReader {
 public:
  BodyReader(const fs::path& path, const std::vector<fs::path>& packages)
      : path_(path), places_(path, packages) {}

  RobotDescription read(const std::string& bytes) {
    YAML::Node root;
    try {
      root = YAML::Load(text::with_line_feeds(bytes));
    } catch (const YAML::Exception& error) {
      fail(ErrorCode::bad_file, {path_.string(), "", error.mark.line + 1},
           "this is not valid YAML (" + error.msg + "); correct this place");
    }
    if (!root.IsMap())
      complain(root, "a Choreonoid body must be a map with format: ChoreonoidBody");
    if (text_or(root, "format", "format", "") != "ChoreonoidBody")
      complain(root, "a Choreonoid body must have format: ChoreonoidBody");
    const YAML::Node version = member(root, "format_version", "formatVersion");
    if (version && (number(version) < 1 || number(version) >= 3))
      complain(version, "version " + version.Scalar() + " is unknown; Ayumi reads 1.0 and 2.0");
    const std::string unit = text_or(root, "angle_unit", "angleUnit", "degree");
    if (unit != "degree" && unit != "radian")
      complain(root, "angle_unit is '" + unit + "'; expected degree or radian");
    angle_ = unit == "degree" ? std::numbers::pi / 180 : 1;
    robot_.name = text_or(root, "name", "name", path_.stem().string());
    robot_.urdf_file = path_.string();
    robot_.sha256 = sha256(bytes);
    const YAML::Node links = member(root, "links", "links");
    if (!links || !links.IsSequence() || links.size() == 0)
      complain(root, "the body has no list of links; add the list 'links'");
    if (links.size() > kMostLinks) complain(links, too_many("links"));
    for (const YAML::Node& link : links) read_link(link);
    order_joints();
    if (const YAML::Node extra = member(root, "extra_joints", "extraJoints"); extra && extra.size())
      robot_.assumptions.push_back(
          "the extra joints close loops of links, so they are left out: Ayumi does not simulate "
          "loops of "
          "links");
    if (!left_out_.empty())
      robot_.assumptions.push_back("shapes that Ayumi does not support are left out: " +
                                   text::join({left_out_.begin(), left_out_.end()}, ", "));
    validate_links(robot_);
    validate_joints(robot_);
    for (const std::string& note : places_.notes()) robot_.assumptions.push_back(note);
    robot_.missing_meshes = places_.missing();
    return std::move(robot_);
  }

 private:
  enum class Use { both, visual, collision };

  [[noreturn]] void complain(const YAML::Node& at, const std::string& message) const {
    fail(ErrorCode::bad_file, {path_.string(), "", at.Mark().line + 1}, message);
  }

  static YAML::Node member(const YAML::Node& node, const char* key, const char* other) {
    if (!node.IsMap()) return YAML::Node(YAML::NodeType::Undefined);
    if (const YAML::Node found = node[key]) return found;
    return node[other];
  }

  std::string text_or(const YAML::Node& node, const char* key, const char* other_key,
                      const std::string& other) const {
    const YAML::Node found = member(node, key, other_key);
    if (!found) return other;
    if (!found.IsScalar()) complain(found, "'" + std::string(key) + "' is not a text");
    return found.Scalar();
  }

  double number(const YAML::Node& node) const {
    if (!node.IsScalar()) complain(node, "a number is needed");
    const std::string& text = node.Scalar();
    const char* begin = text.c_str() + (text.starts_with("+") ? 1 : 0);
    const char* const end = text.c_str() + text.size();
    double value = 0;
    const auto [stop, error] = std::from_chars(begin, end, value);
    if (error != std::errc() || stop != end || !std::isfinite(value))
      complain(node, "'" + text + "' is not a finite number" +
                         (text.find(',') != std::string::npos ? "; write a decimal point" : ""));
    return value;
  }

  double number_or(const YAML::Node& node, const char* key, const char* other_key,
                   double other) const {
    const YAML::Node found = member(node, key, other_key);
    return found ? number(found) : other;
  }

  std::vector<double> numbers(const YAML::Node& node, size_t count) const {
    if (!node.IsSequence())
      complain(node, "a list of " + std::to_string(count) + " numbers is needed");
    std::vector<double> values;
    for (const YAML::Node& each : node) values.push_back(number(each));
    if (values.size() != count)
      complain(node, std::to_string(count) + " numbers are needed, found " +
                         std::to_string(values.size()) +
                         (values.size() > count ? kDecimalCommas : ""));
    return values;
  }

  Vector3d vector(const YAML::Node& node) const {
    const std::vector<double> v = numbers(node, 3);
    return {v[0], v[1], v[2]};
  }

  Eigen::Matrix3d rotation(const YAML::Node& node) const {
    if (node.IsSequence() && node.size() > 0 && node[0].IsSequence()) {
      Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
      for (const YAML::Node& each : node) turn = turn * rotation(each);
      return turn;
    }
    const std::vector<double> v = numbers(node, 4);
    const Vector3d axis(v[0], v[1], v[2]);
    if (axis.norm() < 1e-12) complain(node, "the axis of the rotation has length zero");
    return elementary::turn_matrix(angle_ * v[3], axis.normalized());
  }

  Isometry3d pose(const YAML::Node& node) const {
    Isometry3d pose = Isometry3d::Identity();
    if (const YAML::Node at = member(node, "translation", "translation"))
      pose.translation() = vector(at);
    if (const YAML::Node turn = member(node, "rotation", "rotation"))
      pose.linear() = rotation(turn);
    return pose;
  }

  void read_link(const YAML::Node& node) {
    if (!node.IsMap()) complain(node, "a link must be a map of keys and values");
    LinkDescription link;
    link.name = text_or(node, "name", "name", "");
    if (link.name.empty()) complain(node, "a link has no name");
    add_mass(node, Isometry3d::Identity(), link);
    if (const YAML::Node elements = node["elements"])
      read_elements(elements, Isometry3d::Identity(), Use::both, 0, link);
    const std::string parent = text_or(node, "parent", "parent", "");
    if (!parent.empty()) read_joint(node, link.name, parent);
    robot_.links.push_back(std::move(link));
  }

  void read_joint(const YAML::Node& node, const std::string& link, const std::string& parent) {
    JointDescription joint;
    joint.name = text_or(node, "joint_name", "jointName", link);
    joint.parent = parent;
    joint.child = link;
    joint.origin = pose(node);
    const std::string type = text_or(node, "joint_type", "jointType", "fixed");
    static const std::map<std::string, JointType> types = {
        {"revolute", JointType::revolute},   {"rotate", JointType::revolute},
        {"prismatic", JointType::prismatic}, {"slide", JointType::prismatic},
        {"fixed", JointType::fixed},         {"free", JointType::floating}};
    const auto known = types.find(type);
    if (known == types.end())
      complain(
          node,
          "link " + link + ": the joint type '" + type +
              "' is not supported; the supported types are revolute, prismatic, fixed and free");
    joint.type = known->second;
    joint.axis = Vector3d::UnitZ();  // default of the format
    if (const YAML::Node axis = member(node, "joint_axis", "jointAxis")) joint.axis = axis_of(axis);
    if (joint.type == JointType::revolute || joint.type == JointType::prismatic) {
      const double unit = joint.type == JointType::revolute ? angle_ : 1;
      read_range(node, unit, joint);
      if (const YAML::Node id = member(node, "joint_id", "jointId"); id && number(id) >= 0)
        ids_.emplace_back(number(id), joint.name);
      if (!joint.has_limits && joint.type == JointType::revolute)
        joint.type = JointType::continuous;
    }
    robot_.joints.push_back(joint);
  }

  Vector3d axis_of(const YAML::Node& node) const {
    if (!node.IsScalar()) return vector(node);
    std::string text = node.Scalar();
    double sign = 1;
    if (text.starts_with("-")) sign = -1;
    if (text.starts_with("-") || text.starts_with("+")) text.erase(0, 1);
    for (int i = 0; i < 3; ++i)
      if (text == std::string(1, "XYZ"[i]) || text == std::string(1, "xyz"[i]))
        return sign * Vector3d::Unit(i);
    complain(node, "the axis '" + node.Scalar() + "' is not one of X, Y, Z, -X, -Y and -Z");
  }

  void read_range(const YAML::Node& node, double unit, JointDescription& joint) const {
    if (const YAML::Node range = member(node, "joint_range", "jointRange")) {
      if (range.IsScalar() && range.Scalar() == "unlimited") {
        // the joint stays without limits
      } else if (range.IsScalar()) {
        joint.upper = unit * std::abs(number(range));
        joint.lower = -joint.upper;
        joint.has_limits = true;
      } else {
        const bool open = range.IsSequence() &&
                          std::any_of(range.begin(), range.end(), [](const YAML::Node& each) {
                            return each.IsScalar() && each.Scalar() == "unlimited";
                          });
        if (!open) {
          const std::vector<double> v = numbers(range, 2);
          joint.lower = unit * v[0];
          joint.upper = unit * v[1];
          joint.has_limits = true;
        }
      }
    }
    joint.velocity = largest(member(node, "joint_velocity_range", "jointVelocityRange"), unit);
    if (const double most = number_or(node, "max_joint_velocity", "maxJointVelocity", 0); most > 0)
      joint.velocity = unit * most;
    joint.effort = largest(member(node, "joint_effort_range", "jointEffortRange"), 1);
  }

  double largest(const YAML::Node& range, double unit) const {
    if (!range) return 0;
    if (range.IsScalar()) return unit * std::abs(number(range));
    const std::vector<double> v = numbers(range, 2);
    return unit * std::max(std::abs(v[0]), std::abs(v[1]));
  }

  // Adds the mass of a rigid body among the elements of a link to the mass of the link.
  void add_mass(const YAML::Node& node, const Isometry3d& at, LinkDescription& link) const {
    const YAML::Node mass = node["mass"];
    if (!mass) return;
    Inertia part;
    part.mass = number(mass);
    if (const YAML::Node center = member(node, "center_of_mass", "centerOfMass"))
      part.com = vector(center);
    if (const YAML::Node tensor = node["inertia"]) {
      const std::vector<double> v = numbers(tensor, 9);
      for (int i = 0; i < 9; ++i) part.about_com(i / 3, i % 3) = v[static_cast<size_t>(i)];
      part.about_com = (0.5 * (part.about_com + part.about_com.transpose())).eval();
    }
    part.com = at * part.com;
    part.about_com = at.linear() * part.about_com * at.linear().transpose();
    Inertia& whole = link.inertia;
    const double sum = whole.mass + part.mass;
    const Vector3d com =
        sum > 0 ? Vector3d((whole.mass * whole.com + part.mass * part.com) / sum) : part.com;
    const auto about = [&](const Inertia& each) -> Eigen::Matrix3d {
      const Vector3d d = each.com - com;
      return each.about_com +
             each.mass * (d.squaredNorm() * Eigen::Matrix3d::Identity() - d * d.transpose());
    };
    const Eigen::Matrix3d tensor = about(whole) + about(part);
    whole = {sum, com, tensor};
    link.has_inertial = true;
  }

  // A list of elements with types, or a map from types to elements.
  void read_elements(const YAML::Node& elements, const Isometry3d& at, Use use, int depth,
                     LinkDescription& link) {
    if (depth > kDeepestBodyElement)
      complain(elements, "elements are nested more than " + std::to_string(kDeepestBodyElement) +
                             " levels deep; simplify the body");
    if (elements.IsSequence()) {
      for (const YAML::Node& each : elements)
        read_element(each, text_or(each, "type", "type", ""), at, use, depth, link);
    } else if (elements.IsMap()) {
      for (const auto& each : elements)
        read_element(each.second, each.first.Scalar(), at, use, depth, link);
    }
  }

  void read_element(const YAML::Node& node, const std::string& type, const Isometry3d& above,
                    Use use, int depth, LinkDescription& link) {
    if (++elements_ > kMostBodyElements)
      complain(node, "the body has more than " + std::to_string(kMostBodyElements) +
                         " elements; simplify the body");
    if (!node.IsMap()) return;
    const Isometry3d at = above * pose(node);
    if (type == "RigidBody") add_mass(node, at, link);
    if (type == "Visual") use = Use::visual;
    if (type == "Collision") use = Use::collision;
    if (type == "IMU" || type == "RateGyroSensor" || type == "AccelerationSensor") {
      if (robot_.sensors.imu_link.empty()) {
        robot_.sensors.imu_link = link.name;
        robot_.sensors.imu_position = at.translation();
      }
      return;
    }
    const bool shaped = type == "Shape" || type == "Visual" || type == "Collision";
    if (shaped && node["geometry"]) place(node["geometry"], node, at, use, link);
    if (shaped && node["resource"]) place(node["resource"], node, at, use, link);
    if (type == "Resource") place(node, node, at, use, link);
    if (const YAML::Node elements = node["elements"])
      read_elements(elements, at, use, depth + 1, link);
    if (const YAML::Node shape = node["shape"])
      read_element(shape, "Shape", at, use, depth + 1, link);
  }

  void place(const YAML::Node& geometry, const YAML::Node& owner, const Isometry3d& at, Use use,
             LinkDescription& link) {
    if (!geometry.IsMap()) complain(geometry, "a geometry must be a map with the key type");
    const std::string type = text_or(geometry, "type", "type", "Resource");
    const auto positive = [&](const char* key) {
      const YAML::Node value = geometry[key];
      if (!value) complain(geometry, "link " + link.name + ": the " + type + " has no " + key);
      const double size = number(value);
      if (!(size > 0))
        complain(value, "link " + link.name + ": the " + key + " must be above 0, but it is " +
                            text::exact(size));
      return size;
    };
    PlacedShape placed;
    placed.pose = at;
    // The axis is y in the file and z here.
    const Isometry3d upright(elementary::turn_matrix(-std::numbers::pi / 2, Vector3d::UnitX()));
    if (type == "Box") {
      placed.shape = Box{vector(geometry["size"])};
    } else if (type == "Sphere") {
      placed.shape = Sphere{positive("radius")};
    } else if (type == "Cylinder") {
      placed.shape = Cylinder{positive("radius"), positive("height")};
      placed.pose = at * upright;
    } else if (type == "Capsule") {
      placed.shape = Capsule{positive("radius"), positive("height")};
      placed.pose = at * upright;
    } else if (type == "IndexedFaceSet") {
      placed.shape = MeshShape{{}, Vector3d::Ones(), faces(geometry)};
    } else if (type == "Resource" || type == "Mesh") {
      const std::string uri = text_or(geometry, "uri", "uri", "");
      if (uri.empty()) return;
      const std::string file = places_.find(link.name, uri);
      if (file.empty()) return;
      placed.shape = MeshShape{file, Vector3d::Ones(), {}};
    } else {
      left_out_.insert(type + " of " + link.name);
      return;
    }
    read_color(owner, placed);
    if (use != Use::collision) link.visuals.push_back(placed);
    if (use != Use::visual) link.collisions.push_back(std::move(placed));
  }

  TriangleMesh faces(const YAML::Node& node) const {
    const YAML::Node corners = node["coordinate"] ? node["coordinate"] : node["coordinates"];
    const YAML::Node indices = node["coordIndex"] ? node["coordIndex"] : node["coord_index"];
    if (!corners || !corners.IsSequence() || !indices || !indices.IsSequence())
      complain(node, "an IndexedFaceSet needs lists 'coordinate' and 'coordIndex'");
    std::vector<Vector3d> points;
    for (size_t i = 0; i + 2 < corners.size(); i += 3)
      points.emplace_back(number(corners[i]), number(corners[i + 1]), number(corners[i + 2]));
    MeshPart part;
    std::vector<size_t> face;
    const auto finish = [&] {
      for (size_t k = 2; k < face.size(); ++k) {
        const Vector3d &a = points[face[0]], &b = points[face[k - 1]], &c = points[face[k]];
        const Vector3d normal = (b - a).cross(c - a).normalized();
        if (!(normal.squaredNorm() > 0.5)) continue;  // the triangle has no area
        const auto first = static_cast<std::uint32_t>(part.vertices.size());
        for (const Vector3d& p : {a, b, c}) {
          part.vertices.push_back(p.cast<float>());
          part.normals.push_back(normal.cast<float>());
        }
        part.triangles.push_back({first, first + 1, first + 2});
      }
      face.clear();
    };
    for (const YAML::Node& each : indices) {
      const double index = number(each);
      if (index < 0) {
        finish();
      } else if (index < static_cast<double>(points.size())) {
        face.push_back(static_cast<size_t>(index));
      } else {
        complain(each, "corner " + each.Scalar() + " does not exist; the shape has " +
                           text::counted(points.size(), "corner") + ", numbered from 0");
      }
    }
    finish();
    if (part.triangles.empty()) complain(node, "the IndexedFaceSet has no triangle");
    return {{part}};
  }

  void read_color(const YAML::Node& owner, PlacedShape& placed) const {
    const YAML::Node appearance = owner["appearance"];
    if (!appearance || !appearance.IsMap()) return;
    const YAML::Node material = appearance["material"];
    if (!material || !material.IsMap()) return;
    const YAML::Node color = member(material, "diffuse", "diffuseColor");
    if (!color) return;
    placed.color.head<3>() = vector(color).cast<float>();
    placed.color[3] =
        static_cast<float>(1 - number_or(material, "transparency", "transparency", 0));
    placed.has_color = true;
  }

  // Motions of Choreonoid hold the joints in the order of their ids.
  void order_joints() {
    size_t moving = 0;
    for (const JointDescription& joint : robot_.joints)
      moving += joint.type != JointType::fixed && joint.type != JointType::floating;
    std::stable_sort(ids_.begin(), ids_.end());
    for (size_t i = 1; i < ids_.size(); ++i)
      if (ids_[i].first == ids_[i - 1].first)
        fail(ErrorCode::bad_file, {path_.string()},
             "the joints " + ids_[i - 1].second + " and " + ids_[i].second +
                 " have the same joint_id " + text::exact(ids_[i].first) +
                 "; give each joint another joint_id");
    for (size_t i = 0; i < ids_.size(); ++i)
      if (ids_[i].first != static_cast<double>(i)) {
        robot_.assumptions.push_back(
            "no joint has the joint_id " + std::to_string(i) + ", but a joint has the joint_id " +
            text::exact(ids_.back().first) + ", so the file may be incomplete");
        break;
      }
    if (ids_.size() != moving) return;  // not all joints have an id
    for (const auto& [id, name] : ids_) robot_.joint_order.push_back(name);
  }

  const fs::path& path_;
  MeshPlaces places_;
  double angle_ = 1;  // the file's unit of angles [rad]
  RobotDescription robot_;
  std::vector<std::pair<double, std::string>> ids_;
  std::set<std::string> left_out_;
  int elements_ = 0;
};

}  // namespace

RobotDescription parse_choreonoid_body(const std::string& bytes, const fs::path& path,
                                       const std::vector<fs::path>& packages) {
  try {
    return BodyReader(path, packages).read(bytes);
  } catch (const YAML::Exception& error) {
    fail(ErrorCode::bad_file, {path.string(), "", error.mark.line + 1}, error.msg);
  }
}

}  // namespace ayumi
