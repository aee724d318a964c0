#pragma once
// What the renderer holds of OpenGL. Bodies, marks and the order of a frame are in renderer.cpp;
// ground, sky, shadow and the joining of smoothed and plain pixels in renderer_ground.cpp.

#include <string>
#include <utility>
#include <vector>

#include "ayumi/render/gl.hpp"
#include "ayumi/render/ground_plane.hpp"
#include "ayumi/render/renderer.hpp"
#include "ayumi/render/visible_region.hpp"

namespace ayumi {

constexpr int kShadowSize = 256;  ///< of the coverage [pixel]

/// Where a frame's ground, shadow and horizon are.
struct Setting {
  GroundRectangle plane;
  Eigen::Matrix4f view_projection;
  bool with_shadow = false;
};

/// A body in the index buffer.
struct BodyRanges {
  IndexRange closed, open;
  std::vector<std::pair<IndexRange, GLuint>> textured;  // with their pictures
};

struct Renderer::Parts {
  RenderOptions options;
  OffscreenContext context;
  Gl gl;
  GLuint solid, textured, standing, ground, sky, flat, shadow;
  GlMesh robot, caster, overlay, scenery, bumps, square;
  std::vector<BodyRanges> ranges;
  std::vector<IndexRange> caster_ranges;   // by body: what throws the shadow
  std::vector<Eigen::AlignedBox3d> boxes;  // of each body, body frame
  std::vector<size_t> order;               // in which bodies are drawn
  std::vector<std::string> notes;
  GlTarget drawn, finished, flattened;  // finished: without samples, where antialiased
  GLuint coverage = 0;
  std::vector<std::uint8_t> pixels;  // of the picture, as OpenGL gives it
  IndexRange all_scenery;
  Eigen::AlignedBox3d scenery_box;
  Eigen::Vector4f hole = {0, 0, 0, 0};   // low x, y, high x, y; of the plane's coordinates
  Eigen::Vector4f shade = {0, 0, 1, 1};  // part of the shadow's square that is dark

  Parts(const std::vector<BodySurface>& surface, const RenderOptions& render_options,
        const Scenery& on_floor);

  void upload(const std::vector<BodySurface>& surface);
  Eigen::AlignedBox3d bounds_of(const std::vector<Eigen::Isometry3d>& poses) const;
  std::vector<size_t> nearest_first(const Scene& scene) const;
  void draw_coverage(const Scene& scene, const Eigen::Matrix4d& flatten);
  void light(const Scene& scene, const Eigen::Matrix4f& view_projection,
             const Eigen::Vector3d& sun);
  template <typename Tint>
  void draw_bodies(const std::vector<Eigen::Isometry3d>& poses, double opacity, const Tint& tint);
  void draw_scenery(const Scene& scene, const Eigen::Matrix4f& flatten, bool with_shadow);
  void set_view(const Eigen::Matrix4f& view_projection);
  void draw_exposures(const Scene& scene, const Eigen::Matrix4f& view_projection);
  PixelBox with_edges(const Scene& scene, const Eigen::Matrix4f& view_projection) const;
  void draw_around(const PixelBox& inner, const Scene& scene, const Setting& setting);
  void place(GLuint program, const Setting& setting, const Eigen::Vector2d& at, double reach,
             const Eigen::Vector4f& part);
  void draw_plane(const Scene& scene, const Setting& setting);
  void draw_sky(const Scene& scene, const Setting& setting);
  void draw_shadow(const Setting& setting);
  void draw_overlay(const Scene& scene);
  void resolve(const PixelBox& box);
  Image read();
};

}  // namespace ayumi
