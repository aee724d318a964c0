#include "ayumi/demand/collision_scan.hpp"

#include <algorithm>
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
        data_(model) {
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

  int pairs() const { return static_cast<int>(collisions_.pairs().size()); }

  void place_bodies() {
    poses_.resize(coarse_.size());
    for (size_t c = 0; c < coarse_.size(); ++c) {
      update_positions(model_, series_.samples[coarse_[c]].state, data_);
      for (int body = 0; body < static_cast<int>(spheres_.size()); ++body)
        poses_[c].push_back(data_.pose(body));
    }
    const int n = static_cast<int>(coarse_.size());
    way_.resize(std::max(n - 1, 0), pairs());
    for (int c = 0; c + 1 < n; ++c)
      for (int p = 0; p < pairs(); ++p) way_(c, p) = way_of(p, static_cast<size_t>(c));
  }

  // Largest movement of any point of the second body, seen from the first body, until the next
  // coarse sample.
  double way_of(int pair, size_t c) const {
    const CollisionModel::Pair& bodies = collisions_.pairs()[pair];
    const Eigen::Isometry3d before =
        poses_[c][bodies.a].inverse(Eigen::Isometry) * poses_[c][bodies.b];
    const Eigen::Isometry3d after =
        poses_[c + 1][bodies.a].inverse(Eigen::Isometry) * poses_[c + 1][bodies.b];
    const BodySphere& sphere = spheres_[bodies.b];
    // A turn by an angle moves a point by less than the angle times its distance. The chord of the
    // rotation matrices is sqrt(8) sin(angle/2), and angle/2 is at most pi/2 times its sine.
    const double angle =
        std::numbers::pi * (after.linear() - before.linear()).norm() / std::sqrt(8.0);
    return (after * sphere.center - before * sphere.center).norm() + angle * sphere.radius;
  }

  // The movement between two samples next to a coarse sample. The movement of the neighbouring
  // samples counts, too, because a body may turn back in between.
  double way_around(int c, int pair) const {
    const int first = std::max(c - 1, 0),
              last = std::min<int>(c + 1, static_cast<int>(way_.rows()) - 1);
    double most = 0;
    for (int k = first; k <= last; ++k) most = std::max(most, way_(k, pair));
    return most;
  }

  /// Clearances below this value must be exact.
  double wanted() const { return std::max(exact_, least_); }

  void measure_coarsely() {
    const int n = static_cast<int>(coarse_.size());
    clearance_.resize(n, pairs());
    std::vector<double> bound(static_cast<size_t>(pairs()), -1);
    std::vector<char> known(static_cast<size_t>(pairs()), 0);
    for (int c = 0; c < n; ++c) {
      update_positions(model_, series_.samples[coarse_[c]].state, data_);
      for (int p = 0; p < pairs(); ++p) {
        double& here = bound[static_cast<size_t>(p)];
        const double moved = c > 0 ? way_(c - 1, p) : 0;
        if (c > 0 && moved < kStill && known[static_cast<size_t>(p)]) {
          clearance_(c, p) = here;
          continue;
        }
        here -= moved;
        // The neighbours of the smallest clearance must be exact too.
        const double reach = n > 1 ? 2 * way_around(std::min(c, n - 2), p) : 0;
        known[static_cast<size_t>(p)] = c == 0 || here - reach < wanted();
        if (known[static_cast<size_t>(p)]) {
          here = collisions_.clearance(collisions_.pairs()[p], data_, near_);
          least_ = std::min(least_, here);
        }
        clearance_(c, p) = here;
      }
    }
  }

  // Whether a pair may have a clearance between two coarse samples that must be known.
  bool hides(int c, int p) const {
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
        for (const int p : hidden)
          fine_[static_cast<size_t>(p)].emplace_back(
              k, collisions_.clearance(collisions_.pairs()[p], data_, near_));
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
  std::vector<std::vector<Eigen::Isometry3d>> poses_;  // poses by coarse sample and body
  Eigen::MatrixXd way_, clearance_;                    // by coarse sample and pair [m]
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
