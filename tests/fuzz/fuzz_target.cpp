#include "fuzz_target.hpp"

#include <unistd.h>

#include <cstdlib>
#include <fstream>

namespace ayumi::fuzz {

namespace fs = std::filesystem;

namespace {

// Nothing is kept in the user's cache of meshes.
[[maybe_unused]] const bool kNoCache = setenv("XDG_CACHE_HOME", "off", 1) == 0;

}  // namespace

std::vector<Part> parts_of(std::string_view input) {
  std::vector<Part> parts(1);
  size_t end = std::min(input.find(kSeparator), input.size());
  parts[0].bytes = input.substr(0, end);
  while (end < input.size()) {
    input.remove_prefix(end + 1);
    end = std::min(input.find(kSeparator), input.size());
    const std::string_view part = input.substr(0, end);
    const size_t line = std::min(part.find('\n'), part.size());
    parts.push_back({std::string(part.substr(0, line)),
                     std::string(part.substr(std::min(line + 1, part.size())))});
  }
  return parts;
}

std::string joined(const std::vector<Part>& parts) {
  std::string all = parts.at(0).bytes;
  for (size_t i = 1; i < parts.size(); ++i)
    all += kSeparator + parts[i].name + "\n" + parts[i].bytes;
  return all;
}

InputFolder::InputFolder(const std::vector<Part>& parts, const std::string& first) {
  static const fs::path folder = [] {
    const fs::path memory = "/dev/shm";
    std::string name =
        ((fs::is_directory(memory) ? memory : fs::temp_directory_path()) / "ayumi-fuzz-XXXXXX")
            .string();
    if (!mkdtemp(name.data())) report("no folder can be made for inputs");
    static fs::path made;
    made = name;
    std::atexit([] {
      std::error_code ignored;
      fs::remove_all(made, ignored);
    });
    return made;
  }();
  folder_ = folder;
  for (size_t i = 0; i < parts.size(); ++i) {
    const std::string name = i == 0 ? first : parts[i].name;
    const bool plain = !name.empty() && name.size() < 100 && name != "." && name != ".." &&
                       name.find('/') == std::string::npos && name.find('\0') == std::string::npos;
    if (!plain) continue;
    std::ofstream(folder_ / name, std::ios::binary) << parts[i].bytes;
    names_.push_back(name);
  }
}

InputFolder::~InputFolder() {
  std::error_code ignored;
  for (const std::string& name : names_) fs::remove(folder_ / name, ignored);
}

const RobotModel& hoap1() {
  static const RobotModel model = [] {
    const std::string folder = AYUMI_SOURCE_DIR "/robots/hoap1";
    return load_robot(folder, bundled());
  }();
  return model;
}

}  // namespace ayumi::fuzz
