#include "ayumi/model/outline.hpp"

#include <cmath>
#include <numbers>

#include "ayumi/geometry/box_corner.hpp"
#include "ayumi/math/elementary.hpp"

namespace ayumi {

namespace {

std::vector<Eigen::Vector3d> corners_of(const Eigen::Vector3d& size) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 8; ++i) points.push_back(box_corner(0.5 * size, i));
  return points;
}

struct Ring {
  double radius, height;
};

std::vector<Eigen::Vector3d> rings_of(const std::vector<Ring>& rings) {
  std::vector<Eigen::Vector3d> points;
  for (const Ring& ring : rings)
    for (int i = 0; i < 16; ++i) {
      const double angle = i * std::numbers::pi / 8;
      points.emplace_back(ring.radius * elementary::cos(angle),
                          ring.radius * elementary::sin(angle), ring.height);
    }
  return points;
}

// The rings of two half balls with a straight piece of the given length between them.
std::vector<Eigen::Vector3d> rounded(double radius, double length) {
  std::vector<Ring> rings;
  for (int i = 0; i <= 8; ++i) {
    const double latitude = (i - 4) * std::numbers::pi / 8;
    rings.push_back({radius * elementary::cos(latitude),
                     radius * elementary::sin(latitude) + (i < 4 ? -length / 2 : length / 2)});
  }
  if (length > 0) rings.push_back({radius, -length / 2});
  return rings_of(rings);
}

}  // namespace

std::vector<Eigen::Vector3d> outline(const Shape& shape) {
  if (const auto* box = std::get_if<Box>(&shape)) return corners_of(box->size);
  if (const auto* ball = std::get_if<Sphere>(&shape)) return rounded(ball->radius, 0);
  if (const auto* cylinder = std::get_if<Cylinder>(&shape))
    return rings_of(
        {{cylinder->radius, -cylinder->length / 2}, {cylinder->radius, cylinder->length / 2}});
  if (const auto* capsule = std::get_if<Capsule>(&shape))
    return rounded(capsule->radius, capsule->length);
  std::vector<Eigen::Vector3d> points;
  for (const MeshPart& part : std::get<MeshShape>(shape).mesh.parts)
    for (const Eigen::Vector3f& vertex : part.vertices) points.push_back(vertex.cast<double>());
  return points;
}

}  // namespace ayumi
