#include "ayumi/sim/ground.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"

namespace ayumi {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// Largest depth below a block's top at which a point always stands on the top [m]. A deeper point
/// has hit the side if it is nearer to the side than to the top. Chosen: far above the penetration
/// of a loaded sole (tens of micrometres) and far below the height of a step. No measured case
/// changes between half and twice the value (constants.md).
constexpr double kLip = 0.001;
/// Largest depth inside a sole at which an edge touches the sole's face [m]; a deeper edge has hit
/// the sole's side. Chosen: five times kLip, below the thickness of a sole. No measured case
/// changes between half and twice the value (constants.md).
constexpr double kFaceDepth = 0.005;
/// Depth of a solid block below the plane [m]. Chosen: deeper than any body penetrates. No measured
/// case changes between half and twice the value (constants.md).
constexpr double kBlockDepth = 0.5;
// Definition of the ids of inner points: 1024 for each block, then the nodes of the height field.
constexpr long kBlockIds = 1 << 10, kFieldIds = 1 << 24;

/// Largest number of corners and edges of the ground that may lie under one sole at the same time.
/// Each is a contact, and the time of a step grows with the third power of their number. Chosen: a
/// sole on the edges of a dozen tiles has 60; with twice the number, a second of simulation takes
/// minutes.
constexpr size_t kMostInnerPoints = 128;

double cross_xy(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// The plane of a sole over the ground.
struct Plane {
  Vector3d origin, normal;
  /// The height at the place p.
  double at(const Vector2d& p) const {
    return origin.z() - normal.head<2>().dot(p - origin.head<2>()) / normal.z();
  }
};

bool inside(const std::vector<Vector3d>& polygon, const Vector2d& p) {
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d a = polygon[i].head<2>(), b = polygon[(i + 1) % polygon.size()].head<2>();
    if (cross_xy(b - a, p - a) < 0) return false;
  }
  return true;
}

}  // namespace

Ground::Block Ground::prepared(const GroundBlock& block, double rise) {
  Block result;
  result.count = block_corners(block, result.corner);
  result.center = block.kind == GroundBlock::Kind::disc ? block.center
                                                        : Vector2d(0.5 * (block.low + block.high));
  result.radius = (result.corner[0] - result.center).norm();
  result.height = block.height;
  result.rise = rise;
  return result;
}

SolidBlock Ground::solid(const GroundBlock& block, double rise) const {
  const double bottom = std::min(world_.height, block.height) - kBlockDepth;
  const double depth = block.height - bottom;
  const bool disc = block.kind == GroundBlock::Kind::disc;
  const Vector2d size = block.high - block.low;
  const Vector2d center = disc ? block.center : Vector2d(0.5 * (block.low + block.high));
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() << center, bottom + 0.5 * depth;
  const Shape shape =
      disc ? Shape(Cylinder{block.radius, depth}) : Shape(Box{{size.x(), size.y(), depth}});
  return {Collider(shape), pose, rise};
}

Ground::Ground(const World& world) : world_(world), still_{.pose = floor_pose(world, {}, 0)} {
  if (!world.fields.empty()) field_ = world.fields.front();
  fixed_top_ = world.height;
  if (field_.heights.size() > 0) fixed_top_ = std::max(fixed_top_, field_.heights.maxCoeff());
  for (const GroundBlock& block : world.blocks) {
    blocks_.push_back(prepared(block, 0));
    solids_.push_back(solid(block, 0));
    fixed_top_ = std::max(fixed_top_, block.height);
  }
  fixed_ = blocks_.size();
  set({});
}

void Ground::set(const StepInput& input) {
  floor_ = input.floor ? *input.floor : still_;
  friction_ = input.friction;
  blocks_.resize(fixed_);
  solids_.erase(solids_.begin() + static_cast<std::ptrdiff_t>(fixed_), solids_.end());
  top_ = fixed_top_;
  for (const RisingDisc& bump : input.bumps) {
    blocks_.push_back(prepared(bump.block, bump.rate));
    solids_.push_back(solid(bump.block, bump.rate));
    top_ = std::max(top_, bump.block.height);
  }
}

double Ground::friction(const Vector3d& p) const {
  if (friction_) return *friction_;
  double result = world_.friction;
  for (const FrictionPatch& patch : world_.patches)
    if ((p.head<2>() - patch.low).minCoeff() >= 0 && (patch.high - p.head<2>()).minCoeff() >= 0)
      result = patch.friction;
  return result;
}

bool Ground::on_field(const Vector2d& p) const {
  if (field_.heights.size() == 0) return false;
  const Vector2d place = (p - field_.origin) / field_.spacing;
  return place.minCoeff() >= 0 && place.x() <= static_cast<double>(field_.heights.rows() - 1) &&
         place.y() <= static_cast<double>(field_.heights.cols() - 1);
}

double Ground::field_height(const Vector2d& p, Vector2d& gradient) const {
  const Eigen::MatrixXd& z = field_.heights;
  const Vector2d place = (p - field_.origin) / field_.spacing;
  const Eigen::Index i = std::min<Eigen::Index>(static_cast<Eigen::Index>(place.x()), z.rows() - 2);
  const Eigen::Index j = std::min<Eigen::Index>(static_cast<Eigen::Index>(place.y()), z.cols() - 2);
  const double u = place.x() - static_cast<double>(i), v = place.y() - static_cast<double>(j);
  gradient << (1 - v) * (z(i + 1, j) - z(i, j)) + v * (z(i + 1, j + 1) - z(i, j + 1)),
      (1 - u) * (z(i, j + 1) - z(i, j)) + u * (z(i + 1, j + 1) - z(i + 1, j));
  gradient /= field_.spacing;
  return (1 - u) * ((1 - v) * z(i, j) + v * z(i, j + 1)) +
         u * ((1 - v) * z(i + 1, j) + v * z(i + 1, j + 1));
}

GroundTouch Ground::touch(const Vector3d& p) const {
  GroundTouch result, wall;
  double height = world_.height, wall_depth = std::numeric_limits<double>::infinity();
  if (on_field(p.head<2>())) {
    Vector2d gradient;
    height = field_height(p.head<2>(), gradient);
    result.normal = Vector3d(-gradient.x(), -gradient.y(), 1).normalized();
  }
  for (const Block& block : blocks_) {
    if ((p.head<2>() - block.center).squaredNorm() > block.radius * block.radius) continue;
    double within = std::numeric_limits<double>::infinity();
    Vector2d outward = Vector2d::UnitX();
    for (int k = 0; k < block.count; ++k) {
      const Vector2d& a = block.corner[static_cast<size_t>(k)];
      const Vector2d edge =
          (block.corner[static_cast<size_t>((k + 1) % block.count)] - a).normalized();
      const double distance = cross_xy(edge, p.head<2>() - a);
      if (distance >= within) continue;
      within = distance;
      outward << edge.y(), -edge.x();
    }
    if (within < 0) continue;
    if (block.height - p.z() > std::max(within, kLip)) {
      if (within >= wall_depth) continue;
      wall_depth = within;
      wall.gap = -within;
      wall.normal << outward, 0;
    } else if (block.height > height) {
      height = block.height;
      result.normal = Vector3d::UnitZ();
      result.rise = block.rise;
    }
  }
  result.gap = (p.z() - height) * result.normal.z();
  return std::isfinite(wall_depth) && result.gap > -kLip ? wall : result;
}

// Finds the corners of a block within the sole, and the crossings of the edges of both.
void Ground::inner_points(const std::vector<Vector3d>& sole, double reach,
                          std::vector<InnerPoint>& points) const {
  Vector2d center = Vector2d::Zero();
  for (const Vector3d& corner : sole) center += corner.head<2>() / static_cast<double>(sole.size());
  double radius = 0;
  for (const Vector3d& c : sole) radius = std::max(radius, (c.head<2>() - center).norm());
  const Plane plane{sole[0], (sole[1] - sole[0]).cross(sole.back() - sole[0]).normalized()};
  if (plane.normal.z() < 0.5) return;
  // A part that a higher block covers touches no sole.
  const auto covered = [&](const Vector2d& p, double height) {
    return std::any_of(blocks_.begin(), blocks_.end(), [&](const Block& block) {
      if (block.height <= height || (p - block.center).norm() > block.radius) return false;
      for (int k = 0; k < block.count; ++k) {
        const Vector2d& a = block.corner[static_cast<size_t>(k)];
        const Vector2d& next = block.corner[static_cast<size_t>((k + 1) % block.count)];
        if (cross_xy(next - a, p - a) <= 0) return false;
      }
      return true;
    });
  };
  const auto add = [&](long id, const Vector2d& p, double height, double rise) {
    const double z = plane.at(p), gap = (z - height) * plane.normal.z();
    if (gap >= reach || gap <= -kFaceDepth || covered(p, height)) return;
    if (points.size() >= kMostInnerPoints)
      fail(ErrorCode::bad_pattern,
           "world: more than " + std::to_string(kMostInnerPoints) +
               " corners and edges of the ground lie under one sole at " + text::brief(p.x()) +
               ", " + text::brief(p.y()) +
               " m. Take fewer and larger blocks, or a field with a wider spacing");
    points.push_back({id, {p.x(), p.y(), z}, gap, rise});
  };
  for (size_t b = 0; b < blocks_.size(); ++b) {
    const Block& block = blocks_[b];
    if ((block.center - center).norm() > block.radius + radius) continue;
    const long base = static_cast<long>(b) * kBlockIds;
    for (int k = 0; k < block.count; ++k) {
      const Vector2d& p = block.corner[static_cast<size_t>(k)];
      const Vector2d along = block.corner[static_cast<size_t>((k + 1) % block.count)] - p;
      if (inside(sole, p)) add(base + k, p, block.height, block.rise);
      for (size_t i = 0; i < sole.size(); ++i) {
        const Vector2d a = sole[i].head<2>();
        const Vector2d edge = sole[(i + 1) % sole.size()].head<2>() - a;
        const double area = cross_xy(along, edge);
        if (std::abs(area) < 1e-12) continue;
        const double s = cross_xy(a - p, edge) / area, t = cross_xy(a - p, along) / area;
        if (s > 0 && s < 1 && t > 0 && t < 1)
          add(base + 8 + 8 * static_cast<long>(i) + k, p + s * along, block.height, block.rise);
      }
    }
  }
  visit_nodes(center, radius, [&](Eigen::Index i, Eigen::Index j, const Vector2d& p) {
    if (inside(sole, p)) add(kFieldIds + i * field_.heights.cols() + j, p, field_.heights(i, j), 0);
  });
}

/// Calls visit(i, j, place) for each node of the height field in the square around `center`.
template <typename Visit>
void Ground::visit_nodes(const Vector2d& center, double radius, const Visit& visit) const {
  if (field_.heights.size() == 0) return;
  const Vector2d low = (center.array() - radius).matrix() - field_.origin;
  const auto first = [&](double x, Eigen::Index n) {
    return std::clamp<Eigen::Index>(static_cast<Eigen::Index>(std::ceil(x / field_.spacing)), 0, n);
  };
  const Eigen::Index rows = field_.heights.rows(), columns = field_.heights.cols();
  const Eigen::Index i1 = first(low.x() + 2 * radius, rows),
                     j1 = first(low.y() + 2 * radius, columns);
  for (Eigen::Index i = first(low.x(), rows); i < i1; ++i)
    for (Eigen::Index j = first(low.y(), columns); j < j1; ++j)
      visit(i, j,
            Vector2d(field_.origin +
                     field_.spacing * Vector2d(static_cast<double>(i), static_cast<double>(j))));
}

// Whether a node is higher than the mean of its neighbours along x or along y. The field is
// surrounded by the plane.
bool Ground::stands_out(Eigen::Index i, Eigen::Index j) const {
  const Eigen::MatrixXd& z = field_.heights;
  const auto at = [&](Eigen::Index a, Eigen::Index b) {
    return a < 0 || b < 0 || a >= z.rows() || b >= z.cols() ? world_.height : z(a, b);
  };
  const double twice = 2 * z(i, j) - 1e-9;
  return twice > at(i - 1, j) + at(i + 1, j) || twice > at(i, j - 1) + at(i, j + 1);
}

void Ground::tips(const Vector3d& center, double radius, std::vector<FieldTip>& tips) const {
  // Radius of a tip [m]. Chosen: a sphere has a normal in every direction, and a tenth of a
  // millimetre is small against the spacing of a field. No measured case changes between half and
  // twice the value (constants.md).
  constexpr double kBlunt = 1e-4;
  tips.clear();
  visit_nodes(center.head<2>(), radius, [&](Eigen::Index i, Eigen::Index j, const Vector2d& p) {
    const double height = field_.heights(i, j);
    if (height < center.z() - radius || !stands_out(i, j)) return;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() << p, height - kBlunt;
    tips.push_back({i * field_.heights.cols() + j, {Collider(Shape(Sphere{kBlunt})), pose, 0}});
  });
}

}  // namespace ayumi
