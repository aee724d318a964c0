#include "ayumi/demand/collision_scan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "ayumi/dynamics/kinematics.hpp"

namespace ayumi {

namespace {

// Period at which the distance of every pair of bodies is computed [s]. Chosen: in this time,
// bodies that approach each other at 0.5 m/s come 10 mm nearer, and limits/clearance.cpp adds this
// distance to its tolerance. With half of the value, figures change by less than 5 %; with twice,
// the clearance of the case "grip" changes from 12.2 to 13.5 mm.
constexpr double kCoarsePeriod = 0.020;

std::vector<int> coarse_samples(const CommandSeries& series) {
  const int count = static_cast<int>(series.samples.size());
  const int stride = std::max(1, static_cast<int>(std::lround(kCoarsePeriod / series.dt)));
  std::vector<int> samples;
  for (int k = 0; k < count; k += stride) samples.push_back(k);
  if (samples.back() != count - 1) samples.push_back(count - 1);
  return samples;
}

/// A sphere around all shapes of a body, in its frame [m].
struct BodySphere {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0;
};

/// Where the sphere of a body is, and how it moves until the next coarse sample.
struct BodyPlace {
  Eigen::Vector3d center;  ///< world [m]
  double shift = 0;        ///< movement of the centre [m]
  double turn = 0;         ///< upper bound of the angle of the turn [rad]
};

std::vector<BodySphere> body_spheres(const RobotModel& model, const CollisionModel& collisions) {
  std::vector<BodySphere> spheres(model.bodies().size());
  for (size_t body = 0; body < spheres.size(); ++body) {
    const auto& shapes = collisions.shapes(static_cast<int>(body));
    BodySphere& sphere = spheres[body];
    for (const auto& shape : shapes)
      sphere.center += shape.pose * shape.collider.center() / static_cast<double>(shapes.size());
    for (const auto& shape : shapes)
      sphere.radius =
          std::max(sphere.radius, (shape.pose * shape.collider.center() - sphere.center).norm() +
                                      shape.collider.radius());
  }
  return spheres;
}

/// The scan of one motion. The distance of a pair decreases by no more than its bodies move
/// relative to each other, so most pairs need not be measured at most samples.
class ClearanceScan {
 public:
  ClearanceScan(const RobotModel& model, const CommandSeries& series,
                const CollisionModel& collisions, double near, double exact)
      : model_(model),
        series_(series),
        collisions_(collisions),
        near_(near),
        exact_(exact),
        coarse_(coarse_samples(series)),
        spheres_(body_spheres(model, collisions)),
        data_(model),
        lines_(collisions.pairs().size()) {
    place_bodies();
    measure_coarsely();
    measure_finely();
  }

  void report(const std::function<void(int, int, double)>& note) const {
    const int n = static_cast<int>(coarse_.size());
    for (int p = 0; p < pairs(); ++p) {
      auto fine = fine_[static_cast<size_t>(p)].begin();
      for (int c = 0; c < n; ++c) {
        note(p, coarse_[c], clearance_(c, p));
        for (; c + 1 < n && fine != fine_[static_cast<size_t>(p)].end() &&
               fine->first < coarse_[c + 1];
             ++fine)
          note(p, fine->first, fine->second);
      }
    }
  }

 private:
  // Movement of two bodies relative to each other below which they count as one rigid part [m].
  // Chosen: above the rounding of poses, and a thousandth of the smallest tolerance.
  static constexpr double kStill = 1e-9;
  static constexpr double kNotMeasured = -1;

  int pairs() const { return static_cast<int>(collisions_.pairs().size()); }

  void place_bodies() {
    const int n = static_cast<int>(coarse_.size());
    const int bodies = static_cast<int>(spheres_.size());
    poses_.resize(coarse_.size());
    places_.resize(coarse_.size());
    for (int c = 0; c < n; ++c) {
      update_positions(model_, series_.samples[coarse_[c]].state, data_);
      for (int body = 0; body < bodies; ++body) {
        poses_[c].push_back(data_.pose(body));
        places_[c].push_back({poses_[c][body] * spheres_[body].center, 0, 0});
      }
    }
    for (int c = 0; c + 1 < n; ++c)
      for (int body = 0; body < bodies; ++body) {
        BodyPlace& here = places_[c][body];
        here.shift = (places_[c + 1][body].center - here.center).norm();
        here.turn = angle_between(poses_[c][body].linear(), poses_[c + 1][body].linear());
      }
    way_ = Eigen::MatrixXd::Constant(std::max(n - 1, 0), pairs(), kNotMeasured);
  }

  // A turn by an angle moves a point by less than the angle times its distance; the chord of the
  // rotation matrices is sqrt(8) sin(angle/2), and angle/2 is at most pi/2 times its sine.
  static double angle_between(const Eigen::Matrix3d& before, const Eigen::Matrix3d& after) {
    return std::numbers::pi * (after - before).norm() / std::sqrt(8.0);
  }

  // Largest movement of any point of the second body, seen from the first body, until the next
  // coarse sample.
  double way(int c, int pair) {
    double& way = way_(c, pair);
    if (way != kNotMeasured) return way;
    const CollisionModel::Pair& bodies = collisions_.pairs()[pair];
    std::array<Eigen::Vector3d, 2> center;
    std::array<Eigen::Matrix3d, 2> attitude;
    for (int i = 0; i < 2; ++i) {
      const Eigen::Isometry3d &a = poses_[c + i][bodies.a], &b = poses_[c + i][bodies.b];
      center[i] = a.linear().transpose() * (places_[c + i][bodies.b].center - a.translation());
      attitude[i] = a.linear().transpose() * b.linear();
    }
    way = (center[1] - center[0]).norm() +
          angle_between(attitude[0], attitude[1]) * spheres_[bodies.b].radius;
    return way;
  }

  // An upper bound of way() that takes less time to compute: it adds the movements of both bodies,
  // seen from the ground. `gap` is the distance of their spheres at the coarse sample c.
  double way_bound(int c, const CollisionModel::Pair& bodies, double gap) const {
    const BodyPlace &a = places_[c][bodies.a], &b = places_[c][bodies.b];
    const double ra = spheres_[bodies.a].radius, rb = spheres_[bodies.b].radius;
    return a.shift + a.turn * (gap + ra + 2 * rb) + b.shift + b.turn * rb;
  }

  double sphere_gap(int c, const CollisionModel::Pair& bodies) const {
    return (places_[c][bodies.b].center - places_[c][bodies.a].center).norm() -
           spheres_[bodies.a].radius - spheres_[bodies.b].radius;
  }

  // The movement between two samples next to a coarse sample. The movement of the neighbouring
  // samples counts, too, because a body may turn back in between.
  template <typename WayOf>
  double most_around(int c, const WayOf& way_of) const {
    const int first = std::max(c - 1, 0),
              last = std::min(c + 1, static_cast<int>(coarse_.size()) - 2);
    double most = 0;
    for (int k = first; k <= last; ++k) most = std::max(most, way_of(k));
    return most;
  }
  double way_around(int c, int pair) {
    return most_around(c, [&](int k) { return way(k, pair); });
  }

  // Whether the spheres alone show that a pair is near neither at a coarse sample nor between this
  // sample and its neighbours.
  bool is_far(int c, const CollisionModel::Pair& bodies, double gap) const {
    if (gap < wanted()) return false;
    return gap -
               2 * most_around(c,
                               [&](int k) {
                                 return way_bound(k, bodies, k == c ? gap : sphere_gap(k, bodies));
                               }) >=
           wanted();
  }

  /// Clearances below this value must be exact.
  double wanted() const { return std::max(exact_, least_); }

  // Clearance of a pair. A lower bound is sufficient if it is above `reach` [m] or above near_. The
  // direction along which two shapes were nearest when they were last measured still separates them
  // well.
  double measured(int pair, const Eigen::Isometry3d& pose_a, const Eigen::Isometry3d& pose_b,
                  double reach) {
    const CollisionModel::Pair& bodies = collisions_.pairs()[pair];
    double nearest = std::numeric_limits<double>::infinity();
    size_t next = 0;
    std::vector<Eigen::Vector3d>& lines = lines_[static_cast<size_t>(pair)];
    for (const auto& a : collisions_.shapes(bodies.a)) {
      const Eigen::Isometry3d A = pose_a * a.pose;
      for (const auto& b : collisions_.shapes(bodies.b)) {
        const Eigen::Isometry3d B = pose_b * b.pose;
        if (lines.size() == next) lines.push_back(Eigen::Vector3d::Zero());
        Eigen::Vector3d& line = lines[next++];
        double here = clearance_bound(a.collider, A, b.collider, B);
        if (here >= nearest) continue;
        if (here <= near_) {
          here = line.isZero(0)
                     ? -std::numeric_limits<double>::infinity()
                     : clearance_along(pose_a.linear() * line, a.collider, A, b.collider, B);
          if (here <= reach) {
            const Closest closest = ayumi::closest(a.collider, A, b.collider, B);
            line = pose_a.linear().transpose() * closest.normal;
            here = closest.clearance;
          }
        }
        nearest = std::min(nearest, here);
      }
    }
    return nearest;
  }

  void measure_coarsely() {
    const int n = static_cast<int>(coarse_.size());
    clearance_.resize(n, pairs());
    std::vector<double> bound(static_cast<size_t>(pairs()), -1);
    std::vector<char> known(static_cast<size_t>(pairs()), 0);
    for (int c = 0; c < n; ++c) {
      for (int p = 0; p < pairs(); ++p) {
        const CollisionModel::Pair& bodies = collisions_.pairs()[p];
        double& here = bound[static_cast<size_t>(p)];
        char& is_known = known[static_cast<size_t>(p)];
        const bool still = c > 0 && is_known && way(c - 1, p) < kStill;
        const double gap = sphere_gap(c, bodies);
        if (!still && is_far(c, bodies, gap)) {
          here = gap;
          is_known = 0;
        } else if (!still) {
          if (c > 0) here -= way(c - 1, p);
          // The neighbours of the smallest clearance must be exact too.
          const double reach = wanted() + (n > 1 ? 2 * way_around(std::min(c, n - 2), p) : 0);
          is_known = c == 0 || here < reach;
          if (is_known) {
            here = measured(p, poses_[c][bodies.a], poses_[c][bodies.b], reach);
            least_ = std::min(least_, here);
          }
        }
        clearance_(c, p) = here;
      }
    }
  }

  // Whether a pair may have a clearance between two coarse samples that must be known.
  bool hides(int c, int p) {
    const int n = static_cast<int>(coarse_.size());
    const double here = clearance_(c, p), next = clearance_(c + 1, p);
    const bool minimum =
        c == 0 || here <= clearance_(c - 1, p) || c + 2 >= n || next <= clearance_(c + 2, p);
    const bool meets = (here < 0) != (next < 0);
    if (std::min(here, next) >= near_ || !(minimum || meets)) return false;
    return 0.5 * (here + next) - way_around(c, p) < wanted();
  }

  void measure_finely() {
    const int n = static_cast<int>(coarse_.size());
    fine_.resize(static_cast<size_t>(pairs()));
    for (int c = 0; c + 1 < n; ++c) {
      std::vector<int> hidden;
      for (int p = 0; p < pairs(); ++p)
        if (hides(c, p)) hidden.push_back(p);
      if (hidden.empty()) continue;
      for (int k = coarse_[c] + 1; k < coarse_[c + 1]; ++k) {
        update_positions(model_, series_.samples[k].state, data_);
        for (const int p : hidden) {
          const CollisionModel::Pair& bodies = collisions_.pairs()[p];
          fine_[static_cast<size_t>(p)].emplace_back(
              k, measured(p, data_.pose(bodies.a), data_.pose(bodies.b), wanted()));
        }
      }
    }
  }

  const RobotModel& model_;
  const CommandSeries& series_;
  const CollisionModel& collisions_;
  double near_, exact_;
  std::vector<int> coarse_;
  std::vector<BodySphere> spheres_;
  RobotData data_;
  // The last separating directions by pair and pair of shapes, in the frame of the first body.
  std::vector<std::vector<Eigen::Vector3d>> lines_;
  // Poses and movements by coarse sample and body.
  std::vector<std::vector<Eigen::Isometry3d>> poses_;
  std::vector<std::vector<BodyPlace>> places_;
  Eigen::MatrixXd way_, clearance_;  // path lengths and clearances by coarse sample and pair [m]
  double least_ = std::numeric_limits<double>::infinity();
  // For each pair, samples with their clearances.
  std::vector<std::vector<std::pair<int, double>>> fine_;
};

}  // namespace

void scan_clearance(const RobotModel& model, const CommandSeries& series,
                    const CollisionModel& collisions, double near, double exact,
                    const std::function<void(int pair, int sample, double clearance)>& note) {
  ClearanceScan(model, series, collisions, near, exact).report(note);
}

}  // namespace ayumi
