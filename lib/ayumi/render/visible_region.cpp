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

}  // namespace ayumi
