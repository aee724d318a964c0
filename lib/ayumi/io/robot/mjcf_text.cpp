#include "ayumi/io/robot/mjcf_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <sstream>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/robot/xml_text.hpp"

namespace ayumi {

namespace {

namespace fs = std::filesystem;

// Largest depth of files that include each other. Chosen: models include a handful of parts, one or
// two deep.
constexpr int kDeepestMjcfInclude = 20;
// Largest number of elements of a model with all included files. Chosen: a robot has a few
// thousand.
constexpr size_t kMostMjcfElements = 200000;
// Largest number of bytes of an included file. Chosen: text of a model takes kilobytes.
constexpr size_t kLargestMjcfPart = size_t{64} << 20;

// Sections that do not describe the robot itself: settings of the simulation, of the picture, and
// what Ayumi computes in its own way.
const std::set<std::string> kNotTheRobot = {"option",   "size",      "visual",    "statistic",
                                            "keyframe", "custom",    "sensor",    "tendon",
                                            "skin",     "extension", "deformable"};
// Elements inside of others that only affect the picture, or that describe no part of a rigid
// robot.
const std::set<std::string> kOnlyLooks = {"light", "camera", "texture", "skin", "hfield", "layer"};
// Attributes of later versions of MuJoCo that are read here, or have no meaning for a robot.
const std::set<std::string> kReadHere = {"actuatorfrcrange", "actuatorfrclimited", "dampratio",
                                         "kv", "inheritrange"};
// Attributes that contain words, so that no numbers are read from them.
const std::set<std::string> kMjcfWords = {
    "name",  "class", "childclass", "mesh", "material", "texture", "joint",  "type",  "file",
    "angle", "model", "site",       "body", "body1",    "body2",   "joint1", "joint2"};

double mjcf_number(const char* text, double other) {
  if (!text) return other;
  double value = other;
  std::from_chars(text, text + std::string_view(text).size(), value);
  return value;
}

std::vector<double> mjcf_numbers(const std::string& text) {
  std::vector<double> values;
  std::istringstream words(text);
  for (std::string word; words >> word;) values.push_back(mjcf_number(word.c_str(), 0));
  return values;
}

void remove_attributes(TiXmlElement* element, std::initializer_list<const char*> names) {
  for (const char* name : names) element->RemoveAttribute(name);
}

class Cleaner {
 public:
  Cleaner(const fs::path& path, const MjcfSchema& schema, const MeshIsThere& is_there)
      : path_(path), schema_(schema), is_there_(is_there) {}

  MjcfText clean(const std::string& bytes) {
    TiXmlDocument document;
    parse_xml(document, bytes, path_.string(), "an MJCF model");
    TiXmlElement* root = document.RootElement();
    if (root->ValueStr() != "mujoco")
      complain_xml(path_.string(), root,
                   "the outermost element is <" + root->ValueStr() +
                       ">, but an MJCF model starts with <mujoco>");
    include(root, path_, 0);
    check_numbers(root);
    read_sensors(root);
    read_compiler(root);
    read_defaults(root, "");
    keep_robot(root);
    read_meshes(root);
    std::set<std::string> weighed;
    for (auto* world = root->FirstChildElement("worldbody"); world;
         world = world->NextSiblingElement("worldbody"))
      walk_bodies(world, "", weighed);
    text_.weighed_meshes.assign(weighed.begin(), weighed.end());
    add_fitted_assets(root);
    read_actuators(root);
    keep_known(root);
    for (auto& [what, count] : unknown_)
      text_.notes.push_back("this version of MuJoCo does not know " + what + " (" +
                            text::counted(count, "place") + "), which is left out");
    TiXmlPrinter printer;
    document.Accept(&printer);
    text_.xml = printer.Str();
    TiXmlDocument printed;
    printed.Parse(text_.xml.c_str(), nullptr, TIXML_ENCODING_UTF8);
    note_lines(printed.RootElement(), root);
    return std::move(text_);
  }

 private:
  // Notes the line of each element in the file. An element of an included file, with everything
  // inside it, has no line in this file.
  void note_lines(const TiXmlElement* printed, const TiXmlElement* stated) {
    for (; printed && stated; printed = printed->NextSiblingElement()) {
      if (stated->GetUserData() != &is_included_) {
        text_.lines[printed->Row()] = stated->Row();
        note_lines(printed->FirstChildElement(), stated->FirstChildElement());
      }
      stated = stated->NextSiblingElement();
    }
  }

  // MuJoCo puts the children of an included file in the place of the <include>.
  void include(TiXmlElement* parent, const fs::path& file, int depth) {
    for (TiXmlElement* child = parent->FirstChildElement(); child;) {
      TiXmlElement* const next = child->NextSiblingElement();
      if (++elements_ > kMostMjcfElements)
        complain_xml(file.string(), child,
                     "the model has more than " + std::to_string(kMostMjcfElements) +
                         " elements; simplify the model");
      if (child->ValueStr() == "include") {
        const char* name = child->Attribute("file");
        if (!name) complain_xml(file.string(), child, "<include> has no attribute 'file'");
        // Names are relative to the folder of the model's own file.
        const fs::path included = path_.parent_path() / name;
        if (depth >= kDeepestMjcfInclude || !included_.insert(included.lexically_normal()).second)
          complain_xml(file.string(), child,
                       "'" + std::string(name) +
                           "' is included twice, or includes itself; remove this <include>");
        std::error_code ignored;
        if (!fs::is_regular_file(included, ignored))
          complain_xml(file.string(), child,
                       "the included file " + included.lexically_normal().string() +
                           " is not there; add it or correct the name");
        const std::string bytes = read_file(included, kLargestMjcfPart);
        text_.files += bytes;
        TiXmlDocument document;
        parse_xml(document, bytes, included.string(), "a part of an MJCF model");
        include(document.RootElement(), included, depth + 1);
        for (const TiXmlNode* each = document.RootElement()->FirstChild(); each;
             each = each->NextSibling())
          parent->InsertBeforeChild(child, *each)->SetUserData(&is_included_);
        parent->RemoveChild(child);
      } else {
        include(child, file, depth);
      }
      child = next;
    }
  }

  // MuJoCo accepts "nan" and the beginning of "1.5x".
  void check_numbers(const TiXmlElement* element) const {
    for (const TiXmlAttribute* each = element->FirstAttribute(); each; each = each->Next()) {
      if (kMjcfWords.contains(each->Name())) continue;
      const std::string text = each->Value();
      const bool numeric = !text.empty() &&
                           text.find_first_not_of("0123456789+-.eE, \t\r\n") == std::string::npos &&
                           text.find_first_of("0123456789") != std::string::npos;
      std::istringstream words(text);
      for (std::string word; words >> word;) {
        std::string lower = word;
        for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        const bool not_finite = lower == "nan" || lower == "-nan" || lower == "inf" ||
                                lower == "-inf" || lower == "+inf";
        const char* begin = word.c_str() + (word[0] == '+' ? 1 : 0);
        const char* const end = word.c_str() + word.size();
        double value = 0;
        const auto [stop, error] = std::from_chars(begin, end, value);
        if (!not_finite && (!numeric || (error == std::errc() && stop == end))) continue;
        complain_xml(path_.string(), element,
                     "<" + element->ValueStr() + " " + each->Name() + "=\"" + shown_value(text) +
                         "\">: '" + word + "' is not a finite number" +
                         (word.find(',') != std::string::npos
                              ? "; numbers have a decimal point, and blanks between them"
                              : ""));
      }
    }
    for (auto* child = element->FirstChildElement(); child; child = child->NextSiblingElement())
      check_numbers(child);
  }

  void read_sensors(const TiXmlElement* root) {
    for (const char* kind : {"gyro", "accelerometer"})
      for (auto* section = root->FirstChildElement("sensor"); section;
           section = section->NextSiblingElement("sensor"))
        if (const auto* sensor = section->FirstChildElement(kind); sensor && text_.imu_site.empty())
          text_.imu_site = xml_attribute(sensor, "site", "");
  }

  void read_compiler(TiXmlElement* root) {
    bool limits = false;
    TiXmlElement* last = nullptr;
    for (auto* compiler = root->FirstChildElement("compiler"); compiler;
         compiler = compiler->NextSiblingElement("compiler")) {
      last = compiler;
      strip_ = xml_attribute(compiler, "strippath", strip_ ? "true" : "false") == "true";
      folder_ = xml_attribute(compiler, "assetdir", folder_);
      folder_ = xml_attribute(compiler, "meshdir", folder_);
      weigh_all_ = xml_attribute(compiler, "inertiafromgeom", weigh_all_ ? "true" : "") == "true";
      limits |= compiler->Attribute("autolimits") != nullptr;
      remove_attributes(compiler, {"meshdir", "assetdir", "texturedir", "strippath",
                                   "discardvisual", "fusestatic", "usethread"});
    }
    if (limits) return;
    if (!last) last = static_cast<TiXmlElement*>(root->InsertEndChild(TiXmlElement("compiler")));
    // The default of MuJoCo since version 3: a range that is stated applies.
    last->SetAttribute("autolimits", "true");
  }

  // Collects the attributes of each class, so that attributes unknown to this version of MuJoCo can
  // be looked up.
  void read_defaults(const TiXmlElement* parent, const std::string& above) {
    for (auto* each = parent->FirstChildElement("default"); each;
         each = each->NextSiblingElement("default")) {
      const std::string name = xml_attribute(each, "class", above.empty() ? "main" : "");
      if (name != above) parent_class_[name] = above;
      for (auto* item = each->FirstChildElement(); item; item = item->NextSiblingElement())
        for (const TiXmlAttribute* a = item->FirstAttribute(); a; a = a->Next())
          defaults_[name][item->ValueStr()][a->Name()] = a->Value();
      read_defaults(each, name);
    }
  }

  // The attribute of an element, or else of its class, or of the classes above it.
  std::string found(const TiXmlElement* element, const char* attribute,
                    const std::string& child_class) const {
    if (const char* own = element->Attribute(attribute)) return own;
    std::string name = xml_attribute(element, "class", child_class);
    if (name.empty()) name = "main";
    for (int steps = 0; !name.empty() && steps < kDeepestMjcfInclude; ++steps) {
      if (const auto group = defaults_.find(name); group != defaults_.end())
        if (const auto item = group->second.find(element->ValueStr()); item != group->second.end())
          if (const auto value = item->second.find(attribute); value != item->second.end())
            return value->second;
      const auto above = parent_class_.find(name);
      name = above != parent_class_.end() ? above->second : "";
    }
    return "";
  }

  void keep_robot(TiXmlElement* root) {
    for (TiXmlElement* child = root->FirstChildElement(); child;) {
      TiXmlElement* const next = child->NextSiblingElement();
      if (kNotTheRobot.contains(child->ValueStr())) root->RemoveChild(child);
      child = next;
    }
    remove_looks(root);
  }

  static void remove_looks(TiXmlElement* parent) {
    for (TiXmlElement* child = parent->FirstChildElement(); child;) {
      TiXmlElement* const next = child->NextSiblingElement();
      const std::string& kind = child->ValueStr();
      const bool field = kind == "geom" && (child->Attribute("hfield") ||
                                            xml_attribute(child, "type", "") == "hfield");
      if (kOnlyLooks.contains(kind) || field) {
        parent->RemoveChild(child);
      } else {
        if (kind == "material") child->RemoveAttribute("texture");
        remove_looks(child);
      }
      child = next;
    }
  }

  void read_meshes(TiXmlElement* root) {
    for (auto* asset = root->FirstChildElement("asset"); asset;
         asset = asset->NextSiblingElement("asset"))
      for (auto* mesh = asset->FirstChildElement("mesh"); mesh;
           mesh = mesh->NextSiblingElement("mesh")) {
        const char* file = mesh->Attribute("file");
        if (!file) continue;  // its vertices are in the text
        std::string name = file;
        if (strip_) name = fs::path(name).filename().string();
        MjcfMesh made;
        made.file =
            name.find("://") != std::string::npos ? name : (fs::path(folder_) / name).string();
        const std::vector<double> scale = mjcf_numbers(found(mesh, "scale", ""));
        if (scale.size() == 3) made.scale = {scale[0], scale[1], scale[2]};
        const std::vector<double> place = mjcf_numbers(xml_attribute(mesh, "refpos", ""));
        const std::vector<double> turn = mjcf_numbers(xml_attribute(mesh, "refquat", ""));
        if (place.size() == 3)
          made.reference.translation() = Eigen::Vector3d(place[0], place[1], place[2]);
        if (turn.size() == 4)
          made.reference.linear() = Eigen::Quaterniond(turn[0], turn[1], turn[2], turn[3])
                                        .normalized()
                                        .toRotationMatrix();
        const std::string asset_name = xml_attribute(mesh, "name", fs::path(file).stem().string());
        text_.meshes[asset_name] = made;
        TiXmlElement probe("mesh");
        probe.SetAttribute("name", asset_name);
        probe.SetAttribute("file", kMjcfProbe);
        probe.SetAttribute("scale", "1 1 1");
        mesh = static_cast<TiXmlElement*>(asset->ReplaceChild(mesh, probe));
      }
  }

  void read_inertia(const TiXmlElement* body) {
    const std::vector<double> stated =
        mjcf_numbers(xml_attribute(body->FirstChildElement("inertial"), "fullinertia", ""));
    const std::string name = xml_attribute(body, "name", "");
    if (stated.size() != 6 || name.empty()) return;
    text_.inertias[name] << stated[0], stated[3], stated[4],  //
        stated[3], stated[1], stated[5],                      //
        stated[4], stated[5], stated[2];
  }

  void walk_bodies(TiXmlElement* body, const std::string& above, std::set<std::string>& weighed) {
    const std::string child_class = xml_attribute(body, "childclass", above);
    const bool weighs = weigh_all_ || !body->FirstChildElement("inertial");
    if (!weighs && body->ValueStr() == "body") read_inertia(body);
    for (TiXmlElement *child = body->FirstChildElement(), *next = nullptr; child; child = next) {
      next = child->NextSiblingElement();
      const std::string& kind = child->ValueStr();
      if (kind == "body" || kind == "frame" || kind == "replicate")
        walk_bodies(child, child_class, weighed);
      if (kind == "geom" && body->ValueStr() == "body")
        if (const std::string mesh = found(child, "mesh", child_class); !mesh.empty()) {
          const std::string type = found(child, "type", child_class);
          if (type != "mesh" && text_.meshes.contains(mesh)) {
            fit(xml_attribute(body, "name", ""), mesh, child);
            continue;
          }
          if (weighs) weighed.insert(mesh);
        }
      if (kind != "joint") continue;
      const std::vector<double> range = mjcf_numbers(found(child, "actuatorfrcrange", child_class));
      const std::string limited = found(child, "actuatorfrclimited", child_class);
      const std::string name = xml_attribute(child, "name", "");
      if (range.size() == 2 && limited != "false" && !name.empty())
        text_.force_limits[name] = std::max(std::abs(range[0]), std::abs(range[1]));
    }
  }

  // MuJoCo fits a primitive that names a mesh (a sphere if no type is stated) to this mesh. The
  // primitive gets an asset of its own, because the probe of an asset has another size.
  void fit(const std::string& body, const std::string& mesh, TiXmlElement* geom) {
    if (!is_there_(body, text_.meshes.at(mesh).file)) {
      geom->Parent()->RemoveChild(geom);
      return;
    }
    const std::string asset = mesh + " fitted";
    text_.fitted_meshes[asset] = mesh;
    geom->SetAttribute("mesh", asset);
  }

  void add_fitted_assets(TiXmlElement* root) const {
    if (text_.fitted_meshes.empty()) return;
    TiXmlElement assets("asset");
    for (const auto& [asset, mesh] : text_.fitted_meshes) {
      TiXmlElement probe("mesh");
      probe.SetAttribute("name", asset);
      probe.SetAttribute("file", kMjcfProbe);
      probe.SetAttribute("scale", "1 1 1");
      assets.InsertEndChild(probe);
    }
    root->InsertEndChild(assets);
  }

  // Actuators of tendons and sites move no single joint.
  void read_actuators(TiXmlElement* root) {
    size_t others = 0;
    for (auto* section = root->FirstChildElement("actuator"); section;
         section = section->NextSiblingElement("actuator"))
      for (TiXmlElement* each = section->FirstChildElement(); each;) {
        TiXmlElement* const next = each->NextSiblingElement();
        const char* joint = each->Attribute("joint");
        if (!joint) {
          section->RemoveChild(each);
          ++others;
        } else if (each->ValueStr() == "position") {
          const std::string ratio = found(each, "dampratio", ""), gain = found(each, "kv", "");
          if (!ratio.empty()) text_.damping_ratios[joint] = mjcf_number(ratio.c_str(), 0);
          if (!gain.empty()) text_.velocity_gains[joint] = mjcf_number(gain.c_str(), 0);
        }
        each = next;
      }
    if (others > 0)
      text_.notes.push_back(
          text::counted(others, "actuator") +
          " of tendons, sites or bodies are left out, because only servos of joints are simulated");
  }

  static bool carries_bodies(const TiXmlElement* element) {
    static const std::set<std::string> parts = {"attach", "replicate", "composite", "flexcomp",
                                                "body",   "joint",     "geom",      "inertial"};
    if (parts.contains(element->ValueStr())) return true;
    for (auto* each = element->FirstChildElement(); each; each = each->NextSiblingElement())
      if (carries_bodies(each)) return true;
    return false;
  }

  void keep_known(TiXmlElement* element) {
    const auto known = schema_.find(element->ValueStr());
    std::vector<std::string> unknown;
    for (const TiXmlAttribute* each = element->FirstAttribute(); each; each = each->Next())
      if (known != schema_.end() && !known->second.contains(each->Name()))
        unknown.emplace_back(each->Name());
    for (const std::string& name : unknown) {
      if (!kReadHere.contains(name)) ++unknown_["'" + name + "' of <" + element->ValueStr() + ">"];
      element->RemoveAttribute(name);
    }
    for (TiXmlElement* child = element->FirstChildElement(); child;) {
      TiXmlElement* const next = child->NextSiblingElement();
      if (schema_.contains(child->ValueStr()) || schema_.empty()) {
        keep_known(child);
      } else {
        if (carries_bodies(child))
          complain_xml(
              path_.string(), child,
              "this version of MuJoCo does not know <" + child->ValueStr() +
                  ">, which contains bodies of the robot; move these bodies out of this element");
        ++unknown_["<" + child->ValueStr() + ">"];
        element->RemoveChild(child);
      }
      child = next;
    }
  }

  const fs::path& path_;
  const MjcfSchema& schema_;
  const MeshIsThere& is_there_;
  MjcfText text_;
  size_t elements_ = 0;
  std::set<fs::path> included_;
  char is_included_ = 0;  ///< its address marks the elements of included files
  std::string folder_;
  bool strip_ = false, weigh_all_ = false;
  std::map<std::string, std::string> parent_class_;
  std::map<std::string, std::map<std::string, std::map<std::string, std::string>>> defaults_;
  std::map<std::string, int> unknown_;
};

}  // namespace

// Reads lines such as
//   "   element (*)   attribute attribute",
// which may be continued by lines with attributes only.
MjcfSchema mjcf_schema(const std::string& printed) {
  MjcfSchema schema;
  std::istringstream lines(printed);
  std::string element;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::vector<std::string> all;
    for (std::string word; words >> word;) all.push_back(word);
    size_t first = 0;
    if (all.size() >= 2 && all[1].size() == 3 && all[1].front() == '(') {
      element = all[0];
      first = 2;
      if (element == "(world)body") {  // one line stands for both elements
        element = "body";
        schema["worldbody"];
      }
      schema[element];
    }
    if (!element.empty())
      schema[element].insert(all.begin() + static_cast<std::ptrdiff_t>(first), all.end());
  }
  return schema;
}

MjcfText mjcf_text(const std::string& bytes, const fs::path& path, const MjcfSchema& schema,
                   const MeshIsThere& is_there) {
  return Cleaner(path, schema, is_there).clean(bytes);
}

}  // namespace ayumi
