#pragma once
// Reading and writing of whole files.

#include <filesystem>
#include <functional>
#include <string>

namespace ayumi {

/// Returns the bytes of a regular file. Throws Error(bad_file) with the path and the reason if it
/// is missing, a directory, a device, a named pipe, a socket, unreadable, or larger than
/// `max_bytes`. It never waits. Every reader of Ayumi opens files with this function.
std::string read_file(const std::filesystem::path& path, size_t max_bytes = size_t{1} << 30);

/// Throws Error(bad_file) with the path if no regular file can be written there. This is so if the
/// path is a folder, a device, a named pipe, a socket or a symbolic link, or if its folder does not
/// exist. Symbolic links are neither replaced nor followed.
void require_file_target(const std::filesystem::path& path);

/// Throws Error(bad_file) if something exists at `path`, even a symbolic link to nowhere.
void refuse_existing(const std::filesystem::path& path);

/// Writes the whole file or nothing: it writes to a temporary name beside the file, which is then
/// renamed. Throws Error(bad_file) with the path and the reason, and in the same cases as
/// require_file_target(); an older file at `path` is then untouched.
void write_file(const std::filesystem::path& path, const std::string& bytes);

/// Calls `produce` with a temporary path (same folder, same extension), and then renames that file
/// to `path`. It is meant for writers that need a path of their own. It removes the temporary file
/// if `produce` throws.
void write_file_with(const std::filesystem::path& path,
                     const std::function<void(const std::filesystem::path&)>& produce);

}  // namespace ayumi
