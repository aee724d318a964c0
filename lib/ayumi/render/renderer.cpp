#include <algorithm>
#include <map>
#include <string>

#include "ayumi/base/error.hpp"
#include "ayumi/render/renderer_parts.hpp"
#include "ayumi/render/shaders.hpp"
#include "ayumi/render/simplify.hpp"
#include "ayumi/render/texture.hpp"

// A frame is drawn in this order: first the robot's shadow, as coverage seen along the sun, which
// is read back and blurred; then ground, sky and shadow as a picture (ground_picture.hpp). Then, in
// OpenGL, only where anything else is: the depth of the ground where it may hide something, robot,
// scenery, exposures, overlay. These are drawn on a transparent background, with colours multiplied
// by the share of the pixel that they cover, and laid over the picture. Ground, sky and shadow have
// no edges that samples would smooth (the grid smooths its own lines), so one colour per pixel is
// the same as one per sample.
//
// An exposure is drawn twice, first into the depth alone, so that only its nearest surface shines
// through. It is drawn a little farther away than its true place, so that surfaces that coincide
// with it are visible without speckle. The part of the overlay behind the robot is drawn first,
// faintly, and then its visible part.

namespace ayumi {
namespace {

using Eigen::Matrix4f;
using Eigen::Vector3d;

constexpr size_t kShadowTriangles =
    4000;  // finer triangles cannot be seen in a shadow of kShadowSize

const Eigen::Vector4f kNoTint = Eigen::Vector4f::Zero();

/// Distance by which exposures lie behind their true place, as a share of the camera's distance.
/// Chosen: about 5 mm on a robot of 0.5 m, more than a servo sags. With half of the value, soles
/// and command still mix; with twice, a ghost that stands out by less than 1 cm is hidden.
constexpr double kBehind = 0.007;

/// The projection with `steps` times kBehind more of depth.
Matrix4f pushed_back(const Scene& scene, const Matrix4f& view_projection, size_t steps) {
  const Camera& camera = scene.camera;
  const double away = (camera.eye - camera.target).norm();
  const double step = kBehind * away * double(steps), range = camera.far - camera.near;
  // The growth of OpenGL's depth for this distance.
  const double deeper = camera.parallel_height > 0
                            ? 2 * step / range
                            : 2 * camera.far * camera.near / range * step / (away * (away + step));
  Matrix4f moved = view_projection;
  moved.row(2) += static_cast<float>(deeper) * view_projection.row(3);
  return moved;
}

/// The tint of a body with this heat; a body without heat keeps its own colour.
Eigen::Vector4f heat_tint(float heat) {
  Eigen::Vector4f tint = heat_color(heat);
  tint[3] = heat > 0 ? 0.35f + 0.65f * std::min(heat, 1.0f) : 0.0f;
  return tint;
}

}  // namespace

Eigen::Vector4f heat_color(float heat) {
  return {1.0f, 0.62f * (1 - std::clamp(heat, 0.0f, 1.0f)), 0.02f, 1.0f};
}

std::shared_ptr<const DrawnRobot> drawn_robot(const std::vector<BodySurface>& robot) {
  auto drawn = std::make_shared<DrawnRobot>();
  Triangles all;
  const auto add = [&](const Triangles& part) {
    const IndexRange range = {static_cast<int>(part.indices.size()), all.indices.size()};
    append(all, part);
    return range;
  };
  for (const BodySurface& body : robot) {
    DrawnRobot::Body out = {add(body.closed), add(body.open), {}, {}, {}};
    for (const TexturedSurface& part : body.textured)
      out.textured.emplace_back(add(part.triangles), part.texture);
    for (const Triangles* part : parts_of(body)) out.box.extend(bounds(*part));
    drawn->bodies.push_back(std::move(out));
  }
  drawn->triangles = welded(all);
  std::vector<BodySurface> coarse = robot;
  simplify(coarse, kShadowTriangles);
  all = {};
  for (size_t i = 0; i < coarse.size(); ++i) {
    const size_t first = all.indices.size();
    for (const Triangles* part : parts_of(coarse[i])) append(all, *part);
    drawn->bodies[i].caster = {static_cast<int>(all.indices.size() - first), first};
  }
  for (RenderVertex& vertex : all.vertices) vertex = {vertex.position, {0, 0, 0}, {}, {0, 0}};
  drawn->casters = welded(all);
  return drawn;
}

Renderer::Parts::Parts(const DrawnRobot& drawn_bodies, const RenderOptions& chosen,
                       const Scenery& on_floor)
    : options(chosen), context(chosen.way), gl(context) {
  using namespace shaders;
  solid = gl.link(kSolidVertex, kSolidFragment, kPlainInput);
  textured = gl.link(kSolidVertex, kSolidFragment, kTextureInput);
  standing = gl.link(kSceneryVertex, kSolidFragment, kSceneryInput);
  flat = gl.link(kFlatVertex, kFlatFragment);
  mean = gl.link(kMeanVertex, kMeanFragment);
  ground = gl.link(kGroundVertex, kGroundFragment, on_floor.hole.isEmpty() ? kWhole : kWithHole);
  robot = gl.make_mesh();
  caster = gl.make_mesh();
  overlay = gl.make_mesh();
  scenery = gl.make_mesh();
  bumps = gl.make_mesh();
  upload(drawn_bodies);
  gl.fill(scenery, on_floor.triangles, GL_STATIC_DRAW);
  all_scenery.count = static_cast<GLsizei>(on_floor.triangles.indices.size());
  hole_box = on_floor.hole;
  if (!on_floor.hole.isEmpty())
    hole << on_floor.hole.min().cast<float>(), on_floor.hole.max().cast<float>();
  square = gl.make_square();
  runs = gl.make_places();
  scenery_box = bounds(on_floor.triangles);
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

void Renderer::Parts::upload(const DrawnRobot& drawn_bodies) {
  std::map<std::string, GLuint> pictures;
  const auto picture = [&](const std::string& file) {
    const auto known = pictures.find(file);
    if (known != pictures.end()) return known->second;
    const Texture texture = read_texture(file, notes);
    return pictures[file] = gl.make_texture(texture.rgba, texture.width, texture.height);
  };
  for (const DrawnRobot::Body& body : drawn_bodies.bodies) {
    BodyRanges body_ranges = {body.closed, body.open, {}};
    for (const auto& [range, file] : body.textured)
      body_ranges.textured.emplace_back(range, picture(file));
    ranges.push_back(std::move(body_ranges));
    caster_ranges.push_back(body.caster);
    boxes.push_back(body.box);
  }
  gl.fill(robot, drawn_bodies.triangles, GL_STATIC_DRAW);
  gl.fill(caster, drawn_bodies.casters, GL_STATIC_DRAW);
}

Eigen::AlignedBox3d Renderer::Parts::bounds_of(const std::vector<Eigen::Isometry3d>& poses) const {
  Eigen::AlignedBox3d all;
  for (size_t i = 0; i < boxes.size(); ++i)
    if (!boxes[i].isEmpty()) all.extend(boxes[i].transformed(poses[i]));
  return all;
}

void Renderer::Parts::light(const Scene& scene, const Matrix4f& view_projection,
                            const Vector3d& sun) {
  for (const GLuint program : {standing, textured, solid}) {
    gl.UseProgram(program);
    gl.set(program, "view_projection", view_projection);
    gl.set(program, "model", Matrix4f(Matrix4f::Identity()));
    gl.set(program, "eye", scene.camera.eye);
    gl.set(program, "sun", sun);
    gl.set(program, "up", Vector3d(Vector3d::UnitZ()));
    gl.set(program, "opacity", 1.0);
    gl.set(program, "least", 1.0);
    gl.set(program, "tint", kNoTint);
  }
}

/// Draws bodies from the eye outwards, so that hidden ones are not shaded.
std::vector<size_t> Renderer::Parts::nearest_first(const Scene& scene) const {
  std::vector<std::pair<double, size_t>> away;
  for (size_t i = 0; i < boxes.size(); ++i)
    if (!boxes[i].isEmpty())
      away.emplace_back((scene.poses[i] * boxes[i].center() - scene.camera.eye).norm(), i);
  std::sort(away.begin(), away.end());
  std::vector<size_t> order;
  for (const auto& [distance, body] : away) order.push_back(body);
  return order;
}

/// On return, the program `solid` is in use, with the identity, no tint and full opacity.
template <typename Tint>
void Renderer::Parts::draw_bodies(const std::vector<Eigen::Isometry3d>& poses, double opacity,
                                  const Tint& tint) {
  gl.BindVertexArray(robot.array);
  gl.Enable(GL_CULL_FACE);
  gl.UseProgram(solid);
  gl.set(solid, "opacity", opacity);
  for (const size_t i : order) {
    const BodyRanges& range = ranges[i];
    if (!range.closed.count && !range.open.count) continue;
    gl.set(solid, "tint", tint(i));
    gl.set(solid, "model", Matrix4f(poses[i].matrix().cast<float>()));
    gl.draw(range.closed);
    if (!range.open.count) continue;
    gl.Disable(GL_CULL_FACE);
    gl.draw(range.open);
    gl.Enable(GL_CULL_FACE);
  }
  gl.Disable(GL_CULL_FACE);
  for (size_t i = 0; i < ranges.size(); ++i)
    for (const auto& [range, texture] : ranges[i].textured) {
      gl.UseProgram(textured);
      gl.BindTexture(GL_TEXTURE_2D, texture);
      gl.set(textured, "opacity", opacity);
      gl.set(textured, "tint", tint(i));
      gl.set(textured, "model", Matrix4f(poses[i].matrix().cast<float>()));
      gl.draw(range);
    }
  gl.Enable(GL_CULL_FACE);
  gl.UseProgram(solid);
  gl.set(solid, "model", Matrix4f(Matrix4f::Identity()));
  gl.set(solid, "tint", kNoTint);
  gl.set(solid, "opacity", 1.0);
}

/// On return, the program `solid` is in use.
void Renderer::Parts::draw_scenery(const Scene& scene, const Matrix4f& flatten, bool with_shadow) {
  if (!all_scenery.count && scene.bumps.indices.empty()) return;
  gl.UseProgram(standing);
  gl.set(standing, "model", Matrix4f(scene.floor.matrix().cast<float>()));
  gl.set(standing, "flatten", flatten);
  gl.set(standing, "strength", with_shadow ? 0.6 : 0.0);
  gl.BindTexture(GL_TEXTURE_2D, coverage);
  gl.BindVertexArray(scenery.array);
  gl.draw(all_scenery);
  if (!scene.bumps.indices.empty()) {
    gl.fill(bumps, scene.bumps, GL_STREAM_DRAW);
    gl.draw({static_cast<GLsizei>(scene.bumps.indices.size()), 0});
  }
  gl.UseProgram(solid);
}

void Renderer::Parts::set_view(const Matrix4f& view_projection) {
  for (const GLuint program : {textured, solid}) {
    gl.UseProgram(program);
    gl.set(program, "view_projection", view_projection);
  }
}

void Renderer::Parts::begin_mixing() {
  for (const GLuint program : {textured, solid}) {
    gl.UseProgram(program);
    gl.set(program, "least", 0.0);
  }
}

void Renderer::Parts::draw_exposures(const Scene& scene, const Matrix4f& view_projection) {
  for (size_t i = 0; i < scene.exposures.size(); ++i) {
    const Exposure& exposure = scene.exposures[i];
    set_view(pushed_back(scene, view_projection, scene.exposures.size() - i));
    const auto tint = [&](size_t) { return exposure.tint; };
    gl.ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    draw_bodies(exposure.poses, exposure.opacity, tint);
    gl.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl.Enable(GL_BLEND);
    draw_bodies(exposure.poses, exposure.opacity, tint);
    gl.Disable(GL_BLEND);
  }
  set_view(view_projection);
}

void Renderer::Parts::draw_overlay(const Scene& scene) {
  if (scene.overlay.indices.empty()) return;
  gl.fill(overlay, scene.overlay, GL_STREAM_DRAW);
  gl.UseProgram(solid);
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

Renderer::Renderer(const std::vector<BodySurface>& robot, const RenderOptions& options,
                   const Scenery& scenery)
    : Renderer(options, *drawn_robot(robot), scenery) {}

Renderer::Renderer(const RenderOptions& options, const DrawnRobot& robot, const Scenery& scenery) {
  for (const int edge : {options.width, options.height})
    if (edge < 1 || edge > 4096)
      fail(ErrorCode::usage, "picture size " + std::to_string(options.width) + "x" +
                                 std::to_string(options.height) +
                                 ": each edge must be 1 to 4096 pixels");
  parts_ = std::make_unique<Parts>(robot, options, scenery);
}

Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

void Renderer::reuse(Image image) { parts_->spare = std::move(image); }

Image Renderer::render(const Scene& scene) {
  Parts& p = *parts_;
  require(scene.poses.size() == p.ranges.size(), "a scene needs one pose per body");
  for (const Exposure& exposure : scene.exposures)
    require(exposure.poses.size() == p.ranges.size(), "an exposure needs one pose per body");
  p.context.make_current();
  const Eigen::AlignedBox3d box = p.bounds_of(scene.poses);
  const Vector3d sun = sun_behind(scene.camera, Vector3d::UnitZ());
  // If the sun only grazes the plane, the shadow would have no end.
  const bool with_shadow = p.options.ground && p.options.shadow && !box.isEmpty() &&
                           scene.camera.parallel_height <= 0 &&
                           scene.ground.linear().col(2).dot(sun) > 0.2;
  const Vector3d none = Vector3d::Zero();
  const GroundRectangle plane =
      ground_rectangle(scene.ground, box.isEmpty() ? Eigen::AlignedBox3d(none, none) : box, sun);
  const Eigen::Matrix4d flatten = flattening(plane, sun);
  const Eigen::Matrix4d to_clip =
      projection_matrix(scene.camera, double(p.options.width) / p.options.height) *
      view_matrix(scene.camera);
  const Matrix4f view_projection = to_clip.cast<float>();
  const Setting setting = {plane, view_projection};
  // The colours of everything that is drawn on the transparent background are multiplied by the
  // share of the pixel that it covers, and these shares add up.
  p.gl.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  p.gl.Disable(GL_BLEND);
  p.gl.Disable(GL_SCISSOR_TEST);
  p.shadow.cover.clear();
  if (with_shadow) p.draw_coverage(scene, flatten);
  Image image = std::move(p.spare);
  GroundPicture(scene.camera, to_clip, p.options.width, p.options.height, plane, p.hole_box,
                p.options.ground)
      .draw(p.shadow, image);
  const PixelBox part = p.with_bodies(scene, view_projection);
  if (part.width <= 0 || part.height <= 0) return image;
  p.make_room(part);
  p.gl.BindFramebuffer(GL_FRAMEBUFFER, p.drawn.framebuffer);
  p.gl.Viewport(-part.x, -part.y, p.options.width, p.options.height);
  p.gl.DepthFunc(GL_LEQUAL);
  p.gl.Enable(GL_DEPTH_TEST);
  p.gl.ClearColor(0, 0, 0, 0);
  // A part of a target would be cleared by drawing over it, which takes much longer.
  p.gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  p.gl.Enable(GL_SCISSOR_TEST);
  p.gl.Scissor(0, 0, part.width, part.height);
  p.draw_plane_depth(scene, setting, part);
  p.order = p.nearest_first(scene);
  p.light(scene, view_projection, sun);
  p.draw_bodies(scene.poses, 1.0, [&](size_t i) {
    return i < scene.heat.size() ? heat_tint(scene.heat[i]) : kNoTint;
  });
  p.draw_scenery(scene, flatten.cast<float>(), with_shadow);
  p.begin_mixing();
  p.draw_exposures(scene, view_projection);
  p.draw_overlay(scene);
  p.lay_over(part, p.covered_runs(scene, view_projection, part), image);
  return image;
}

const std::vector<std::string>& Renderer::notes() const { return parts_->notes; }

}  // namespace ayumi
