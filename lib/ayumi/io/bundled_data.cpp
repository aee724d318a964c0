#include "ayumi/io/bundled_data.hpp"

namespace ayumi {

namespace fs = std::filesystem;

fs::path bundled_data(const fs::path& binary, const std::string& name) {
  std::error_code ignored;
  // Largest number of folders above the program or module that are searched. bin/ayumi is one
  // folder below the installation, lib/python3/dist-packages/ayumi/... is four folders below it.
  constexpr int kDeepest = 5;
  fs::path above = binary.parent_path();
  for (int i = 0; i < kDeepest && above.has_relative_path(); ++i) {
    above = above.parent_path();
    const fs::path folder = above / "share" / "ayumi" / name;
    if (fs::is_directory(folder, ignored)) return folder;
  }
  const fs::path source = fs::path(AYUMI_SOURCE_DIR) / name;
  return fs::is_directory(source, ignored) ? source : fs::path(AYUMI_INSTALLED_DATA) / name;
}

}  // namespace ayumi
