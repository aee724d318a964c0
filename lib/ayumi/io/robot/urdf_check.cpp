#include "ayumi/io/robot/urdf_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <set>
#include <vector>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/robot/xml_text.hpp"
#include "ayumi/model/validate.hpp"

namespace ayumi {

namespace {

constexpr const char* kXacro =
    "this is a xacro file; expand it with `xacro FILE > robot.urdf` of ROS, and use robot.urdf";

// A numeric attribute and how many numbers it holds.
struct NumericAttribute {
  const char* element;  // "*" means any element
  const char* name;
  int count;
};

constexpr NumericAttribute kNumeric[] = {
    {"*", "xyz", 3},
    {"*", "rpy", 3},
    {"mass", "value", 1},
    {"inertia", "ixx", 1},
    {"inertia", "ixy", 1},
    {"inertia", "ixz", 1},
    {"inertia", "iyy", 1},
    {"inertia", "iyz", 1},
    {"inertia", "izz", 1},
    {"box", "size", 3},
    {"sphere", "radius", 1},
    {"cylinder", "radius", 1},
    {"cylinder", "length", 1},
    {"mesh", "scale", 3},
    {"color", "rgba", 4},
    {"limit", "lower", 1},
    {"limit", "upper", 1},
    {"limit", "effort", 1},
    {"limit", "velocity", 1},
    {"dynamics", "damping", 1},
    {"dynamics", "friction", 1},
    {"mimic", "multiplier", 1},
    {"mimic", "offset", 1},
};

const std::vector<std::string> kJointTypes = {"fixed",     "revolute", "continuous",
                                              "prismatic", "floating", "planar"};
const std::vector<std::string> kGeometries = {"box", "sphere", "cylinder", "mesh"};

// The elements that URDF, its simulators and its planners know inside of an element. A name is a
// misspelling if it is none of these and is similar to a name that Ayumi reads.
struct KnownElements {
  const char* parent;
  std::vector<std::string> read, other;
};
const std::vector<KnownElements> kKnownElements = {
    {"robot", {"link", "joint", "material"}, {"gazebo", "transmission", "sensor", "plugin"}},
    {"link",
     {"inertial", "visual", "collision"},
     {"contact", "self_collision_checking", "collision_checking", "sensor", "kinematic", "site"}},
    {"joint",
     {"parent", "child", "origin", "axis", "limit", "dynamics", "mimic"},
     {"calibration", "safety_controller", "hardwareInterface", "physics"}},
    {"inertial", {"origin", "mass", "inertia"}, {}},
    {"visual", {"origin", "geometry", "material"}, {"name"}},
    {"collision", {"origin", "geometry"}, {"name", "material", "verbose"}},
    {"geometry", {"box", "sphere", "cylinder", "mesh"}, {"capsule", "ellipsoid", "plane", "sdf"}},
};

class Checker {
 public:
  Checker(const std::string& file) : file_(file) {}

  [[noreturn]] void complain(const TiXmlElement* at, const std::string& message) const {
    complain_xml(file_, at, message);
  }

  std::string required(const TiXmlElement* element, const char* attribute,
                       const std::string& owner) const {
    const char* value = element->Attribute(attribute);
    if (value == nullptr || *value == 0)
      complain(element, owner + "<" + element->Value() + "> has no attribute '" + attribute + "'");
    return value;
  }

  void numbers(const TiXmlElement* element, const std::string& owner) const {
    for (const NumericAttribute& wanted : kNumeric) {
      if (std::strcmp(wanted.element, "*") != 0 && element->ValueStr() != wanted.element) continue;
      const char* value = element->Attribute(wanted.name);
      if (value != nullptr) finite_numbers(element, owner, wanted, value);
    }
    for (auto* child = element->FirstChildElement(); child; child = child->NextSiblingElement())
      numbers(child, owner);
  }

  // A misspelt element would be ignored with everything inside it. So all elements of its kind are
  // counted, and the first is named.
  void refuse_misspellings(const TiXmlElement* root) const {
    struct Misspelling {
      const TiXmlElement* first = nullptr;
      std::string meant, parent;
      size_t count = 0;
    };
    std::vector<std::pair<std::string, Misspelling>> found;
    const std::function<void(const TiXmlElement*)> look = [&](const TiXmlElement* element) {
      const auto known = std::find_if(
          kKnownElements.begin(), kKnownElements.end(),
          [&](const KnownElements& each) { return element->ValueStr() == each.parent; });
      if (known == kKnownElements.end()) return;
      for (auto* child = element->FirstChildElement(); child; child = child->NextSiblingElement()) {
        const std::string& name = child->ValueStr();
        const auto is_in = [&](const std::vector<std::string>& names) {
          return std::find(names.begin(), names.end(), name) != names.end();
        };
        if (is_in(known->read)) {
          look(child);
          continue;
        }
        if (is_in(known->other) || name.find(':') != std::string::npos) continue;
        const std::string meant = text::nearest(name, known->read);
        if (meant.empty()) continue;
        const auto same = std::find_if(found.begin(), found.end(),
                                       [&](const auto& each) { return each.first == name; });
        Misspelling& misspelling =
            same != found.end() ? same->second : found.emplace_back(name, Misspelling{}).second;
        if (misspelling.count++ == 0) {
          misspelling.first = child;
          misspelling.meant = meant;
          misspelling.parent = known->parent;
        }
      }
    };
    look(root);
    if (found.empty()) return;
    std::vector<std::string> words;
    for (const auto& [name, each] : found)
      words.push_back("<" + name + "> is not an element of a " + each.parent + "; did you mean <" +
                      each.meant + ">? (in " + text::counted(each.count, each.parent) + ")");
    complain(found.front().second.first, text::join(words, "; "));
  }

  void link(TiXmlElement* element, RobotDescription& robot, UrdfText& text) const {
    const std::string name = required(element, "name", "");
    const std::string owner = "link " + name + ": ";
    text.link_place.emplace(name, static_cast<int>(text.link_place.size()));
    robot.links.emplace_back();
    robot.links.back().name = name;
    numbers(element, owner);
    if (const auto* inertial = element->FirstChildElement("inertial")) {
      for (const char* part : {"mass", "inertia"})
        if (!inertial->FirstChildElement(part))
          complain(inertial, owner + "<inertial> has no <" + part + ">; add it");
      required(inertial->FirstChildElement("mass"), "value", owner);
      for (const char* entry : {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"})
        required(inertial->FirstChildElement("inertia"), entry, owner);
    }
    for (const char* kind : {"visual", "collision"})
      for (auto* shape = element->FirstChildElement(kind); shape;
           shape = shape->NextSiblingElement(kind))
        geometry(shape, owner);
  }

  void joint(TiXmlElement* element, RobotDescription& robot, UrdfText& text) const {
    const std::string name = required(element, "name", "");
    const std::string owner = "joint " + name + ": ";
    text.joint_place.emplace(name, static_cast<int>(text.joint_place.size()));
    JointDescription joint;
    joint.name = name;
    const std::string type = required(element, "type", owner);
    if (std::find(kJointTypes.begin(), kJointTypes.end(), type) == kJointTypes.end())
      complain(element, owner + "unknown joint type '" + type + "'; known: " +
                            text::join(kJointTypes, ", ") + text::suggestion(type, kJointTypes));
    if (type == "planar")
      complain(element, owner +
                            "planar joints are not supported; use two prismatic and one "
                            "continuous joint");
    for (const char* end : {"parent", "child"}) {
      const auto* node = element->FirstChildElement(end);
      if (!node) complain(element, owner + "<" + end + " link=\"...\"/> is missing; add it");
      (std::strcmp(end, "parent") == 0 ? joint.parent : joint.child) =
          required(node, "link", owner);
    }
    numbers(element, owner);
    if (type == "revolute" || type == "prismatic" || element->FirstChildElement("limit"))
      limits(element, name, text);
    robot.joints.push_back(joint);
  }

 private:
  void finite_numbers(const TiXmlElement* element, const std::string& owner,
                      const NumericAttribute& wanted, const std::string& text) const {
    const std::string place =
        owner + "<" + element->Value() + " " + wanted.name + "=\"" + shown_value(text) + "\">: ";
    if (text.find("${") != std::string::npos) complain(element, place + kXacro);
    xml_numbers(file_, element, place, text, wanted.count);
  }

  void geometry(const TiXmlElement* shape, const std::string& owner) const {
    const auto* geometry = shape->FirstChildElement("geometry");
    const auto* kind = geometry ? geometry->FirstChildElement() : nullptr;
    if (!kind) complain(shape, owner + "<" + shape->Value() + "> has no <geometry> with a shape");
    if (std::find(kGeometries.begin(), kGeometries.end(), kind->ValueStr()) == kGeometries.end())
      complain(kind, owner + "unknown geometry <" + kind->Value() +
                         ">; known: " + text::join(kGeometries, ", "));
    const auto needs = [&](const char* attribute) { required(kind, attribute, owner); };
    if (kind->ValueStr() == "box") needs("size");
    if (kind->ValueStr() == "sphere" || kind->ValueStr() == "cylinder") needs("radius");
    if (kind->ValueStr() == "cylinder") needs("length");
    if (kind->ValueStr() == "mesh") needs("filename");
    for (const char* extent : {"radius", "length"})
      if (double value = 1; kind->QueryDoubleAttribute(extent, &value) == TIXML_SUCCESS)
        if (!(value > 0))
          complain(kind,
                   owner + "the " + extent + " must be above 0, but it is " + text::exact(value));
  }

  // urdfdom requires effort and velocity. From here on, 0 means that the file does not state the
  // value.
  void limits(TiXmlElement* element, const std::string& name, UrdfText& text) const {
    TiXmlElement* limit = element->FirstChildElement("limit");
    if (!limit) {
      limit = static_cast<TiXmlElement*>(element->InsertEndChild(TiXmlElement("limit")));
    }
    if (!limit->Attribute("lower") && !limit->Attribute("upper")) text.unlimited.insert(name);
    for (const char* attribute : {"effort", "velocity"})
      if (!limit->Attribute(attribute)) limit->SetAttribute(attribute, "0");
  }

  const std::string& file_;
};

void refuse_xacro(const TiXmlElement* element, const Checker& checker) {
  if (element->ValueStr().starts_with("xacro:")) checker.complain(element, kXacro);
  for (auto* each = element->FirstChildElement(); each; each = each->NextSiblingElement())
    refuse_xacro(each, checker);
}

/// Makes materials that visuals define materials of the robot. A visual may name a material that a
/// later visual defines, and urdfdom would leave it without colour. The first definition counts.
void share_materials(TiXmlElement* root) {
  std::set<std::string> known;
  const auto name_of = [](const TiXmlElement* material) {
    const char* name = material->Attribute("name");
    return std::string(name ? name : "");
  };
  for (auto* each = root->FirstChildElement("material"); each;
       each = each->NextSiblingElement("material"))
    known.insert(name_of(each));
  for (auto* link = root->FirstChildElement("link"); link; link = link->NextSiblingElement("link"))
    for (auto* visual = link->FirstChildElement("visual"); visual;
         visual = visual->NextSiblingElement("visual")) {
      const TiXmlElement* material = visual->FirstChildElement("material");
      if (!material || !material->FirstChildElement() || name_of(material).empty()) continue;
      if (known.insert(name_of(material)).second) root->InsertEndChild(*material);
    }
}

}  // namespace

UrdfText check_urdf(const std::string& bytes, const std::string& file) {
  TiXmlDocument document;
  parse_xml(document, bytes, file, "a URDF");
  TiXmlElement* root = document.RootElement();
  const Checker checker(file);
  if (root->ValueStr() != "robot")
    checker.complain(root, "the outermost element is <" + root->ValueStr() +
                               ">, but a URDF starts with <robot name=\"...\">");
  refuse_xacro(root, checker);
  checker.required(root, "name", "");
  checker.refuse_misspellings(root);
  UrdfText text;
  RobotDescription tree;
  tree.urdf_file = file;
  for (auto* each = root->FirstChildElement(); each; each = each->NextSiblingElement()) {
    if (each->ValueStr() == "link") checker.link(each, tree, text);
    if (each->ValueStr() == "joint") checker.joint(each, tree, text);
    if (tree.links.size() > kMostLinks) checker.complain(each, too_many("links"));
    if (tree.joints.size() > kMostLinks) checker.complain(each, too_many("joints"));
    if (each->ValueStr() == "material") checker.numbers(each, "material: ");
  }
  validate_links(tree);
  validate_joints(tree);
  find_root_link(tree);
  share_materials(root);
  TiXmlPrinter printer;
  document.Accept(&printer);
  text.xml = printer.Str();
  return text;
}

}  // namespace ayumi
