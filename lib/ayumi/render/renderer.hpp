#pragma once
// Pictures of a robot on its ground, by OpenGL in software: sky light and a sun with a soft shadow,
// a metric grid (0.1 m fine, 1 m bold), and overlays that shine faintly through what hides them.

#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ayumi/render/camera.hpp"
#include "ayumi/render/image.hpp"
#include "ayumi/render/offscreen_context.hpp"
#include "ayumi/render/robot_surface.hpp"
#include "ayumi/render/triangles.hpp"

namespace ayumi {

struct RenderOptions {
  int width = 1280, height = 720;  ///< size [pixel], from 1 to 4096
  bool antialias = true;           ///< four samples per pixel
  bool shadow = true;
  bool ground = true;
  Offscreen way = Offscreen::automatic;
};

/// The robot's triangles as renderers take them. They are made once for any number of renderers.
struct DrawnRobot {
  struct Body {
    IndexRange closed, open;
    /// Surfaces with the file of their picture.
    std::vector<std::pair<IndexRange, std::string>> textured;
    IndexRange caster;
    Eigen::AlignedBox3d box;  ///< box in the body frame
  };
  Triangles triangles;  ///< triangles of all bodies, each in its frame
  Triangles casters;    ///< coarser triangles that throw the shadow
  std::vector<Body> bodies;
};
std::shared_ptr<const DrawnRobot> drawn_robot(const std::vector<BodySurface>& robot);

/// The robot drawn once more, translucent: a ghost, or an earlier instant.
struct Exposure {
  std::vector<Eigen::Isometry3d> poses;            ///< poses in the world, one per body
  Eigen::Vector4f tint = Eigen::Vector4f::Zero();  ///< sRGB colour, and its share
  double opacity = 0.40;                           ///< from 0 to 1
};

/// The colour of a joint by Scene::heat, from amber to red.
Eigen::Vector4f heat_color(float heat);

/// Fixed objects on the ground.
struct Scenery {
  Triangles triangles;       ///< triangles in the floor's frame
  Eigen::AlignedBox2d hole;  ///< part of the ground plane that a field replaces [m]
};

struct Scene {
  std::vector<Eigen::Isometry3d> poses;  ///< poses in the world, one per body
  Camera camera;
  /// Frame of the plane, whose z is the normal.
  Eigen::Isometry3d ground = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d floor = Eigen::Isometry3d::Identity();  ///< frame of scenery and bumps
  Triangles bumps;                  ///< bumps on the ground now, in the floor's frame
  Triangles overlay;                ///< triangles in the world frame
  std::vector<Exposure> exposures;  ///< exposures in the order in which they are drawn
  std::vector<float> heat;  ///< heat by body, from 0 for its own colour to 1 for red; or empty
};

/// Holds the OpenGL context and the robot's surface in it. Only one thread may use a renderer at a
/// time; several renderers in several threads do not disturb each other. The same scene gives the
/// same bytes.
class Renderer {
 public:
  /// Throws Error(usage) for a size outside 1..4096, and Error(internal) if OpenGL fails.
  Renderer(const std::vector<BodySurface>& robot, const RenderOptions& options,
           const Scenery& scenery = {});
  /// The renderer keeps only the data of the robot in OpenGL.
  Renderer(const RenderOptions& options, const DrawnRobot& robot, const Scenery& scenery = {});
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// Throws Error(internal) unless the scene has one pose per body.
  Image render(const Scene& scene);

  /// Gives the memory of `image` to the next picture. `image` must no longer be needed.
  void reuse(Image image);

  /// The parts that are drawn differently from the files, with the reason, such as a texture that
  /// cannot be read.
  const std::vector<std::string>& notes() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace ayumi
