// Frames of RoKi: a link's frame is that of its joint, `frame` places it in the parent link (three
// rows of rotation and position), and a joint turns about z or slides along it. Angles are in
// degrees.
#include "ayumi/io/robot/ztk.hpp"

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
#include "ayumi/io/degrees.hpp"
#include "ayumi/io/run/sha256.hpp"
#include "ayumi/io/table/comma_cells.hpp"
#include "ayumi/model/validate.hpp"

namespace ayumi {

namespace {

namespace fs = std::filesystem;
using Eigen::Isometry3d;
using Eigen::Vector3d;

// Largest number of corners and faces of all shapes. Chosen: the robots of mi-lib have some
// thousand.
constexpr size_t kMostZtkFields = 500'000;

// The shortest turn of z to a direction.
Eigen::Matrix3d turn_of_z(const Vector3d& direction) {
  const Vector3d d = direction.normalized();
  if (d.z() < -1 + 1e-12) return Vector3d(1, -1, -1).asDiagonal();
  const Vector3d v = Vector3d::UnitZ().cross(d);
  Eigen::Matrix3d cross;
  cross << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return Eigen::Matrix3d::Identity() + cross + cross * cross / (1 + d.z());
}

struct ZtkField {
  std::string key;
  std::string value;  // the fields up to the next key
  size_t line = 0;
};
struct Section {
  std::string tag;  // tag of the section, such as "roki::link"
  std::vector<ZtkField> fields;
  size_t line = 0;

  const ZtkField* find(std::string_view key) const {
    for (const ZtkField& field : fields)
      if (field.key == key) return &field;
    return nullptr;
  }
};

class ZtkReader {
 public:
  explicit ZtkReader(const fs::path& path) : path_(path) {}

  RobotDescription read(const std::string& bytes) {
    split(text::with_line_feeds(bytes));
    robot_.name = path_.stem().string();
    robot_.urdf_file = path_.string();
    robot_.sha256 = sha256(bytes);
    for (const Section& section : sections_) {
      if (section.tag == "roki::chain" && section.find("name"))
        robot_.name = section.find("name")->value;
      if (section.tag == "zeo::optic") read_optic(section);
      if (section.tag == "roki::motor") read_motor(section);
    }
    for (const Section& section : sections_)
      if (section.tag == "zeo::shape") read_shape(section);
    for (const Section& section : sections_)
      if (section.tag == "roki::link") {
        if (robot_.links.size() == kMostLinks) complain(section.line, too_many("links"));
        read_link(section);
      }
    if (robot_.links.empty()) complain(1, "there is no [roki::link]; a chain of RoKi is needed");
    if (!left_out_.empty())
      robot_.assumptions.push_back("shapes that Ayumi does not support are left out: " +
                                   text::join({left_out_.begin(), left_out_.end()}, ", "));
    validate_links(robot_);
    validate_joints(robot_);
    return std::move(robot_);
  }

 private:
  [[noreturn]] void complain(size_t line, const std::string& message) const {
    fail(ErrorCode::bad_file, {path_.string(), "", static_cast<long>(line)}, message);
  }

  void split(const std::string& bytes) {
    std::string_view rest = bytes;
    size_t fields = 0;
    for (size_t line = 1; !rest.empty(); ++line) {
      std::string_view text = take_line(rest);
      text = trimmed(text.substr(0, text.find('%')));  // a remark follows
      if (text.empty()) continue;
      if (text.front() == '[') {
        const size_t end = text.find(']');
        if (end == std::string_view::npos) complain(line, "the tag has no ']'");
        sections_.push_back({std::string(trimmed(text.substr(1, end - 1))), {}, line});
        continue;
      }
      if (sections_.empty()) complain(line, "a tag such as [roki::chain] is needed first");
      std::vector<ZtkField>& all = sections_.back().fields;
      const size_t colon = text.find(':');
      if (colon != std::string_view::npos && std::isalpha(static_cast<unsigned char>(text[0]))) {
        if (++fields > kMostZtkFields)
          complain(line, "the file has more than " + std::to_string(kMostZtkFields) +
                             " fields; simplify the shapes");
        all.push_back({std::string(trimmed(text.substr(0, colon))),
                       std::string(trimmed(text.substr(colon + 1))), line});
      } else if (all.empty()) {
        complain(line, "a field `key: value` is needed");
      } else {
        all.back().value += " " + std::string(text);
      }
    }
  }

  std::vector<double> numbers(const ZtkField& field, size_t count) const {
    std::vector<double> values;
    std::string_view rest = field.value;
    constexpr std::string_view between = " \t,{}()";
    while (true) {
      const size_t begin = rest.find_first_not_of(between);
      if (begin == std::string_view::npos) break;
      rest.remove_prefix(begin);
      const std::string_view word = rest.substr(0, rest.find_first_of(between));
      rest.remove_prefix(word.size());
      const char* first = word.data() + (word.front() == '+' ? 1 : 0);
      double value = 0;
      const auto [end, error] = std::from_chars(first, word.data() + word.size(), value);
      if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
        complain(field.line,
                 field.key + ": '" + std::string(word.substr(0, 24)) + "' is not a finite number");
      values.push_back(value);
    }
    if (values.size() != count)
      complain(field.line, field.key + ": " + text::counted(count, "number") +
                               (count == 1 ? " is" : " are") + " needed, found " +
                               std::to_string(values.size()) +
                               (values.size() > count ? kDecimalCommas : ""));
    return values;
  }

  double number_or(const Section& section, std::string_view key, double other) const {
    const ZtkField* const field = section.find(key);
    return field ? numbers(*field, 1)[0] : other;
  }

  Vector3d vector(const ZtkField& field) const {
    const std::vector<double> v = numbers(field, 3);
    return {v[0], v[1], v[2]};
  }

  std::string name_of(const Section& section) const {
    const ZtkField* const name = section.find("name");
    if (!name || name->value.empty()) complain(section.line, "[" + section.tag + "] has no name");
    return name->value;
  }

  void read_optic(const Section& section) {
    Eigen::Vector4f color(0.8f, 0.8f, 0.8f, 1);
    if (const ZtkField* diffuse = section.find("diffuse"))
      color.head<3>() = vector(*diffuse).cast<float>();
    color[3] = static_cast<float>(number_or(section, "alpha", 1));
    colors_[name_of(section)] = color;
  }

  // Computes the torque of a DC motor that stands still under its whole voltage.
  void read_motor(const Section& section) {
    const double voltage = std::max(std::abs(number_or(section, "maxvoltage", 0)),
                                    std::abs(number_or(section, "minvoltage", 0)));
    efforts_[name_of(section)] = number_or(section, "motorconstant", 0) *
                                 number_or(section, "admittance", 0) *
                                 number_or(section, "gearratio", 1) * voltage;
  }

  void read_shape(const Section& section) {
    PlacedShape placed;
    placed.name = name_of(section);
    if (const ZtkField* optic = section.find("optic"))
      if (const auto color = colors_.find(optic->value); color != colors_.end()) {
        placed.color = color->second;
        placed.has_color = true;
      }
    if (const ZtkField* mirror = section.find("mirror")) {
      read_mirrored(section, *mirror, placed);
      return;
    }
    const ZtkField* const kind = section.find("type");
    const std::string type = kind ? kind->value : "";
    const ZtkField* const center = section.find("center");
    if (center && type != "cylinder" && type != "capsule")
      placed.pose.translation() = vector(*center);
    if (type == "box") {
      Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
      const char* const names[] = {"ax", "ay", "az"};
      for (int i = 0; i < 3; ++i)
        if (const ZtkField* axis = section.find(names[i])) axes.col(i) = vector(*axis).normalized();
      placed.pose.linear() = axes;
      placed.shape = Box{
          {positive(section, "depth"), positive(section, "width"), positive(section, "height")}};
    } else if (type == "sphere") {
      placed.shape = Sphere{positive(section, "radius")};
    } else if (type == "cylinder" || type == "capsule") {
      read_round(section, type == "cylinder", placed);
    } else if (type == "polyhedron") {
      placed.shape = MeshShape{{}, Vector3d::Ones(), polyhedron(section)};
    } else {
      left_out_.insert(type.empty() ? placed.name : type + " " + placed.name);
      return;
    }
    shapes_[placed.name] = placed;
  }

  double positive(const Section& section, const char* key) const {
    const ZtkField* const field = section.find(key);
    if (!field) complain(section.line, "the shape has no " + std::string(key));
    const double value = numbers(*field, 1)[0];
    if (!(value > 0))
      complain(field->line, std::string(key) + " must be above 0, but it is " + text::exact(value));
    return value;
  }

  // The cylinder between the centres of both ends.
  void read_round(const Section& section, bool cylinder, PlacedShape& placed) const {
    std::vector<Vector3d> ends;
    for (const ZtkField& field : section.fields)
      if (field.key == "center") ends.push_back(vector(field));
    if (ends.size() != 2 || !((ends[1] - ends[0]).norm() > 0))
      complain(section.line, "the centers of both ends are needed, and they must differ");
    const double length = (ends[1] - ends[0]).norm(), radius = positive(section, "radius");
    placed.pose.translation() = 0.5 * (ends[0] + ends[1]);
    placed.pose.linear() = turn_of_z(ends[1] - ends[0]);
    if (cylinder)
      placed.shape = Cylinder{radius, length};
    else
      placed.shape = Capsule{radius, length};
  }

  TriangleMesh polyhedron(const Section& section) const {
    std::vector<Vector3d> corners;
    MeshPart part;
    for (const ZtkField& field : section.fields) {
      if (field.key == "vert") {
        const std::vector<double> v = numbers(field, 4);
        if (v[0] != static_cast<double>(corners.size()))
          complain(field.line, "corner " + text::brief(v[0]) + " is given, but corner " +
                                   std::to_string(corners.size()) +
                                   " must come next; number the corners from 0 in their order");
        corners.emplace_back(v[1], v[2], v[3]);
      }
      if (field.key != "face") continue;
      std::array<Vector3d, 3> face;
      const std::vector<double> v = numbers(field, 3);
      for (size_t i = 0; i < 3; ++i) {
        if (!(v[i] >= 0) || v[i] >= static_cast<double>(corners.size()) || v[i] != std::floor(v[i]))
          complain(field.line, "corner " + text::brief(v[i]) + " does not exist; the shape has " +
                                   text::counted(corners.size(), "corner") + ", numbered from 0");
        face[i] = corners[static_cast<size_t>(v[i])];
      }
      add_face(face, part);
    }
    if (part.triangles.empty()) complain(section.line, "the polyhedron has no face");
    return {{part}};
  }

  static void add_face(const std::array<Vector3d, 3>& face, MeshPart& part) {
    const Vector3d normal = (face[1] - face[0]).cross(face[2] - face[0]).normalized();
    if (!normal.allFinite()) return;
    const auto first = static_cast<std::uint32_t>(part.vertices.size());
    for (const Vector3d& corner : face) {
      part.vertices.push_back(corner.cast<float>());
      part.normals.push_back(normal.cast<float>());
    }
    part.triangles.push_back({first, first + 1, first + 2});
  }

  // Reads a line such as "mirror: left_foot y": the named shape with its y reversed.
  void read_mirrored(const Section& section, const ZtkField& mirror, PlacedShape placed) {
    const size_t blank = mirror.value.find(' ');
    const std::string of = mirror.value.substr(0, blank);
    const std::string_view axis = blank == std::string::npos
                                      ? std::string_view()
                                      : trimmed(std::string_view(mirror.value).substr(blank + 1));
    const size_t index = std::string("xyz").find(axis.empty() ? '?' : axis[0]);
    const auto found = shapes_.find(of);
    if (found == shapes_.end() || index == std::string::npos)
      complain(section.line, "`mirror` needs the name of an earlier shape, and the axis x, y or z");
    PlacedShape copy = found->second;
    copy.name = placed.name;
    if (placed.has_color) copy.color = placed.color, copy.has_color = true;
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    turn(static_cast<int>(index), static_cast<int>(index)) = -1;
    if (auto* mesh = std::get_if<MeshShape>(&copy.shape)) {
      for (MeshPart& part : mesh->mesh.parts) {
        for (auto* points : {&part.vertices, &part.normals})
          for (Eigen::Vector3f& point : *points) point = turn.cast<float>() * point;
        for (auto& triangle : part.triangles) std::swap(triangle[1], triangle[2]);
      }
    } else {  // primitives are equal to their mirror images
      copy.pose.translation() = turn * copy.pose.translation();
      copy.pose.linear() = turn * copy.pose.linear() * turn;
    }
    shapes_[copy.name] = copy;
  }

  void read_link(const Section& section) {
    LinkDescription link;
    link.name = name_of(section);
    link.inertia.mass = number_or(section, "mass", 0);
    if (const ZtkField* com = section.find("COM")) link.inertia.com = vector(*com);
    if (const ZtkField* tensor = section.find("inertia")) {
      const std::vector<double> v = numbers(*tensor, 9);
      for (int i = 0; i < 9; ++i) link.inertia.about_com(i / 3, i % 3) = v[static_cast<size_t>(i)];
      link.inertia.about_com =
          (0.5 * (link.inertia.about_com + link.inertia.about_com.transpose())).eval();
    }
    link.has_inertial = link.inertia.mass != 0;
    for (const ZtkField& field : section.fields) {
      if (field.key != "shape") continue;
      const auto shape = shapes_.find(field.value);
      if (shape != shapes_.end()) {
        link.visuals.push_back(shape->second);
        link.collisions.push_back(shape->second);
      }
    }
    if (const ZtkField* parent = section.find("parent"))
      read_joint(section, link.name, parent->value);
    robot_.links.push_back(std::move(link));
  }

  void read_joint(const Section& section, const std::string& link, const std::string& parent) {
    JointDescription joint;
    joint.name = link;
    joint.parent = parent;
    joint.child = link;
    joint.axis = Vector3d::UnitZ();
    if (const ZtkField* frame = section.find("frame")) {
      const std::vector<double> v = numbers(*frame, 12);
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) joint.origin.linear()(i, j) = v[static_cast<size_t>(4 * i + j)];
        joint.origin.translation()[i] = v[static_cast<size_t>(4 * i + 3)];
      }
      // Largest error of a rotation matrix. Chosen: a hundred times the rounding to six digits.
      constexpr double kRotation = 1e-4;
      const Eigen::Matrix3d turn = joint.origin.linear();
      if (!((turn.transpose() * turn - Eigen::Matrix3d::Identity()).norm() < kRotation) ||
          turn.determinant() < 0)
        complain(frame->line, "the first three columns of `frame` are not a rotation");
      joint.origin.linear() = Eigen::Quaterniond(turn).normalized().toRotationMatrix();
    }
    const ZtkField* const type =
        section.find("jointtype") ? section.find("jointtype") : section.find("joint");
    const std::string kind = type ? type->value : "fixed";
    static const std::map<std::string, JointType> types = {{"fixed", JointType::fixed},
                                                           {"revolute", JointType::revolute},
                                                           {"prismatic", JointType::prismatic},
                                                           {"float", JointType::floating}};
    const auto known = types.find(kind);
    if (known == types.end())
      complain(
          type->line,
          "link " + link + ": the joint type '" + kind +
              "' is not supported; the supported types are fixed, revolute, prismatic and float");
    joint.type = known->second;
    if (joint.type == JointType::revolute || joint.type == JointType::prismatic) {
      const double unit = joint.type == JointType::revolute ? kRadiansPerDegree : 1;
      joint.has_limits = section.find("min") && section.find("max");
      if (joint.has_limits) {
        joint.lower = unit * number_or(section, "min", 0);
        joint.upper = unit * number_or(section, "max", 0);
      } else if (joint.type == JointType::revolute) {
        joint.type = JointType::continuous;
      }
      joint.damping = number_or(section, "viscosity", 0);
      joint.friction = number_or(section, "coulomb", 0);
      if (const ZtkField* motor = section.find("motor"))
        if (const auto effort = efforts_.find(motor->value); effort != efforts_.end())
          joint.effort = effort->second;
      robot_.joint_order.push_back(joint.name);
    }
    robot_.joints.push_back(joint);
  }

  const fs::path& path_;
  std::vector<Section> sections_;
  std::map<std::string, Eigen::Vector4f> colors_;
  std::map<std::string, double> efforts_;
  std::map<std::string, PlacedShape> shapes_;
  std::set<std::string> left_out_;
  RobotDescription robot_;
};

// ---- writing

std::string vector_text(const Vector3d& v) {
  return "{ " + text::exact(v.x()) + ", " + text::exact(v.y()) + ", " + text::exact(v.z()) + " }";
}

class ZtkWriter {
 public:
  explicit ZtkWriter(const RobotDescription& robot) : robot_(robot) {}

  std::string whole(const std::vector<std::string>& joint_order) {
    text_ = "[roki::chain]\nname: " + robot_.name + "\n";
    moved_.insert(joint_order.begin(), joint_order.end());
    std::set<std::string> children;
    for (const JointDescription& joint : robot_.joints) {
      children.insert(joint.child);
      if (!moved_.contains(joint.name)) continue;
      turns_[joint.child] = turn_of_z(joint.axis);
      names_[joint.child] = joint.name;
    }
    for (const LinkDescription& link : robot_.links) {
      if (names_.contains(link.name)) continue;
      const bool taken = std::any_of(robot_.joints.begin(), robot_.joints.end(),
                                     [&](const auto& joint) { return joint.name == link.name; });
      names_[link.name] = taken ? link.name + "_link" : link.name;
    }
    for (const LinkDescription& link : robot_.links) {
      write_shapes(link, link.visuals);
      // Meshes for pictures are not always loaded, but meshes for contacts are.
      if (!shapes_.contains(link.name)) write_shapes(link, link.collisions);
    }
    // The order is: the root, the links that joints move, and the fixed links.
    std::vector<const LinkDescription*> links;
    for (const LinkDescription& link : robot_.links)
      if (!children.contains(link.name)) links.push_back(&link);
    for (const std::string& name : joint_order)
      for (const JointDescription& joint : robot_.joints)
        if (joint.name == name)
          for (const LinkDescription& link : robot_.links)
            if (link.name == joint.child) links.push_back(&link);
    for (const LinkDescription& link : robot_.links)
      if (std::find(links.begin(), links.end(), &link) == links.end()) links.push_back(&link);
    for (const LinkDescription* link : links) write_link(*link);
    return text_;
  }

 private:
  Eigen::Matrix3d turn_of(const std::string& link) const {
    const auto found = turns_.find(link);
    return found == turns_.end() ? Eigen::Matrix3d(Eigen::Matrix3d::Identity()) : found->second;
  }

  void write_shapes(const LinkDescription& link, const std::vector<PlacedShape>& shapes) {
    for (size_t i = 0; i < shapes.size(); ++i) {
      const PlacedShape& placed = shapes[i];
      Isometry3d pose = placed.pose;
      pose = turn_of(link.name).transpose() * pose;
      std::string body;
      const auto* mesh = std::get_if<MeshShape>(&placed.shape);
      if (const auto* box = std::get_if<Box>(&placed.shape)) {
        body = "type: box\ncenter: " + vector_text(pose.translation()) + "\n";
        const char* const axes[] = {"ax", "ay", "az"};
        for (int k = 0; k < 3; ++k)
          body += std::string(axes[k]) + ": " + vector_text(pose.linear().col(k)) + "\n";
        body += "depth: " + text::exact(box->size.x()) + "\nwidth: " + text::exact(box->size.y()) +
                "\nheight: " + text::exact(box->size.z()) + "\n";
      } else if (const auto* sphere = std::get_if<Sphere>(&placed.shape)) {
        body = "type: sphere\ncenter: " + vector_text(pose.translation()) +
               "\nradius: " + text::exact(sphere->radius) + "\n";
      } else if (const auto* cylinder = std::get_if<Cylinder>(&placed.shape)) {
        body = round_text("cylinder", pose, cylinder->length, cylinder->radius);
      } else if (const auto* capsule = std::get_if<Capsule>(&placed.shape)) {
        body = round_text("capsule", pose, capsule->length, capsule->radius);
      } else if (mesh && !mesh->mesh.parts.empty()) {
        body = mesh_text(mesh->mesh, pose);
      }
      if (body.empty()) continue;
      const std::string name = names_[link.name] + "_" + std::to_string(i);
      const Eigen::Vector4f color =
          placed.has_color ? placed.color : Eigen::Vector4f(0.8f, 0.8f, 0.8f, 1);
      text_ += "\n[zeo::optic]\nname: " + name +
               "\ndiffuse: " + vector_text(color.head<3>().cast<double>()) +
               "\nambient: " + vector_text(color.head<3>().cast<double>()) +
               "\nalpha: " + text::exact(static_cast<double>(color[3])) +
               "\n\n[zeo::shape]\nname: " + name + "\noptic: " + name + "\n" + body;
      shapes_[link.name].push_back(name);
    }
  }

  static std::string round_text(const char* type, const Isometry3d& pose, double length,
                                double radius) {
    const Vector3d half = 0.5 * length * pose.linear().col(2);
    return "type: " + std::string(type) + "\ncenter: " + vector_text(pose.translation() - half) +
           "\ncenter: " + vector_text(pose.translation() + half) +
           "\nradius: " + text::exact(radius) + "\n";
  }

  static std::string mesh_text(const TriangleMesh& mesh, const Isometry3d& pose) {
    std::string corners, faces;
    size_t count = 0;
    for (const MeshPart& part : mesh.parts) {
      for (const Eigen::Vector3f& vertex : part.vertices) {
        const Vector3d p = pose * vertex.cast<double>();
        corners += "vert: " + std::to_string(count++) + " " + vector_text(p) + "\n";
      }
      const size_t first = count - part.vertices.size();
      for (const auto& triangle : part.triangles)
        faces += "face: " + std::to_string(first + triangle[0]) + " " +
                 std::to_string(first + triangle[1]) + " " + std::to_string(first + triangle[2]) +
                 "\n";
    }
    return "type: polyhedron\n" + corners + faces;
  }

  void write_link(const LinkDescription& link) {
    const Eigen::Matrix3d turn = turn_of(link.name);
    const auto joint =
        std::find_if(robot_.joints.begin(), robot_.joints.end(),
                     [&](const JointDescription& each) { return each.child == link.name; });
    const bool root = joint == robot_.joints.end();
    const bool moves = !root && moved_.contains(joint->name);
    const bool slides = moves && joint->type == JointType::prismatic;
    text_ += "\n[roki::link]\nname: " + names_[link.name] + "\njointtype: " +
             (root     ? "float"
              : slides ? "prismatic"
              : moves  ? "revolute"
                       : "fixed") +
             "\n";
    if (moves && joint->has_limits) {
      const double unit = slides ? 1 : kRadiansPerDegree;
      text_ += "min: " + text::exact(joint->lower / unit) +
               "\nmax: " + text::exact(joint->upper / unit) + "\n";
    }
    if (moves && (joint->damping > 0 || joint->friction > 0))
      text_ += "viscosity: " + text::exact(joint->damping) +
               "\ncoulomb: " + text::exact(joint->friction) + "\n";
    const Eigen::Matrix3d tensor = turn.transpose() * link.inertia.about_com * turn;
    text_ += "mass: " + text::exact(link.inertia.mass) +
             "\nCOM: " + vector_text(turn.transpose() * link.inertia.com) + "\ninertia: {\n";
    for (int i = 0; i < 3; ++i)
      text_ += " " + text::exact(tensor(i, 0)) + ", " + text::exact(tensor(i, 1)) + ", " +
               text::exact(tensor(i, 2)) + "\n";
    Isometry3d frame = Isometry3d::Identity();
    if (!root) {
      frame = turn_of(joint->parent).transpose() * joint->origin;
      frame.linear() = frame.linear() * turn;
    }
    text_ += "}\nframe: {\n";
    for (int i = 0; i < 3; ++i)
      text_ += " " + text::exact(frame.linear()(i, 0)) + ", " + text::exact(frame.linear()(i, 1)) +
               ", " + text::exact(frame.linear()(i, 2)) + ", " +
               text::exact(frame.translation()[i]) + "\n";
    text_ += "}\n";
    for (const std::string& shape : shapes_[link.name]) text_ += "shape: " + shape + "\n";
    if (!root) text_ += "parent: " + names_[joint->parent] + "\n";
  }

  const RobotDescription& robot_;
  std::set<std::string> moved_;  // joints in the order of the motion
  std::map<std::string, Eigen::Matrix3d>
      turns_;  // turns of links whose z is not the axis of their joint
  std::map<std::string, std::string> names_;  // names by the link's own name
  std::map<std::string, std::vector<std::string>> shapes_;
  std::string text_;
};

}  // namespace

RobotDescription parse_ztk(const std::string& bytes, const fs::path& path) {
  return ZtkReader(path).read(bytes);
}

std::string ztk_text(const RobotDescription& robot, const std::vector<std::string>& joint_order) {
  return ZtkWriter(robot).whole(joint_order);
}

}  // namespace ayumi
