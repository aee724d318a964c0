#pragma once
// Quintics that meet value, rate and acceleration at both ends: what a track of keys at rest cannot
// say around a flight. They enter a track as dense spline keys.

#include <vector>

#include "ayumi/math/track.hpp"

namespace ayumi {

/// A point that a motion passes.
struct QuinticEnd {
  double t = 0;  ///< [s]
  double value = 0, rate = 0, acceleration = 0;
};

/// Of the quintic from one end to the other, at t between.
TrackPoint quintic_at(const QuinticEnd& from, const QuinticEnd& to, double t);

/// Spline keys of the quintics through all points, at most 4 ms apart, the first point included.
/// The track is to be at rest before and after them, or to go on with such keys.
std::vector<TrackKey> quintic_keys(const std::vector<QuinticEnd>& points);

}  // namespace ayumi
