#pragma once
// Quintics with given value, rate and acceleration at both ends, which connect a track to a flight.
// They enter a track as closely spaced spline keys.

#include <vector>

#include "ayumi/math/track.hpp"

namespace ayumi {

/// A point of a motion.
struct QuinticEnd {
  double t = 0;  ///< time [s]
  double value = 0, rate = 0, acceleration = 0;
};

/// The value, the rate and the acceleration at time t of the quintic between two points.
TrackPoint quintic_at(const QuinticEnd& from, const QuinticEnd& to, double t);

/// Spline keys of the quintics through all points, at most 4 ms apart, the first point included.
/// The track has to rest before and after them, or to continue with such keys.
std::vector<TrackKey> quintic_keys(const std::vector<QuinticEnd>& points);

}  // namespace ayumi
