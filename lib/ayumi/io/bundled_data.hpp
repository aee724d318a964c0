#pragma once
// The folders of robots, patterns and examples that belong to Ayumi.

#include <filesystem>
#include <string>

namespace ayumi {

/// The folder `name` ("robots", "patterns", "examples"). It is searched in three places:
/// share/ayumi of the folder below which `binary` (the program or the Python module) is installed,
/// the sources, and the place where the build was to be installed.
std::filesystem::path bundled_data(const std::filesystem::path& binary, const std::string& name);

}  // namespace ayumi
