#include "ayumi/io/run/run_output.hpp"

#include <algorithm>
#include <set>

#include "ayumi/base/error.hpp"
#include "ayumi/io/run/run_folder.hpp"

namespace ayumi {

namespace {

namespace fs = std::filesystem;

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(fs::symlink_status(path, ignored));
}

// What is there under the name of a file of the run may be removed only where it is a file.
void require_own_file(const fs::path& path) {
  if (is_there(path)) require_file_target(path);
}

std::set<std::string> files_of_run_in(const fs::path& folder) {
  if (!is_there(folder / "run.json")) return {};
  const std::vector<std::string> names = run_file_names(folder);
  return {names.begin(), names.end()};
}

}  // namespace

void require_run_target(const fs::path& folder, bool replace,
                        const std::vector<std::string>& names) {
  if (!is_there(folder)) return;
  std::error_code error;
  if (!fs::is_directory(folder, error))
    fail(ErrorCode::bad_file, folder.string() + ": this is not a folder; -o needs a folder");
  if (!replace && is_there(folder / "run.json")) refuse_existing(folder);
  const std::set<std::string> previous = files_of_run_in(folder);
  for (const std::string& name : previous) require_own_file(folder / name);
  for (const std::string& name : names)
    if (is_there(folder / name) && !previous.contains(name))
      fail(ErrorCode::bad_file, (folder / name).string() +
                                    ": this already exists and is not a file of a run, so no run "
                                    "replaces it; move it away or choose another folder");
}

RunOutput::RunOutput(const fs::path& folder, bool replace)
    : target_((folder / "").parent_path()),
      staging_(target_ / ".ayumi_part"),
      replace_(replace),
      lock_(target_) {
  require_run_target(target_, replace_, {});
  std::error_code error;
  fs::remove_all(staging_, error);  // of a process that ended before its run was complete
  fs::create_directory(staging_, error);
  if (error)
    fail(ErrorCode::bad_file, target_.string() + ": cannot be written (" + error.message() + ")");
}

RunOutput::~RunOutput() {
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
}

void RunOutput::deliver() const {
  try {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(staging_))
      names.push_back(entry.path().filename().string());
    std::stable_sort(names.begin(), names.end(), [](const std::string& a, const std::string& b) {
      return (a == "run.json") < (b == "run.json");
    });
    require_run_target(target_, replace_, names);
    const std::set<std::string> previous = files_of_run_in(target_);
    fs::remove(target_ / "run.json");  // from here on there is no complete run in the folder
    for (const std::string& name : previous) fs::remove(target_ / name);
    for (const std::string& name : names) fs::rename(staging_ / name, target_ / name);
  } catch (const fs::filesystem_error& error) {
    fail(ErrorCode::bad_file,
         target_.string() + ": cannot be written (" + error.code().message() + ")");
  }
}

}  // namespace ayumi
