// The linear programs have two unknowns. They are solved row by row (Seidel): as long as the best
// point so far satisfies the next row, it stays; otherwise the new best point lies on that row.
#include "ayumi/math/path_timing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace ayumi {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Tolerance within which a row of unit length, or a row between parallel rows, counts as satisfied.
// Chosen: far above the rounding of doubles and far below any limit of a motion.
constexpr double kKept = 1e-10;

// Largest value of s''. Definition: above any value that makes sense, so that only the rows limit
// s''.
constexpr double kMostU = 1e9;

struct UnitRow {
  double u, x, most;  // the vector (u, x) has length 1
};

struct Interval {
  double least, most;
};

// Rows of unit length. `impossible` is set if a row without unknowns is violated.
struct Rows {
  std::vector<UnitRow> all;
  bool impossible = false;

  void clear() {
    all.clear();
    impossible = false;
  }
  void add(double u, double x, double most) {
    const double length = std::sqrt(u * u + x * x);
    if (length > 1e-12)
      all.push_back({u / length, x / length, most / length});
    else if (most < -kKept)
      impossible = true;
  }
};

// The least x (sign -1) or the largest x (sign 1). The row that was found last goes to the front,
// because it binds again at the next point.
std::optional<double> extreme_x(Rows& rows, double sign, double least, double most) {
  if (rows.impossible || least > most) return std::nullopt;
  double u = 0, x = sign > 0 ? most : least;
  for (size_t i = 0; i < rows.all.size(); ++i) {
    const UnitRow row = rows.all[i];
    if (row.u * u + row.x * x <= row.most + kKept) continue;
    // The points of the row are (u, x) = most (row.u, row.x) + t (-row.x, row.u).
    double low = -kInfinity, high = kInfinity;
    const auto cut = [&](double a, double b, double c) {
      const double along = -a * row.x + b * row.u, rest = c - row.most * (a * row.u + b * row.x);
      if (std::abs(along) < 1e-12) return rest >= -kKept;
      if (along > 0)
        high = std::min(high, rest / along);
      else
        low = std::max(low, rest / along);
      return true;
    };
    bool possible =
        cut(0, 1, most) && cut(0, -1, -least) && cut(1, 0, kMostU) && cut(-1, 0, kMostU);
    for (size_t j = 0; possible && j < i; ++j)
      possible = cut(rows.all[j].u, rows.all[j].x, rows.all[j].most);
    if (!possible || low > high + kKept * (1 + std::abs(low))) return std::nullopt;
    low = std::min(low, high);
    const double rises = sign * row.u;
    const double t = std::abs(rises) < 1e-12 ? 0.5 * (low + high) : rises > 0 ? high : low;
    u = row.most * row.u - t * row.x;
    x = row.most * row.x + t * row.u;
    for (size_t j = i; j > 0; --j) rows.all[j] = rows.all[j - 1];
    rows.all[0] = row;
  }
  return std::clamp(x, least, most);
}

class Reachability {
 public:
  explicit Reachability(const std::vector<TimingPoint>& points)
      : points_(points), reach_(points.size()) {}

  PathTiming run() {
    PathTiming timing;
    const int last = static_cast<int>(points_.size()) - 1;
    for (int i = last; i >= 0; --i)
      if (!go_back(i, i == last)) {
        timing.stuck = i;
        return timing;
      }
    timing.x.push_back(reach_[0].most);
    for (int i = 0; i < last; ++i) timing.x.push_back(next(i, timing.x.back()));
    return timing;
  }

 private:
  double step(int i) const {
    const auto at = static_cast<size_t>(i);
    return points_[at + 1].at - points_[at].at;
  }

  // The rows of the step that begins at point i; at the last point, the rows of that point alone.
  void collect(int i, bool last) {
    rows_.clear();
    const auto at = static_cast<size_t>(i);
    const double twice = last ? 0 : 2 * step(i);
    if (!last) {
      const Interval& to = reach_[at + 1];
      rows_.add(twice, 1, to.most);
      rows_.add(-twice, -1, -to.least);
    }
    for (const TimingRow& row : points_[at].rows) rows_.add(row.u, row.x, row.most);
    if (last) return;
    for (const TimingRow& row : points_[at + 1].rows)
      rows_.add(row.u + twice * row.x, row.x, row.most);
  }

  bool go_back(int i, bool last) {
    collect(i, last);
    const TimingPoint& point = points_[static_cast<size_t>(i)];
    const auto most = extreme_x(rows_, 1, point.least, point.most);
    const auto least = most ? extreme_x(rows_, -1, point.least, *most) : most;
    if (!least) return false;
    reach_[static_cast<size_t>(i)] = {*least, *most};
    return true;
  }

  double next(int i, double x) {
    collect(i, false);
    const Interval& to = reach_[static_cast<size_t>(i) + 1];
    const double twice = 2 * step(i);
    double low = (to.least - x) / twice, high = (to.most - x) / twice;
    for (const UnitRow& row : rows_.all) {
      if (std::abs(row.u) < 1e-12) continue;
      const double u = (row.most - row.x * x) / row.u;
      if (row.u > 0)
        high = std::min(high, u);
      else
        low = std::max(low, u);
    }
    // Because of rounding, the upper bound may be slightly below the lower one.
    return std::clamp(x + twice * std::max(high, std::min(low, high)), to.least, to.most);
  }

  const std::vector<TimingPoint>& points_;
  std::vector<Interval> reach_;
  Rows rows_;
};

}  // namespace

PathTiming quickest_timing(const std::vector<TimingPoint>& points) {
  return Reachability(points).run();
}

std::vector<double> times_along(const std::vector<TimingPoint>& points,
                                const std::vector<double>& x) {
  std::vector<double> times = {0};
  for (size_t i = 0; i + 1 < x.size(); ++i)
    times.push_back(times.back() + 2 * (points[i + 1].at - points[i].at) /
                                       (std::sqrt(x[i]) + std::sqrt(x[i + 1])));
  return times;
}

}  // namespace ayumi
