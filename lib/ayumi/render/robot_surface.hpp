#pragma once
// The robot as triangles of each body, and the poses of its bodies.

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "ayumi/dynamics/robot_data.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/render/triangles.hpp"

namespace ayumi {

/// Triangles with a picture on them, which are seen from both sides.
struct TexturedSurface {
  Triangles triangles;
  std::string texture;  ///< file of the picture, as MeshPart::texture_file
};

/// The visible surface of one body, in the body frame.
struct BodySurface {
  Triangles closed;  ///< the outside is counter-clockwise; back faces need no drawing
  Triangles open;    ///< surfaces that are to be seen from both sides
  std::vector<TexturedSurface> textured;
};

/// The surfaces of all bodies: the visuals of their links. A body without a visual is drawn with
/// its collision shapes. A body without any shape is drawn as sticks to the next joints. If meshes
/// of the robot are missing, every link without a visual is drawn with its collision shapes. A
/// colour that is set on a visual has priority over the mesh's own colour and its texture. If no
/// colour is given, the surface is grey.
std::vector<BodySurface> robot_surface(const RobotModel& model);

/// The number of bodies that are drawn with more than their visuals.
int count_substitutes(const RobotModel& model);

/// Whether any link has a visual.
bool has_visuals(const RobotModel& model);

/// All triangles of a body, whatever they look like.
std::vector<const Triangles*> parts_of(const BodySurface& body);

/// The frames of the bodies in the world, one per body.
std::vector<Eigen::Isometry3d> body_poses(const RobotModel& model, const RobotState& state);
/// The frames, for calls with many states: `data` is a workspace of the model.
std::vector<Eigen::Isometry3d> body_poses(const RobotModel& model, const RobotState& state,
                                          RobotData& data);

/// The axis-aligned bounds of the robot in the world [m].
Eigen::AlignedBox3d robot_bounds(const std::vector<BodySurface>& surface,
                                 const std::vector<Eigen::Isometry3d>& poses);

/// The largest edge of these bounds in a posture [m]; 1 if nothing is drawn.
double robot_extent(const std::vector<BodySurface>& surface, const RobotModel& model,
                    const RobotState& state);

}  // namespace ayumi
