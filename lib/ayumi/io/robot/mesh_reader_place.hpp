#pragma once
// The place of the program ayumi-mesh-reader.

#include <filesystem>
#include <vector>

namespace ayumi {

/// The places where ayumi-mesh-reader may be, the preferred one first: the file that the
/// environment variable AYUMI_MESH_READER names, and no other where it is set; else beside the file
/// that holds this library (the program or the Python module); libexec/ayumi of the folders above
/// it; the build folder; libexec/ayumi where the build was to be installed, of /usr, and of
/// /usr/local.
std::vector<std::filesystem::path> mesh_reader_places();

/// The first of those places at which there is a file. Throws Error(bad_file), which names all of
/// them and what to do.
std::filesystem::path find_mesh_reader();

}  // namespace ayumi
