#pragma once
// Pictures on the surfaces of meshes: PNG and JPEG.

#include <cstdint>
#include <string>
#include <vector>

namespace ayumi {

struct Texture {
  int width = 1, height = 1;                              ///< [pixel]
  std::vector<std::uint8_t> rgba = {255, 255, 255, 255};  ///< rows from the bottom
};

constexpr int kLargestTexture = 2048;  ///< larger ones are halved until they fit [pixel]

/// The picture `file` names, or, where it begins with "data:", the bytes behind
/// that. One that cannot be read is white, and `notes` says so; a file whose
/// name differs only by case is taken, and `notes` says that too.
Texture read_texture(const std::string& file, std::vector<std::string>& notes);

/// The bytes that read_texture() decodes; empty where there is no such file.
std::string texture_bytes(const std::string& file, std::vector<std::string>& notes);

}  // namespace ayumi
