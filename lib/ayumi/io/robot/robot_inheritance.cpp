#include "ayumi/io/robot/robot_inheritance.hpp"

#include <algorithm>
#include <numbers>
#include <set>

#include "ayumi/base/file.hpp"
#include "ayumi/base/json_pointer.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/json/document_format.hpp"
#include "ayumi/io/robot/robot_source.hpp"

namespace ayumi {

namespace {

namespace fs = std::filesystem;

constexpr double kRadiansPerDeg = std::numbers::pi / 180;

// Lists in which a later entry overrides an earlier one or adds to it.
const std::set<std::string> kAppended = {"servos", "joint_weight", "limits", "collision_ignore",
                                         "assumptions"};

class SidecarOverlay {
 public:
  SidecarOverlay(MergedSidecar& under, const std::string& file) : under_(under), file_(file) {}

  // Merges `over`, which is at `place` of its own file, into `under`, which is at `pointer` of the
  // merged document.
  void merge(Json& under, const Json& over, const std::string& pointer, const std::string& place,
             const std::string& key = "") {
    if (under.is_object() && over.is_object()) {
      for (const auto& [name, value] : over.items()) {
        const std::string step = "/" + json_pointer_token(name);
        if (under.contains(name))
          merge(under[name], value, pointer + step, place + step, name);
        else
          put(under[name], value, pointer + step, place + step);
      }
    } else if (under.is_array() && over.is_array() && kAppended.contains(key)) {
      for (size_t i = 0; i < over.size(); ++i) append(under, over[i], pointer, entry(place, i));
    } else if (under.is_array() && over.is_array() && key == "profiles") {
      for (size_t i = 0; i < over.size(); ++i)
        merge_profile(under, over[i], pointer, entry(place, i));
    } else {
      put(under, over, pointer, place);
    }
  }

 private:
  static std::string entry(const std::string& pointer, size_t index) {
    return pointer + "/" + std::to_string(index);
  }

  void put(Json& under, const Json& over, const std::string& pointer, const std::string& place) {
    under = over;
    under_.places[pointer] = {file_, place};
  }

  void append(Json& list, const Json& item, const std::string& pointer, const std::string& place) {
    under_.places[entry(pointer, list.size())] = {file_, place};
    list.push_back(item);
  }

  void merge_profile(Json& list, const Json& profile, const std::string& pointer,
                     const std::string& place) {
    const auto name = [](const Json& each) {
      return each.is_object() && each.contains("name") ? each["name"] : Json();
    };
    for (size_t i = 0; i < list.size(); ++i)
      if (!name(profile).is_null() && name(list[i]) == name(profile))
        return merge(list[i], profile, entry(pointer, i), place);
    append(list, profile, pointer, place);
  }

  MergedSidecar& under_;
  const std::string& file_;
};

void scale_numbers(Json& value, double factor) {
  if (value.is_number()) value = value.get<double>() * factor;
  if (value.is_object())
    for (auto& [key, member] : value.items()) scale_numbers(member, factor);
}

// Notes that the value at `from` is now at `to`, with everything inside it.
void move_places(MergedSidecar& sidecar, const JsonPlace& place, const std::string& from,
                 const std::string& to) {
  JsonPlaces moved = {{to, place}};
  for (const auto& [pointer, inner] : sidecar.places)
    if (pointer.starts_with(from + "/")) moved[to + pointer.substr(from.size())] = inner;
  std::erase_if(sidecar.places, [&](const auto& each) {
    return each.first == from || each.first.starts_with(from + "/");
  });
  sidecar.places.merge(moved);
}

// A value in radians may override a value in degrees, and a value in degrees one in radians.
void use_units_of(const Json& over, MergedSidecar& base) {
  Json& under = base.document;
  const auto convert = [&](Json& from, Json& to, const std::string& key, double factor) {
    to[key] = from[key];
    scale_numbers(to[key], factor);
    from.erase(key);
  };
  for (const bool degrees : {false, true}) {
    const std::string key = degrees ? "_deg" : "", other = degrees ? "" : "_deg";
    const double factor = degrees ? 1 / kRadiansPerDeg : kRadiansPerDeg;
    if (over.contains("soft_limit_margin" + key)) under.erase("soft_limit_margin" + other);
    const auto postures = over.find("postures" + key);
    const auto hidden = under.find("postures" + other);
    if (postures == over.end() || hidden == under.end()) continue;
    if (!postures->is_object() || !hidden->is_object()) continue;
    Json from = *hidden;
    Json to = under.value("postures" + key, Json::object());
    for (const auto& [name, joints] : postures->items()) {
      if (!from.contains(name)) continue;
      const std::string step = "/" + json_pointer_token(name);
      const JsonPlace place = base.root().at("postures" + other).at(name).place();
      move_places(base, place, "/postures" + other + step, "/postures" + key + step);
      convert(from, to, name, factor);
    }
    under["postures" + other] = from;
    under["postures" + key] = to;
  }
}

class BaseReader {
 public:
  explicit BaseReader(const FindRobot& find) : find_(find) {}

  MergedSidecar read(const fs::path& file) {
    open_.push_back(fs::weakly_canonical(file));
    if (has_robot_ending(file))
      return {{{"format", "ayumi.robot/1"}, {"urdf", file.filename().string()}},
              {{"", {file.string(), ""}}},
              ""};
    const std::string bytes = read_file(file);
    Json document = parse_json(bytes, file.string(), ErrorCode::bad_file);
    const JsonNode root = root_of(document, file.string(), ErrorCode::bad_file);
    require_format(root, "ayumi.robot/1");
    const auto base = root.find("base");
    if (!base) return {document, {{"", {file.string(), ""}}}, bytes};
    MergedSidecar merged = read(base_file(*base, file));
    document.erase("base");
    use_units_of(document, merged);
    SidecarOverlay(merged, file.string()).merge(merged.document, document, "", "");
    merged.bytes += bytes;
    return merged;
  }

 private:
  fs::path base_file(const JsonNode& base, const fs::path& file) const {
    const std::string name = base.string();
    if (name.empty()) base.complain("the name or path of another robot is needed");
    const fs::path beside = file.parent_path() / name;
    std::error_code ignored;
    fs::path found;
    try {
      found = find_(fs::exists(beside, ignored) ? beside.string() : name);
    } catch (const Error& error) {
      base.complain(error.what());
    }
    if (!fs::exists(found, ignored)) base.complain("robot '" + name + "': no such file");
    const fs::path canonical = fs::weakly_canonical(found);
    const auto again = std::find(open_.begin(), open_.end(), canonical);
    if (again == open_.end()) return found;
    std::vector<std::string> circle;
    for (auto each = again; each != open_.end(); ++each) circle.push_back(each->string());
    base.complain(circle.size() == 1 ? "'" + name + "' is this file itself; name another robot"
                                     : "the bases form a circle: " + text::join(circle, ", ") +
                                           ". Each of these files names the next file as its "
                                           "base, and the last file names the first one. Remove "
                                           "\"base\" from one of these files");
  }

  const FindRobot& find_;
  std::vector<fs::path> open_;
};

}  // namespace

MergedSidecar read_merged_sidecar(const fs::path& file, const FindRobot& find) {
  return BaseReader(find).read(file);
}

}  // namespace ayumi
