#include "ayumi/dynamics/self_collision.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "ayumi/dynamics/kinematics.hpp"

namespace ayumi {

namespace {

// Distance in the home posture [m] below which bodies up to kHousingJoints joints apart are taken
// for housings of one compound joint, made to pass each other. Chosen: a hip or an ankle has up to
// three axes, whose housings nearly touch.
constexpr double kHousingGap = 0.005;
constexpr int kHousingJoints = 3;

// Overlap in the home posture that counts as touching [m]. Chosen: above the rounding of the
// distance, below any real overlap.
constexpr double kTouchingOverlap = 1e-6;

// Height of the box that stands for a foot without collision shapes, as a share of the height of
// the foot's joint above the sole. Chosen: 8 mm for DARwIn-OP. A foot that swings over the other
// one passes at a greater height, and soles that stand on each other overlap.
constexpr double kSoleHeight = 0.25;

// Smallest height of this box, as a share of the longer side of the sole. Chosen: 2 mm for
// DARwIn-OP (104 mm). A joint may lie in the plane of the sole, and flat boxes in one plane do not
// overlap.
constexpr double kLeastSoleHeight = 0.02;

// The box above the outline of a sole, in the frame of its body.
PlacedShape sole_box(const Sole& sole) {
  Eigen::AlignedBox2d outline;
  for (const Eigen::Vector2d& corner : sole.polygon) outline.extend(corner);
  const double height = std::max(kSoleHeight * std::abs((sole.frame.inverse().translation()).z()),
                                 kLeastSoleHeight * outline.sizes().maxCoeff());
  PlacedShape box;
  box.shape = Box{{outline.sizes().x(), outline.sizes().y(), height}};
  box.pose =
      sole.frame * Eigen::Translation3d(outline.center().x(), outline.center().y(), 0.5 * height);
  return box;
}

int joints_between(const RobotModel& model, int a, int b) {
  int steps = 0;
  // Bodies are sorted with parents first: if one always climbs from the larger index, the two paths
  // meet at the common ancestor.
  while (a != b) {
    if (a > b)
      a = model.bodies()[a].parent;
    else
      b = model.bodies()[b].parent;
    ++steps;
  }
  return steps;
}

std::set<std::pair<int, int>> ignored_pairs(const RobotModel& model) {
  std::set<std::pair<int, int>> result;
  for (const auto& [first, second] : model.description().collision_ignore) {
    const int a = model.find_link(first), b = model.find_link(second);
    if (a >= 0 && b >= 0) result.insert(std::minmax(model.links()[a].body, model.links()[b].body));
  }
  return result;
}

}  // namespace

CollisionModel::CollisionModel(const RobotModel& model, MeshAs mesh_as)
    : shapes_(model.bodies().size()) {
  for (size_t l = 0; l < model.links().size(); ++l) {
    const Link& link = model.links()[l];
    for (size_t i = 0; i < link.collisions.size(); ++i) {
      const PlacedShape& shape = link.collisions[i];
      shapes_[link.body].push_back({mesh_as == MeshAs::box
                                        ? Collider(shape.shape)
                                        : Collider(shape.shape, model.collision_hulls()[l][i]),
                                    link.pose * shape.pose});
    }
  }

  if (model.has_soles())
    for (const Side side : {Side::left, Side::right}) {
      const Sole& sole = model.sole(side);
      if (!shapes_[sole.body].empty()) continue;
      const PlacedShape box = sole_box(sole);
      shapes_[sole.body].push_back({Collider(box.shape), box.pose});
    }

  RobotData data(model);
  update_positions(model, model.rest_state(), data);
  const auto ignored = ignored_pairs(model);
  const int n = static_cast<int>(shapes_.size());
  for (int a = 0; a < n; ++a) {
    for (int b = a + 1; b < n; ++b) {
      if (shapes_[a].empty() || shapes_[b].empty() || ignored.count({a, b})) continue;
      const int joints = joints_between(model, a, b);
      if (joints < 2) continue;
      const double home = clearance({a, b}, data, kHousingGap);
      if (home > (joints <= kHousingJoints ? kHousingGap : -kTouchingOverlap))
        pairs_.push_back({a, b});
    }
  }
}

double CollisionModel::clearance(const Pair& pair, const RobotData& data, double skip) const {
  double nearest = std::numeric_limits<double>::infinity();
  const Eigen::Isometry3d A = data.pose(pair.a), B = data.pose(pair.b);
  for (const PlacedCollider& a : shapes_[pair.a]) {
    const Eigen::Isometry3d pose_a = A * a.pose;
    for (const PlacedCollider& b : shapes_[pair.b]) {
      const Eigen::Isometry3d pose_b = B * b.pose;
      const double bound = clearance_bound(a.collider, pose_a, b.collider, pose_b);
      if (bound >= nearest) continue;
      nearest = std::min(
          nearest, bound > skip ? bound : ayumi::clearance(a.collider, pose_a, b.collider, pose_b));
    }
  }
  return nearest;
}

}  // namespace ayumi
