#include "ayumi/render/visible_region.hpp"

#include <algorithm>
#include <cmath>

namespace ayumi {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr int kSpare = 2;  // [pixel] around what is seen, for smoothed edges

}  // namespace

VisibleRegion::VisibleRegion(const Eigen::Matrix4f& view_projection, int width, int height)
    : view_projection_(view_projection.cast<double>()), width_(width), height_(height) {}

void VisibleRegion::add(const Vector3d& point) {
  const Eigen::Vector4d clip = view_projection_ * point.homogeneous();
  if (clip.w() < 1e-6) {
    seen_.extend(Vector2d(-1, -1));
    seen_.extend(Vector2d(1, 1));
    return;
  }
  // Far outside is as good as just outside, and fits an int.
  seen_.extend(Vector2d((clip.head<2>() / clip.w()).cwiseMax(-2).cwiseMin(2)));
}

void VisibleRegion::add(const Eigen::AlignedBox3d& box, const Eigen::Isometry3d& pose) {
  if (box.isEmpty()) return;
  for (int i = 0; i < 8; ++i)
    add(Vector3d(pose * box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i))));
}

PixelBox VisibleRegion::pixels() const {
  if (seen_.isEmpty()) return {};
  const auto edge = [](double at, int size, int spare) {
    return std::clamp(static_cast<int>(std::floor((0.5 + 0.5 * at) * size)) + spare, 0, size);
  };
  const int x = edge(seen_.min().x(), width_, -kSpare);
  const int y = edge(seen_.min().y(), height_, -kSpare);
  return {x, y, edge(seen_.max().x(), width_, kSpare + 1) - x,
          edge(seen_.max().y(), height_, kSpare + 1) - y};
}

std::array<PixelBox, 4> around(const PixelBox& inner, int width, int height) {
  const int right = inner.x + inner.width, top = inner.y + inner.height;
  return {{{0, 0, width, inner.y},
           {0, top, width, height - top},
           {0, inner.y, inner.x, inner.height},
           {right, inner.y, width - right, inner.height}}};
}

// The square is seen as a convex shape: it holds a row whose two ends it holds, and with the lowest
// row and another one all rows between.
double ground_height(const Camera& camera, double aspect, const GroundRectangle& plane,
                     const Vector2d& center, double reach) {
  const Eigen::Matrix3d turn = view_matrix(camera).topLeftCorner<3, 3>();  // right, up, back
  const double up = std::tan(0.5 * camera.field_of_view), right = up * aspect;
  const Vector3d eye = camera.eye - plane.origin;
  const auto is_ground = [&](double x, double y) {
    const Vector3d ray = turn.transpose() * Vector3d(x * right, y * up, -1);
    const double depth = -plane.normal.dot(eye) / plane.normal.dot(ray);
    if (!(depth > camera.near && depth < camera.far)) return false;
    const Vector3d at = eye + depth * ray;
    return std::abs(plane.u.dot(at) - center.x()) < reach &&
           std::abs(plane.v.dot(at) - center.y()) < reach;
  };
  const auto is_row = [&](double y) { return is_ground(-1, y) && is_ground(1, y); };
  if (plane.normal.dot(eye) <= 0 || !is_row(-1)) return -1;
  if (is_row(1)) return 1;
  double low = -1, high = 1;
  for (int i = 0; i < 20; ++i) (is_row(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
  return low;
}

}  // namespace ayumi
