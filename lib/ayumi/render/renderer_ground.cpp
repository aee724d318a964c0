#include <cstring>

#include "ayumi/render/renderer_parts.hpp"

namespace ayumi {

using Eigen::Matrix4f;
using Eigen::Vector3d;

namespace {

constexpr int kShadowBlur = 2;      // radius of the box [pixel of the coverage]
constexpr double kPlaneReach = 30;  // of the ground's square, in distances of the camera
const Vector3d kHorizon = {0.877, 0.893, 0.907};  // sRGB
const Eigen::Vector4f kWholePlane = {0, 0, 1, 1};

/// Point of the plane below the camera's target, its coordinates.
Eigen::Vector2d middle_of_plane(const Camera& camera, const GroundRectangle& plane) {
  const Vector3d target = camera.target - plane.origin;
  return {plane.u.dot(target), plane.v.dot(target)};
}

/// Four bytes per pixel from the bottom become three from the top.
Image image_of(const std::vector<std::uint8_t>& rgba, int width, int height) {
  Image image{width, height, std::vector<std::uint8_t>(size_t(3) * width * height)};
  for (int y = 0; y < height; ++y) {
    const std::uint8_t* source = &rgba[size_t(4) * width * (height - 1 - y)];
    std::uint8_t* target = image.pixel(0, y);
    int x = 0;
    for (; x + 1 < width; ++x) std::memcpy(target + 3 * x, source + 4 * x, 4);
    std::memcpy(target + 3 * x, source + 4 * x, 3);
  }
  return image;
}

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
  std::vector<std::uint8_t> cover(size_t(kShadowSize) * kShadowSize);
  gl.ReadPixels(0, 0, kShadowSize, kShadowSize, GL_RED, GL_UNSIGNED_BYTE, cover.data());
  blur(cover, kShadowSize, kShadowBlur);
  shade = covered(cover, kShadowSize);
  gl.BindTexture(GL_TEXTURE_2D, coverage);
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_R8, kShadowSize, kShadowSize, 0, GL_RED, GL_UNSIGNED_BYTE,
                cover.data());
}

PixelBox Renderer::Parts::with_edges(const Scene& scene, const Matrix4f& view_projection) const {
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

/// Leaves `drawn` to be drawn into, within `inner`.
void Renderer::Parts::draw_around(const PixelBox& inner, const Scene& scene,
                                  const Setting& setting) {
  const auto restrict_to = [&](const PixelBox& box) {
    gl.Scissor(box.x, box.y, box.width, box.height);
  };
  gl.BindFramebuffer(GL_FRAMEBUFFER, finished.framebuffer);
  gl.Disable(GL_DEPTH_TEST);
  gl.Enable(GL_SCISSOR_TEST);
  for (const PixelBox& box : around(inner, options.width, options.height)) {
    if (box.width <= 0 || box.height <= 0) continue;
    restrict_to(box);
    draw_sky(scene, setting);
    draw_plane(scene, setting);
    draw_shadow(setting);
  }
  gl.BindFramebuffer(GL_FRAMEBUFFER, drawn.framebuffer);
  restrict_to(inner);
}

void Renderer::Parts::place(GLuint program, const Setting& setting, const Eigen::Vector2d& at,
                            double reach, const Eigen::Vector4f& part) {
  gl.UseProgram(program);
  gl.set(program, "view_projection", setting.view_projection);
  gl.set(program, "origin", setting.plane.origin);
  gl.set(program, "axis_u", setting.plane.u);
  gl.set(program, "axis_v", setting.plane.v);
  gl.set(program, "center", at.x(), at.y());
  gl.set(program, "reach", reach);
  gl.set(program, "part", part);
  gl.set(program, "hole", hole);
  gl.BindVertexArray(square.array);
  gl.Enable(GL_CULL_FACE);
}

void Renderer::Parts::draw_plane(const Scene& scene, const Setting& setting) {
  if (!options.ground || scene.camera.parallel_height > 0) return;
  const double distance = (scene.camera.eye - scene.camera.target).norm();
  place(ground, setting, middle_of_plane(scene.camera, setting.plane), kPlaneReach * distance,
        kWholePlane);
  gl.set(ground, "fade", 4.5 * distance);
  gl.set(ground, "horizon", kHorizon);
  gl.Enable(GL_POLYGON_OFFSET_FILL);
  gl.PolygonOffset(1, 1);  // soles lie in the ground plane
  gl.DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  gl.Disable(GL_POLYGON_OFFSET_FILL);
}

void Renderer::Parts::draw_sky(const Scene& scene, const Setting& setting) {
  const double distance = (scene.camera.eye - scene.camera.target).norm();
  const bool covers = options.ground && hole.isZero() && scene.camera.parallel_height <= 0;
  const double bottom =
      covers ? ground_height(scene.camera, double(options.width) / options.height, setting.plane,
                             middle_of_plane(scene.camera, setting.plane), kPlaneReach * distance) -
                   4.0 / options.height
             : -1;
  if (bottom > 1 - 6.0 / options.height) return;
  gl.UseProgram(sky);
  gl.set(sky, "bottom", bottom);
  gl.set(sky, "horizon", kHorizon);
  gl.set(sky, "horizon_height",
         horizon_height(scene.camera, setting.plane.normal, setting.view_projection));
  gl.BindVertexArray(square.array);
  gl.Enable(GL_CULL_FACE);
  gl.DepthMask(GL_FALSE);
  gl.DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  gl.DepthMask(GL_TRUE);
}

void Renderer::Parts::draw_shadow(const Setting& setting) {
  if (!setting.with_shadow) return;
  place(shadow, setting, setting.plane.center, setting.plane.reach, shade);
  gl.set(shadow, "strength", 0.42);
  gl.BindTexture(GL_TEXTURE_2D, coverage);
  gl.DepthMask(GL_FALSE);
  gl.Enable(GL_BLEND);
  gl.DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  gl.Disable(GL_BLEND);
  gl.DepthMask(GL_TRUE);
}

/// Into the picture without samples, from which it will be read.
void Renderer::Parts::resolve(const PixelBox& box) {
  const int right = box.x + box.width, top = box.y + box.height;
  gl.Disable(GL_SCISSOR_TEST);
  gl.BindFramebuffer(GL_READ_FRAMEBUFFER, drawn.framebuffer);
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, finished.framebuffer);
  if (box.width > 0 && box.height > 0)
    gl.BlitFramebuffer(box.x, box.y, right, top, box.x, box.y, right, top, GL_COLOR_BUFFER_BIT,
                       GL_NEAREST);
  gl.BindFramebuffer(GL_READ_FRAMEBUFFER, finished.framebuffer);
}

Image Renderer::Parts::read() {
  pixels.resize(size_t(4) * options.width * options.height);
  gl.ReadPixels(0, 0, options.width, options.height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
  return image_of(pixels, options.width, options.height);
}

}  // namespace ayumi
