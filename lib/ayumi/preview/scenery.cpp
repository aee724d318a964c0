#include "ayumi/preview/scenery.hpp"

#include <algorithm>
#include <array>

#include "ayumi/math/rotation.hpp"

namespace ayumi {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector4f;

const Vector4f kBlock = {0.66f, 0.60f, 0.50f, 1};
const Vector4f kField = {0.62f, 0.63f, 0.58f, 1};

/// A flat polygon with a normal of its own, anticlockwise seen from outside.
void add_face(Triangles& target, const std::vector<Vector3d>& corners, const Vector4f& color) {
  const auto first = static_cast<std::uint32_t>(target.vertices.size());
  add_polygon(target, corners, color);
  const Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  for (size_t i = first; i < target.vertices.size(); ++i)
    target.vertices[i].normal = normal.cast<float>();
}

void add_block(Triangles& target, const GroundBlock& block, double floor) {
  std::array<Vector2d, 8> corners;
  const auto count = static_cast<size_t>(block_corners(block, corners));
  std::vector<Vector3d> top;
  for (size_t i = 0; i < count; ++i) top.emplace_back(corners[i].x(), corners[i].y(), block.height);
  add_face(target, top, kBlock);
  for (size_t i = 0; i < count; ++i) {
    const Vector3d &a = top[i], &b = top[(i + 1) % count];
    add_face(target, {Vector3d(a.x(), a.y(), floor), Vector3d(b.x(), b.y(), floor), b, a}, kBlock);
  }
}

void add_field(Triangles& target, const HeightField& field) {
  const auto node = [&](Eigen::Index i, Eigen::Index j) {
    return Vector3d(field.origin.x() + field.spacing * double(i),
                    field.origin.y() + field.spacing * double(j), field.heights(i, j));
  };
  for (Eigen::Index i = 0; i + 1 < field.heights.rows(); ++i)
    for (Eigen::Index j = 0; j + 1 < field.heights.cols(); ++j) {
      add_face(target, {node(i, j), node(i + 1, j), node(i + 1, j + 1)}, kField);
      add_face(target, {node(i, j), node(i + 1, j + 1), node(i, j + 1)}, kField);
    }
}

void add_patch(Triangles& target, const FrictionPatch& patch, double floor) {
  const auto share = static_cast<float>(std::clamp(patch.friction, 0.0, 1.0));
  const Vector4f color = {0.45f * share + 0.2f, 0.45f * share + 0.3f, 0.3f * share + 0.5f, 0.9f};
  const Vector2d &a = patch.low, &b = patch.high;
  add_face(target,
           {Vector3d(a.x(), a.y(), floor), Vector3d(b.x(), a.y(), floor),
            Vector3d(b.x(), b.y(), floor), Vector3d(a.x(), b.y(), floor)},
           color);
}

}  // namespace

Triangles make_scenery(const World& world) {
  Triangles local;
  for (const FrictionPatch& patch : world.patches) add_patch(local, patch, world.height + 2e-4);
  for (const GroundBlock& block : world.blocks) add_block(local, block, world.height);
  for (const HeightField& field : world.fields) add_field(local, field);
  Eigen::Isometry3d slope = Eigen::Isometry3d::Identity();
  slope.linear() = exp_rotation(Vector3d(world.slope.x(), world.slope.y(), 0)).toRotationMatrix();
  Triangles scenery;
  append(scenery, local, slope);
  return scenery;
}

}  // namespace ayumi
