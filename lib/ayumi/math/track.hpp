#pragma once
// A scalar track: keys of one quantity over time. Every segment is a polynomial of degree five or
// less; before the first and after the last key the track is constant.

#include <array>
#include <cstddef>
#include <vector>

namespace ayumi {

/// Interpolation from one key to the next.
///   linear        straight, C0
///   cubic         Hermite with Catmull-Rom rates, C1
///   minimum_jerk  rest to rest quintic, C2
///   hold          the previous value until the key, then a step
///   spline        cubic spline through consecutive spline keys, C2 inside the run
/// The end of a cubic or spline run is at rest or has the slope of a linear neighbour.
enum class Interpolation { linear, cubic, minimum_jerk, hold, spline };

struct TrackKey {
  double t = 0;  ///< time [s]
  double value = 0;
  /// Interpolation of the segment that ends here.
  Interpolation interpolation = Interpolation::minimum_jerk;
};

/// A value of a track with its rate [per s] and its acceleration [per s^2].
struct TrackPoint {
  double value = 0, rate = 0, acceleration = 0;
};

class Track {
 public:
  Track() : Track(0.0) {}
  /// A constant track.
  explicit Track(double value) : keys_{{0, value, Interpolation::hold}} {}
  /// A track of at least one key, with strictly increasing times and finite values. Throws
  /// Error(internal) otherwise; the caller checks this before, with file and place.
  explicit Track(std::vector<TrackKey> keys);

  TrackPoint at(double t) const;
  const std::vector<TrackKey>& keys() const { return keys_; }

 private:
  size_t segment_at(double t) const;

  std::vector<TrackKey> keys_;
  std::vector<std::array<double, 6>> segments_;  ///< coefficients in u = (t - t0)/(t1 - t0)
};

/// A curve from 0 to 1 for u in [0, 1], at rest at both ends and constant outside. Derivatives are
/// with respect to u.
TrackPoint minimum_jerk(double u);

}  // namespace ayumi
