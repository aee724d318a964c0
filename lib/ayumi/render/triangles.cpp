#include "ayumi/render/triangles.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>

#include "ayumi/base/error.hpp"
#include "ayumi/base/key_numbers.hpp"
#include "ayumi/math/rotation.hpp"

namespace ayumi {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using Eigen::Vector4f;
constexpr double kTurn = 2 * std::numbers::pi;  // a full turn [rad]
// Segments around an axis; a sphere takes half as many from pole to pole.
constexpr int kSegments = 32;

std::array<std::uint8_t, 4> to_bytes(const Vector4f& color) {
  std::array<std::uint8_t, 4> bytes;
  for (int i = 0; i < 4; ++i)
    bytes[i] = static_cast<std::uint8_t>(std::lround(255 * std::clamp(color[i], 0.0f, 1.0f)));
  return bytes;
}

std::uint32_t add_vertex(Triangles& target, const Vector3d& position, const Vector3d& normal,
                         const Vector4f& color) {
  target.vertices.push_back(
      {position.cast<float>(), normal.cast<float>(), to_bytes(color), Eigen::Vector2f::Zero()});
  return static_cast<std::uint32_t>(target.vertices.size() - 1);
}

void add_triangle(Triangles& target, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  target.indices.insert(target.indices.end(), {a, b, c});
}

/// A profile of points (radius, z) with a normal each, which is turned about z. Neighbouring
/// profile points form a band; z falls along the profile, so that the outside is counter-clockwise.
struct ProfilePoint {
  double radius, z, normal_radius, normal_z;
};

void add_turned(Triangles& target, const std::vector<ProfilePoint>& profile, int segments,
                const Vector4f& color) {
  const auto first = static_cast<std::uint32_t>(target.vertices.size());
  for (const ProfilePoint& point : profile) {
    for (int i = 0; i <= segments; ++i) {
      const double angle = kTurn * (i % segments) / segments;  // the seam closes exactly
      const double c = std::cos(angle), s = std::sin(angle);
      add_vertex(target, {point.radius * c, point.radius * s, point.z},
                 {point.normal_radius * c, point.normal_radius * s, point.normal_z}, color);
    }
  }
  const auto row = static_cast<std::uint32_t>(segments + 1);
  for (std::uint32_t k = 0; k + 1 < profile.size(); ++k) {
    for (std::uint32_t i = 0; i + 1 < row; ++i) {
      const std::uint32_t a = first + k * row + i, b = a + row;
      if (profile[k].radius > 0) add_triangle(target, a, b, a + 1);
      if (profile[k + 1].radius > 0) add_triangle(target, a + 1, b, b + 1);
    }
  }
}

std::vector<ProfilePoint> arc(double radius, double z, double from, double to, int steps) {
  std::vector<ProfilePoint> points;
  for (int k = 0; k <= steps; ++k) {
    const double angle = from + (to - from) * k / steps;
    double c = std::cos(angle);
    if (std::abs(c) < 1e-12) c = 0;
    points.push_back({radius * c, z + radius * std::sin(angle), c, std::sin(angle)});
  }
  return points;
}

Triangles box(const Vector3d& size, const Vector4f& color) {
  Triangles out;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      const Vector3d normal = sign * Vector3d::Unit(axis);
      const Vector3d u = Vector3d::Unit((axis + 1) % 3), v = normal.cross(u);
      const auto first = static_cast<std::uint32_t>(out.vertices.size());
      for (const auto& [a, b] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
        add_vertex(out, 0.5 * size.cwiseProduct(normal + a * u + b * v), normal, color);
      add_triangle(out, first, first + 1, first + 2);
      add_triangle(out, first, first + 2, first + 3);
    }
  }
  return out;
}

Triangles capsule(double radius, double length, const Vector4f& color) {
  const double quarter = kTurn / 4;
  std::vector<ProfilePoint> profile = arc(radius, length / 2, quarter, 0, kSegments / 4);
  const std::vector<ProfilePoint> lower = arc(radius, -length / 2, 0, -quarter, kSegments / 4);
  profile.insert(profile.end(), lower.begin() + (length > 0 ? 0 : 1), lower.end());
  Triangles out;
  add_turned(out, profile, kSegments, color);
  return out;
}

Triangles cylinder(double radius, double length, const Vector4f& color) {
  const double h = length / 2;
  Triangles out;
  add_turned(out, {{0, h, 0, 1}, {radius, h, 0, 1}}, kSegments, color);
  add_turned(out, {{radius, h, 1, 0}, {radius, -h, 1, 0}}, kSegments, color);
  add_turned(out, {{radius, -h, 0, -1}, {0, -h, 0, -1}}, kSegments, color);
  return out;
}

/// A frame at `origin` whose z axis is `direction`.
Eigen::Isometry3d frame_along(const Vector3d& origin, const Vector3d& direction) {
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  frame.translation() = origin;
  frame.linear() = rotation_between(Vector3d::UnitZ(), direction).matrix();
  return frame;
}

/// Vertices at the same place get the same number.
std::vector<std::uint32_t> weld(const Triangles& surface) {
  KeyNumbers<3> places(surface.vertices.size());
  std::vector<std::uint32_t> welded;
  welded.reserve(surface.vertices.size());
  for (const RenderVertex& vertex : surface.vertices) {
    KeyNumbers<3>::Key key;
    for (size_t axis = 0; axis < 3; ++axis)  // turns -0 into 0
      key[axis] = std::bit_cast<std::uint32_t>(vertex.position[Eigen::Index(axis)] + 0.0f);
    welded.push_back(places.number(key));
  }
  return welded;
}

/// Whether every edge is passed as often in one direction as in the other.
bool is_closed(const Triangles& surface) {
  const std::vector<std::uint32_t> welded = weld(surface);
  KeyNumbers<2> edges(surface.indices.size());
  std::vector<std::int32_t> balance;  // balance of each edge
  for (size_t i = 0; i < surface.indices.size(); i += 3) {
    std::array<std::uint32_t, 3> corner;
    for (size_t k = 0; k < 3; ++k) corner[k] = welded[surface.indices[i + k]];
    if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) continue;
    for (size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = corner[k], to = corner[(k + 1) % 3];
      const std::uint32_t edge = edges.number({std::min(from, to), std::max(from, to)});
      if (edge == balance.size()) balance.push_back(0);
      balance[edge] += from < to ? 1 : -1;
    }
  }
  return !balance.empty() &&
         std::all_of(balance.begin(), balance.end(), [](std::int32_t sum) { return sum == 0; });
}

double signed_volume(const Triangles& surface) {
  const Vector3d origin = surface.vertices[surface.indices[0]].position.cast<double>();
  double volume = 0;
  for (size_t i = 0; i < surface.indices.size(); i += 3) {
    std::array<Vector3d, 3> corner;
    for (size_t k = 0; k < 3; ++k)
      corner[k] = surface.vertices[surface.indices[i + k]].position.cast<double>() - origin;
    volume += corner[0].dot(corner[1].cross(corner[2])) / 6;
  }
  return volume;
}

/// The sum over the faces of their area times the cosine between face and vertex normals.
double agreement(const Triangles& surface) {
  double sum = 0;
  for (size_t i = 0; i < surface.indices.size(); i += 3) {
    const RenderVertex& a = surface.vertices[surface.indices[i]];
    const RenderVertex& b = surface.vertices[surface.indices[i + 1]];
    const RenderVertex& c = surface.vertices[surface.indices[i + 2]];
    const Vector3f face = (b.position - a.position).cross(c.position - a.position);
    sum += face.dot(a.normal + b.normal + c.normal);
  }
  return sum;
}

}  // namespace

void append(Triangles& target, const Triangles& part, const Eigen::Isometry3d& pose) {
  const auto offset = static_cast<std::uint32_t>(target.vertices.size());
  if (offset == 0) {  // most bodies have one large part
    target.vertices.reserve(part.vertices.size());
    target.indices.reserve(part.indices.size());
  }
  for (RenderVertex vertex : part.vertices) {
    vertex.position = (pose * vertex.position.cast<double>()).cast<float>();
    vertex.normal = (pose.linear() * vertex.normal.cast<double>()).cast<float>();
    target.vertices.push_back(vertex);
  }
  for (const std::uint32_t index : part.indices) target.indices.push_back(index + offset);
}

Triangles welded(const Triangles& surface) {
  using Numbers = KeyNumbers<sizeof(RenderVertex) / 4>;
  Numbers known(surface.vertices.size());
  Triangles out;
  out.indices.reserve(surface.indices.size());
  for (const std::uint32_t index : surface.indices) {
    const RenderVertex& vertex = surface.vertices[index];
    Numbers::Key key;
    std::memcpy(key.data(), &vertex, sizeof key);
    const std::uint32_t number = known.number(key);
    if (number == out.vertices.size()) out.vertices.push_back(vertex);
    out.indices.push_back(number);
  }
  return out;
}

Triangles tessellate(const Shape& primitive, const Vector4f& color) {
  if (const auto* shape = std::get_if<Box>(&primitive)) return box(shape->size, color);
  if (const auto* shape = std::get_if<Sphere>(&primitive)) return capsule(shape->radius, 0, color);
  if (const auto* shape = std::get_if<Cylinder>(&primitive))
    return cylinder(shape->radius, shape->length, color);
  if (const auto* shape = std::get_if<Capsule>(&primitive))
    return capsule(shape->radius, shape->length, color);
  fail(ErrorCode::internal, "tessellate: a mesh is not a primitive");
}

Triangles tessellate(const MeshPart& part, const Vector4f& color) {
  Triangles out;
  const bool with_normals = part.normals.size() == part.vertices.size();
  const bool with_uvs = part.uvs.size() == part.vertices.size();
  out.indices.reserve(3 * part.triangles.size());
  out.vertices.reserve(3 * part.triangles.size());
  const auto bytes = to_bytes(color);
  for (const auto& triangle : part.triangles) {
    if (std::any_of(triangle.begin(), triangle.end(),
                    [&](std::uint32_t index) { return index >= part.vertices.size(); }))
      continue;
    const Vector3f face = (part.vertices[triangle[1]] - part.vertices[triangle[0]])
                              .cross(part.vertices[triangle[2]] - part.vertices[triangle[0]]);
    if (!face.allFinite() || face.squaredNorm() == 0) continue;
    for (const std::uint32_t index : triangle) {
      Vector3f normal = with_normals ? part.normals[index] : face;
      if (!normal.allFinite() || normal.squaredNorm() == 0) normal = face;
      out.indices.push_back(static_cast<std::uint32_t>(out.vertices.size()));
      out.vertices.push_back({part.vertices[index], normal.normalized(), bytes,
                              with_uvs ? part.uvs[index] : Eigen::Vector2f(0, 0)});
    }
  }
  return out;
}

SurfaceKind orient(Triangles& surface) {
  if (surface.indices.empty()) return SurfaceKind::open;
  const bool closed = is_closed(surface);
  if (closed && signed_volume(surface) < 0) {
    for (size_t i = 0; i < surface.indices.size(); i += 3)
      std::swap(surface.indices[i + 1], surface.indices[i + 2]);
  }
  if (agreement(surface) < 0)
    for (RenderVertex& vertex : surface.vertices) vertex.normal = -vertex.normal;
  return closed ? SurfaceKind::closed : SurfaceKind::open;
}

Eigen::AlignedBox3d bounds(const Triangles& surface) {
  Eigen::AlignedBox3d box;
  for (const RenderVertex& vertex : surface.vertices)
    box.extend(vertex.position.cast<double>().eval());
  return box;
}

void add_sphere(Triangles& target, const Vector3d& center, double radius, const Vector4f& color) {
  Triangles sphere;
  const double quarter = kTurn / 4;
  add_turned(sphere, arc(radius, 0, quarter, -quarter, 10), 20, color);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = center;
  append(target, sphere, pose);
}

void add_rod(Triangles& target, const Vector3d& from, const Vector3d& to, double radius,
             const Vector4f& color) {
  const double length = (to - from).norm();
  if (length < 1e-4) return;
  Triangles rod;
  add_turned(rod, {{radius, length, 1, 0}, {radius, 0, 1, 0}}, 12, color);
  append(target, rod, frame_along(from, to - from));
}

void add_arrow(Triangles& target, const Vector3d& from, const Vector3d& to, double radius,
               const Vector4f& color) {
  const double length = (to - from).norm();
  if (length < 1e-4) return;
  const double wide = 2.6 * radius, head = std::min(6.5 * radius, 0.6 * length);
  const double neck = length - head, slope = std::hypot(wide, head);
  Triangles arrow;
  add_turned(arrow, {{radius, neck, 1, 0}, {radius, 0, 1, 0}}, 16, color);
  add_turned(arrow, {{radius, 0, 0, -1}, {0, 0, 0, -1}}, 16, color);
  add_turned(arrow,
             {{0, length, head / slope, wide / slope}, {wide, neck, head / slope, wide / slope}},
             16, color);
  add_turned(arrow, {{wide, neck, 0, -1}, {0, neck, 0, -1}}, 16, color);
  append(target, arrow, frame_along(from, to - from));
}

void add_ring(Triangles& target, const Vector3d& center, const Vector3d& normal, double inner,
              double outer, const Vector4f& color) {
  Triangles ring;
  add_turned(ring, {{inner, 0, 0, 0}, {outer, 0, 0, 0}}, kSegments, color);
  append(target, ring, frame_along(center, normal));
}

void add_band(Triangles& target, const std::vector<Vector3d>& points,
              const std::vector<Vector4f>& color_at, const Vector3d& normal, double width,
              bool closed) {
  const size_t count = points.size();
  if (count < 2) return;
  const auto first = static_cast<std::uint32_t>(target.vertices.size());
  for (size_t i = 0; i < count; ++i) {
    const Vector3d& before = points[i > 0 ? i - 1 : (closed ? count - 1 : 0)];
    const Vector3d& after = points[i + 1 < count ? i + 1 : (closed ? 0 : count - 1)];
    const Vector3d in = (points[i] - before).normalized(), out = (after - points[i]).normalized();
    Vector3d along = in + out;
    if (along.squaredNorm() < 1e-12) along = after - before;
    const Vector3d side = normal.cross(along).normalized();
    const double bend = std::max(0.5, std::abs(side.dot(normal.cross(out).normalized())));
    const double reach = 0.5 * width / (out.squaredNorm() > 0 && in.squaredNorm() > 0 ? bend : 1.0);
    add_vertex(target, points[i] + reach * side, Vector3d::Zero(), color_at[i]);
    add_vertex(target, points[i] - reach * side, Vector3d::Zero(), color_at[i]);
  }
  for (std::uint32_t i = 0; i < (closed ? count : count - 1); ++i) {
    const std::uint32_t a = first + 2 * i, b = first + 2 * ((i + 1) % count);
    add_triangle(target, a, a + 1, b + 1);
    add_triangle(target, a, b + 1, b);
  }
}

void add_polygon(Triangles& target, const std::vector<Vector3d>& points, const Vector4f& color) {
  const auto first = static_cast<std::uint32_t>(target.vertices.size());
  for (const Vector3d& point : points) add_vertex(target, point, Vector3d::Zero(), color);
  for (std::uint32_t i = 1; i + 1 < points.size(); ++i)
    add_triangle(target, first, first + i, first + i + 1);
}

}  // namespace ayumi
