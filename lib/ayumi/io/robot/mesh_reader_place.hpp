#pragma once
// The place of the program ayumi-mesh-reader.

#include <filesystem>
#include <vector>

namespace ayumi {

/// The places where ayumi-mesh-reader may be, the preferred one first. If the environment variable
/// AYUMI_MESH_READER is set, this is only the file that it names. Otherwise they are: beside the
/// file that contains this library (the program or the Python module); libexec/ayumi of the folders
/// above it; the build folder; and libexec/ayumi of the place where the build was to be installed,
/// of /usr, and of /usr/local.
std::vector<std::filesystem::path> mesh_reader_places();

/// The first of these places at which there is a file. Throws Error(bad_file), which names all of
/// them and what to do.
std::filesystem::path find_mesh_reader();

/// The library assimp with which ayumi-mesh-reader was built. It need not be there now: an archive
/// has a copy of its own beside the program.
std::filesystem::path assimp_library();

}  // namespace ayumi
