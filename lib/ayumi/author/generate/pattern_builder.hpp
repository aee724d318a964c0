#pragma once
// Functions that the generators share: rounding, ranges, and keys and phases in sequence.

#include "ayumi/motion/pattern.hpp"

namespace ayumi {

double to_millisecond(double t);
double to_tenth_millimetre(double x);

/// Throws Error(usage) that names the parameter if a parameter of the generator `pattern` is out of
/// its range.
void require_range(const char* pattern, const char* name, double value, double low, double high,
                   const char* unit);
/// Throws Error(usage) if this COG height [m] is too small or too large for legs of the length
/// `leg` [m]. A height of 0 stands for the usual height.
void require_cog_height(const char* pattern, double height, double leg);

/// Sum of the link lengths from hip to sole [m].
double leg_length(const RobotModel& model);

/// Distance between hip and sole of the left leg in the home posture [m].
double home_reach(const RobotModel& model);

/// COG height in the home posture, lowered if the legs there are too straight to move a foot or the
/// COG [m]. It is 0 if the height of home can be kept.
double bent_height(const RobotModel& model);

/// Ratio of the home COG height to that of HOAP-1: it scales lengths, and its root scales times.
double size_beside_hoap1(const RobotModel& model);

/// Adds keys and phases to a pattern. Times are rounded to the millisecond.
struct PatternBuilder {
  Pattern& pattern;
  double t = 0;  ///< time at which the last phase ends [s]

  void key(double at, ZmpKey::Place place);
  void add(double at, Keyframe key);
  void phase(double length, Support support, std::optional<Swing> swing = {});
};

}  // namespace ayumi
