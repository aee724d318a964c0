#pragma once
// The robot as triangles of each body, and the poses of its bodies.

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "ayumi/dynamics/robot_data.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/render/triangles.hpp"

namespace ayumi {

/// Triangles with a picture on them; seen from both sides.
struct TexturedSurface {
  Triangles triangles;
  std::string texture;  ///< as MeshPart::texture_file
};

/// The visible surface of one body, in the body frame.
struct BodySurface {
  Triangles closed;  ///< outside counter-clockwise; back faces need no drawing
  Triangles open;    ///< to be seen from both sides
  std::vector<TexturedSurface> textured;
};

/// One per body: the visuals of its links, or the collision shapes of a robot without any visual,
/// and sticks to the next joints where such a body has no shape either. A colour set on a visual
/// goes before the mesh's own and its texture; grey where neither is stated.
std::vector<BodySurface> robot_surface(const RobotModel& model);

/// Whether any link has a visual.
bool has_visuals(const RobotModel& model);

/// All its triangles, whatever they look like.
std::vector<const Triangles*> parts_of(const BodySurface& body);

/// Body frames in the world, one per body.
std::vector<Eigen::Isometry3d> body_poses(const RobotModel& model, const RobotState& state);
/// The same for many states: `data` is a workspace of the model.
std::vector<Eigen::Isometry3d> body_poses(const RobotModel& model, const RobotState& state,
                                          RobotData& data);

/// Axis-aligned bounds in the world [m].
Eigen::AlignedBox3d robot_bounds(const std::vector<BodySurface>& surface,
                                 const std::vector<Eigen::Isometry3d>& poses);

/// The largest edge of these bounds in a posture [m]; 1 where nothing is drawn.
double robot_extent(const std::vector<BodySurface>& surface, const RobotModel& model,
                    const RobotState& state);

}  // namespace ayumi
