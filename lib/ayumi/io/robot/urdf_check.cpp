#include "ayumi/io/robot/urdf_check.hpp"

#include <tinyxml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <set>
#include <vector>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/model/validate.hpp"

namespace ayumi {

namespace {

// Nested elements. Chosen: a URDF needs five, and the stack holds far more.
constexpr int kDeepestNesting = 200;

// Links of a robot. Chosen: humanoids with hands have about a hundred; urdfdom and the tree of the
// robot descend a chain of links by recursion, and some steps take the square of their number.
constexpr size_t kMostLinks = 1000;
// Attributes of an element. Chosen: URDF knows at most eight; TinyXML compares all of an element
// with each other.
constexpr int kMostAttributes = 100;

// A numeric attribute and how many numbers it holds.
struct NumericAttribute {
  const char* element;  // "*": any
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

class Checker {
 public:
  Checker(const std::string& file) : file_(file) {}

  [[noreturn]] void complain(const TiXmlElement* at, const std::string& message) const {
    fail(ErrorCode::bad_file, file_ + ":" + std::to_string(at->Row()) + ": " + message);
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
      if (!node) complain(element, owner + "has no <" + end + " link=\"...\"/>");
      (std::strcmp(end, "parent") == 0 ? joint.parent : joint.child) =
          required(node, "link", owner);
    }
    numbers(element, owner);
    if (type == "revolute" || type == "prismatic") limits(element, name, text);
    robot.joints.push_back(joint);
  }

 private:
  void finite_numbers(const TiXmlElement* element, const std::string& owner,
                      const NumericAttribute& wanted, const std::string& text) const {
    int count = 0;
    const char* at = text.data();
    const char* const end = at + text.size();
    const std::string place =
        owner + "<" + element->Value() + " " + wanted.name + "=\"" + text + "\">: ";
    while (true) {
      while (at != end && std::isspace(static_cast<unsigned char>(*at))) ++at;
      if (at == end) break;
      if (*at == '+') ++at;
      double value = 0;
      const auto [stop, error] = std::from_chars(at, end, value);
      const bool whole = stop == end || std::isspace(static_cast<unsigned char>(*stop));
      if (error != std::errc() || !whole || !std::isfinite(value))
        complain(element, place + "'" + std::string(at, std::find(at, end, ' ')) +
                              "' is not a finite number");
      at = stop;
      ++count;
    }
    if (count != wanted.count)
      complain(element, place + std::to_string(wanted.count) + " numbers are needed, found " +
                            std::to_string(count));
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
        if (!(value > 0)) complain(kind, owner + std::string(extent) + " must be above 0");
  }

  // urdfdom wants effort and velocity; 0 stands for "unstated" from here on.
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

// TinyXML descends by recursion: refuse text that nests deeper than any robot's.
void refuse_deep_nesting(const std::string& bytes, const std::string& file) {
  int depth = 0;
  for (size_t i = 0; i + 1 < bytes.size(); ++i) {
    if (bytes[i] == '<' && bytes[i + 1] == '/') --depth;
    if (bytes[i] == '<' && bytes[i + 1] != '/' && bytes[i + 1] != '!' && bytes[i + 1] != '?')
      ++depth;
    if (bytes[i] == '/' && bytes[i + 1] == '>') --depth;
    if (depth > kDeepestNesting) fail(ErrorCode::bad_file, file + ": nested too deeply for a URDF");
  }
}

// A byte '=' outside a quotation stands for one attribute.
void refuse_many_attributes(const std::string& bytes, const std::string& file) {
  int line = 1, count = 0;
  char quote = 0;
  for (size_t i = 0; i < bytes.size(); ++i) {
    if (bytes[i] == '\n') ++line;
    if (quote != 0) {
      if (bytes[i] == quote) quote = 0;
      continue;
    }
    if (bytes.compare(i, 4, "<!--") == 0) {
      const size_t end = std::min(bytes.find("-->", i + 4), bytes.size());
      line += static_cast<int>(std::count(bytes.begin() + i, bytes.begin() + end, '\n'));
      i = end;
      continue;
    }
    if (bytes[i] == '<') count = 0;
    if (bytes[i] != '=') continue;
    if (++count > kMostAttributes)
      fail(ErrorCode::bad_file, file + ":" + std::to_string(line) + ": an element has more than " +
                                    std::to_string(kMostAttributes) + " attributes");
    size_t value = i + 1;
    while (value < bytes.size() && std::isspace(static_cast<unsigned char>(bytes[value]))) ++value;
    if (value >= bytes.size() || (bytes[value] != '"' && bytes[value] != '\'')) continue;
    line += static_cast<int>(std::count(bytes.begin() + i + 1, bytes.begin() + value, '\n'));
    quote = bytes[value];
    i = value;
  }
}

void parse_xml(TiXmlDocument& document, const std::string& bytes, const std::string& file) {
  const bool blank =
      std::all_of(bytes.begin(), bytes.end(), [](unsigned char c) { return std::isspace(c); });
  if (blank) fail(ErrorCode::bad_file, file + ": the file is empty, a URDF is needed");
  refuse_deep_nesting(bytes, file);
  refuse_many_attributes(bytes, file);
  document.Parse(bytes.c_str(), nullptr, TIXML_ENCODING_UTF8);
  if (document.Error() && !document.RootElement())
    fail(ErrorCode::bad_file, file + ": not XML (" + document.ErrorDesc() + "); a URDF is needed");
  if (document.Error())
    fail(ErrorCode::bad_file, file + ":" + std::to_string(document.ErrorRow()) + ": not XML (" +
                                  document.ErrorDesc() + ")");
  if (!document.RootElement())
    fail(ErrorCode::bad_file, file + ": not XML (no element in it); a URDF is needed");
}

}  // namespace

namespace {

/// Materials that visuals define, as materials of the robot: a visual may name one that a later
/// visual defines, which urdfdom would leave without colour. The first definition holds.
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
  parse_xml(document, bytes, file);
  TiXmlElement* root = document.RootElement();
  const Checker checker(file);
  if (root->ValueStr() != "robot")
    checker.complain(root, "the outermost element is <" + root->ValueStr() +
                               ">, a URDF starts with <robot name=\"...\">");
  checker.required(root, "name", "");
  UrdfText text;
  RobotDescription tree;
  tree.urdf_file = file;
  for (auto* each = root->FirstChildElement(); each; each = each->NextSiblingElement()) {
    if (each->ValueStr().starts_with("xacro:"))
      checker.complain(each, "this is a xacro macro file; expand it to a URDF first");
    if (each->ValueStr() == "link") checker.link(each, tree, text);
    if (tree.links.size() > kMostLinks)
      checker.complain(each,
                       "more than " + std::to_string(kMostLinks) + " links; simplify the robot");
    if (each->ValueStr() == "joint") checker.joint(each, tree, text);
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
