#include "ayumi/render/simplify.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "ayumi/base/key_numbers.hpp"

// Each vertex moves to the mean of the vertices in its cell, and triangles whose corners share a
// cell are removed. A removed triangle has no area, so that a closed surface stays closed: at each
// edge of the surface, as many triangles run through it in one direction as in the other. Within a
// cell, vertices that look towards different sides of a cube keep normals of their own, so that
// edges stay edges.

namespace ayumi {
namespace {

using Eigen::Vector3f;

/// A key of the cell of a point; the lowest three bits are the side of a cube to which its normal
/// points.
std::uint64_t key_of(const RenderVertex& vertex, const Vector3f& origin, float edge,
                     bool with_side) {
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const float cell = std::floor((vertex.position[axis] - origin[axis]) / edge);
    key = key << 20 | (static_cast<std::uint64_t>(cell) & 0xfffff);
  }
  if (!with_side) return key;
  Eigen::Index axis = 0;
  vertex.normal.cwiseAbs().maxCoeff(&axis);
  return key << 3 | static_cast<std::uint64_t>(2 * axis + (vertex.normal[axis] < 0 ? 1 : 0));
}

struct Cells {
  KeyNumbers<2> numbers;
  std::vector<Vector3f> sum;
  std::vector<float> count;

  explicit Cells(size_t vertices) : numbers(vertices) {}

  std::uint32_t add(std::uint64_t key, const Vector3f& value) {
    const std::uint32_t number =
        numbers.number({static_cast<std::uint32_t>(key), static_cast<std::uint32_t>(key >> 32)});
    if (number == sum.size()) {
      sum.emplace_back(Vector3f::Zero());
      count.push_back(0);
    }
    sum[number] += value;
    count[number] += 1;
    return number;
  }
};

Triangles clustered(const Triangles& surface, float edge) {
  Triangles out;
  if (surface.indices.empty()) return out;
  const Vector3f origin = bounds(surface).min().cast<float>();
  Cells places(surface.vertices.size()), normals(surface.vertices.size());
  std::vector<std::uint32_t> place, side;
  for (const RenderVertex& vertex : surface.vertices) {
    place.push_back(places.add(key_of(vertex, origin, edge, false), vertex.position));
    side.push_back(normals.add(key_of(vertex, origin, edge, true), vertex.normal));
  }
  for (size_t i = 0; i < surface.indices.size(); i += 3) {
    const std::array<std::uint32_t, 3> corner = {surface.indices[i], surface.indices[i + 1],
                                                 surface.indices[i + 2]};
    const std::uint32_t a = place[corner[0]], b = place[corner[1]], c = place[corner[2]];
    if (a == b || b == c || c == a) continue;
    for (const std::uint32_t index : corner) {
      RenderVertex vertex = surface.vertices[index];
      vertex.position = places.sum[place[index]] / places.count[place[index]];
      const Vector3f normal = normals.sum[side[index]];
      if (normal.norm() > 1e-6f) vertex.normal = normal.normalized();
      out.indices.push_back(static_cast<std::uint32_t>(out.vertices.size()));
      out.vertices.push_back(vertex);
    }
  }
  return out;
}

size_t count_at(const std::vector<BodySurface>& surface, float edge,
                std::vector<BodySurface>& result) {
  result.clear();
  for (const BodySurface& body : surface) {
    BodySurface coarse;
    coarse.closed = clustered(body.closed, edge);
    coarse.open = clustered(body.open, edge);
    for (const TexturedSurface& part : body.textured)
      coarse.textured.push_back({clustered(part.triangles, edge), part.texture});
    result.push_back(std::move(coarse));
  }
  return triangle_count(result);
}

double area_of(const Triangles& surface) {
  double area = 0;
  for (size_t i = 0; i < surface.indices.size(); i += 3) {
    const Vector3f& a = surface.vertices[surface.indices[i]].position;
    const Vector3f& b = surface.vertices[surface.indices[i + 1]].position;
    const Vector3f& c = surface.vertices[surface.indices[i + 2]].position;
    area += 0.5 * double((b - a).cross(c - a).norm());
  }
  return area;
}

}  // namespace

size_t triangle_count(const std::vector<BodySurface>& surface) {
  size_t count = 0;
  for (const BodySurface& body : surface)
    for (const Triangles* part : parts_of(body)) count += part->indices.size() / 3;
  return count;
}

double simplify(std::vector<BodySurface>& surface, size_t max_triangles) {
  if (triangle_count(surface) <= max_triangles) return 0;
  double area = 0, largest = 0;
  for (const BodySurface& body : surface)
    for (const Triangles* part : parts_of(body)) {
      area += area_of(*part);
      if (!part->indices.empty()) largest = std::max(largest, bounds(*part).sizes().maxCoeff());
    }
  if (area <= 0) return 0;
  // A closed surface of cells of this edge has about twice as many triangles as cells.
  const double first = 0.7 * std::sqrt(2 * area / static_cast<double>(max_triangles));
  std::vector<BodySurface> result;
  for (double edge = first; edge < 2 * largest + first; edge *= 1.25) {
    if (count_at(surface, static_cast<float>(edge), result) > max_triangles) continue;
    surface = std::move(result);
    return edge;
  }
  return 0;
}

}  // namespace ayumi
