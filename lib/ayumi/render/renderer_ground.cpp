#include <algorithm>
#include <array>

#include "ayumi/render/renderer_parts.hpp"

namespace ayumi {

using Eigen::Matrix4f;
using Eigen::Vector3d;

namespace {

constexpr int kShadowBlur = 2;  // radius of the box [pixel of the coverage]

}  // namespace

void Renderer::Parts::draw_coverage(const Scene& scene, const Eigen::Matrix4d& flatten) {
  gl.BindFramebuffer(GL_FRAMEBUFFER, flattened.framebuffer);
  gl.Viewport(0, 0, kShadowSize, kShadowSize);
  gl.Disable(GL_DEPTH_TEST);
  gl.Disable(GL_CULL_FACE);
  gl.Disable(GL_BLEND);
  gl.ClearColor(0, 0, 0, 0);
  gl.Clear(GL_COLOR_BUFFER_BIT);
  gl.UseProgram(flat);
  gl.BindVertexArray(caster.array);
  for (size_t i = 0; i < caster_ranges.size(); ++i) {
    if (!caster_ranges[i].count) continue;
    gl.set(flat, "flatten", Matrix4f((flatten * scene.poses[i].matrix()).cast<float>()));
    gl.draw(caster_ranges[i]);
  }
  std::vector<std::uint8_t>& cover = shadow.cover;
  cover.resize(size_t(kShadowSize) * kShadowSize);
  gl.ReadPixels(0, 0, kShadowSize, kShadowSize, GL_RED, GL_UNSIGNED_BYTE, cover.data());
  blur(cover, kShadowSize, kShadowBlur);
  shadow.dark = covered(cover, kShadowSize);
  if (!all_scenery.count && scene.bumps.indices.empty()) return;
  gl.BindTexture(GL_TEXTURE_2D, coverage);
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_R8, kShadowSize, kShadowSize, 0, GL_RED, GL_UNSIGNED_BYTE,
                cover.data());
}

PixelBox Renderer::Parts::with_bodies(const Scene& scene, const Matrix4f& view_projection) const {
  VisibleRegion region(view_projection, options.width, options.height);
  for (size_t i = 0; i < boxes.size(); ++i) {
    region.add(boxes[i], scene.poses[i]);
    for (const Exposure& exposure : scene.exposures) region.add(boxes[i], exposure.poses[i]);
  }
  region.add(scenery_box, scene.floor);
  region.add(bounds(scene.bumps), scene.floor);
  for (const RenderVertex& vertex : scene.overlay.vertices)
    region.add(vertex.position.cast<double>());
  return region.pixels();
}

PixelBox Renderer::Parts::below_ground(const Scene& scene, const Setting& setting) const {
  VisibleRegion region(setting.view_projection, options.width, options.height);
  const GroundRectangle& plane = setting.plane;
  const auto is_below = [&](const Vector3d& p) { return plane.normal.dot(p - plane.origin) < 0; };
  const auto add = [&](const Eigen::AlignedBox3d& box, const Eigen::Isometry3d& pose) {
    if (box.isEmpty()) return;
    bool below = false;
    for (int i = 0; i < 8; ++i)
      below |= is_below(pose * box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)));
    if (below) region.add(box, pose);
  };
  for (size_t i = 0; i < boxes.size(); ++i) {
    add(boxes[i], scene.poses[i]);
    // These lie farther away than where they are.
    for (const Exposure& exposure : scene.exposures) region.add(boxes[i], exposure.poses[i]);
  }
  add(scenery_box, scene.floor);
  add(bounds(scene.bumps), scene.floor);
  const std::vector<RenderVertex>& marks = scene.overlay.vertices;
  for (size_t i = 0; i + 2 < scene.overlay.indices.size(); i += 3) {
    std::array<Vector3d, 3> corners;
    for (size_t k = 0; k < 3; ++k)
      corners[k] = marks[scene.overlay.indices[i + k]].position.cast<double>();
    if (std::any_of(corners.begin(), corners.end(), is_below))
      for (const Vector3d& corner : corners) region.add(corner);
  }
  return region.pixels();
}

void Renderer::Parts::draw_plane_depth(const Scene& scene, const Setting& setting,
                                       const PixelBox& within) {
  if (!options.ground || scene.camera.parallel_height > 0) return;
  const PixelBox box = below_ground(scene, setting);
  if (box.width <= 0 || box.height <= 0) return;
  const auto restrict_to = [&](const PixelBox& part) {
    gl.Scissor(part.x, part.y, part.width, part.height);
  };
  restrict_to(box);
  const GroundRectangle& plane = setting.plane;
  const double distance = (scene.camera.eye - scene.camera.target).norm();
  gl.UseProgram(ground);
  gl.set(ground, "view_projection", setting.view_projection);
  gl.set(ground, "origin", plane.origin);
  gl.set(ground, "axis_u", plane.u);
  gl.set(ground, "axis_v", plane.v);
  const Eigen::Vector2d middle = middle_of_plane(scene.camera, plane);
  gl.set(ground, "center", middle.x(), middle.y());
  gl.set(ground, "reach", kPlaneReach * distance);
  gl.set(ground, "hole", hole);
  gl.BindVertexArray(square.array);
  gl.Enable(GL_CULL_FACE);
  gl.Enable(GL_POLYGON_OFFSET_FILL);
  gl.PolygonOffset(1, 1);  // soles lie in the ground plane
  gl.ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  gl.DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  gl.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  gl.Disable(GL_POLYGON_OFFSET_FILL);
  restrict_to(within);
}

void Renderer::Parts::lay_over(const PixelBox& box, Image& image) {
  if (options.antialias) {
    const int right = box.x + box.width, top = box.y + box.height;
    gl.Disable(GL_SCISSOR_TEST);
    gl.BindFramebuffer(GL_READ_FRAMEBUFFER, drawn.framebuffer);
    gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, finished.framebuffer);
    gl.BlitFramebuffer(box.x, box.y, right, top, box.x, box.y, right, top, GL_COLOR_BUFFER_BIT,
                       GL_NEAREST);
    gl.BindFramebuffer(GL_READ_FRAMEBUFFER, finished.framebuffer);
  }
  pixels.resize(size_t(4) * size_t(box.width) * size_t(box.height));
  gl.ReadPixels(box.x, box.y, box.width, box.height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
  lay_pixels_over(pixels.data(), box, image);
}

}  // namespace ayumi
