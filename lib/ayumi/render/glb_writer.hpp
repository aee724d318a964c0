#pragma once
// The bytes of a binary glTF file as its parts are added: accessors, materials, pictures.

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "ayumi/base/text.hpp"

namespace ayumi::glb {

using Color = std::array<std::uint8_t, 4>;  ///< sRGB and alpha

/// A list of numbers as text, such as "[1,2.5]".
template <typename Values>
std::string list(const Values& values) {
  std::string out = "[";
  for (const auto& value : values) out += (out.size() > 1 ? "," : "") + text::exact(value);
  return out + "]";
}
std::string quoted(const std::string& text);
/// The text ",\"key\":[items]", or an empty text if there are no items.
std::string joined(const std::string& key, const std::vector<std::string>& items);

/// The members of the file while it grows. Each call returns the number of the part that it added.
class Writer {
 public:
  /// Adds `components` values for each entry. With `with_bounds`, the least and largest values are
  /// written, which glTF requires in some places.
  int add_floats(const std::vector<float>& values, int components, bool vertices, bool with_bounds);
  int add_indices(const std::vector<std::uint32_t>& values);
  /// Returns the same number again for the same colour.
  int material(const Color& color, bool double_sided);
  /// A material with the picture of a mesh. If there is no picture to embed, it is the same as
  /// `material`.
  int material(const Color& color, const std::string& texture);

  /// The whole file, with the text of its nodes (the first is the scene's root) and animations.
  std::string file(const std::string& nodes, const std::string& animations) const;
  std::vector<std::string> meshes;  ///< meshes as JSON

 private:
  std::string binary_;
  std::vector<std::string> views_, accessors_, materials_, images_, textures_;
  std::map<std::pair<Color, bool>, int> known_materials_;
  std::map<std::pair<Color, std::string>, int> known_textured_;

  int add_view(const void* data, size_t bytes, int target);
};

}  // namespace ayumi::glb
