#pragma once
// The folders of robots, patterns and examples that belong to Ayumi.

#include <filesystem>
#include <string>

namespace ayumi {

/// The folder `name` ("robots", "patterns", "examples"): in share/ayumi of the folder below which
/// `binary` (the program, the Python module) is installed; else that of the sources; else where the
/// build was to be installed.
std::filesystem::path bundled_data(const std::filesystem::path& binary, const std::string& name);

}  // namespace ayumi
