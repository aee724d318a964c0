#pragma once
// What the generators share: rounding, ranges, keys and phases laid one after the other.

#include "ayumi/motion/pattern.hpp"

namespace ayumi {

double to_millisecond(double t);
double to_tenth_millimetre(double x);

/// Throws Error(usage) naming the parameter of the generator `pattern` out of its range.
void require_range(const char* pattern, const char* name, double value, double low, double high,
                   const char* unit);

/// Sum of the link lengths from hip to sole [m].
double leg_length(const RobotModel& model);

/// Home's COG height, lowered where home's legs are too straight to move a foot or the COG [m]; 0
/// keeps home's.
double bent_height(const RobotModel& model);

/// Home COG height over that of HOAP-1: scales lengths, its root times.
double size_beside_hoap1(const RobotModel& model);

/// Times are rounded to the millisecond.
struct PatternWriter {
  Pattern& pattern;
  double t = 0;  ///< end of the last phase [s]

  void key(double at, ZmpKey::Place place);
  void add(double at, Keyframe key);
  void phase(double length, Support support, std::optional<Swing> swing = {});
};

}  // namespace ayumi
