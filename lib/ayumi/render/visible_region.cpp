#include "ayumi/render/visible_region.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace ayumi {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr int kSpare = 2;  // pixels around the visible part, for smoothed edges
constexpr int kTile = 16;  // edge of a tile [pixel]
// Distance from the middle of the picture, in half widths of the picture, beyond which all tiles
// count as covered. Chosen: multiplied by 4096 pixels, it still fits into an int.
constexpr double kFarOutside = 1e4;

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
  // A place far outside has the same effect as one just outside, and this one fits into an int.
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

CoveredTiles::CoveredTiles(const Eigen::Matrix4f& view_projection, int width, int height,
                           const PixelBox& box)
    : view_projection_(view_projection.cast<double>()),
      width_(width),
      height_(height),
      box_(box),
      columns_((box.width + kTile - 1) / kTile),
      rows_((box.height + kTile - 1) / kTile),
      covered_(size_t(columns_) * size_t(rows_), false) {}

void CoveredTiles::add(std::span<const Vector3d> points) {
  std::vector<Vector2d> seen;  // places of visible points from the box's corner [pixel]
  Eigen::AlignedBox2d all;
  for (const Vector3d& point : points) {
    const Eigen::Vector4d clip = view_projection_ * point.homogeneous();
    // The place of the point does not fit into an int, and a nearer place would change the
    // direction of the edges that end there.
    if (clip.w() < 1e-6 || !(clip.head<2>().cwiseAbs().maxCoeff() <= kFarOutside * clip.w()))
      return std::fill(covered_.begin(), covered_.end(), true);
    const Vector2d place = clip.head<2>() / clip.w();
    seen.emplace_back((0.5 + 0.5 * place.x()) * width_ - box_.x,
                      (0.5 + 0.5 * place.y()) * height_ - box_.y);
    all.extend(seen.back());
  }
  if (all.isEmpty()) return;
  const auto tile = [](double at, int count) {
    return std::clamp(static_cast<int>(std::floor(at / kTile)), 0, count - 1);
  };
  const auto is_beside = [](double low, double high, int count) {
    return high < 0 || low >= double(count) * kTile;
  };
  if (is_beside(all.min().y() - kSpare, all.max().y() + kSpare, rows_)) return;
  const int last = tile(all.max().y() + kSpare, rows_);
  for (int row = tile(all.min().y() - kSpare, rows_); row <= last; ++row) {
    const double bottom = row * kTile - kSpare, top = (row + 1) * kTile + kSpare;
    double low = INFINITY, high = -INFINITY;
    const auto take = [&](double x) {
      low = std::min(low, x);
      high = std::max(high, x);
    };
    // The tiles between any two points, within the row, are covered.
    for (size_t i = 0; i < seen.size(); ++i)
      for (size_t k = i; k < seen.size(); ++k) {
        const Vector2d &a = seen[i], &b = seen[k];
        const double rise = b.y() - a.y();
        double from = 0, to = 1;
        if (std::abs(rise) > 1e-9) {
          const double at_bottom = (bottom - a.y()) / rise, at_top = (top - a.y()) / rise;
          from = std::max(from, std::min(at_bottom, at_top));
          to = std::min(to, std::max(at_bottom, at_top));
        } else if (a.y() < bottom || a.y() > top) {
          continue;
        }
        if (from > to) continue;
        take(a.x() + from * (b.x() - a.x()));
        take(a.x() + to * (b.x() - a.x()));
      }
    if (!(low <= high) || is_beside(low - kSpare, high + kSpare, columns_)) continue;
    const auto begin = covered_.begin() + row * columns_;
    std::fill(begin + tile(low - kSpare, columns_), begin + tile(high + kSpare, columns_) + 1,
              true);
  }
}

void CoveredTiles::add(const Eigen::AlignedBox3d& box, const Eigen::Isometry3d& pose) {
  if (box.isEmpty()) return;
  std::array<Vector3d, 8> corners;
  for (int i = 0; i < 8; ++i)
    corners[size_t(i)] = pose * box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
  add(corners);
}

std::vector<PixelBox> CoveredTiles::runs() const {
  std::vector<PixelBox> all;
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_;) {
      const auto is_covered = [&](int at) {
        return at < columns_ && covered_[size_t(row) * size_t(columns_) + size_t(at)];
      };
      const int first = column;
      while (is_covered(column)) ++column;
      if (column > first) {
        const int x = first * kTile, y = row * kTile;
        all.push_back({box_.x + x, box_.y + y, std::min(column * kTile, box_.width) - x,
                       std::min(y + kTile, box_.height) - y});
      } else {
        ++column;
      }
    }
  return all;
}

}  // namespace ayumi
