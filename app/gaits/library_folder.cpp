#include "gaits/library_folder.hpp"

#include <algorithm>

#include "ayumi/base/error.hpp"
#include "ayumi/io/json/json_depth.hpp"

namespace ayumi::app {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

constexpr const char* kStaging = ".ayumi_part";
constexpr const char* kIndex = "index.json";
constexpr const char* kAsked = "asked.json";
/// A file that exists while files are moved. It shows that the files that are already in their
/// place belong to the library.
constexpr const char* kDelivering = "delivering.json";
/// Names at the top of a library's folder, except the index.
constexpr const char* kTop[] = {"patterns", "walks", "cycles", "transitions", "map.svg", "map.png"};
constexpr const char* kGaitsFormat = "ayumi.gaits/1";

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(fs::symlink_status(path, ignored));
}

/// The files that a finished library lists, including the index. If a listed path leads out of the
/// folder, this is not the index of a library.
std::vector<std::string> files_of_library(const fs::path& folder) {
  const fs::path index = folder / kIndex;
  std::vector<std::string> files = {kIndex};
  try {
    const auto json = shallow_json<nlohmann::json>(read_file(index));
    if (json.at("format") != kGaitsFormat) throw std::out_of_range("format");
    for (const auto& each : json.at("files")) {
      const fs::path path = fs::path(each.get<std::string>()).lexically_normal();
      if (path.is_absolute() || path.empty() || *path.begin() == "..")
        throw std::out_of_range("files");
      files.push_back(path.string());
    }
  } catch (const Json::exception&) {
    files.clear();
  } catch (const std::out_of_range&) {
    files.clear();
  }
  if (files.empty())
    fail(ErrorCode::bad_file,
         index.string() +
             ": this file is not the index of a library of walks, so ayumi gaits does not replace "
             "it. Move the file away or choose another folder");
  return files;
}

void require_target(const fs::path& folder, bool replace) {
  if (!is_there(folder)) return;
  if (!fs::is_directory(folder))
    fail(ErrorCode::bad_file, {folder.string()},
         "this is a file, but -o needs a folder. Choose another name");
  if (is_there(folder / kStaging / kDelivering)) return;
  if (is_there(folder / kIndex)) {
    files_of_library(folder);
    if (!replace) refuse_existing(folder);
    return;
  }
  for (const char* name : kTop)
    if (is_there(folder / name))
      fail(ErrorCode::bad_file, {(folder / name).string()},
           "this file already exists and is not a part of a library of "
           "walks. Move the file away or choose another folder");
}

}  // namespace

LibraryFolder::LibraryFolder(const fs::path& folder, const Json& asked, bool replace)
    : target_((folder / "").parent_path()), staging_(target_ / kStaging), lock_(target_) {
  require_target(target_, replace);
  const std::string text = asked.dump(1) + "\n";
  std::error_code error;
  if (is_there(staging_ / kAsked) && !replace) {
    if (read_file(staging_ / kAsked) == text) return;
    fail(
        ErrorCode::bad_file, {target_.string()},
        "this folder contains an unfinished library that was begun with other options. To continue "
        "the library, give the same options. To begin again, give --force. Otherwise choose "
        "another folder");
  }
  // A library with the same request is continued, even with --force, unless it was finished and
  // delivered before.
  if (is_there(staging_ / kAsked) && read_file(staging_ / kAsked) == text) return;
  fs::remove_all(staging_, error);
  fs::create_directories(staging_ / "done", error);
  if (error)
    fail(ErrorCode::bad_file, {target_.string()},
         "the folder cannot be written (" + error.message() + ")");
  write_file(staging_ / kAsked, text);
}

std::optional<Json> LibraryFolder::known(const std::string& name) const {
  const fs::path file = staging_ / "done" / (name + ".json");
  if (!is_there(file)) return {};
  auto json = shallow_json<Json>(read_file(file));
  // The file was written as a whole, so something else has changed it.
  if (json.is_discarded()) return {};
  return json;
}

void LibraryFolder::add(const std::string& name, const Json& result,
                        const LibraryFiles& files) const {
  for (const auto& [path, bytes] : files) {
    fs::create_directories((staging_ / path).parent_path());
    write_file(staging_ / path, bytes);
  }
  write_file(staging_ / "done" / (name + ".json"), result.dump());
}

void LibraryFolder::deliver(const Json& index, const std::vector<std::string>& paths) const {
  std::vector<std::string> previous;
  const bool again = is_there(staging_ / kDelivering);
  if (is_there(target_ / kIndex)) previous = files_of_library(target_);
  if (!again)
    for (const std::string& path : paths)
      if (is_there(target_ / path) &&
          std::find(previous.begin(), previous.end(), path) == previous.end())
        fail(ErrorCode::bad_file, (target_ / path).string() +
                                      ": this file already exists and is not a part of the old "
                                      "library. Move the file away or choose another folder");
  write_file(staging_ / kIndex, index.dump(1) + "\n");
  write_file(staging_ / kDelivering, "true\n");
  try {
    // From here until the index is moved, there is no complete library in the folder.
    for (const std::string& path : previous) fs::remove(target_ / path);
    for (const std::string& path : paths) {
      fs::create_directories((target_ / path).parent_path());
      if (is_there(staging_ / path)) fs::rename(staging_ / path, target_ / path);
    }
    fs::rename(staging_ / kIndex, target_ / kIndex);
  } catch (const fs::filesystem_error& error) {
    fail(ErrorCode::bad_file, {target_.string()},
         "the folder cannot be written (" + error.code().message() + ")");
  }
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
  // Removes empty folders of the library that was replaced.
  for (const char* name : kTop)
    if (fs::is_directory(target_ / name, ignored) && fs::is_empty(target_ / name, ignored))
      fs::remove(target_ / name, ignored);
}

}  // namespace ayumi::app
