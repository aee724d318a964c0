#include "ayumi/io/robot/mesh_place.hpp"

#include <algorithm>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/robot/xml_text.hpp"

namespace ayumi {

namespace {

namespace fs = std::filesystem;

// Number of folders above the robot's file whose neighbours are searched. Chosen: a URDF lies in
// package/urdf/ or package/robots/name/, and packages lie beside each other.
constexpr int kNeighbours = 4;
// Largest number of neighbours that are searched in one folder. Chosen: a workspace has fewer
// packages; a folder with more is not one.
constexpr int kMostNeighbours = 500;
// Largest size of a package.xml [bytes]. Chosen: package.xml files have a few kilobytes.
constexpr size_t kLargestPackageFile = size_t{1} << 20;

bool names_package(const fs::path& folder, const std::string& name) {
  const fs::path file = folder / "package.xml";
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) return false;
  TiXmlDocument document;
  try {
    parse_xml(document, read_file(file, kLargestPackageFile), file.string(), "a package.xml");
  } catch (const Error&) {  // a file that cannot be read names no package
    return false;
  }
  const TiXmlElement* root = document.RootElement();
  const TiXmlElement* tag = root ? root->FirstChildElement("name") : nullptr;
  return tag && tag->GetText() && name == tag->GetText();
}

// The package in a folder or in one of its subfolders; empty if there is none.
fs::path package_in(const fs::path& folder, const std::string& name, bool neighbours) {
  std::error_code ignored;
  if (folder.filename() == name || names_package(folder, name)) return folder;
  if (fs::is_directory(folder / name, ignored)) return folder / name;
  if (!neighbours) return {};
  std::vector<fs::path> found;  // sorted by name, independently of the file system
  int seen = 0;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (++seen > kMostNeighbours) break;
    if (entry.is_directory(ignored) && names_package(entry.path(), name))
      found.push_back(entry.path());
  }
  return found.empty() ? fs::path() : *std::min_element(found.begin(), found.end());
}

std::string lower_name(std::string name) {
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return name;
}

// The file whose name differs from `file` only in upper and lower case; empty if there is none.
fs::path with_other_capitals(const fs::path& file) {
  fs::path found = file.is_absolute() ? file.root_path() : fs::path(".");
  std::error_code ignored;
  for (const fs::path& part : file.relative_path()) {
    fs::path next = found / part;
    if (!fs::exists(next, ignored)) {
      next.clear();
      for (const auto& entry : fs::directory_iterator(found, ignored))
        if (lower_name(entry.path().filename().string()) == lower_name(part.string()) &&
            (next.empty() || entry.path() < next))
          next = entry.path();
    }
    if (next.empty()) return {};
    found = next;
  }
  return found.lexically_normal();
}

void add_once(std::vector<std::string>& words, const std::string& word) {
  if (std::find(words.begin(), words.end(), word) == words.end()) words.push_back(word);
}

}  // namespace

// The file that the name leads to; empty if its package does not exist.
fs::path MeshPlaces::named_file(const std::string& name) const {
  if (name.starts_with("file://")) return name.substr(7);
  for (const std::string scheme : {"package://", "model://"}) {
    if (!name.starts_with(scheme)) continue;
    const std::string inside = name.substr(scheme.size());
    const size_t slash = std::min(inside.find('/'), inside.size());
    const std::string package = inside.substr(0, slash);
    const std::string rest = inside.substr(std::min(slash + 1, inside.size()));
    for (const fs::path& folder : packages_)
      if (const fs::path found = package_in(fs::absolute(folder).lexically_normal(), package, true);
          !found.empty())
        return found / rest;
    const fs::path first = fs::absolute(robot_file_).lexically_normal().parent_path();
    std::error_code ignored;
    int above = 0;
    for (fs::path folder = first;; folder = folder.parent_path(), ++above) {
      if (const fs::path found = package_in(folder, package, above < kNeighbours); !found.empty())
        return found / rest;
      if (folder == folder.root_path()) break;
    }
    // Now packages are searched whose folder has another name, as in copies and downloads.
    above = 0;
    for (fs::path folder = first; above < kNeighbours && folder != folder.root_path();
         folder = folder.parent_path(), ++above)
      if (!rest.empty() && fs::is_regular_file(folder / rest, ignored)) return folder / rest;
    return {};
  }
  return robot_file_.parent_path() / name;
}

std::string MeshPlaces::find(const std::string& link, const std::string& name) {
  const fs::path file = named_file(name).lexically_normal();
  std::error_code ignored;
  if (file.empty()) {
    add_once(missing_, name + " of link " + link + " (no such package)");
    return {};
  }
  if (fs::is_regular_file(file, ignored)) return file.string();
  if (fs::is_directory(file, ignored)) {
    add_once(missing_,
             name + " of link " + link + " (" + file.string() + " is a folder; name its file)");
    return {};
  }
  const fs::path other = with_other_capitals(file);
  if (other.empty() || !fs::is_regular_file(other, ignored)) {
    add_once(missing_, name + " of link " + link);
    return {};
  }
  add_once(renamed_, other.filename().string() + " for " + name);
  return other.string();
}

std::vector<std::string> MeshPlaces::notes() const {
  std::vector<std::string> notes;
  if (!renamed_.empty())
    notes.push_back(
        "the names of these mesh files differ from the names in the robot's file only in upper and "
        "lower case, so Ayumi used the files: " +
        text::join(renamed_, ", ") + ". Correct the names in the robot's file");
  return notes;
}

}  // namespace ayumi
