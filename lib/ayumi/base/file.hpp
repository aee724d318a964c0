#pragma once
// Whole files in, whole files out.

#include <filesystem>
#include <functional>
#include <string>

namespace ayumi {

/// The bytes of a regular file. Throws Error(bad_file) naming the path and the reason when it is
/// missing, a directory, unreadable, or larger than `max_bytes`.
std::string read_file(const std::filesystem::path& path, size_t max_bytes = size_t{1} << 30);

/// Writes the whole file or nothing: into a temporary name beside it, then renamed. Throws
/// Error(bad_file) naming the path and the reason; an older file at `path` is then untouched.
void write_file(const std::filesystem::path& path, const std::string& bytes);

/// Calls `produce` with a temporary path (same folder, same extension), then renames it to `path`.
/// For writers that need a path of their own. Removes the temporary file when `produce` throws.
void write_file_with(const std::filesystem::path& path,
                     const std::function<void(const std::filesystem::path&)>& produce);

}  // namespace ayumi
