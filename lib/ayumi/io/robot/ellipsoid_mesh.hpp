#pragma once
// An ellipsoid as a mesh, for formats that have this shape. Only files of io/robot include it.

#include <cmath>
#include <numbers>

#include "ayumi/geometry/shape.hpp"
#include "ayumi/math/elementary.hpp"

namespace ayumi {

inline TriangleMesh ellipsoid_mesh(const Eigen::Vector3d& radii) {
  // Numbers of facets. Chosen: the surface deviates by 1 % of a radius.
  constexpr int kRings = 12, kSectors = 24;
  MeshPart part;
  for (int ring = 0; ring <= kRings; ++ring)
    for (int sector = 0; sector < kSectors; ++sector) {
      const double a = std::numbers::pi * ring / kRings;
      const double b = 2 * std::numbers::pi * sector / kSectors;
      const Eigen::Vector3d unit(elementary::sin(a) * elementary::cos(b),
                                 elementary::sin(a) * elementary::sin(b), elementary::cos(a));
      part.vertices.push_back(radii.cwiseProduct(unit).cast<float>());
      part.normals.push_back(unit.cwiseQuotient(radii).normalized().cast<float>());
    }
  const auto at = [](int ring, int sector) {
    return static_cast<std::uint32_t>(ring * kSectors + sector % kSectors);
  };
  for (int ring = 0; ring < kRings; ++ring)
    for (int sector = 0; sector < kSectors; ++sector) {
      part.triangles.push_back({at(ring, sector), at(ring + 1, sector), at(ring + 1, sector + 1)});
      part.triangles.push_back({at(ring, sector), at(ring + 1, sector + 1), at(ring, sector + 1)});
    }
  return {{part}};
}

}  // namespace ayumi
