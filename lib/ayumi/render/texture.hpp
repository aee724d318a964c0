#pragma once
// Pictures on the surfaces of meshes: PNG and JPEG.

#include <cstdint>
#include <string>
#include <vector>

namespace ayumi {

struct Texture {
  int width = 1, height = 1;                              ///< size [pixel]
  std::vector<std::uint8_t> rgba = {255, 255, 255, 255};  ///< rows from the bottom
};

constexpr int kLargestTexture = 2048;  ///< larger textures are halved until they fit [pixel]

/// The picture in the file that `file` names, or, if `file` begins with "data:", in the bytes after
/// that. A picture that cannot be read is white. If there is only a file whose name differs by
/// case, this file is read. In both cases, `notes` says so.
Texture read_texture(const std::string& file, std::vector<std::string>& notes);

/// The bytes that read_texture() decodes; empty if there is no such file.
std::string texture_bytes(const std::string& file, std::vector<std::string>& notes);

}  // namespace ayumi
