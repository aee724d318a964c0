#include "ayumi/render/hidden_parts.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <numeric>

#include "ayumi/base/key_numbers.hpp"

namespace ayumi {
namespace {

using Eigen::Vector3d;

// Largest distance of a corner outside a plane of its own part, as a share of the part's size. A
// hidden corner must be inside by twice this distance. Chosen: a part of 200 pixels is then convex
// to 0.04 pixels. With half of the value, round parts whose corners have six digits are not convex;
// with twice, it is 0.08 pixels.
constexpr double kFlat = 2e-4;
// Largest product of planes and corners of a part that is examined. Chosen: that of a part of 1,150
// triangles. With twice the value, heavy meshes take longer to examine; with half, finely divided
// balls and tubes are left out.
constexpr size_t kMostWork = 4'000'000;
// Number of pairs of a piece and a triangle of a body above which nothing is left out. Chosen:
// these pairs take about half a second; a body with so many pieces has screws and grilles, which
// hide little.
constexpr size_t kMostTests = 200'000'000;

/// A group of triangles that are connected.
struct Piece {
  std::vector<std::uint32_t> triangles;  // first index of each triangle, divided by 3
  Eigen::AlignedBox3d box;
  std::vector<Eigen::Vector4d> planes;  // positive outside; empty if the part is not convex
};

Vector3d place(const Triangles& surface, size_t index) {
  return surface.vertices[surface.indices[index]].position.cast<double>();
}

std::vector<Piece> pieces_of(const Triangles& surface) {
  KeyNumbers<3> numbers(surface.vertices.size());
  std::vector<std::uint32_t> place_of;
  for (const RenderVertex& vertex : surface.vertices) {
    KeyNumbers<3>::Key key;
    for (size_t axis = 0; axis < 3; ++axis)  // turns -0 into 0
      key[axis] = std::bit_cast<std::uint32_t>(vertex.position[Eigen::Index(axis)] + 0.0f);
    place_of.push_back(numbers.number(key));
  }
  std::vector<std::uint32_t> joined(numbers.size());
  std::iota(joined.begin(), joined.end(), 0u);
  const auto first_of = [&](std::uint32_t at) {
    while (joined[at] != at) at = joined[at] = joined[joined[at]];
    return at;
  };
  for (size_t i = 0; i + 2 < surface.indices.size(); i += 3)
    for (size_t k = 1; k < 3; ++k)
      joined[first_of(place_of[surface.indices[i + k]])] = first_of(place_of[surface.indices[i]]);
  std::vector<Piece> pieces;
  std::vector<std::int64_t> piece_of(numbers.size(), -1);
  for (size_t i = 0; i + 2 < surface.indices.size(); i += 3) {
    std::int64_t& piece = piece_of[first_of(place_of[surface.indices[i]])];
    if (piece < 0) {
      piece = static_cast<std::int64_t>(pieces.size());
      pieces.emplace_back();
    }
    Piece& its = pieces[size_t(piece)];
    its.triangles.push_back(static_cast<std::uint32_t>(i / 3));
    for (size_t k = 0; k < 3; ++k) its.box.extend(place(surface, i + k));
  }
  return pieces;
}

void find_planes(const Triangles& surface, Piece& piece) {
  const double flat = kFlat * piece.box.diagonal().norm();
  const size_t corners = 3 * piece.triangles.size();
  if (corners * piece.triangles.size() > kMostWork) return;
  std::vector<Eigen::Vector4d> planes;
  for (const std::uint32_t triangle : piece.triangles) {
    const size_t first = size_t(3) * triangle;
    if (surface.vertices[surface.indices[first]].color[3] < 255) return;
    const Vector3d a = place(surface, first);
    const Vector3d normal = (place(surface, first + 1) - a).cross(place(surface, first + 2) - a);
    const double size = normal.norm();
    if (!(size > 0)) continue;
    planes.emplace_back(normal.x() / size, normal.y() / size, normal.z() / size,
                        -normal.dot(a) / size);
    for (const std::uint32_t other : piece.triangles)
      for (size_t k = 0; k < 3; ++k)
        if (planes.back().dot(place(surface, size_t(3) * other + k).homogeneous()) > flat) return;
  }
  piece.planes = std::move(planes);
}

/// Whether a triangle is inside, which means that all its corners are inside.
bool is_inside(const Piece& piece, const std::array<Vector3d, 3>& corners) {
  if (piece.planes.empty() || !piece.box.contains(corners[0])) return false;
  const double flat = kFlat * piece.box.diagonal().norm();
  return std::all_of(corners.begin(), corners.end(), [&](const Vector3d& corner) {
    return piece.box.contains(corner) &&
           std::all_of(piece.planes.begin(), piece.planes.end(), [&](const Eigen::Vector4d& plane) {
             return plane.dot(corner.homogeneous()) < -2 * flat;
           });
  });
}

/// Removes from the body those triangles that are inside one of the pieces, except in their own
/// piece.
void leave_out(Triangles& surface, const std::vector<Piece>& pieces,
               const std::vector<std::int64_t>& own) {
  std::vector<std::uint32_t> left;
  for (size_t i = 0; i + 2 < surface.indices.size(); i += 3) {
    const std::array<Vector3d, 3> corners = {place(surface, i), place(surface, i + 1),
                                             place(surface, i + 2)};
    bool hidden = false;
    for (size_t k = 0; k < pieces.size() && !hidden; ++k)
      hidden = (own.empty() || own[i / 3] != static_cast<std::int64_t>(k)) &&
               is_inside(pieces[k], corners);
    if (!hidden)
      left.insert(left.end(), surface.indices.begin() + static_cast<std::ptrdiff_t>(i),
                  surface.indices.begin() + static_cast<std::ptrdiff_t>(i + 3));
  }
  surface.indices = std::move(left);
}

}  // namespace

void leave_out_hidden(std::vector<BodySurface>& robot) {
  for (BodySurface& body : robot) {
    std::vector<Piece> pieces = pieces_of(body.closed);
    std::vector<std::int64_t> own(body.closed.indices.size() / 3);
    for (size_t k = 0; k < pieces.size(); ++k) {
      find_planes(body.closed, pieces[k]);
      for (const std::uint32_t triangle : pieces[k].triangles)
        own[triangle] = static_cast<std::int64_t>(k);
    }
    // A part that is not convex hides nothing here.
    if (std::none_of(pieces.begin(), pieces.end(),
                     [](const Piece& piece) { return !piece.planes.empty(); }))
      continue;
    size_t triangles = body.closed.indices.size() / 3 + body.open.indices.size() / 3;
    for (const TexturedSurface& part : body.textured)
      triangles += part.triangles.indices.size() / 3;
    if (pieces.size() * triangles > kMostTests) continue;
    leave_out(body.closed, pieces, own);
    leave_out(body.open, pieces, {});
    for (TexturedSurface& part : body.textured) leave_out(part.triangles, pieces, {});
  }
}

}  // namespace ayumi
