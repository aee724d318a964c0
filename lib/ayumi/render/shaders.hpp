#pragma once
// The renderer's shader programs (GLSL 3.30). Colours are linear inside, sRGB at the end.

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

// The shader above with a picture instead of the colour. It is a separate program, because for
// software renderers a sampler costs time even if it is not used.
inline constexpr const char* kTextureInput = R"(
in vec2 place;
uniform sampler2D picture;
vec4 surface_color(vec4 base) {
  vec4 texel = texture(picture, place);
  return vec4(to_linear(texel.rgb) * base.rgb, texel.a * base.a);
}
)";
inline constexpr const char* kPlainInput = "vec4 surface_color(vec4 base) { return base; }\n";

// Objects on the floor are darker where the robot's shadow falls on them. `place` is the point of
// the shadow's coverage texture onto which the sun projects the vertex.
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

// The light comes from the whole sky, brighter from above, and from the sun, which also makes a
// dull highlight. A face that is seen from behind, or whose normal points away from the eye, is lit
// as if it were seen from the front. A normal that points only slightly away from the eye, as at an
// outline, is kept, because the reversed normal would point down to the dark side. A mark has a
// zero normal and is not lit. `least` is 1 if nothing is visible through the surface.
inline constexpr const char* kSolidFragment = R"(
in vec3 world_position;
in vec3 world_normal;
in vec4 base_color;
uniform vec3 eye;
uniform vec3 sun;
uniform vec3 up;
uniform float opacity;
uniform float least;
out vec4 pixel;
void main() {
  vec4 own_color = surface_color(base_color);
  float size = dot(world_normal, world_normal);
  vec3 n = world_normal * inversesqrt(max(size, 1e-12));
  vec3 v = normalize(eye - world_position);
  n = dot(n, v) < (gl_FrontFacing ? -0.25 : 0.0) ? -n : n;
  float direct = max(dot(n, sun), 0.0);
  vec3 ambient = mix(vec3(0.30, 0.29, 0.28), vec3(0.62, 0.65, 0.70), 0.5 + 0.5 * dot(n, up));
  vec3 half_way = v + sun;
  float shine = max(dot(n, half_way), 0.0);
  shine *= shine / max(dot(half_way, half_way), 1e-12);
  shine *= shine; shine *= shine; shine *= shine; shine *= shine;
  // A black surface still reflects a little of the sky.
  vec3 lit = own_color.rgb * (0.62 * ambient + 0.72 * direct) + 0.015 * ambient +
             0.10 * shine * direct;
  pixel = vec4(to_srgb(size < 1e-6 ? own_color.rgb : lit), max(own_color.a * opacity, least));
}
)";

// A square of the ground plane; plane coordinates in metres.
inline constexpr const char* kGroundVertex = R"(
layout(location = 0) in vec2 corner;
uniform mat4 view_projection;
uniform vec3 origin;
uniform vec3 axis_u;
uniform vec3 axis_v;
uniform vec2 center;
uniform float reach;
out vec2 plane;
void main() {
  plane = center + reach * corner;
  gl_Position = view_projection * vec4(origin + plane.x * axis_u + plane.y * axis_v, 1.0);
}
)";

// There are two programs, with and without a hole, because a program that may leave out pixels
// prevents the early depth test.
inline constexpr const char* kWhole = "bool outside(vec2 p) { return true; }\n";
inline constexpr const char* kWithHole = R"(
uniform vec4 hole;
bool outside(vec2 p) { return any(lessThan(p, hole.xy)) || any(greaterThan(p, hole.zw)); }
)";

// This shader only writes the depth of the ground.
inline constexpr const char* kGroundFragment = R"(
in vec2 plane;
out vec4 pixel;
void main() {
  if (!outside(plane)) discard;
  pixel = vec4(0.0);
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

// Computes one colour from the samples of each pixel; places are in pixels.
inline constexpr const char* kMeanVertex = R"(
layout(location = 0) in vec2 place;
uniform vec2 center;
void main() { gl_Position = vec4(place / center - 1.0, 0.0, 1.0); }
)";

inline constexpr const char* kMeanFragment = R"(
uniform sampler2DMS samples;
out vec4 pixel;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  pixel = 0.25 * (texelFetch(samples, at, 0) + texelFetch(samples, at, 1) +
                  texelFetch(samples, at, 2) + texelFetch(samples, at, 3));
}
)";

}  // namespace ayumi::shaders
