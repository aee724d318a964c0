#include <algorithm>
#include <array>

#include "ayumi/render/renderer_parts.hpp"

namespace ayumi {

using Eigen::Matrix4f;
using Eigen::Vector3d;

namespace {

constexpr int kShadowBlur = 2;  // radius of the box, in pixels of the coverage
constexpr int kSamples =
    4;  // samples per pixel if edges are smoothed, as in the shader kMeanFragment
constexpr int kRoom = 64;  // pixels by which targets grow

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
    // Exposures are drawn farther away than they are.
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
  gl.Scissor(box.x - within.x, box.y - within.y, box.width, box.height);
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
  gl.PolygonOffset(1, 1);  // soles lie in the ground plane, so that its depth is moved away
  gl.ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  gl.DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  gl.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  gl.Disable(GL_POLYGON_OFFSET_FILL);
  gl.Scissor(0, 0, within.width, within.height);
}

std::vector<PixelBox> Renderer::Parts::covered_runs(const Scene& scene,
                                                    const Matrix4f& view_projection,
                                                    const PixelBox& box) const {
  CoveredTiles tiles(view_projection, options.width, options.height, box);
  for (size_t i = 0; i < boxes.size(); ++i) {
    tiles.add(boxes[i], scene.poses[i]);
    for (const Exposure& exposure : scene.exposures) tiles.add(boxes[i], exposure.poses[i]);
  }
  tiles.add(scenery_box, scene.floor);
  tiles.add(bounds(scene.bumps), scene.floor);
  const std::vector<std::uint32_t>& indices = scene.overlay.indices;
  for (size_t i = 0; i + 2 < indices.size(); i += 3) {
    std::array<Vector3d, 3> corners;
    for (size_t k = 0; k < 3; ++k)
      corners[k] = scene.overlay.vertices[indices[i + k]].position.cast<double>();
    tiles.add(corners);
  }
  return tiles.runs();
}

void Renderer::Parts::make_room(const PixelBox& box) {
  if (box.width <= drawn.width && box.height <= drawn.height) return;
  const auto whole = [](int size) { return (size + kRoom - 1) / kRoom * kRoom; };
  const int width = std::max(drawn.width, whole(box.width));
  const int height = std::max(drawn.height, whole(box.height));
  gl.discard(drawn);
  gl.discard(finished);
  drawn = gl.make_target(width, height, options.antialias ? kSamples : 0, GL_RGBA8, true);
  if (options.antialias) finished = gl.make_target(width, height, 0, GL_RGBA8, false);
}

void Renderer::Parts::lay_over(const PixelBox& box, const std::vector<PixelBox>& parts,
                               Image& image) {
  if (options.antialias) {
    std::vector<float> places;
    for (const PixelBox& part : parts) {
      const auto left = float(part.x - box.x), bottom = float(part.y - box.y);
      const float right = left + float(part.width), top = bottom + float(part.height);
      for (const float number : {left, bottom, right, bottom, right, top,  //
                                 left, bottom, right, top, left, top})
        places.push_back(number);
    }
    gl.BindFramebuffer(GL_FRAMEBUFFER, finished.framebuffer);
    gl.Viewport(0, 0, finished.width, finished.height);
    gl.Disable(GL_SCISSOR_TEST);
    gl.Disable(GL_DEPTH_TEST);
    gl.UseProgram(mean);
    gl.set(mean, "center", 0.5 * finished.width, 0.5 * finished.height);
    gl.BindTexture(GL_TEXTURE_2D_MULTISAMPLE, drawn.color);
    gl.BindVertexArray(runs.array);
    gl.BindBuffer(GL_ARRAY_BUFFER, runs.vertices);
    gl.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(places.size() * sizeof(float)),
                  places.data(), GL_STREAM_DRAW);
    gl.DrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(places.size() / 2));
  }
  pixels.resize(size_t(4) * size_t(box.width) * size_t(box.height));
  gl.ReadPixels(0, 0, box.width, box.height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
  for (const PixelBox& part : parts)
    lay_pixels_over(
        &pixels[4 * (size_t(part.y - box.y) * size_t(box.width) + size_t(part.x - box.x))],
        box.width, part, image);
}

}  // namespace ayumi
