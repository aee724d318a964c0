#pragma once
// The renderer's shader programs (GLSL 3.30). Colours are linear inside, sRGB at the end; those of
// ground and sky are sRGB throughout.

namespace ayumi::shaders {

inline constexpr const char* kCommon = R"(#version 330 core
// Close to the sRGB curve, by square roots only.
vec3 to_srgb(vec3 c) {
  vec3 a = sqrt(clamp(c, 0.0, 1.0));
  vec3 b = sqrt(a);
  return 0.585122381 * a + 0.783140355 * b - 0.368262736 * sqrt(b);
}
vec3 to_linear(vec3 c) { return c * (c * (c * 0.305306011 + 0.682171111) + 0.012522878); }
)";

inline constexpr const char* kSolidVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 color;
layout(location = 3) in vec2 uv;
uniform mat4 model;
uniform mat4 view_projection;
uniform vec4 tint;
out vec3 world_position;
out vec3 world_normal;
out vec4 base_color;
out vec2 place;
void main() {
  vec4 world = model * vec4(position, 1.0);
  world_position = world.xyz;
  world_normal = mat3(model) * normal;
  base_color = vec4(mix(to_linear(color.rgb), to_linear(tint.rgb), tint.a), color.a);
  place = uv;
  gl_Position = view_projection * world;
}
)";

// The same with a picture instead of the colour: a program of its own, because
// software renderers pay for a sampler even where it is not used.
inline constexpr const char* kTextureInput = R"(
in vec2 place;
uniform sampler2D picture;
vec4 surface_color(vec4 base) {
  vec4 texel = texture(picture, place);
  return vec4(to_linear(texel.rgb) * base.rgb, texel.a * base.a);
}
)";
inline constexpr const char* kPlainInput = "vec4 surface_color(vec4 base) { return base; }\n";

// What stands on the floor is darker where the robot's shadow falls on it; `place` is where the sun
// casts it in the coverage.
inline constexpr const char* kSceneryVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 color;
uniform mat4 model;
uniform mat4 view_projection;
uniform mat4 flatten;
out vec3 world_position;
out vec3 world_normal;
out vec4 base_color;
out vec2 place;
void main() {
  vec4 world = model * vec4(position, 1.0);
  world_position = world.xyz;
  world_normal = mat3(model) * normal;
  base_color = vec4(to_linear(color.rgb), color.a);
  place = 0.5 + 0.5 * (flatten * world).xy;
  gl_Position = view_projection * world;
}
)";
inline constexpr const char* kSceneryInput = R"(
in vec2 place;
uniform sampler2D picture;
uniform float strength;
vec4 surface_color(vec4 base) {
  return vec4(base.rgb * (1.0 - strength * texture(picture, place).r), base.a);
}
)";

// Light from the whole sky, brighter from above; the sun; a dull highlight. A face seen from
// behind, or with its normal turned away, is lit as if it were the front; a normal that is turned
// away just so, at an outline, stays (turned, it would look down into the dark). Zero normal: an
// unlit mark.
inline constexpr const char* kSolidFragment = R"(
in vec3 world_position;
in vec3 world_normal;
in vec4 base_color;
uniform vec3 eye;
uniform vec3 sun;
uniform vec3 up;
uniform float opacity;
out vec4 pixel;
void main() {
  vec4 own_color = surface_color(base_color);
  float size = dot(world_normal, world_normal);
  vec3 n = world_normal * inversesqrt(max(size, 1e-12));
  vec3 v = normalize(eye - world_position);
  n = dot(n, v) < (gl_FrontFacing ? -0.25 : 0.0) ? -n : n;
  float direct = max(dot(n, sun), 0.0);
  vec3 ambient = mix(vec3(0.30, 0.29, 0.28), vec3(0.62, 0.65, 0.70), 0.5 + 0.5 * dot(n, up));
  float shine = max(dot(n, normalize(v + sun)), 0.0);
  shine *= shine; shine *= shine; shine *= shine; shine *= shine; shine *= shine;
  // What is black still mirrors a little of the sky.
  vec3 lit = own_color.rgb * (0.62 * ambient + 0.72 * direct) + 0.015 * ambient +
             0.10 * shine * direct;
  pixel = vec4(to_srgb(size < 1e-6 ? own_color.rgb : lit), own_color.a * opacity);
}
)";

// A part of the ground plane; plane coordinates in metres. `part` is its middle and half edges, in
// units of `reach` around `center`.
inline constexpr const char* kGroundVertex = R"(
layout(location = 0) in vec2 corner;
uniform mat4 view_projection;
uniform vec3 origin;
uniform vec3 axis_u;
uniform vec3 axis_v;
uniform vec2 center;
uniform float reach;
uniform vec4 part;
out vec2 plane;
void main() {
  plane = center + reach * (part.xy + part.zw * corner);
  gl_Position = view_projection * vec4(origin + plane.x * axis_u + plane.y * axis_v, 1.0);
}
)";

// Programs of their own with and without a hole: one that may leave pixels out hinders the early
// depth test.
inline constexpr const char* kWhole = "bool outside(vec2 p) { return true; }\n";
inline constexpr const char* kWithHole = R"(
uniform vec4 hole;
bool outside(vec2 p) { return any(lessThan(p, hole.xy)) || any(greaterThan(p, hole.zw)); }
)";

inline constexpr const char* kGroundFragment = R"(
in vec2 plane;
uniform vec2 center;
uniform float fade;
uniform vec3 horizon;
out vec4 pixel;
// Share of a pixel that lines of a spacing cover; far away, where they run together, their mean.
float grid(vec2 p, vec2 footprint, vec2 sharpness, float spacing, float width) {
  vec2 q = p * (1.0 / spacing);
  vec2 away = abs(q - floor(q + 0.5)) * spacing;
  vec2 cover = clamp(0.5 + (0.5 * max(vec2(width), footprint) - away) * sharpness, 0.0, 1.0) *
               min(width * sharpness, 1.0);
  cover = mix(cover, vec2(width / spacing), clamp(footprint * (2.0 / spacing) - 0.6, 0.0, 1.0));
  return max(cover.x, cover.y);
}
// Colours are sRGB here: a root per pixel of the whole picture would cost more than all the rest.
void main() {
  vec2 footprint = max(fwidth(plane), vec2(1e-6));
  vec2 sharpness = 1.0 / footprint;
  if (!outside(plane)) discard;
  vec3 color = vec3(0.798, 0.801, 0.798);
  color = mix(color, vec3(0.646, 0.653, 0.659),
              0.55 * grid(plane, footprint, sharpness, 0.1, 0.0022));
  color = mix(color, vec3(0.508, 0.518, 0.535),
              0.80 * grid(plane, footprint, sharpness, 1.0, 0.006));
  vec2 d = (plane - center) * (1.0 / fade);
  float near = 1.0 / (1.0 + dot(d, d) * dot(d, d));
  pixel = vec4(mix(horizon, color, near), 1.0);
}
)";

inline constexpr const char* kSkyVertex = R"(
layout(location = 0) in vec2 corner;
uniform float bottom;
out float height;
void main() {
  height = mix(bottom, 1.0, 0.5 + 0.5 * corner.y);
  gl_Position = vec4(corner.x, height, 1.0, 1.0);
}
)";

inline constexpr const char* kSkyFragment = R"(
in float height;
uniform vec3 horizon;
uniform float horizon_height;
out vec4 pixel;
void main() {
  vec3 zenith = vec3(0.735, 0.798, 0.867);
  pixel = vec4(mix(horizon, zenith, clamp(height - horizon_height, 0.0, 1.0)), 1.0);
}
)";

// The robot flattened along the sun onto the ground, as coverage.
inline constexpr const char* kFlatVertex = R"(
layout(location = 0) in vec3 position;
uniform mat4 flatten;
void main() { gl_Position = flatten * vec4(position, 1.0); }
)";

inline constexpr const char* kFlatFragment = R"(
out vec4 pixel;
void main() { pixel = vec4(1.0); }
)";

inline constexpr const char* kShadowFragment = R"(
in vec2 plane;
uniform vec2 center;
uniform float reach;
uniform sampler2D coverage;
uniform float strength;
out vec4 pixel;
void main() {
  if (!outside(plane)) discard;
  float cover = texture(coverage, 0.5 + 0.5 * (plane - center) / reach).r;
  pixel = vec4(0.03, 0.04, 0.07, strength * cover);
}
)";

}  // namespace ayumi::shaders
