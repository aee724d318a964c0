#include "ayumi/render/robot_surface.hpp"

#include <algorithm>

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/render/simplify.hpp"

namespace ayumi {
namespace {

constexpr double kStick = 0.06;  // radius of sticks, as a share of the length of the longest one

void add_surface(BodySurface& body, Triangles surface, const Eigen::Isometry3d& pose) {
  Triangles& target = orient(surface) == SurfaceKind::closed ? body.closed : body.open;
  append(target, surface, pose);
}

void add_shape(BodySurface& body, const PlacedShape& placed, const Eigen::Isometry3d& link_pose) {
  const Eigen::Isometry3d pose = link_pose * placed.pose;
  const auto* mesh = std::get_if<MeshShape>(&placed.shape);
  if (!mesh) {
    add_surface(body, tessellate(placed.shape, placed.color), pose);
    return;
  }
  for (const MeshPart& part : mesh->mesh.parts) {
    const bool textured =
        !part.texture_file.empty() && !placed.has_color && part.uvs.size() == part.vertices.size();
    if (textured) {
      // The picture's own colours. They are not multiplied by a colour that only stands for "none".
      const Eigen::Vector4f white(1, 1, 1, part.has_color ? part.color[3] : 1.0f);
      Triangles surface = tessellate(part, white);
      orient(surface);
      body.textured.push_back({{}, part.texture_file});
      append(body.textured.back().triangles, surface, pose);
      continue;
    }
    const Eigen::Vector4f color = placed.has_color || !part.has_color ? placed.color : part.color;
    add_surface(body, tessellate(part, color), pose);
  }
}

bool is_bare(const BodySurface& body) {
  return body.closed.indices.empty() && body.open.indices.empty() && body.textured.empty();
}

/// Adds sticks from the frame of each body without a shape to the frames of the bodies that are
/// attached to it.
void add_sticks(const RobotModel& model, std::vector<BodySurface>& surface) {
  const auto length = [](const Body& body) { return body.placement.translation().norm(); };
  double longest = 0;
  std::vector<bool> bare;
  for (const BodySurface& body : surface) bare.push_back(is_bare(body));
  for (const Body& body : model.bodies())
    if (body.parent >= 0) longest = std::max(longest, length(body));
  for (const Body& body : model.bodies())
    if (body.parent >= 0 && bare[size_t(body.parent)] && length(body) > 1e-6)
      add_rod(surface[size_t(body.parent)].open, Eigen::Vector3d::Zero(),
              body.placement.translation(), kStick * longest, PlacedShape().color);
}

/// The visuals of all bodies.
std::vector<BodySurface> visual_surface(const RobotModel& model) {
  std::vector<BodySurface> surface(model.bodies().size());
  for (const Link& link : model.links())
    for (const PlacedShape& placed : link.visuals)
      add_shape(surface[size_t(link.body)], placed, link.pose);
  return surface;
}

/// Draws links and bodies that have no visuals: with their collision shapes, or else with sticks. A
/// body may consist of several links. If the files of all visuals were found, a link without a
/// visual beside one that has a visual is meant to be invisible.
void add_substitutes(const RobotModel& model, std::vector<BodySurface>& surface) {
  const bool missing = !model.description().missing_meshes.empty();
  std::vector<bool> bare;
  for (const BodySurface& body : surface) bare.push_back(is_bare(body));
  for (const Link& link : model.links())
    if (link.visuals.empty() && (missing || bare[size_t(link.body)]))
      for (const PlacedShape& placed : link.collisions)
        add_shape(surface[size_t(link.body)], placed, link.pose);
  add_sticks(model, surface);
}

}  // namespace

bool has_visuals(const RobotModel& model) {
  return std::any_of(model.links().begin(), model.links().end(),
                     [](const Link& link) { return !link.visuals.empty(); });
}

std::vector<BodySurface> robot_surface(const RobotModel& model) {
  std::vector<BodySurface> surface = visual_surface(model);
  add_substitutes(model, surface);
  return surface;
}

int count_substitutes(const RobotModel& model) {
  const std::vector<BodySurface> visuals = visual_surface(model);
  std::vector<BodySurface> surface = visuals;
  add_substitutes(model, surface);
  int count = 0;
  for (size_t i = 0; i < surface.size(); ++i)
    if (triangle_count({surface[i]}) > triangle_count({visuals[i]})) ++count;
  return count;
}

std::vector<const Triangles*> parts_of(const BodySurface& body) {
  std::vector<const Triangles*> parts = {&body.closed, &body.open};
  for (const TexturedSurface& surface : body.textured) parts.push_back(&surface.triangles);
  return parts;
}

std::vector<Eigen::Isometry3d> body_poses(const RobotModel& model, const RobotState& state) {
  RobotData data(model);
  return body_poses(model, state, data);
}

std::vector<Eigen::Isometry3d> body_poses(const RobotModel& model, const RobotState& state,
                                          RobotData& data) {
  update_positions(model, state, data);
  std::vector<Eigen::Isometry3d> poses;
  for (size_t i = 0; i < model.bodies().size(); ++i)
    poses.push_back(data.pose(static_cast<int>(i)));
  return poses;
}

Eigen::AlignedBox3d robot_bounds(const std::vector<BodySurface>& surface,
                                 const std::vector<Eigen::Isometry3d>& poses) {
  Eigen::AlignedBox3d box;
  for (size_t i = 0; i < surface.size(); ++i)
    for (const Triangles* part : parts_of(surface[i]))
      for (const RenderVertex& vertex : part->vertices)
        box.extend((poses[i] * vertex.position.cast<double>()).eval());
  return box;
}

double robot_extent(const std::vector<BodySurface>& surface, const RobotModel& model,
                    const RobotState& state) {
  const Eigen::AlignedBox3d box = robot_bounds(surface, body_poses(model, state));
  return box.isEmpty() ? 1.0 : std::max(1e-3, box.sizes().maxCoeff());
}

}  // namespace ayumi
