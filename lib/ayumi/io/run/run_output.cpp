#include "ayumi/io/run/run_output.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "ayumi/base/error.hpp"
#include "ayumi/io/run/run_folder.hpp"

namespace ayumi {

namespace {

namespace fs = std::filesystem;

// Hidden folders in the target. The first holds the run that is being made. The second holds the
// run that is being replaced, and only exists during a delivery.
constexpr const char* kStaging = ".ayumi_part";
constexpr const char* kReplaced = ".ayumi_replaced";
constexpr const char* kRunJson = "run.json";

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(fs::symlink_status(path, ignored));
}

// Whether this is itself a folder. A symbolic link to a folder may lead to files that no run has
// written, for example in a folder that another person has packed.
bool is_own_folder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(fs::symlink_status(path, ignored));
}

// Throws if something other than a file has the name of a file of the run, because it must not be
// removed.
void require_own_file(const fs::path& path) {
  if (is_there(path)) require_file_target(path);
}

std::set<std::string> files_of_run_in(const fs::path& folder) {
  if (!is_there(folder / "run.json")) return {};
  const std::vector<std::string> names = run_file_names(folder);
  return {names.begin(), names.end()};
}

// The names of the files in a folder, run.json last.
std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end(), [](const std::string& a, const std::string& b) {
    return std::pair(a == kRunJson, a) < std::pair(b == kRunJson, b);
  });
  return names;
}

// The files of the new run that a delivery has already moved to their place: files that the
// run.json in the staging folder lists, with the hash that it states. A file of the user with such
// a name has another hash.
std::vector<fs::path> delivered_files(const fs::path& target) {
  std::vector<fs::path> files;
  const fs::path staging = target / kStaging;
  if (!is_own_folder(target / kReplaced) || !is_own_folder(staging)) return files;
  if (!is_there(staging / kRunJson)) return files;
  for (const std::string& name : run_file_names(staging)) {
    if (name == kRunJson || is_there(staging / name)) continue;
    try {
      if (is_file_of_run(staging, target / name)) files.push_back(target / name);
    } catch (const Error&) {  // the file does not exist, or is not a file
    }
  }
  return files;
}

// If a delivery was not completed, brings back what was there before it. If it was completed,
// removes what it has replaced.
void undo_delivery(const fs::path& target) {
  std::error_code ignored;
  for (const char* name : {kStaging, kReplaced})
    if (!is_own_folder(target / name)) fs::remove(target / name, ignored);
  if (!is_there(target / kReplaced)) return;
  if (is_there(target / kStaging / kRunJson) || !is_there(target / kRunJson)) {
    for (const fs::path& file : delivered_files(target)) fs::remove(file, ignored);
    for (const std::string& name : names_in(target / kReplaced))
      if (!is_there(target / name)) fs::rename(target / kReplaced / name, target / name, ignored);
    fs::remove(target / kReplaced,
               ignored);  // the folder stays if one of its files could not go back
  } else {
    fs::remove_all(target / kReplaced, ignored);
  }
}

}  // namespace

void require_run_target(const fs::path& folder, bool replace,
                        const std::vector<std::string>& names) {
  if (!is_there(folder)) return;
  std::error_code error;
  if (!fs::is_directory(folder, error))
    fail(ErrorCode::bad_file, {folder.string()},
         "this is a file, but -o needs a folder; choose another name");
  if (!replace && is_there(folder / "run.json")) refuse_existing(folder);
  const std::set<std::string> previous = files_of_run_in(folder);
  for (const std::string& name : previous) require_own_file(folder / name);
  const std::vector<fs::path> delivered = delivered_files(folder);
  const auto may_go = [&](const std::string& name) {
    return previous.contains(name) ||
           std::find(delivered.begin(), delivered.end(), folder / name) != delivered.end();
  };
  for (const std::string& name : names)
    if (is_there(folder / name) && !may_go(name))
      fail(ErrorCode::bad_file, {(folder / name).string()},
           "this file already exists and was not written by a run, so a run does not replace "
           "it; move the file away or choose another folder");
}

RunOutput::RunOutput(const fs::path& folder, bool replace)
    : target_((folder / "").parent_path()),
      staging_(target_ / kStaging),
      replaced_(target_ / kReplaced),
      replace_(replace),
      lock_(target_) {
  undo_delivery(target_);
  require_run_target(target_, replace_, {});
  std::error_code error;
  fs::remove_all(staging_, error);  // left by a process that ended before its run was complete
  fs::create_directory(staging_, error);
  if (error)
    fail(ErrorCode::bad_file, {target_.string()},
         "the folder cannot be written (" + error.message() + ")");
  unfinished_.emplace(staging_, UnfinishedPath::Kind::folder);
}

RunOutput::~RunOutput() {
  try {
    std::error_code ignored;
    fs::remove_all(staging_, ignored);
  } catch (const std::exception&) {  // no memory was left; the next run removes the folder
  }
}

void RunOutput::deliver() {
  unfinished_.reset();  // from here on, the next start needs these files to undo a delivery
  const std::vector<std::string> names = names_in(staging_);
  require_run_target(target_, replace_, names);
  const std::set<std::string> previous = files_of_run_in(target_);
  try {
    fs::create_directory(replaced_);
    // From here until run.json is moved, there is no complete run in the folder.
    if (previous.contains(kRunJson)) fs::rename(target_ / kRunJson, replaced_ / kRunJson);
    for (const std::string& name : previous)
      if (is_there(target_ / name)) fs::rename(target_ / name, replaced_ / name);
    for (const std::string& name : names) fs::rename(staging_ / name, target_ / name);
  } catch (const fs::filesystem_error& error) {
    undo_delivery(target_);
    fail(ErrorCode::bad_file, {target_.string()},
         "the folder cannot be written (" + error.code().message() + ")");
  }
  std::error_code ignored;
  fs::remove_all(replaced_, ignored);
}

}  // namespace ayumi
