#pragma once
// Files that only their owner may read.

#include <filesystem>
#include <string_view>

namespace ayumi {

/// Writes or replaces a file that only its owner may read, whole or not at all. The result is false
/// if that is not possible.
bool write_private_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace ayumi
