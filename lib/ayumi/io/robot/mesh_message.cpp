#include "ayumi/io/robot/mesh_message.hpp"

#include <cmath>
#include <cstring>
#include <type_traits>

#include "ayumi/base/error.hpp"

namespace ayumi {

namespace {

struct PartHead {
  std::uint64_t vertices = 0, uvs = 0, triangles = 0, texture = 0;
  float color[4] = {};
  std::uint64_t has_color = 0;
};
static_assert(sizeof(PartHead) == 56);

// Largest difference of the length of a normal from 1. Chosen: float has 24 bits, so a normalized
// vector is far nearer to 1 than this.
constexpr float kUnitTolerance = 1e-3f;

template <typename Item>
void append(std::string& bytes, const Item* items, size_t count) {
  bytes.append(reinterpret_cast<const char*>(items), count * sizeof(Item));
}

class MeshDecoder {
 public:
  explicit MeshDecoder(std::string_view bytes) : left_(bytes) {}

  TriangleMesh decode() {
    std::uint64_t parts = 0;
    take(&parts, 1);
    // Each part has a head, so the number of remaining bytes bounds the count.
    if (parts > left_.size() / sizeof(PartHead)) complain("more parts than bytes");
    TriangleMesh mesh;
    for (part_ = 0; part_ < parts; ++part_) mesh.parts.push_back(decode_part());
    if (!left_.empty()) complain(std::to_string(left_.size()) + " bytes too many");
    if (mesh.parts.empty()) complain("no part");
    return mesh;
  }

 private:
  [[noreturn]] void complain(const std::string& what) const {
    fail(ErrorCode::bad_file, "part " + std::to_string(part_) + ": " + what);
  }

  template <typename Item>
  void take(Item* items, size_t count) {
    if (count > left_.size() / sizeof(Item)) complain("the data end too early");
    if (count > 0) std::memcpy(static_cast<void*>(items), left_.data(), count * sizeof(Item));
    left_.remove_prefix(count * sizeof(Item));
  }

  template <typename Item>
  void take(std::vector<Item>& items, size_t count) {
    if (count > left_.size() / sizeof(Item)) complain("the data end too early");
    items.resize(count);
    take(items.data(), count);
  }

  MeshPart decode_part() {
    PartHead head;
    take(&head, 1);
    MeshPart part;
    take(part.vertices, head.vertices);
    take(part.normals, head.vertices);
    take(part.uvs, head.uvs);
    take(part.triangles, head.triangles);
    if (head.texture > left_.size()) complain("the data end too early");
    part.texture_file = left_.substr(0, head.texture);
    left_.remove_prefix(head.texture);
    part.has_color = head.has_color != 0;
    for (int i = 0; i < 4; ++i) part.color[i] = head.color[i];
    check(part);
    return part;
  }

  void check(const MeshPart& part) {
    triangles_ += part.triangles.size();
    if (triangles_ > kMostMeshTriangles)
      complain("more than " + std::to_string(kMostMeshTriangles) + " triangles");
    if (part.triangles.empty()) complain("no triangle");
    if (!part.uvs.empty() && part.uvs.size() != part.vertices.size())
      complain(std::to_string(part.uvs.size()) + " texture coordinates for " +
               std::to_string(part.vertices.size()) + " vertices");
    for (size_t i = 0; i < part.vertices.size(); ++i) {
      if (!part.vertices[i].allFinite()) complain("vertex " + std::to_string(i) + " is not finite");
      if (!(std::abs(part.normals[i].norm() - 1) < kUnitTolerance))
        complain("normal " + std::to_string(i) + " is not a unit vector");
    }
    for (const Eigen::Vector2f& uv : part.uvs)
      if (!uv.allFinite()) complain("a texture coordinate is not finite");
    for (size_t i = 0; i < part.triangles.size(); ++i)
      for (const std::uint32_t corner : part.triangles[i])
        if (corner >= part.vertices.size())
          complain("triangle " + std::to_string(i) + " names vertex " + std::to_string(corner) +
                   " of " + std::to_string(part.vertices.size()));
    if (!part.color.allFinite()) complain("the colour is not finite");
    const std::string& texture = part.texture_file;
    if (!texture.empty() && texture[0] != kTextureName && texture[0] != kTextureBytes)
      complain("the texture is neither a name nor a picture");
    if (!texture.empty() && texture[0] == kTextureName && texture.find('\0') != std::string::npos)
      complain("the name of the texture has a zero byte");
  }

  std::string_view left_;
  std::uint64_t part_ = 0;
  size_t triangles_ = 0;
};

}  // namespace

std::string encode_mesh(const TriangleMesh& mesh) {
  static_assert(sizeof(Eigen::Vector3f) == 12 && sizeof(Eigen::Vector2f) == 8);
  size_t size = sizeof(std::uint64_t);
  for (const MeshPart& part : mesh.parts)
    size += sizeof(PartHead) + 24 * part.vertices.size() + 8 * part.uvs.size() +
            12 * part.triangles.size() + part.texture_file.size();
  std::string bytes;
  bytes.reserve(size);
  const std::uint64_t parts = mesh.parts.size();
  append(bytes, &parts, 1);
  for (const MeshPart& part : mesh.parts) {
    PartHead head{part.vertices.size(),
                  part.uvs.size(),
                  part.triangles.size(),
                  part.texture_file.size(),
                  {},
                  part.has_color ? 1u : 0u};
    for (int i = 0; i < 4; ++i) head.color[i] = part.color[i];
    append(bytes, &head, 1);
    append(bytes, part.vertices.data(), part.vertices.size());
    append(bytes, part.normals.data(), part.normals.size());
    append(bytes, part.uvs.data(), part.uvs.size());
    append(bytes, part.triangles.data(), part.triangles.size());
    bytes += part.texture_file;
  }
  return bytes;
}

TriangleMesh decode_mesh(std::string_view bytes) { return MeshDecoder(bytes).decode(); }

}  // namespace ayumi
