#include "ayumi/render/scenery.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/render/log_reading.hpp"

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

/// A wall from the edge a-b of a field down or up to the plane, seen from both sides.
void add_skirt(Triangles& target, const Vector3d& a, const Vector3d& b, double floor) {
  const Vector3d c(b.x(), b.y(), floor), d(a.x(), a.y(), floor);
  if (std::abs(a.z() - floor) + std::abs(b.z() - floor) < 1e-9) return;
  add_face(target, {a, b, c, d}, kField);
  add_face(target, {b, a, d, c}, kField);
}

void add_field(Triangles& target, const HeightField& field, double floor, int max_nodes) {
  const Eigen::Index rows = field.heights.rows(), columns = field.heights.cols();
  const Eigen::Index step = 1 + (std::max(rows, columns) - 1) / std::max(2, max_nodes);
  const auto node = [&](Eigen::Index i, Eigen::Index j) {
    i = std::min(i, rows - 1);
    j = std::min(j, columns - 1);
    return Vector3d(field.origin.x() + field.spacing * double(i),
                    field.origin.y() + field.spacing * double(j), field.heights(i, j));
  };
  for (Eigen::Index i = 0; i + 1 < rows; i += step)
    for (Eigen::Index j = 0; j + 1 < columns; j += step) {
      add_face(target, {node(i, j), node(i + step, j), node(i + step, j + step)}, kField);
      add_face(target, {node(i, j), node(i + step, j + step), node(i, j + step)}, kField);
    }
  for (Eigen::Index i = 0; i + 1 < rows; i += step)
    for (const Eigen::Index j : {Eigen::Index(0), columns - 1})
      add_skirt(target, node(i, j), node(i + step, j), floor);
  for (Eigen::Index j = 0; j + 1 < columns; j += step)
    for (const Eigen::Index i : {Eigen::Index(0), rows - 1})
      add_skirt(target, node(i, j), node(i, j + step), floor);
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

Triangles make_scenery(const World& world, int max_nodes) {
  Triangles scenery;
  for (const FrictionPatch& patch : world.patches) add_patch(scenery, patch, world.height + 2e-4);
  for (const GroundBlock& block : world.blocks) add_block(scenery, block, world.height);
  for (const HeightField& field : world.fields) add_field(scenery, field, world.height, max_nodes);
  return scenery;
}

std::vector<RisingBump> rising_bumps(const RobotModel& model, const SimulationLog& log) {
  std::vector<RisingBump> bumps;
  for (const Disturbance& d : log.scenario) {
    const auto* source = std::get_if<Bump>(&d.what);
    if (!source) continue;
    const Vector2d& place = source->place;
    RisingBump bump = {{}, d.at, d.at + d.duration};
    bump.block.kind = GroundBlock::Kind::disc;
    bump.block.center = place;
    if (source->foot) {
      RobotData data(model);
      update_positions(model, sample_at(log, d.at).state, data);
      const Vector3d p = sole_pose(model, data, *source->foot) * Vector3d(place.x(), place.y(), 0);
      bump.block.center = (floor_at(log, d.at).inverse() * p).head<2>();
    }
    bump.block.radius = source->radius;
    bump.block.height = log.world.height + source->height;
    bumps.push_back(bump);
  }
  return bumps;
}

Triangles make_bumps(const std::vector<RisingBump>& bumps, double ground_height, double t) {
  Triangles out;
  for (const RisingBump& bump : bumps) {
    if (t < bump.begin || t >= bump.end) continue;
    GroundBlock block = bump.block;
    block.height = ground_height + (block.height - ground_height) * bump_share(t - bump.begin);
    if (block.height > ground_height) add_block(out, block, ground_height);
  }
  return out;
}

double bump_share(double since) {
  const double s = std::clamp(since / kBumpRise, 0.0, 1.0);
  return s * s * s * (10 - 15 * s + 6 * s * s);
}

}  // namespace ayumi
