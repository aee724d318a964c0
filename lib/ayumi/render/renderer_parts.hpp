#pragma once
// The OpenGL objects that the renderer holds. Bodies, marks and the order of a frame are in
// renderer.cpp. The shadow, the depth of the ground plane, and the joining with the ground's
// picture are in renderer_ground.cpp.

#include <string>
#include <utility>
#include <vector>

#include "ayumi/render/gl.hpp"
#include "ayumi/render/ground_picture.hpp"
#include "ayumi/render/ground_plane.hpp"
#include "ayumi/render/renderer.hpp"
#include "ayumi/render/visible_region.hpp"

namespace ayumi {

constexpr int kShadowSize = ShadowPicture::kSize;  ///< pixels of the coverage

/// The place of the ground in a frame.
struct Setting {
  GroundRectangle plane;
  Eigen::Matrix4f view_projection;
};

/// The parts of the index buffer that draw a body.
struct BodyRanges {
  IndexRange closed, open;
  std::vector<std::pair<IndexRange, GLuint>> textured;  // surfaces with their pictures
};

struct Renderer::Parts {
  RenderOptions options;
  OffscreenContext context;
  Gl gl;
  GLuint solid, textured, standing, ground, flat, mean;
  GlMesh robot, caster, overlay, scenery, bumps, square, runs;
  std::vector<BodyRanges> ranges;
  std::vector<IndexRange> caster_ranges;   // by body: triangles that throw the shadow
  std::vector<Eigen::AlignedBox3d> boxes;  // box of each body, body frame
  std::vector<size_t> order;               // order in which bodies are drawn
  std::vector<std::string> notes;
  GlTarget drawn, finished;  // as large as the part of the picture in front of the ground;
                             // finished: without samples
  GlTarget flattened;
  GLuint coverage = 0;
  std::vector<std::uint8_t> pixels;  // pixels of a part of the picture, in the order of OpenGL
  Image spare;                       // memory for the next picture
  IndexRange all_scenery;
  Eigen::AlignedBox3d scenery_box;
  Eigen::AlignedBox2d hole_box;
  // Corners of the hole, as low x, y, high x, y, in the plane's coordinates.
  Eigen::Vector4f hole = {0, 0, 0, 0};
  ShadowPicture shadow;  // shadow of the frame

  Parts(const DrawnRobot& drawn_bodies, const RenderOptions& render_options,
        const Scenery& on_floor);

  void upload(const DrawnRobot& drawn_bodies);
  Eigen::AlignedBox3d bounds_of(const std::vector<Eigen::Isometry3d>& poses) const;
  std::vector<size_t> nearest_first(const Scene& scene) const;
  void draw_coverage(const Scene& scene, const Eigen::Matrix4d& flatten);
  void light(const Scene& scene, const Eigen::Matrix4f& view_projection,
             const Eigen::Vector3d& sun);
  template <typename Tint>
  void draw_bodies(const std::vector<Eigen::Isometry3d>& poses, double opacity, const Tint& tint);
  void draw_scenery(const Scene& scene, const Eigen::Matrix4f& flatten, bool with_shadow);
  void set_view(const Eigen::Matrix4f& view_projection);
  /// From now on, surfaces are drawn with their own opacity, and blended.
  void begin_mixing();
  void draw_exposures(const Scene& scene, const Eigen::Matrix4f& view_projection);
  /// The part of the picture that shows anything except the ground.
  PixelBox with_bodies(const Scene& scene, const Eigen::Matrix4f& view_projection) const;
  /// The part of the picture with anything that the ground may hide.
  PixelBox below_ground(const Scene& scene, const Setting& setting) const;
  /// Draws the depth of the ground where it may hide something. Its colours are in a separate
  /// picture.
  void draw_plane_depth(const Scene& scene, const Setting& setting, const PixelBox& within);
  void draw_overlay(const Scene& scene);
  /// The tiles of the box that contain anything except the ground.
  std::vector<PixelBox> covered_runs(const Scene& scene, const Eigen::Matrix4f& view_projection,
                                     const PixelBox& box) const;
  /// Makes targets for a part of the picture whose corner is the corner of the targets.
  void make_room(const PixelBox& box);
  /// Puts the smoothed colours over the picture of ground and sky.
  void lay_over(const PixelBox& box, const std::vector<PixelBox>& parts, Image& image);
};

}  // namespace ayumi
