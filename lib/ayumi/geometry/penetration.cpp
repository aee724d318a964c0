// Least values of h lie at normals of faces, at products of edges, or, about round parts, anywhere:
// those that can be named are tried, and the best of them improved by turning d.
#include "ayumi/geometry/penetration.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

constexpr int kAround = 12;         // directions tried around a round body
constexpr int kImproved = 4;        // candidates that are improved
constexpr double kFirstTurn = 0.2;  // [rad]
constexpr double kLastTurn = 1e-6;  // [rad]

double reach(const Solid& solid, const Isometry3d& pose, const Vector3d& d) {
  const Vector3d u = pose.linear().transpose() * d;
  switch (solid.kind) {
    case Solid::Kind::box:
      return u.cwiseAbs().dot(solid.half);
    case Solid::Kind::cylinder:
      return solid.half_length * std::abs(u.z()) + solid.radius * std::hypot(u.x(), u.y());
    default:
      return solid.half_length * std::abs(u.z()) + solid.radius;
  }
}

// Unit normals of faces, and directions around a round body.
std::vector<Vector3d> normals(const Solid& solid, const Isometry3d& pose) {
  std::vector<Vector3d> result;
  for (int i = 0; i < 3; ++i) result.push_back(pose.linear().col(i));
  if (solid.kind == Solid::Kind::box) return result;
  for (int i = 1; i < kAround; ++i) {
    const double angle = M_PI * i / kAround;
    result.push_back(std::cos(angle) * pose.linear().col(0) +
                     std::sin(angle) * pose.linear().col(1));
  }
  return result;
}

struct Direction {
  Vector3d d;
  double depth = 0;
};

class Overlap {
 public:
  Overlap(const Solid& a, const Isometry3d& pose_a, const Solid& b, const Isometry3d& pose_b)
      : a_(a), b_(b), pose_a_(pose_a), pose_b_(pose_b) {}

  double least() {
    for (const Vector3d& d : normals(a_, pose_a_)) add(d);
    for (const Vector3d& d : normals(b_, pose_b_)) add(d);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        add(Vector3d(pose_a_.linear().col(i).cross(pose_b_.linear().col(j))));
    add(pose_a_.translation() - pose_b_.translation());
    const size_t improved = std::min<size_t>(kImproved, candidates_.size());
    std::partial_sort(candidates_.begin(), candidates_.begin() + improved, candidates_.end(),
                      [](const Direction& x, const Direction& y) { return x.depth < y.depth; });
    double least = candidates_.front().depth;
    for (size_t i = 0; i < improved; ++i) least = std::min(least, improve(candidates_[i]));
    return least;
  }

 private:
  double depth(const Vector3d& d) const {
    return (pose_a_.translation() - pose_b_.translation()).dot(d) + reach(a_, pose_a_, d) +
           reach(b_, pose_b_, d);
  }

  void add(const Vector3d& way) {
    if (way.norm() < 1e-9) return;
    const Vector3d d = way.normalized();
    for (const Vector3d& each : {d, Vector3d(-d)}) candidates_.push_back({each, depth(each)});
  }

  double improve(Direction best) const {
    for (double turn = kFirstTurn; turn > kLastTurn; turn *= 0.5) {
      for (bool better = true; better;) {
        better = false;
        const Vector3d u = best.d.unitOrthogonal(), v = best.d.cross(u);
        for (const Vector3d& side : {u, Vector3d(-u), v, Vector3d(-v)}) {
          const Vector3d d = (best.d + turn * side).normalized();
          const double now = depth(d);
          if (now >= best.depth - 1e-12) continue;
          best = {d, now};
          better = true;
          break;
        }
      }
    }
    return best.depth;
  }

  const Solid &a_, &b_;
  const Isometry3d &pose_a_, &pose_b_;
  std::vector<Direction> candidates_;
};

}  // namespace

double overlap(const Solid& a, const Isometry3d& pose_a, const Solid& b, const Isometry3d& pose_b) {
  return Overlap(a, pose_a, b, pose_b).least();
}

}  // namespace ayumi
