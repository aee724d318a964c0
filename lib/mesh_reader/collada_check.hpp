#pragma once
// Checks numbers of a COLLADA file that assimp does not check.

#include <string>

namespace ayumi::mesh_reader {

/// assimp does not compare COLLADA's counts, indices, strides and offsets with the data: a wrong
/// number can fill the memory or make assimp read beyond the data. Throws Refusal if a count or an
/// index exceeds the number of bytes, or if an accessor reaches beyond its array.
void check_collada(const std::string& bytes);

}  // namespace ayumi::mesh_reader
