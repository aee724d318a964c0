#include "corners.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "ayumi/base/key_numbers.hpp"

namespace ayumi::mesh_reader {

namespace {

using Eigen::Vector3f;

// Cosine of the angle between facets above which an edge is a crease. Chosen: 40 degrees. Sharper
// edges keep separate normals, while the facets of round parts do not.
constexpr float kCrease = 0.766f;
// Largest number of facets at one place that are compared with each other. Chosen: a place of a
// fine mesh has about six; the tip of a larger fan keeps the normals of its facets.
constexpr std::uint32_t kMostAround = 64;

// The bits of a number, where -0 has the bits of 0.
std::uint32_t bits(float number) { return std::bit_cast<std::uint32_t>(number + 0.0f); }

/// Gives each triangle three vertices of its own.
void separate(MeshPart& part) {
  MeshPart apart = part;
  apart.vertices.clear();
  apart.normals.clear();
  apart.uvs.clear();
  for (std::array<std::uint32_t, 3>& triangle : apart.triangles)
    for (std::uint32_t& corner : triangle) {
      const std::uint32_t vertex = corner;
      corner = static_cast<std::uint32_t>(apart.vertices.size());
      apart.vertices.push_back(part.vertices[vertex]);
      apart.normals.push_back(part.normals[vertex]);
      if (!part.uvs.empty()) apart.uvs.push_back(part.uvs[vertex]);
    }
  part = std::move(apart);
}

/// Unit vectors, or zero for flat triangles. They are computed in double, because the squared area
/// of a tiny or huge triangle leaves the range of float.
std::vector<Vector3f> facet_normals(const MeshPart& part) {
  std::vector<Vector3f> normals;
  normals.reserve(part.triangles.size());
  for (const auto& [a, b, c] : part.triangles) {
    const Eigen::Vector3d at = part.vertices[a].cast<double>();
    const Eigen::Vector3d area =
        (part.vertices[b].cast<double>() - at).cross(part.vertices[c].cast<double>() - at);
    const double size = area.norm();
    const bool usable = std::isfinite(size) && size > 0;
    normals.emplace_back(usable ? (area / size).cast<float>().eval() : Vector3f::Zero().eval());
  }
  return normals;
}

/// Makes the missing normals of a part in which each vertex is a corner of only one triangle.
void make_missing_normals(MeshPart& part) {
  const size_t corners = part.vertices.size();
  const std::vector<Vector3f> facets = facet_normals(part);
  KeyNumbers<3> numbers(corners);
  std::vector<std::uint32_t> place_of;
  place_of.reserve(corners);
  for (const Vector3f& at : part.vertices)
    place_of.push_back(numbers.number({bits(at.x()), bits(at.y()), bits(at.z())}));
  std::vector<std::uint32_t> first(numbers.size() + 1), around(corners);
  for (const std::uint32_t place : place_of) ++first[place + 1];
  for (size_t place = 1; place < first.size(); ++place) first[place] += first[place - 1];
  std::vector<std::uint32_t> next = first;
  for (size_t corner = 0; corner < corners; ++corner)
    around[next[place_of[corner]]++] = static_cast<std::uint32_t>(corner);
  for (size_t corner = 0; corner < corners; ++corner) {
    if (!part.normals[corner].isZero()) continue;
    const Vector3f& own = facets[corner / 3];
    const std::uint32_t begin = first[place_of[corner]], end = first[place_of[corner] + 1];
    Vector3f sum = own;
    if (end - begin <= kMostAround) {
      sum.setZero();
      for (std::uint32_t k = begin; k < end; ++k) {
        const Vector3f& other = facets[around[k] / 3];
        if (own.dot(other) > kCrease) sum += other;
      }
    }
    part.normals[corner] = sum.isZero() ? Vector3f::UnitZ().eval() : sum.normalized().eval();
  }
}

void join(MeshPart& part) {
  KeyNumbers<8> numbers(part.vertices.size());
  std::vector<std::uint32_t> number_of;
  number_of.reserve(part.vertices.size());
  size_t count = 0;
  for (size_t i = 0; i < part.vertices.size(); ++i) {
    const Vector3f &at = part.vertices[i], &normal = part.normals[i];
    KeyNumbers<8>::Key key = {bits(at.x()),
                              bits(at.y()),
                              bits(at.z()),
                              bits(normal.x()),
                              bits(normal.y()),
                              bits(normal.z()),
                              0,
                              0};
    if (!part.uvs.empty()) key[6] = bits(part.uvs[i].x()), key[7] = bits(part.uvs[i].y());
    const std::uint32_t number = numbers.number(key);
    number_of.push_back(number);
    if (number < count) continue;
    part.vertices[count] = at;
    part.normals[count] = normal;
    if (!part.uvs.empty()) part.uvs[count] = part.uvs[i];
    ++count;
  }
  part.vertices.resize(count);
  part.normals.resize(count);
  if (!part.uvs.empty()) part.uvs.resize(count);
  for (std::array<std::uint32_t, 3>& triangle : part.triangles)
    for (std::uint32_t& corner : triangle) corner = number_of[corner];
}

}  // namespace

void finish_corners(MeshPart& part) {
  const bool missing = std::any_of(part.normals.begin(), part.normals.end(),
                                   [](const Vector3f& normal) { return normal.isZero(); });
  if (missing) {
    separate(part);
    make_missing_normals(part);
  }
  join(part);
}

}  // namespace ayumi::mesh_reader
