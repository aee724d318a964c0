#pragma once
// The layering rules of docs/architecture.md, read from the sources: which room may include which,
// and where third-party headers may appear.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace ayumi::test {

namespace fs = std::filesystem;

struct Room {
  int floor = 0;
  /// Rooms that it may include although they are on the same floor.
  std::set<std::string> also = {};
  std::set<std::string> hidden = {};  ///< lower rooms that it may not include
  bool data_only = false;  ///< from the rooms that compute, only data_headers() may be included
};

inline const std::map<std::string, Room>& rooms() {
  static const std::map<std::string, Room> table = {
      {"base", {0, {}, {}, false}},
      {"math", {1, {}, {}, false}},
      {"geometry", {2, {}, {}, false}},
      {"model", {2, {"geometry"}, {}, false}},
      {"dynamics", {3, {}, {}, false}},
      {"motion", {4, {}, {}, false}},
      {"plan", {5, {}, {}, false}},
      {"demand", {5, {}, {}, false}},
      {"author", {6, {}, {}, false}},
      {"limits", {6, {}, {}, false}},
      {"check", {7, {}, {}, false}},
      {"control", {7, {}, {"limits"}, false}},
      {"repair", {8, {}, {"control"}, false}},
      {"sim", {8, {}, {"check", "limits"}, false}},
      {"study", {9, {}, {}, false}},
      {"identify", {9, {"study"}, {"repair"}, false}},
      {"task", {9, {}, {"repair"}, false}},
      {"sim/plant_mujoco", {9, {}, {"check", "limits", "control", "repair"}, false}},
      {"repair/task", {10, {}, {}, false}},
      {"io", {10, {}, {}, true}},
      {"render", {10, {}, {}, true}},
      {"plot", {10, {"render"}, {}, true}},
      {"report", {11, {}, {}, true}},
      {"app", {12, {}, {}, false}},
      {"python", {12, {}, {}, false}},
      {"mesh_reader", {12, {}, {}, false}}};
  return table;
}

/// Rooms of which io, render, plot and report may include data_headers() only.
inline bool computes(const std::string& room) {
  static const std::set<std::string> rooms = {"check", "limits", "control", "repair", "sim"};
  return rooms.contains(room);
}

/// The room of a path such as "check/consistency.hpp": the longest leading folder that is a room.
inline std::string room_of(const std::string& path) {
  const size_t first = path.find('/'), second = path.find('/', first + 1);
  const std::string two = second == std::string::npos ? "" : path.substr(0, second);
  return rooms().contains(two) ? two : path.substr(0, first);
}

/// Headers with results, options and bounds of results, in the rooms that compute.
/// finding_groups.hpp puts findings together for people, in the answer of check, on the live page
/// and in a report. has_zmp.hpp says which samples of a run have a ZMP.
inline const std::set<std::string>& data_headers() {
  static const std::set<std::string> headers = {
      "check/consistency.hpp", "check/finding_groups.hpp", "limits/table_safety.hpp",
      "repair/repair.hpp",     "sim/has_zmp.hpp",          "sim/log_events.hpp",
      "sim/simulate.hpp",      "sim/simulation_log.hpp"};
  return headers;
}

/// Headers that are installed, by their path below lib/ayumi: those of public_headers.txt and those
/// that they include. Of third-party headers, they include only Eigen's.
inline const std::set<std::string>& public_headers() {
  static const std::set<std::string> headers = [] {
    const fs::path lib = fs::path(AYUMI_SOURCE_DIR) / "lib";
    static const std::regex include(R"re(^#include "(ayumi/[^"]+)".*)re");
    std::ifstream list(lib / "cmake/public_headers.txt");
    std::vector<std::string> waiting(std::istream_iterator<std::string>(list), {});
    std::set<std::string> found;
    while (!waiting.empty()) {
      const std::string header = waiting.back();
      waiting.pop_back();
      if (!found.insert(header.substr(6)).second) continue;
      std::ifstream file(lib / header);
      std::smatch match;
      for (std::string line; std::getline(file, line);)
        if (std::regex_match(line, match, include)) waiting.push_back(match[1]);
    }
    return found;
  }();
  return headers;
}

struct ThirdParty {
  std::string name;
  std::regex header;
  /// Rooms that may use it; if empty, all rooms, public headers included.
  std::set<std::string> rooms;
};

inline const std::vector<ThirdParty>& third_parties() {
  static const std::vector<ThirdParty> table = {
      {"Eigen", std::regex("(unsupported/)?Eigen/.*"), {}},
      {"Boost.Math", std::regex("boost/math/.*"), {"math"}},
      {"Ipopt", std::regex("Ip[A-Z].*|coin(-or)?/.*"), {"repair"}},
      {"Ceres", std::regex("ceres/.*"), {"identify"}},
      {"dynamic loader", std::regex("dlfcn\\.h"), {"render", "repair"}},
      {"urdfdom", std::regex("(urdf|console_bridge|tinyxml).*"), {"io"}},
      // assimp's readers trust their input, so that only the confined program ayumi-mesh-reader
      // contains them.
      {"assimp", std::regex("assimp/.*"), {"mesh_reader"}},
      {"libseccomp", std::regex("seccomp\\.h"), {"mesh_reader"}},
      {"OpenSSL", std::regex("openssl/.*"), {"io"}},
      {"zlib", std::regex("zlib\\.h"), {"io"}},
      {"yaml-cpp", std::regex("yaml-cpp/.*"), {"io"}},
      {"libzip", std::regex("zip\\.h"), {"io"}},
      {"zstd", std::regex("zstd\\.h"), {"io"}},
      {"nlohmann-json", std::regex("nlohmann/.*"), {"io", "app"}},
      {"OpenGL", std::regex("E?GL/.*"), {"render"}},
      {"cairo", std::regex("cairo.*"), {"render", "plot"}},
      {"libjpeg", std::regex("jpeglib\\.h"), {"render"}},
      {"CLI11", std::regex("CLI/.*"), {"app"}},
      {"cpp-httplib", std::regex("httplib\\.h"), {"app"}},
      {"SQLite", std::regex("sqlite3\\.h"), {"app"}},
      {"pybind11", std::regex("pybind11/.*"), {"python"}},
      {"MuJoCo", std::regex("mujoco/.*"), {"sim/plant_mujoco", "io"}},
      {"POSIX",
       std::regex("sys/.*|(unistd|fcntl|signal|spawn|poll|termios|pthread|malloc)\\.h"),
       {"base", "render", "app", "mesh_reader"}},
      {"processor intrinsics", std::regex("(imm|x86)intrin\\.h"), {"dynamics", "sim", "render"}}};
  return table;
}

/// The broken rule, or an empty text if a file of `room` may include "ayumi/`header`".
inline std::string room_rule(const std::string& room, const std::string& header) {
  const std::string target = room_of(header);
  const auto to = rooms().find(target);
  if (to == rooms().end()) return "there is no room '" + target + "'";
  if (room == target) return "";
  const Room& from = rooms().at(room);
  if (from.also.contains(target)) return "";
  const int floor = to->second.floor;
  if (floor >= from.floor || from.hidden.contains(target))
    return "room '" + room + "' (floor " + std::to_string(from.floor) + ") may not include room '" +
           target + "' (floor " + std::to_string(floor) + ")";
  if (from.data_only && computes(target) && !data_headers().contains(header))
    return "room '" + room + "' may include only data types of room '" + target + "'";
  return "";
}

/// The broken rule, or an empty text if a file of `room` may include <`header`>.
inline std::string third_party_rule(const std::string& room, bool public_header,
                                    const std::string& header) {
  // A header of the standard library.
  if (header.find_first_of("/.") == std::string::npos) return "";
  for (const ThirdParty& party : third_parties()) {
    if (!std::regex_match(header, party.header)) continue;
    if (party.rooms.empty()) return "";
    if (!party.rooms.contains(room)) return party.name + " may not be used in room '" + room + "'";
    return public_header ? "only Eigen shows in public headers" : "";
  }
  return "<" + header + "> is no known third party";
}

/// The violations in one source file, each as "shown:line: rule".
inline std::vector<std::string> file_violations(const fs::path& file, const std::string& shown,
                                                const std::string& room, bool public_header) {
  static const std::regex include(R"re(^\s*#\s*include\s*(["<])([^">]+)[">].*)re");
  if (!rooms().contains(room)) return {shown + ":1: there is no room '" + room + "'"};
  std::vector<std::string> found;
  std::ifstream stream(file);
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    std::smatch match;
    if (!std::regex_match(line, match, include)) continue;
    const std::string header = match[2];
    std::string rule;
    if (header.starts_with("ayumi/"))
      rule = room_rule(room, header.substr(6));
    else if (match[1] == "<")
      rule = third_party_rule(room, public_header, header);
    else if (room != "app" && room != "python" && room != "mesh_reader")
      rule = "\"" + header + "\": write the path from ayumi/";
    if (!rule.empty()) found.push_back(shown + ":" + std::to_string(number) + ": " + rule);
  }
  return found;
}

/// All violations of the rules in lib/ayumi, lib/python, lib/mesh_reader and app below `root`,
/// sorted.
inline std::vector<std::string> layering_violations(const fs::path& root) {
  static const std::set<std::string> forbidden = {"util",   "utils",   "common",  "core",
                                                  "helper", "helpers", "manager", "managers"};
  std::vector<std::string> found;
  for (const fs::path& top : {fs::path("lib/ayumi"), fs::path("lib/python"),
                              fs::path("lib/mesh_reader"), fs::path("app")}) {
    if (!fs::exists(root / top)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      const fs::path inside = fs::relative(entry.path(), root / top);
      const std::string shown = (top / inside).generic_string();
      const std::string extension = entry.path().extension();
      if (entry.is_directory() && forbidden.contains(inside.filename()))
        found.push_back(shown + ": no such folder name");
      if (extension != ".cpp" && extension != ".hpp") continue;
      const bool library = top == "lib/ayumi";
      if (library && !inside.has_parent_path()) continue;  // ayumi.hpp gathers the rooms
      const std::string room = library ? room_of(inside.generic_string()) : top.filename().string();
      const bool public_header = library && public_headers().contains(inside.generic_string());
      const auto breaks = file_violations(entry.path(), shown, room, public_header);
      found.insert(found.end(), breaks.begin(), breaks.end());
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace ayumi::test
