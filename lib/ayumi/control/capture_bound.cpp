// Supports are constant over a tick, so that the integral is a sum. The support of tick i has the
// weight
//   exp(-omega i dt) (1 - exp(-omega dt)),
// and the last support also has the remaining weight exp(-omega n dt).
#include "ayumi/control/capture_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ayumi/control/support_region.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::Vector2d;

namespace {

double omega_of(const CommandSample& command) {
  return std::sqrt(kGravity / (command.cog.z() - command.zmp.z()));
}

const CommandSample& sample_at(const CommandSeries& series, long k) {
  return series.samples[std::clamp<long>(k, 0, static_cast<long>(series.samples.size()) - 1)];
}

ConvexPolygon planned_support(const RobotModel& model, const CommandSample& command) {
  const ConvexPolygon polygon = support_polygon(model, command.feet, command.support);
  return polygon.empty() ? ConvexPolygon({command.zmp.head<2>()}) : polygon;
}

bool same_support(const CommandSample& a, const CommandSample& b) {
  if (a.support != b.support || a.support == Support::none) return false;
  for (Side side : {Side::left, Side::right}) {
    const int i = static_cast<int>(side);
    if (supports(a.support, side) && a.feet[i].matrix() != b.feet[i].matrix()) return false;
  }
  return true;
}

}  // namespace

CaptureRegion capture_region(const RobotModel& model, const CommandSeries& series, long k,
                             int directions) {
  const CommandSample& now = sample_at(series, k);
  const double w = omega_of(now);
  CaptureRegion region;
  region.dcm = (now.cog + now.dcog / w).head<2>();
  region.impulse_per_length = model.mass() * w;
  for (int i = 0; i < directions; ++i) {
    const double angle = 2 * M_PI * i / directions;
    region.normals.emplace_back(elementary::cos(angle), elementary::sin(angle));
  }
  region.support.assign(region.normals.size(), 0.0);

  const long end = static_cast<long>(series.samples.size());
  ConvexPolygon polygon = planned_support(model, now);
  const auto add = [&](double weight) {
    for (size_t i = 0; i < region.normals.size(); ++i)
      region.support[i] += weight * polygon.support(region.normals[i]);
  };
  // Ticks with the same support are added together. `begin` is the weight that was left when this
  // support began.
  double begin = 1;
  for (long j = std::min(k, end - 1) + 1; j < end; ++j) {
    if (same_support(sample_at(series, j - 1), sample_at(series, j))) continue;
    const double left = elementary::exp(-w * series.dt * static_cast<double>(j - k));
    add(begin - left);
    begin = left;
    polygon = planned_support(model, sample_at(series, j));
  }
  add(begin);
  return region;
}

double capture_bound(const CaptureRegion& region, const Vector2d& u) {
  double least = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < region.normals.size(); ++i) {
    const Vector2d& n = region.normals[i];
    const double along = n.dot(u);
    if (along < 1e-6) continue;
    least = std::min(least, (region.support[i] - n.dot(region.dcm)) / along);
  }
  return region.impulse_per_length * least;
}

double edge_bound(const RobotModel& model, const CommandSeries& series, long k, const Vector2d& u) {
  const CommandSample& now = sample_at(series, k);
  const ConvexPolygon polygon = planned_support(model, now);
  const std::vector<Vector2d>& v = polygon.vertices();
  const Vector2d z = now.zmp.head<2>();
  double least = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < v.size(); ++i) {
    const Vector2d edge = v[(i + 1) % v.size()] - v[i];
    const Vector2d n = Vector2d(edge.y(), -edge.x()).normalized();
    if (n.dot(u) > 1e-9) least = std::min(least, n.dot(v[i] - z) / n.dot(u));
  }
  return std::isfinite(least) ? model.mass() * omega_of(now) * least : 0.0;
}

}  // namespace ayumi
