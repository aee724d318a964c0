#pragma once
// The folder of a library of walks while it is being made. Every finished cell and transition is
// kept in a hidden folder, so that a stopped program can continue. The library appears when it is
// complete.

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ayumi/base/file_lock.hpp"

namespace ayumi::app {

/// The bytes of each file in the library, by its path.
using LibraryFiles = std::vector<std::pair<std::string, std::string>>;

class LibraryFolder {
 public:
  /// `asked` determines every byte of the library. With `replace`, an existing library will be
  /// replaced, and an unfinished one is begun anew. Throws Error(bad_file) if another process is
  /// writing, or if the folder contains something else under a name of the library, a finished
  /// library (unless `replace`), or an unfinished one with another request.
  LibraryFolder(const std::filesystem::path& folder, const nlohmann::ordered_json& asked,
                bool replace);

  /// The result that add() received under this name, in this or an earlier process.
  std::optional<nlohmann::ordered_json> known(const std::string& name) const;

  /// Keeps the files, and then the result. Several threads may call it, for different names.
  void add(const std::string& name, const nlohmann::ordered_json& result,
           const LibraryFiles& files) const;

  /// The path of a file in the folder, which is still hidden.
  std::filesystem::path file(const std::string& path) const { return staging_ / path; }

  /// Writes `index` and moves all files to their place, the index last. `paths` are all other
  /// files.
  void deliver(const nlohmann::ordered_json& index, const std::vector<std::string>& paths) const;

 private:
  std::filesystem::path target_, staging_;
  FolderLock lock_;
};

}  // namespace ayumi::app
