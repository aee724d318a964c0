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
  int width = 1280, height = 720;  ///< [pixel], 1 to 4096
  bool antialias = true;           ///< four samples per pixel
  bool shadow = true;
  bool ground = true;
  Offscreen way = Offscreen::automatic;
};

/// The robot's triangles as renderers take them: made once, however many renderers draw it.
struct DrawnRobot {
  struct Body {
    IndexRange closed, open;
    std::vector<std::pair<IndexRange, std::string>> textured;  ///< with the file of the picture
    IndexRange caster;
    Eigen::AlignedBox3d box;  ///< body frame
  };
  Triangles triangles;  ///< of all bodies, each in its frame
  Triangles casters;    ///< what throws the shadow, coarser
  std::vector<Body> bodies;
};
std::shared_ptr<const DrawnRobot> drawn_robot(const std::vector<BodySurface>& robot);

/// The robot once more, translucent: a ghost, or an earlier instant.
struct Exposure {
  std::vector<Eigen::Isometry3d> poses;            ///< one per body, world
  Eigen::Vector4f tint = Eigen::Vector4f::Zero();  ///< sRGB, and its share of the colour
  double opacity = 0.40;
};

/// Colour of a joint by Scene::heat, from amber to red.
Eigen::Vector4f heat_color(float heat);

/// Fixed objects on the ground.
struct Scenery {
  Triangles triangles;       ///< in the floor's frame
  Eigen::AlignedBox2d hole;  ///< of the ground plane, where a field takes its place [m]
};

struct Scene {
  std::vector<Eigen::Isometry3d> poses;  ///< one per body, world
  Camera camera;
  Eigen::Isometry3d ground = Eigen::Isometry3d::Identity();  ///< frame of the plane, z its normal
  Eigen::Isometry3d floor = Eigen::Isometry3d::Identity();   ///< frame of scenery and bumps
  Triangles bumps;                                           ///< on the ground now, floor's frame
  Triangles overlay;                                         ///< world frame
  std::vector<Exposure> exposures;                           ///< drawn in their order
  std::vector<float> heat;  ///< empty, or by body: 0 its own colour, 1 red
};

/// Holds the OpenGL context and the robot's surface in it. One thread at a time; several renderers
/// in several threads do not disturb each other. The same scene gives the same bytes.
class Renderer {
 public:
  /// Throws Error(usage) for a size outside 1..4096, Error(internal) where OpenGL fails.
  Renderer(const std::vector<BodySurface>& robot, const RenderOptions& options,
           const Scenery& scenery = {});
  /// Only the data of the robot in OpenGL are kept.
  Renderer(const RenderOptions& options, const DrawnRobot& robot, const Scenery& scenery = {});
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// Throws Error(internal) unless the scene has one pose per body.
  Image render(const Scene& scene);

  /// The next picture takes the memory of this one, which nobody needs any more.
  void reuse(Image image);

  /// Parts that are drawn in another way than the files state, with the reason: a texture that
  /// cannot be read.
  const std::vector<std::string>& notes() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace ayumi
