#pragma once
// Pictures of a robot on its ground, by OpenGL in software: sky light and a sun with a soft shadow,
// a metric grid (0.1 m fine, 1 m bold), and overlays that shine faintly through what hides them.

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "ayumi/preview/camera.hpp"
#include "ayumi/preview/image.hpp"
#include "ayumi/preview/robot_surface.hpp"
#include "ayumi/preview/triangles.hpp"

namespace ayumi {

struct RenderOptions {
  int width = 1280, height = 720;  ///< [pixel], 1 to 4096
  bool antialias = true;           ///< four samples per pixel
  bool shadow = true;
  bool ground = true;
};

struct Scene {
  std::vector<Eigen::Isometry3d> poses;  ///< one per body, world
  Camera camera;
  Eigen::Vector3d ground_normal = Eigen::Vector3d::UnitZ();  ///< of the plane through the origin
  Triangles overlay;                                         ///< world frame
};

/// Holds the OpenGL context and the robot's surface in it. One thread at a time; several renderers
/// in several threads do not disturb each other. The same scene gives the same bytes.
class Renderer {
 public:
  /// Throws Error(usage) for a size outside 1..4096, Error(internal) where OpenGL fails.
  Renderer(const std::vector<BodySurface>& robot, const RenderOptions& options);
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// Throws Error(internal) unless the scene has one pose per body.
  Image render(const Scene& scene);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace ayumi
