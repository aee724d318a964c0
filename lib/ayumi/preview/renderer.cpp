#include "ayumi/preview/renderer.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "ayumi/base/error.hpp"
#include "ayumi/preview/gl.hpp"
#include "ayumi/preview/offscreen_context.hpp"
#include "ayumi/preview/shaders.hpp"

// Order of a frame: the robot's shadow as coverage seen along the sun, read back, blurred and given
// back as a small texture; then robot, ground, sky, shadow, overlay. What an overlay hides behind
// the robot is drawn first and faintly, then its visible part.

namespace ayumi {
namespace {

using Eigen::Matrix4f;
using Eigen::Vector3d;

constexpr int kShadowSize = 512;
constexpr int kSamples = 4;
constexpr float kHorizon[3] = {0.74f, 0.77f, 0.80f};

/// Frame of the ground plane and the square of it that the robot's shadow falls on.
struct Ground {
  Vector3d u, v, normal;
  Eigen::Vector2d center;
  double reach = 1;  ///< half edge of the square [m]
};

Ground make_ground(const Vector3d& normal, const Eigen::AlignedBox3d& box, const Vector3d& sun) {
  Ground ground;
  ground.normal = normal.normalized();
  ground.u = (Vector3d::UnitX() - ground.normal.x() * ground.normal).normalized();
  ground.v = ground.normal.cross(ground.u);
  Eigen::AlignedBox2d square;
  for (int i = 0; i < 8; ++i) {
    Vector3d p = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
    p -= sun * (ground.normal.dot(p) / ground.normal.dot(sun));
    square.extend(Eigen::Vector2d(ground.u.dot(p), ground.v.dot(p)));
  }
  ground.center = square.center();
  ground.reach = 0.5 * square.sizes().maxCoeff() * 1.1;
  return ground;
}

/// Where the ground vanishes straight ahead, -1 at the bottom of the picture, 1 at its top.
double horizon_height(const Camera& camera, const Vector3d& normal, const Matrix4f& to_clip) {
  const Vector3d ahead = camera.target - camera.eye;
  const Vector3d level = ahead - normal * normal.dot(ahead);
  if (level.norm() < 1e-3 * ahead.norm()) return 1;
  const Eigen::Vector4f clip =
      to_clip *
      level.normalized().cast<float>().homogeneous().cwiseProduct(Eigen::Vector4f(1, 1, 1, 0));
  return std::clamp(double(clip.y() / clip.w()), -1.0, 2.0);
}

/// Two passes of a box of 2 radius + 1 along rows and columns, in place.
void blur(std::vector<std::uint8_t>& image, int size, int radius) {
  std::vector<std::uint8_t> line(static_cast<size_t>(size));
  const auto smooth = [&](std::uint8_t* data, int stride) {
    int sum = 0;
    for (int i = 0; i < size; ++i) line[size_t(i)] = data[i * stride];
    for (int i = 0; i < radius; ++i) sum += line[size_t(i)];
    for (int i = 0; i < size; ++i) {
      if (i + radius < size) sum += line[size_t(i + radius)];
      if (i - radius - 1 >= 0) sum -= line[size_t(i - radius - 1)];
      data[i * stride] = static_cast<std::uint8_t>(sum / (2 * radius + 1));
    }
  };
  for (int pass = 0; pass < 2; ++pass) {
    for (int i = 0; i < size; ++i) smooth(&image[size_t(i) * size_t(size)], 1);
    for (int i = 0; i < size; ++i) smooth(&image[size_t(i)], size);
  }
}

}  // namespace

struct Renderer::Parts {
  RenderOptions options;
  OffscreenContext context;
  Gl gl;
  GLuint solid, ground, sky, flat, shadow;
  GlMesh robot, overlay, square;
  std::vector<std::pair<IndexRange, IndexRange>> ranges;  // closed and open triangles of each body
  std::vector<Eigen::AlignedBox3d> boxes;                 // of each body, body frame
  GlTarget drawn, resolved, flattened;
  GLuint coverage = 0;

  Parts(const std::vector<BodySurface>& surface, const RenderOptions& render_options);

  void upload(const std::vector<BodySurface>& surface);
  Eigen::AlignedBox3d bounds_of(const std::vector<Eigen::Isometry3d>& poses) const;
  void draw_coverage(const Scene& scene, const Ground& plane, const Vector3d& sun);
  void draw_robot(const Scene& scene, const Matrix4f& view_projection, const Vector3d& sun);
  void draw_ground(const Scene& scene, const Matrix4f& view_projection, const Ground& plane);
  void draw_overlay(const Scene& scene, const Matrix4f& view_projection, const Vector3d& sun);
  Image read();
};

Renderer::Parts::Parts(const std::vector<BodySurface>& surface, const RenderOptions& chosen)
    : options(chosen) {
  using namespace shaders;
  solid = gl.link(kSolidVertex, kSolidFragment);
  ground = gl.link(kGroundVertex, kGroundFragment);
  sky = gl.link(kSkyVertex, kSkyFragment);
  flat = gl.link(kFlatVertex, kFlatFragment);
  shadow = gl.link(kGroundVertex, kShadowFragment);
  robot = gl.make_mesh();
  overlay = gl.make_mesh();
  upload(surface);
  gl.GenVertexArrays(1, &square.array);
  gl.BindVertexArray(square.array);
  gl.GenBuffers(1, &square.vertices);
  gl.BindBuffer(GL_ARRAY_BUFFER, square.vertices);
  const float corners[] = {-1, -1, 1, -1, -1, 1, 1, 1};
  gl.BufferData(GL_ARRAY_BUFFER, sizeof corners, corners, GL_STATIC_DRAW);
  gl.EnableVertexAttribArray(0);
  gl.VertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
  drawn = gl.make_target(options.width, options.height, options.antialias ? kSamples : 0, GL_RGBA8,
                         true);
  if (options.antialias)
    resolved = gl.make_target(options.width, options.height, 0, GL_RGBA8, false);
  flattened = gl.make_target(kShadowSize, kShadowSize, 0, GL_R8, false);
  gl.GenTextures(1, &coverage);
  gl.BindTexture(GL_TEXTURE_2D, coverage);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
}

void Renderer::Parts::upload(const std::vector<BodySurface>& surface) {
  Triangles all;
  const auto add = [&](const Triangles& part) {
    const IndexRange range = {static_cast<GLsizei>(part.indices.size()), all.indices.size()};
    append(all, part);
    return range;
  };
  for (const BodySurface& body : surface) {
    const IndexRange closed = add(body.closed);
    ranges.emplace_back(closed, add(body.open));
    boxes.push_back(bounds(body.closed).merged(bounds(body.open)));
  }
  gl.fill(robot, all, GL_STATIC_DRAW);
}

Eigen::AlignedBox3d Renderer::Parts::bounds_of(const std::vector<Eigen::Isometry3d>& poses) const {
  Eigen::AlignedBox3d all;
  for (size_t i = 0; i < boxes.size(); ++i)
    if (!boxes[i].isEmpty()) all.extend(boxes[i].transformed(poses[i]));
  return all;
}

void Renderer::Parts::draw_coverage(const Scene& scene, const Ground& plane, const Vector3d& sun) {
  // p -> ((p - s (n.p)/(n.s)) . u - center) / reach, and the same for v; depth 0.
  const Eigen::Matrix3d fall =
      Eigen::Matrix3d::Identity() - sun * plane.normal.transpose() / plane.normal.dot(sun);
  Eigen::Matrix4d flatten = Eigen::Matrix4d::Zero();
  flatten.block<1, 3>(0, 0) = plane.u.transpose() * fall / plane.reach;
  flatten.block<1, 3>(1, 0) = plane.v.transpose() * fall / plane.reach;
  flatten.topRightCorner<2, 1>() = -plane.center / plane.reach;
  flatten(3, 3) = 1;
  gl.BindFramebuffer(GL_FRAMEBUFFER, flattened.framebuffer);
  gl.Viewport(0, 0, kShadowSize, kShadowSize);
  gl.Disable(GL_DEPTH_TEST);
  gl.Disable(GL_CULL_FACE);
  gl.Disable(GL_BLEND);
  gl.ClearColor(0, 0, 0, 0);
  gl.Clear(GL_COLOR_BUFFER_BIT);
  gl.UseProgram(flat);
  gl.BindVertexArray(robot.array);
  for (size_t i = 0; i < ranges.size(); ++i) {
    gl.set(flat, "flatten", Matrix4f((flatten * scene.poses[i].matrix()).cast<float>()));
    gl.draw(ranges[i].first);
    gl.draw(ranges[i].second);
  }
  std::vector<std::uint8_t> cover(size_t(kShadowSize) * kShadowSize);
  gl.ReadPixels(0, 0, kShadowSize, kShadowSize, GL_RED, GL_UNSIGNED_BYTE, cover.data());
  blur(cover, kShadowSize, 3);
  gl.BindTexture(GL_TEXTURE_2D, coverage);
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_R8, kShadowSize, kShadowSize, 0, GL_RED, GL_UNSIGNED_BYTE,
                cover.data());
}

void Renderer::Parts::draw_robot(const Scene& scene, const Matrix4f& view_projection,
                                 const Vector3d& sun) {
  gl.UseProgram(solid);
  gl.set(solid, "view_projection", view_projection);
  gl.set(solid, "eye", scene.camera.eye);
  gl.set(solid, "sun", sun);
  gl.set(solid, "up", scene.ground_normal.normalized());
  gl.set(solid, "opacity", 1.0);
  gl.BindVertexArray(robot.array);
  gl.Enable(GL_CULL_FACE);
  for (size_t i = 0; i < ranges.size(); ++i) {
    if (!ranges[i].first.count && !ranges[i].second.count) continue;
    gl.set(solid, "model", Matrix4f(scene.poses[i].matrix().cast<float>()));
    gl.draw(ranges[i].first);
    if (!ranges[i].second.count) continue;
    gl.Disable(GL_CULL_FACE);
    gl.draw(ranges[i].second);
    gl.Enable(GL_CULL_FACE);
  }
}

void Renderer::Parts::draw_ground(const Scene& scene, const Matrix4f& view_projection,
                                  const Ground& plane) {
  const Vector3d target = scene.camera.target;
  const Eigen::Vector2d center(plane.u.dot(target), plane.v.dot(target));
  const double distance = (scene.camera.eye - target).norm();
  const auto place = [&](GLuint program, const Eigen::Vector2d& at, double reach) {
    gl.UseProgram(program);
    gl.set(program, "view_projection", view_projection);
    gl.set(program, "axis_u", plane.u);
    gl.set(program, "axis_v", plane.v);
    gl.set(program, "center", at.x(), at.y());
    gl.set(program, "reach", reach);
  };
  gl.BindVertexArray(square.array);
  gl.Enable(GL_CULL_FACE);
  if (options.ground) {
    place(ground, center, 30 * distance);
    gl.set(ground, "fade", 4.5 * distance);
    gl.set(ground, "horizon", Vector3d(kHorizon[0], kHorizon[1], kHorizon[2]));
    gl.Enable(GL_POLYGON_OFFSET_FILL);
    gl.PolygonOffset(1, 1);  // soles lie in the ground plane
    gl.DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    gl.Disable(GL_POLYGON_OFFSET_FILL);
  }
  gl.UseProgram(sky);
  gl.set(sky, "horizon", Vector3d(kHorizon[0], kHorizon[1], kHorizon[2]));
  gl.set(sky, "horizon_height", horizon_height(scene.camera, plane.normal, view_projection));
  gl.DepthMask(GL_FALSE);
  gl.DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  if (options.ground && options.shadow) {
    place(shadow, plane.center, plane.reach);
    gl.set(shadow, "strength", 0.42);
    gl.Enable(GL_BLEND);
    gl.DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  }
  gl.DepthMask(GL_TRUE);
}

void Renderer::Parts::draw_overlay(const Scene& scene, const Matrix4f& view_projection,
                                   const Vector3d& sun) {
  if (scene.overlay.indices.empty()) return;
  gl.fill(overlay, scene.overlay, GL_STREAM_DRAW);
  gl.UseProgram(solid);
  gl.set(solid, "view_projection", view_projection);
  gl.set(solid, "model", Matrix4f(Matrix4f::Identity()));
  gl.set(solid, "sun", sun);
  const IndexRange all = {static_cast<GLsizei>(scene.overlay.indices.size()), 0};
  gl.Enable(GL_CULL_FACE);
  gl.Enable(GL_BLEND);
  gl.set(solid, "opacity", 0.6);
  gl.DepthMask(GL_FALSE);
  gl.DepthFunc(GL_GREATER);
  gl.draw(all);
  gl.set(solid, "opacity", 1.0);
  gl.DepthMask(GL_TRUE);
  gl.DepthFunc(GL_LEQUAL);
  gl.draw(all);
  gl.Disable(GL_BLEND);
}

Image Renderer::Parts::read() {
  const int width = options.width, height = options.height;
  if (options.antialias) {
    gl.BindFramebuffer(GL_READ_FRAMEBUFFER, drawn.framebuffer);
    gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved.framebuffer);
    gl.BlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    gl.BindFramebuffer(GL_READ_FRAMEBUFFER, resolved.framebuffer);
  }
  std::vector<std::uint8_t> pixels(size_t(4) * width * height);
  gl.ReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
  Image image{width, height, std::vector<std::uint8_t>(size_t(3) * width * height)};
  for (int y = 0; y < height; ++y) {
    const std::uint8_t* source = &pixels[size_t(4) * width * (height - 1 - y)];
    std::uint8_t* target = image.pixel(0, y);
    for (int x = 0; x < width; ++x)
      for (int channel = 0; channel < 3; ++channel)
        target[3 * x + channel] = source[4 * x + channel];
  }
  return image;
}

Renderer::Renderer(const std::vector<BodySurface>& robot, const RenderOptions& options) {
  for (const int edge : {options.width, options.height})
    if (edge < 1 || edge > 4096)
      fail(ErrorCode::usage, "picture size " + std::to_string(options.width) + "x" +
                                 std::to_string(options.height) +
                                 ": each edge must be 1 to 4096 pixels");
  parts_ = std::make_unique<Parts>(robot, options);
}

Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Image Renderer::render(const Scene& scene) {
  Parts& p = *parts_;
  require(scene.poses.size() == p.ranges.size(), "a scene needs one pose per body");
  p.context.make_current();
  const Eigen::AlignedBox3d box = p.bounds_of(scene.poses);
  const Vector3d up = scene.ground_normal.normalized();
  // The sun stands over the camera's left shoulder, whatever side it looks from.
  const Vector3d toward = (scene.camera.eye - scene.camera.target).normalized();
  Vector3d flat_toward = toward - up * up.dot(toward);
  if (flat_toward.norm() < 1e-6) flat_toward = up.unitOrthogonal();
  flat_toward.normalize();
  const Vector3d sun = (0.35 * flat_toward - 0.5 * up.cross(flat_toward) + 1.2 * up).normalized();
  const bool with_shadow = p.options.ground && p.options.shadow && !box.isEmpty();
  const Ground plane =
      make_ground(up, box.isEmpty() ? Eigen::AlignedBox3d(up * 0.0, up * 0.0) : box, sun);
  const Matrix4f view_projection =
      (projection_matrix(scene.camera, double(p.options.width) / p.options.height) *
       view_matrix(scene.camera))
          .cast<float>();
  p.gl.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  if (with_shadow) p.draw_coverage(scene, plane, sun);
  p.gl.BindFramebuffer(GL_FRAMEBUFFER, p.drawn.framebuffer);
  p.gl.Viewport(0, 0, p.options.width, p.options.height);
  p.gl.Enable(GL_DEPTH_TEST);
  p.gl.DepthFunc(GL_LEQUAL);
  p.gl.Disable(GL_BLEND);
  p.gl.ClearColor(kHorizon[0], kHorizon[1], kHorizon[2], 1);
  p.gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  p.draw_robot(scene, view_projection, sun);
  p.draw_ground(scene, view_projection, plane);
  p.draw_overlay(scene, view_projection, sun);
  return p.read();
}

}  // namespace ayumi
