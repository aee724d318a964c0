#include "ayumi/render/glb_writer.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/render/texture.hpp"

namespace ayumi::glb {
namespace {

// Numbers of the glTF 2.0 specification.
constexpr int kByte4 = 5126, kUnsigned = 5125;              // FLOAT, UNSIGNED_INT
constexpr int kVertexTarget = 34962, kIndexTarget = 34963;  // ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER

double linear(std::uint8_t srgb) {
  const double c = srgb / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

/// Six digits are more than the precision of eight bits of colour.
double rounded(double value) { return std::round(1e6 * value) / 1e6; }

}  // namespace

std::string quoted(const std::string& text) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      out += {'\\', c};
    else if (byte < 0x20)
      out += std::string("\\u00") + kDigits[byte / 16] + kDigits[byte % 16];
    else
      out += c;
  }
  return out + '"';
}

std::string joined(const std::string& key, const std::vector<std::string>& items) {
  return items.empty() ? "" : ",\"" + key + "\":[" + text::join(items, ",") + "]";
}

int Writer::add_view(const void* data, size_t bytes, int target) {
  std::string view = "{\"buffer\":0,\"byteOffset\":" + std::to_string(binary_.size()) +
                     ",\"byteLength\":" + std::to_string(bytes);
  if (target) view += ",\"target\":" + std::to_string(target);
  views_.push_back(view + "}");
  binary_.append(static_cast<const char*>(data), bytes);
  binary_.append((4 - bytes % 4) % 4, '\0');
  return static_cast<int>(views_.size()) - 1;
}

int Writer::add_floats(const std::vector<float>& values, int components, bool vertices,
                       bool with_bounds) {
  const int view =
      add_view(values.data(), values.size() * sizeof(float), vertices ? kVertexTarget : 0);
  constexpr const char* kTypes[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
  const auto width = static_cast<size_t>(components);
  std::string accessor = "{\"bufferView\":" + std::to_string(view) +
                         ",\"componentType\":" + std::to_string(kByte4) +
                         ",\"count\":" + std::to_string(values.size() / width) + ",\"type\":\"" +
                         kTypes[components] + "\"";
  if (with_bounds) {
    std::vector<double> low(values.begin(), values.begin() + components), high = low;
    for (size_t i = 0; i < values.size(); ++i) {
      low[i % width] = std::min(low[i % width], double(values[i]));
      high[i % width] = std::max(high[i % width], double(values[i]));
    }
    accessor += ",\"min\":" + list(low) + ",\"max\":" + list(high);
  }
  accessors_.push_back(accessor + "}");
  return static_cast<int>(accessors_.size()) - 1;
}

int Writer::add_indices(const std::vector<std::uint32_t>& values) {
  const int view = add_view(values.data(), 4 * values.size(), kIndexTarget);
  accessors_.push_back("{\"bufferView\":" + std::to_string(view) +
                       ",\"componentType\":" + std::to_string(kUnsigned) +
                       ",\"count\":" + std::to_string(values.size()) + ",\"type\":\"SCALAR\"}");
  return static_cast<int>(accessors_.size()) - 1;
}

int Writer::material(const Color& color, bool double_sided) {
  const auto [entry, fresh] =
      known_materials_.emplace(std::pair(color, double_sided), static_cast<int>(materials_.size()));
  if (!fresh) return entry->second;
  const std::array<double, 4> factor = {rounded(linear(color[0])), rounded(linear(color[1])),
                                        rounded(linear(color[2])), rounded(color[3] / 255.0)};
  std::string words = "{\"pbrMetallicRoughness\":{\"baseColorFactor\":" + list(factor) +
                      ",\"metallicFactor\":0,\"roughnessFactor\":0.7}";
  if (color[3] < 255) words += ",\"alphaMode\":\"BLEND\"";
  if (double_sided) words += ",\"doubleSided\":true";
  materials_.push_back(words + "}");
  return entry->second;
}

int Writer::material(const Color& color, const std::string& texture) {
  const auto known = known_textured_.find({color, texture});
  if (known != known_textured_.end()) return known->second;
  std::vector<std::string> notes;
  const std::string bytes = texture_bytes(texture, notes);
  const bool png = bytes.starts_with("\x89PNG");
  if (!png && !bytes.starts_with("\xff\xd8")) return material(color, true);
  const int view = add_view(bytes.data(), bytes.size(), 0);
  textures_.push_back("{\"source\":" + std::to_string(images_.size()) + "}");
  images_.push_back("{\"bufferView\":" + std::to_string(view) + ",\"mimeType\":\"image/" +
                    (png ? "png" : "jpeg") + "\"}");
  materials_.push_back("{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":" +
                       std::to_string(textures_.size() - 1) +
                       "},\"metallicFactor\":0,\"roughnessFactor\":0.7},\"doubleSided\":true}");
  return known_textured_[{color, texture}] = static_cast<int>(materials_.size()) - 1;
}

std::string Writer::file(const std::string& nodes, const std::string& animations) const {
  std::string json =
      "{\"asset\":{\"version\":\"2.0\",\"generator\":\"ayumi\"},\"scene\":0,"
      "\"scenes\":[{\"nodes\":[0]}],\"nodes\":" +
      nodes + animations + joined("meshes", meshes) + joined("materials", materials_) +
      joined("textures", textures_) + joined("images", images_) + joined("accessors", accessors_) +
      joined("bufferViews", views_);
  if (!binary_.empty())
    json += ",\"buffers\":[{\"byteLength\":" + std::to_string(binary_.size()) + "}]";
  json += "}";
  json.append((4 - json.size() % 4) % 4, ' ');
  std::string bytes;
  const auto word = [&](size_t value) {
    const auto small = static_cast<std::uint32_t>(value);
    bytes.append(reinterpret_cast<const char*>(&small), 4);
  };
  const size_t binary_chunk = binary_.empty() ? 0 : 8 + binary_.size();
  word(0x46546C67);  // "glTF"
  word(2);
  word(12 + 8 + json.size() + binary_chunk);
  word(json.size());
  word(0x4E4F534A);  // "JSON"
  bytes += json;
  if (binary_chunk == 0) return bytes;
  word(binary_.size());
  word(0x004E4942);  // "BIN"
  return bytes + binary_;
}

}  // namespace ayumi::glb
