#include "ayumi/io/robot/mesh_reader_place.hpp"

#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <sstream>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"

namespace ayumi {

namespace fs = std::filesystem;

namespace {

constexpr const char* kReaderName = "ayumi-mesh-reader";
constexpr const char* kReaderVariable = "AYUMI_MESH_READER";

// The file from which this code was loaded: the program, or a module that another program has
// loaded. It is found in /proc/self/maps, whose lines are "begin-end access offset device inode
// path".
fs::path file_of_this_library() {
  const auto here = reinterpret_cast<std::uintptr_t>(&file_of_this_library);
  std::istringstream maps(read_file("/proc/self/maps"));
  for (std::string line; std::getline(maps, line);) {
    std::uintptr_t begin = 0, end = 0;
    const char* const last = line.data() + line.size();
    const auto [dash, wrong_begin] = std::from_chars(line.data(), last, begin, 16);
    if (wrong_begin != std::errc() || dash == last) continue;
    const auto [after, wrong_end] = std::from_chars(dash + 1, last, end, 16);
    if (wrong_end != std::errc() || here < begin || here >= end) continue;
    const size_t path = line.find('/');
    return path == std::string::npos ? fs::path() : fs::path(line.substr(path));
  }
  return {};
}

std::vector<fs::path> places_without_variable() {
  const fs::path inside = fs::path(AYUMI_LIBEXEC) / "ayumi" / kReaderName;
  std::vector<fs::path> places;
  try {
    fs::path above = file_of_this_library().parent_path();
    if (!above.empty()) places.push_back(above / kReaderName);
    // Largest number of folders above this file that are searched, as for bundled data. Chosen:
    // lib/python3/dist-packages/ayumi/... is four folders deep.
    constexpr int kDeepest = 5;
    for (int i = 0; i < kDeepest && above.has_relative_path(); ++i) {
      above = above.parent_path();
      places.push_back(above / inside);
    }
  } catch (const Error&) {  // without /proc, the fixed places remain
  }
  places.emplace_back(AYUMI_BUILT_MESH_READER);
  for (const fs::path root : {AYUMI_INSTALL_PREFIX, "/usr", "/usr/local"})
    places.push_back(root / inside);
  return places;
}

}  // namespace

std::vector<fs::path> mesh_reader_places() {
  const char* named = std::getenv(kReaderVariable);
  if (named && *named) return {named};
  // The file that contains this code does not change while it runs.
  static const std::vector<fs::path> places = places_without_variable();
  return places;
}

fs::path assimp_library() { return AYUMI_ASSIMP; }

fs::path find_mesh_reader() {
  std::vector<std::string> searched;
  for (const fs::path& place : mesh_reader_places()) {
    std::error_code ignored;
    if (fs::is_regular_file(place, ignored)) return place;
    searched.push_back(place.string());
  }
  fail(ErrorCode::bad_file,
       "the program " + std::string(kReaderName) +
           ", which reads meshes, was not found. Install Ayumi as a whole, or set "
           "the environment variable " +
           kReaderVariable + " to the path of the program. Ayumi looked for " +
           text::join(searched, ", "));
}

}  // namespace ayumi
