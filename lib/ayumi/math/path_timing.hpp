#pragma once
// The quickest motion along a path whose limits are linear in u = s'' and x = s'^2, where s is the
// place on the path. It is found by time-optimal path parameterisation by reachability analysis
// (Pham and Pham 2018). Over a step of length d between two points, x_{i+1} = x_i + 2 d u_i. The
// backward pass finds the x from which the end is reached,
//   K_i = {x : a u + b x <= c for the rows of both ends of the step, x + 2 d u in K_{i+1}},
// which is an interval. The forward pass takes the largest u that stays in these intervals.

#include <vector>

namespace ayumi {

/// The limit u * s'' + x * s'^2 <= most.
struct TimingRow {
  double u = 0, x = 0, most = 0;
};

/// The limits that hold at one point of the path.
struct TimingPoint {
  double at = 0;  ///< its place s on the path; places increase
  std::vector<TimingRow> rows;
  double least = 0, most = 1;  ///< finite bounds of x
};

struct PathTiming {
  std::vector<double> x;  ///< s'^2 by point; empty if there is no timing
  int stuck = -1;  ///< the last point from which the end cannot be reached; -1 if there is none
};

/// The timing that has the largest possible x at every point, so that no timing that satisfies the
/// rows is quicker.
PathTiming quickest_timing(const std::vector<TimingPoint>& points);

/// The time at every point [s], from 2 d / (s'_i + s'_{i+1}) for each step. Of two neighbours, at
/// least one must be above 0.
std::vector<double> times_along(const std::vector<TimingPoint>& points,
                                const std::vector<double>& x);

}  // namespace ayumi
