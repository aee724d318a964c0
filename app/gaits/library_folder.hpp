#pragma once
// The folder of a library of walks while it is made: every finished cell and transition is kept in
// a hidden folder, so that a stopped program goes on; the library appears when it is complete.

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ayumi/base/file.hpp"

namespace ayumi::app {

/// Bytes by the path of a file in the library.
using LibraryFiles = std::vector<std::pair<std::string, std::string>>;

class LibraryFolder {
 public:
  /// `asked` decides every byte of the library. With `replace`, a library that is there will be
  /// replaced, and an unfinished one is begun anew. Throws Error(bad_file) where another process is
  /// writing, where the folder holds something else under a name of the library, a finished library
  /// (unless `replace`), or an unfinished one of which other things were asked.
  LibraryFolder(const std::filesystem::path& folder, const nlohmann::ordered_json& asked,
                bool replace);

  /// What add() was given under this name, in this or an earlier process.
  std::optional<nlohmann::ordered_json> known(const std::string& name) const;

  /// Keeps the files, and then the result. May be called from several threads, for several names.
  void add(const std::string& name, const nlohmann::ordered_json& result,
           const LibraryFiles& files) const;

  /// The files in the folder that is still hidden.
  std::filesystem::path file(const std::string& path) const { return staging_ / path; }

  /// Writes `index` and moves all files to their place, the index last. `paths`: all others.
  void deliver(const nlohmann::ordered_json& index, const std::vector<std::string>& paths) const;

 private:
  std::filesystem::path target_, staging_;
  FolderLock lock_;
};

}  // namespace ayumi::app
