#pragma once
// A scalar track of keys over time: what an author writes about one quantity. Every segment is a
// polynomial of degree five or less; before the first and after the last key the track holds.

#include <array>
#include <vector>

namespace ayumi {

/// How a track goes from one key to the next.
///   linear        straight, C0
///   cubic         Hermite with Catmull-Rom rates, C1
///   minimum_jerk  rest to rest quintic, C2
///   hold          the old value until the key, then a jump
///   spline        cubic spline through consecutive spline keys, C2 inside the run
/// Where a cubic or spline run ends it is at rest, or takes the slope of a linear neighbour.
enum class Interpolation { linear, cubic, minimum_jerk, hold, spline };

struct TrackKey {
  double t = 0;  ///< [s]
  double value = 0;
  Interpolation interpolation = Interpolation::minimum_jerk;  ///< of the segment that ends here
};

struct TrackPoint {
  double value = 0, rate = 0, acceleration = 0;
};

class Track {
 public:
  Track() : Track(0.0) {}
  /// A constant.
  explicit Track(double value) : keys_{{0, value, Interpolation::hold}} {}
  /// At least one key, times strictly increasing, finite; throws Error(internal) otherwise (the
  /// caller knows the file and place to name).
  explicit Track(std::vector<TrackKey> keys);

  TrackPoint at(double t) const;
  const std::vector<TrackKey>& keys() const { return keys_; }

 private:
  std::vector<TrackKey> keys_;
  std::vector<std::array<double, 6>> segments_;  ///< coefficients in u = (t - t0)/(t1 - t0)
};

/// Rest to rest from 0 to 1 for u in [0, 1], clamped outside; derivatives per u.
TrackPoint minimum_jerk(double u);

}  // namespace ayumi
