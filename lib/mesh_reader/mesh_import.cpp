// Each node of the scene carries T = T_parent T_node. A vertex becomes s (T v) with the scale s per
// axis, and a normal becomes the unit vector along (s T)^-T n. If det(s T) < 0, the triangles are
// turned.

#include "mesh_import.hpp"

#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "ayumi/io/robot/mesh_message.hpp"
#include "collada_check.hpp"
#include "companion_files.hpp"
#include "corners.hpp"

namespace ayumi::mesh_reader {

namespace {

namespace fs = std::filesystem;

std::string lower_extension(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension;
}

Eigen::Matrix4d matrix(const aiMatrix4x4& m) {
  Eigen::Matrix4d result;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) result(row, column) = m[row][column];
  return result;
}

Eigen::Vector3d vector(const aiVector3D& v) { return {v.x, v.y, v.z}; }

float srgb(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

class Collector {
 public:
  Collector(const aiScene& scene, std::string extension, const Eigen::Vector3d& scale)
      : scene_(scene), extension_(std::move(extension)), scale_(scale.asDiagonal()) {}

  TriangleMesh collect() {
    add_node(*scene_.mRootNode, Eigen::Matrix4d::Identity());
    return std::move(mesh_);
  }

 private:
  void add_node(const aiNode& node, const Eigen::Matrix4d& parent) {
    const Eigen::Matrix4d transform = parent * matrix(node.mTransformation);
    for (unsigned i = 0; i < node.mNumMeshes; ++i)
      add_mesh(*scene_.mMeshes[node.mMeshes[i]], transform);
    for (unsigned i = 0; i < node.mNumChildren; ++i) add_node(*node.mChildren[i], transform);
  }

  void add_mesh(const aiMesh& source, const Eigen::Matrix4d& transform) {
    const Eigen::Matrix3d turn = scale_ * transform.topLeftCorner<3, 3>();
    const Eigen::Vector3d shift = scale_ * transform.topRightCorner<3, 1>();
    if (std::abs(turn.determinant()) < 1e-30)
      throw Refusal("a scale of zero flattens the mesh; give a scale other than 0");
    const Eigen::Matrix3d normal_turn = turn.inverse().transpose();
    MeshPart part;
    for (unsigned i = 0; i < source.mNumVertices; ++i) {
      part.vertices.push_back((turn * vector(source.mVertices[i]) + shift).cast<float>());
      if (!part.vertices.back().allFinite())
        throw Refusal("a vertex is not finite; repair the mesh");
      Eigen::Vector3d normal = Eigen::Vector3d::Zero();
      // STL has one normal per facet, which is often zero. With these normals, round surfaces would
      // look faceted.
      if (source.HasNormals() && extension_ != ".stl")
        normal = normal_turn * vector(source.mNormals[i]);
      const bool usable = std::isfinite(normal.norm()) && normal.norm() > 1e-12;
      part.normals.emplace_back(usable ? normal.normalized().cast<float>().eval()
                                       : Eigen::Vector3f::Zero().eval());
      if (source.HasTextureCoords(0))
        part.uvs.emplace_back(source.mTextureCoords[0][i].x, source.mTextureCoords[0][i].y);
      if (source.HasTextureCoords(0) && !part.uvs.back().allFinite()) part.uvs.back().setZero();
    }
    add_triangles(source, turn.determinant() < 0, part);
    finish_corners(part);
    add_material(source, part);
    if (!part.triangles.empty()) mesh_.parts.push_back(std::move(part));
  }

  void add_triangles(const aiMesh& source, bool mirrored, MeshPart& part) {
    for (unsigned i = 0; i < source.mNumFaces; ++i) {
      const aiFace& face = source.mFaces[i];
      if (face.mNumIndices != 3) continue;
      std::array<std::uint32_t, 3> corners = {face.mIndices[0], face.mIndices[1], face.mIndices[2]};
      for (const std::uint32_t corner : corners)
        if (corner >= part.vertices.size())
          throw Refusal("a triangle names a vertex that does not exist; export the mesh again");
      if (mirrored) std::swap(corners[1], corners[2]);
      part.triangles.push_back(corners);
    }
    total_ += part.triangles.size();
    if (total_ > kMostMeshTriangles)
      throw Refusal("the mesh has more than " + std::to_string(kMostMeshTriangles) +
                    " triangles; simplify the mesh");
  }

  void add_material(const aiMesh& source, MeshPart& part) const {
    if (source.mMaterialIndex >= scene_.mNumMaterials) return;
    const aiMaterial& material = *scene_.mMaterials[source.mMaterialIndex];
    aiString name;
    material.Get(AI_MATKEY_NAME, name);
    const bool invented =
        extension_ == ".stl" || std::strcmp(name.C_Str(), AI_DEFAULT_MATERIAL_NAME) == 0;
    aiColor4D color;
    if (!invented && material.Get(AI_MATKEY_COLOR_DIFFUSE, color) == AI_SUCCESS) {
      const bool linear = extension_ == ".gltf" || extension_ == ".glb";
      part.color = {color.r, color.g, color.b, color.a};
      if (linear) part.color.head<3>() = part.color.head<3>().unaryExpr(&srgb).eval();
      float opacity = 1;
      if (extension_ == ".obj" && material.Get(AI_MATKEY_OPACITY, opacity) == AI_SUCCESS)
        part.color[3] = opacity;
      part.has_color = part.color.allFinite();
      if (!part.has_color) part.color = MeshPart().color;
    }
    aiString texture;
    if (material.GetTexture(aiTextureType_DIFFUSE, 0, &texture) == AI_SUCCESS && texture.length > 0)
      part.texture_file = texture_of(texture.C_Str());
  }

  // The name of a file, or the bytes of a picture inside the mesh; empty for bare texels.
  std::string texture_of(const std::string& name) const {
    const aiTexture* inside = scene_.GetEmbeddedTexture(name.c_str());
    if (!inside) return kTextureName + name;
    if (inside->mHeight > 0) return "";
    return kTextureBytes + std::string(reinterpret_cast<char*>(inside->pcData), inside->mWidth);
  }

  const aiScene& scene_;
  std::string extension_;
  Eigen::Matrix3d scale_;
  TriangleMesh mesh_;
  size_t total_ = 0;
};

}  // namespace

TriangleMesh import_mesh(const std::string& name, const std::string& bytes,
                         const Eigen::Vector3d& scale, const AskFile& ask) {
  const std::string extension = lower_extension(name);
  if (extension == ".dae") check_collada(bytes);
  Assimp::Importer importer;
  importer.SetIOHandler(new CompanionFiles(name, bytes, ask));  // the importer owns it
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                              aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  // assimp makes no normals and does not join vertices: its search for points at the same place
  // takes half of the time of reading a large mesh.
  constexpr unsigned kSteps = aiProcess_Triangulate | aiProcess_SortByPType;
  const aiScene* scene = nullptr;
  std::string reason;
  try {
    scene = importer.ReadFile(CompanionFiles::path_of(name), kSteps);
    reason = importer.GetErrorString();
  } catch (const std::exception& error) {
    reason = error.what();
  }
  if (!scene || !scene->mRootNode)
    throw Refusal("the file cannot be read as a mesh (" + reason +
                  "); export the mesh again as STL, OBJ, COLLADA or glTF");
  TriangleMesh mesh = Collector(*scene, extension, scale).collect();
  if (mesh.parts.empty()) throw Refusal("the mesh has no triangle; export the mesh again");
  return mesh;
}

}  // namespace ayumi::mesh_reader
