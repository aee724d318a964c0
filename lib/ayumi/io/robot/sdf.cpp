#include "ayumi/io/robot/sdf.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <list>
#include <map>
#include <numbers>
#include <optional>
#include <set>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/robot/ellipsoid_mesh.hpp"
#include "ayumi/io/robot/mesh_place.hpp"
#include "ayumi/io/robot/xml_text.hpp"
#include "ayumi/io/run/sha256.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/validate.hpp"

namespace ayumi {

namespace {

namespace fs = std::filesystem;
using Eigen::Isometry3d;
using Eigen::Vector3d;

// Position limits from which on a joint counts as unlimited. Source: the format's own default is
// 1e16.
constexpr double kUnlimited = 1e15;
// Largest depth of models inside each other, by nesting or inclusion. Chosen: robots have two or
// three.
constexpr int kDeepestModel = 20;
constexpr double kUnstatedMass = 1;  // [kg], [kg m^2]. Source: the format's defaults for a link.
// Largest number of bytes of an included file. Chosen: text of a model takes kilobytes.
constexpr size_t kLargestSdfPart = size_t{64} << 20;
constexpr const char* kModelFrame = "__model__";

const char* xml_text(const TiXmlElement* element) {
  const char* text = element ? element->GetText() : nullptr;
  return text ? text : "";
}

std::string without_blank_ends(std::string text) {
  const char* blanks = " \t\r\n";
  text.erase(0, text.find_first_not_of(blanks));
  text.erase(text.find_last_not_of(blanks) + 1);
  return text;
}

class SdfReader {
 public:
  SdfReader(const fs::path& path, const std::vector<fs::path>& packages)
      : path_(path), places_(path, packages) {}

  RobotDescription read(const std::string& bytes) {
    TiXmlDocument document;
    parse_xml(document, bytes, path_.string(), "an SDF model");
    const TiXmlElement* root = document.RootElement();
    if (root->ValueStr() != "sdf")
      complain(root,
               "the outermost element is <" + root->ValueStr() + ">, but an SDF starts with <sdf>");
    version_ = version_of(root);
    const TiXmlElement* model = robot_of(root);
    robot_.name = required(model, "name");
    robot_.urdf_file = path_.string();
    frames_[kModelFrame] = {Isometry3d::Identity(), "", model};
    read_model(model, "", 0);
    robot_.sha256 = sha256(bytes + files_);
    make_links();
    make_joints();
    if (robot_.links.empty()) complain(model, "the model " + robot_.name + " has no <link>");
    if (!massless_.empty())
      robot_.assumptions.push_back(
          "links without <inertial> get a mass of 1 kg, as SDF defines it: " +
          text::join(massless_, ", "));
    validate_links(robot_);
    validate_joints(robot_);
    for (const std::string& note : places_.notes()) robot_.assumptions.push_back(note);
    robot_.missing_meshes = places_.missing();
    return std::move(robot_);
  }

 private:
  struct Frame {
    Isometry3d pose;
    std::string relative_to;  // name of the frame; if it is empty, the frame of the robot
    const TiXmlElement* at = nullptr;
    bool open = false;
  };
  struct LinkSource {
    std::string name, scope;
    const TiXmlElement* element;
  };
  struct JointSource {
    std::string name, scope, parent, child;
    const TiXmlElement* element;
  };

  [[noreturn]] void complain(const TiXmlElement* at, const std::string& message) const {
    complain_xml(file_.empty() ? path_.string() : file_, at, message);
  }

  std::string required(const TiXmlElement* element, const char* attribute) const {
    const std::string value = xml_attribute(element, attribute, "");
    if (value.empty())
      complain(element, "<" + element->ValueStr() + "> has no attribute '" + attribute + "'");
    return value;
  }

  double version_of(const TiXmlElement* root) const {
    const std::string text = required(root, "version");
    const std::vector<double> numbers =
        xml_numbers(path_.string(), root, "<sdf version>: ", text, 1);
    // The versions 1.10 and 1.11 come after 1.9.
    const size_t dot = text.find('.');
    const double minor = dot == std::string::npos ? 0 : std::atof(text.c_str() + dot + 1);
    if (std::floor(numbers[0]) != 1 || minor < 4)
      complain(root, "version " + text + " of SDF is unknown; Ayumi reads 1.4 to 1.11");
    return minor;
  }

  // Finds the numbers of joints, and of the places where joints name links.
  static std::pair<int, int> size_of(const TiXmlElement* model) {
    std::pair<int, int> size = {0, 0};
    for (auto* each = model->FirstChildElement(); each; each = each->NextSiblingElement()) {
      size.first += each->ValueStr() == "joint";
      size.second += each->ValueStr() == "link";
      if (each->ValueStr() != "model") continue;
      const auto inner = size_of(each);
      size.first += inner.first;
      size.second += inner.second;
    }
    return size;
  }

  const TiXmlElement* robot_of(const TiXmlElement* root) {
    std::vector<const TiXmlElement*> models;
    for (auto* each = root->FirstChildElement(); each; each = each->NextSiblingElement()) {
      if (each->ValueStr() == "model") models.push_back(each);
      if (each->ValueStr() != "world") continue;
      for (auto* model = each->FirstChildElement("model"); model;
           model = model->NextSiblingElement("model"))
        models.push_back(model);
    }
    if (models.empty()) complain(root, "the file has no <model>");
    const auto* best =
        *std::max_element(models.begin(), models.end(),
                          [](const auto* a, const auto* b) { return size_of(a) < size_of(b); });
    std::vector<std::string> others;
    for (const auto* each : models)
      if (each != best) others.push_back(xml_attribute(each, "name", "a model without name"));
    if (!others.empty())
      robot_.assumptions.push_back(
          "the file has several models. Ayumi read the model with the most joints and left these "
          "models out: " +
          text::join(others, ", "));
    return best;
  }

  std::vector<double> numbers(const TiXmlElement* element, int count) const {
    return xml_numbers(file_.empty() ? path_.string() : file_, element,
                       "<" + element->ValueStr() + ">: ", xml_text(element), count);
  }

  double number(const TiXmlElement* parent, const char* name, double other) const {
    const TiXmlElement* element = parent ? parent->FirstChildElement(name) : nullptr;
    if (!element || without_blank_ends(xml_text(element)).empty()) return other;
    std::string text = without_blank_ends(xml_text(element));
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (text == "inf" || text == "+inf") return std::numeric_limits<double>::infinity();
    if (text == "-inf") return -std::numeric_limits<double>::infinity();
    return numbers(element, 1)[0];
  }

  Isometry3d pose_of(const TiXmlElement* owner) const {
    const TiXmlElement* element = owner->FirstChildElement("pose");
    Isometry3d pose = Isometry3d::Identity();
    if (!element || without_blank_ends(xml_text(element)).empty()) return pose;
    if (xml_attribute(element, "rotation_format", "") == "quat_xyzw") {
      const std::vector<double> v = numbers(element, 7);
      const Eigen::Quaterniond turn(v[6], v[3], v[4], v[5]);
      if (turn.norm() < 1e-9)
        complain(element, "the quaternion of the pose is zero; give a unit quaternion");
      pose.linear() = turn.normalized().toRotationMatrix();
      pose.translation() = Vector3d(v[0], v[1], v[2]);
      return pose;
    }
    const std::vector<double> v = numbers(element, 6);
    const bool degrees = xml_attribute(element, "degrees", "false") == "true";
    const double unit = degrees ? std::numbers::pi / 180 : 1;
    pose.linear() = (elementary::turn_quaternion(unit * v[5], Vector3d::UnitZ()) *
                     elementary::turn_quaternion(unit * v[4], Vector3d::UnitY()) *
                     elementary::turn_quaternion(unit * v[3], Vector3d::UnitX()))
                        .toRotationMatrix();
    pose.translation() = Vector3d(v[0], v[1], v[2]);
    return pose;
  }

  // The frame to which the pose of `owner` is relative.
  static std::string relative_to(const TiXmlElement* owner, const std::string& scope,
                                 const std::string& other) {
    const std::string named = xml_attribute(owner->FirstChildElement("pose"), "relative_to", "");
    return named.empty() ? other : scope + named;
  }

  void add_frame(const std::string& name, const TiXmlElement* at, const std::string& relative) {
    if (!frames_.emplace(name, Frame{pose_of(at), relative, at, false}).second)
      complain(at, "the name '" + name + "' is given twice");
  }

  Frame& frame_of(const std::string& name, const TiXmlElement* at) {
    const auto found = frames_.find(name);
    if (found != frames_.end()) return found->second;
    std::vector<std::string> known;
    for (const auto& [each, frame] : frames_) known.push_back(each);
    complain(at, "there is no frame '" + name + "'" + text::suggestion(name, known));
  }

  // Pose of a frame in the robot, with every joint at 0. Without recursion, because a file may have
  // very many frames in a chain.
  Isometry3d resolved(const std::string& name, const TiXmlElement* at) {
    std::vector<Frame*> chain = {&frame_of(name, at)};
    std::string reached = name;
    while (!chain.back()->relative_to.empty()) {
      Frame& frame = *chain.back();
      if (frame.open) complain(frame.at, "the frames form a circle at '" + reached + "'");
      frame.open = true;
      reached = frame.relative_to;
      chain.push_back(&frame_of(reached, frame.at));
    }
    Isometry3d pose = chain.back()->pose;
    for (auto frame = std::next(chain.rbegin()); frame != chain.rend(); ++frame) {
      pose = pose * (*frame)->pose;
      (*frame)->pose = pose;
      (*frame)->open = false;
      (*frame)->relative_to.clear();
    }
    return pose;
  }

  void read_model(const TiXmlElement* model, const std::string& scope, int depth) {
    if (depth > kDeepestModel)
      complain(model, "models are nested more than " + std::to_string(kDeepestModel) +
                          " levels deep; simplify the file");
    const std::string own = scope + kModelFrame;
    for (auto* each = model->FirstChildElement(); each; each = each->NextSiblingElement()) {
      const std::string& kind = each->ValueStr();
      if (kind == "link") {
        const std::string name = scope + required(each, "name");
        add_frame(name, each, relative_to(each, scope, own));
        links_.push_back({name, scope, each});
        if (links_.size() > kMostLinks) complain(each, too_many("links"));
      } else if (kind == "joint") {
        read_joint(each, scope);
      } else if (kind == "frame") {
        const std::string attached = xml_attribute(each, "attached_to", "");
        add_frame(scope + required(each, "name"), each,
                  relative_to(each, scope, attached.empty() ? own : scope + attached));
      } else if (kind == "model") {
        add_nested(each, each, required(each, "name"), scope, depth);
      } else if (kind == "include") {
        include(each, scope, depth);
      }
    }
  }

  // Adds a nested model. The element `place` has its pose: the model itself, or the <include> that
  // names it.
  void add_nested(const TiXmlElement* model, const TiXmlElement* place, const std::string& name,
                  const std::string& scope, int depth) {
    const std::string inner = scope + name + "::";
    add_frame(scope + name, place, relative_to(place, scope, scope + kModelFrame));
    frames_[inner + kModelFrame] = {Isometry3d::Identity(), scope + name, model, false};
    read_model(model, inner, depth + 1);
    const std::string placed = xml_attribute(place, "placement_frame", "");
    if (placed.empty()) return;
    // The pose gives the place of the named frame of the model, and not of the model's own frame.
    const std::string key = inner + kModelFrame;
    frames_[key] = {Isometry3d::Identity(), "", model, false};
    const Isometry3d offset = resolved(inner + placed, place);
    const Isometry3d outer = resolved(scope + name, place) * offset.inverse();
    for (auto inside = frames_.lower_bound(inner);
         inside != frames_.end() && inside->first.starts_with(inner); ++inside)
      if (Frame& frame = inside->second; frame.relative_to.empty()) frame.pose = outer * frame.pose;
  }

  void include(const TiXmlElement* element, const std::string& scope, int depth) {
    const std::string uri = without_blank_ends(xml_text(element->FirstChildElement("uri")));
    if (uri.empty()) complain(element, "<include> has no <uri>");
    fs::path found =
        uri.find("://") == std::string::npos ? path_.parent_path() / uri : places_.folder(uri);
    std::error_code ignored;
    if (fs::is_directory(found, ignored)) {
      TiXmlDocument config;
      const fs::path about = found / "model.config";
      std::string file = "model.sdf";
      if (fs::is_regular_file(about, ignored)) {
        parse_xml(config, read_file(about, kLargestSdfPart), about.string(), "a model.config");
        if (const auto* sdf = config.RootElement()->FirstChildElement("sdf"))
          file = without_blank_ends(xml_text(sdf));
      }
      found /= file;
    }
    if (!fs::is_regular_file(found, ignored))
      complain(element, "the included model " + uri +
                            " is not there; --package-path names the folder of the models");
    if (depth > kDeepestModel)
      complain(element, "models include each other more than " + std::to_string(kDeepestModel) +
                            " levels deep; check that no model includes itself");
    TiXmlDocument& document = included_.emplace_back();
    const std::string bytes = read_file(found, kLargestSdfPart);
    files_ += bytes;
    parse_xml(document, bytes, found.string(), "an SDF model");
    const TiXmlElement* model = document.RootElement()->FirstChildElement("model");
    if (!model) complain(element, "the included file " + found.string() + " has no <model>");
    const TiXmlElement* name = element->FirstChildElement("name");
    add_nested(model, element,
               name ? without_blank_ends(xml_text(name)) : xml_attribute(model, "name", "included"),
               scope, depth);
  }

  void read_joint(const TiXmlElement* element, const std::string& scope) {
    JointSource joint{scope + required(element, "name"), scope, "", "", element};
    for (const bool parent : {true, false}) {
      const TiXmlElement* end = element->FirstChildElement(parent ? "parent" : "child");
      const std::string name =
          without_blank_ends(xml_text(end ? end->FirstChildElement("link_name") : nullptr));
      const std::string link = name.empty() ? without_blank_ends(xml_text(end)) : name;
      if (link.empty())
        complain(element,
                 "joint " + joint.name + " has no <" + (parent ? "parent" : "child") + ">");
      (parent ? joint.parent : joint.child) = link == "world" ? link : scope + link;
    }
    add_frame(joint.name, element, relative_to(element, scope, joint.child));
    joints_.push_back(joint);
    if (joints_.size() > kMostLinks) complain(element, too_many("joints"));
  }

  // A joint may name a frame that is attached to a link.
  std::string link_of(const std::string& name, const TiXmlElement* at) const {
    std::string link = name;
    for (int steps = 0; steps < kDeepestModel; ++steps) {
      if (std::any_of(links_.begin(), links_.end(),
                      [&](const LinkSource& each) { return each.name == link; }))
        return link;
      const auto frame = frames_.find(link);
      if (frame == frames_.end() || frame->second.at->ValueStr() != "frame") break;
      const size_t scope = link.rfind("::");
      link = (scope == std::string::npos ? "" : link.substr(0, scope + 2)) +
             xml_attribute(frame->second.at, "attached_to", "");
    }
    std::vector<std::string> known;
    for (const LinkSource& each : links_) known.push_back(each.name);
    complain(at, "there is no link '" + name + "'" + text::suggestion(name, known));
  }

  void make_joints() {
    for (const JointSource& source : joints_) {
      if (source.parent == "world" || source.child == "world") {
        robot_.assumptions.push_back(
            "the joint " + source.name +
            " to the world is left out, because a robot that stands on its feet moves freely");
        continue;
      }
      make_joint(source);
    }
  }

  void make_joint(const JointSource& source) {
    const std::string type = required(source.element, "type");
    static const std::vector<std::string> known = {"revolute",  "continuous", "prismatic",
                                                   "universal", "revolute2",  "fixed"};
    if (std::find(known.begin(), known.end(), type) == known.end())
      complain(source.element, "joint " + source.name + ": the type '" + type +
                                   "' is not supported; the supported types are " +
                                   text::join(known, ", "));
    const std::string parent = link_of(source.parent, source.element);
    const std::string child = link_of(source.child, source.element);
    const Isometry3d at = resolved(source.name, source.element);
    const bool two = type == "universal" || type == "revolute2";
    JointDescription joint;
    joint.name = source.name;
    joint.parent = parent;
    joint.child = two ? child + "/" + source.name : child;
    joint.origin = link_frame(parent).inverse() * at;
    joint.type = type == "fixed"       ? JointType::fixed
                 : type == "prismatic" ? JointType::prismatic
                                       : JointType::revolute;
    if (joint.type != JointType::fixed) read_axis(source, "axis", at, joint);
    if (type == "continuous") joint.has_limits = false;
    if (!joint.has_limits && joint.type == JointType::revolute) joint.type = JointType::continuous;
    robot_.joints.push_back(joint);
    if (!two) return;
    robot_.links.push_back({joint.child, false, {}, {}, {}});
    JointDescription second;
    second.name = source.name + "_2";
    second.parent = joint.child;
    second.child = child;
    second.type = JointType::revolute;
    read_axis(source, "axis2", at, second);
    if (!second.has_limits) second.type = JointType::continuous;
    robot_.joints.push_back(second);
  }

  void read_axis(const JointSource& source, const char* name, const Isometry3d& at,
                 JointDescription& joint) {
    const TiXmlElement* axis = source.element->FirstChildElement(name);
    joint.axis = Vector3d::UnitZ();  // default of the format
    if (!axis) complain(source.element, "joint " + source.name + " has no <" + name + ">");
    if (const TiXmlElement* xyz = axis->FirstChildElement("xyz")) {
      const std::vector<double> v = numbers(xyz, 3);
      joint.axis = Vector3d(v[0], v[1], v[2]);
      const std::string expressed = xml_attribute(xyz, "expressed_in", "");
      const bool in_model = number_or_flag(axis, "use_parent_model_frame", version_ < 5);
      if (!expressed.empty() && source.scope + expressed != source.name)
        joint.axis = at.linear().transpose() *
                     (resolved(source.scope + expressed, xyz).linear() * joint.axis);
      else if (expressed.empty() && in_model)
        joint.axis = at.linear().transpose() *
                     (resolved(source.scope + kModelFrame, xyz).linear() * joint.axis);
    }
    const TiXmlElement* limit = axis->FirstChildElement("limit");
    joint.lower = number(limit, "lower", -kUnlimited);
    joint.upper = number(limit, "upper", kUnlimited);
    joint.has_limits = joint.lower > -kUnlimited && joint.upper < kUnlimited;
    if (!joint.has_limits) joint.lower = joint.upper = 0;
    const auto stated = [](double value) {
      return value > 0 && value < kUnlimited
                 ? value
                 : 0;  // below 0 and infinite mean that there is no limit
    };
    joint.effort = stated(number(limit, "effort", -1));
    joint.velocity = stated(number(limit, "velocity", -1));
    const TiXmlElement* dynamics = axis->FirstChildElement("dynamics");
    joint.damping = number(dynamics, "damping", 0);
    joint.friction = number(dynamics, "friction", 0);
    if (const TiXmlElement* mimic = axis->FirstChildElement("mimic")) {
      joint.mimic = source.scope + required(mimic, "joint");
      joint.mimic_multiplier = number(mimic, "multiplier", 1);
      joint.mimic_offset =
          number(mimic, "offset", 0) - joint.mimic_multiplier * number(mimic, "reference", 0);
    }
  }

  bool number_or_flag(const TiXmlElement* parent, const char* name, bool other) const {
    const TiXmlElement* element = parent->FirstChildElement(name);
    if (!element) return other;
    const std::string text = without_blank_ends(xml_text(element));
    return text == "1" || text == "true";
  }

  // A link of the robot has the frame of the joint that carries it.
  Isometry3d link_frame(const std::string& link) {
    if (carriers_.empty())
      for (const JointSource& joint : joints_)
        if (joint.parent != "world" && joint.child != "world")
          carriers_.emplace(link_of(joint.child, joint.element), &joint);
    const auto carrier = carriers_.find(link);
    if (carrier == carriers_.end()) return resolved(link, nullptr);
    return resolved(carrier->second->name, carrier->second->element);
  }

  void make_links() {
    for (const LinkSource& source : links_) {
      const Isometry3d shift =
          link_frame(source.name).inverse() * resolved(source.name, source.element);
      LinkDescription link;
      link.name = source.name;
      link.has_inertial = true;
      link.inertia = inertia_of(source, shift);
      for (const char* kind : {"visual", "collision"})
        for (auto* shape = source.element->FirstChildElement(kind); shape;
             shape = shape->NextSiblingElement(kind))
          place(shape, source, shift,
                std::string(kind) == "visual" ? link.visuals : link.collisions);
      for (auto* sensor = source.element->FirstChildElement("sensor"); sensor;
           sensor = sensor->NextSiblingElement("sensor"))
        if (xml_attribute(sensor, "type", "") == "imu" && robot_.sensors.imu_link.empty()) {
          robot_.sensors.imu_link = link.name;
          robot_.sensors.imu_position = (shift * part_pose(sensor, source)).translation();
        }
      robot_.links.push_back(std::move(link));
    }
  }

  // The pose of a part of a link, in the link's own frame.
  Isometry3d part_pose(const TiXmlElement* part, const LinkSource& source) {
    const Isometry3d pose = pose_of(part);
    const std::string named = xml_attribute(part->FirstChildElement("pose"), "relative_to", "");
    if (named.empty()) return pose;
    return resolved(source.name, part).inverse() * resolved(source.scope + named, part) * pose;
  }

  Inertia inertia_of(const LinkSource& source, const Isometry3d& shift) {
    const TiXmlElement* inertial = source.element->FirstChildElement("inertial");
    if (!inertial) {
      massless_.push_back(source.name);
      return {kUnstatedMass, shift.translation(), kUnstatedMass * Eigen::Matrix3d::Identity()};
    }
    const TiXmlElement* tensor = inertial->FirstChildElement("inertia");
    const auto entry = [&](const char* name, double other) { return number(tensor, name, other); };
    Eigen::Matrix3d I;
    I << entry("ixx", kUnstatedMass), entry("ixy", 0), entry("ixz", 0),  //
        entry("ixy", 0), entry("iyy", kUnstatedMass), entry("iyz", 0),   //
        entry("ixz", 0), entry("iyz", 0), entry("izz", kUnstatedMass);
    const Isometry3d frame = shift * part_pose(inertial, source);
    return {number(inertial, "mass", kUnstatedMass), frame.translation(),
            frame.linear() * I * frame.linear().transpose()};
  }

  void place(const TiXmlElement* element, const LinkSource& source, const Isometry3d& shift,
             std::vector<PlacedShape>& shapes) {
    const TiXmlElement* geometry = element->FirstChildElement("geometry");
    const TiXmlElement* kind = geometry ? geometry->FirstChildElement() : nullptr;
    if (!kind) return;
    PlacedShape placed;
    placed.name = xml_attribute(element, "name", "");
    placed.pose = shift * part_pose(element, source);
    const std::string& type = kind->ValueStr();
    const auto positive = [&](const char* name) {
      const double value = number(kind, name, 0);
      if (!(value > 0))
        complain(kind, "link " + source.name + ": <" + type + "> needs a <" + name + "> above 0");
      return value;
    };
    const auto triple = [&](const char* name, double other) {
      const TiXmlElement* each = kind->FirstChildElement(name);
      if (!each) return Vector3d(other, other, other);
      const std::vector<double> v = numbers(each, 3);
      return Vector3d(v[0], v[1], v[2]);
    };
    if (type == "box") {
      placed.shape = Box{triple("size", 1)};
    } else if (type == "sphere") {
      placed.shape = Sphere{positive("radius")};
    } else if (type == "cylinder") {
      placed.shape = Cylinder{positive("radius"), positive("length")};
    } else if (type == "capsule") {
      placed.shape = Capsule{positive("radius"), positive("length")};
    } else if (type == "ellipsoid") {
      placed.shape = MeshShape{{}, Vector3d::Ones(), ellipsoid_mesh(triple("radii", 1))};
    } else if (type == "mesh") {
      const std::string uri = without_blank_ends(xml_text(kind->FirstChildElement("uri")));
      const std::string file = places_.find(source.name, uri);
      if (file.empty()) return;
      placed.shape = MeshShape{file, triple("scale", 1), {}};
    } else {
      return;  // planes and height fields belong to the world
    }
    if (const TiXmlElement* material = element->FirstChildElement("material"))
      if (const TiXmlElement* diffuse = material->FirstChildElement("diffuse")) {
        const std::string text = without_blank_ends(xml_text(diffuse));
        const bool alpha = std::count(text.begin(), text.end(), ' ') >= 3;
        const std::vector<double> v = numbers(diffuse, alpha ? 4 : 3);
        placed.color = Eigen::Vector4d(v[0], v[1], v[2], alpha ? v[3] : 1).cast<float>();
        placed.has_color = true;
      }
    shapes.push_back(std::move(placed));
  }

  const fs::path& path_;
  MeshPlaces places_;
  double version_ = 0;  // the part of the version after "1."
  std::string file_, files_;
  RobotDescription robot_;
  std::map<std::string, Frame> frames_;
  std::vector<LinkSource> links_;
  std::vector<JointSource> joints_;
  std::map<std::string, const JointSource*> carriers_;  // by link, the first joint that has it
  std::vector<std::string> massless_;
  std::list<TiXmlDocument> included_;
};

}  // namespace

RobotDescription parse_sdf(const std::string& bytes, const fs::path& path,
                           const std::vector<fs::path>& packages) {
  return SdfReader(path, packages).read(bytes);
}

}  // namespace ayumi
