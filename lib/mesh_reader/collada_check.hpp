#pragma once
// Numbers of a COLLADA file that assimp believes.

#include <string>

namespace ayumi::mesh_reader {

/// assimp does not compare COLLADA's counts, indices, strides and offsets with the data: a wrong
/// one fills the memory or reads beyond the numbers. Throws Refusal where a count or an index
/// exceeds the number of bytes, and where an accessor reaches beyond its array.
void check_collada(const std::string& bytes);

}  // namespace ayumi::mesh_reader
