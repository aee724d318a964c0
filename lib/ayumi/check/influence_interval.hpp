#pragma once
// An influence interval is the time in which one fault has effects, in samples; its last sample is
// included.

#include "ayumi/limits/judged_motion.hpp"

namespace ayumi {

struct Interval {
  int first = 0, last = 0;
  bool touches(const Interval& other) const { return first <= other.last && last >= other.first; }
  bool touches(const FindingWindow& w) const { return first <= w.last && last >= w.first; }
  bool contains(const FindingWindow& w) const { return first <= w.first && w.last <= last; }
  bool contains(int sample) const { return first <= sample && sample <= last; }
};

/// Number of samples on either side whose rates and accelerations are wrong because the angle of a
/// joint is discontinuous. Derived: rates and accelerations are differences over two samples to
/// either side (motion/differentiate.hpp), and a discontinuity lies between two samples.
inline constexpr int kDifferenceReach = 3;

/// The window with `pad` samples on either side.
Interval around(const FindingWindow& window, int pad = 0);
inline Interval around(const Interval& interval, int pad) {
  return {interval.first - pad, interval.last + pad};
}

/// The window and the time around it in which the COG of the posture deviates from the command.
Interval deviation_around(const JudgedMotion& motion, const FindingWindow& window);

/// The window of a foot's fault and the time around it, within the same contact, in which the sole
/// is out of its place by more than rounding.
Interval displacement_around(const JudgedMotion& motion, const FindingWindow& window);

/// The largest distance of a supporting sole from its place [m].
double displacement(const JudgedMotion& motion, int foot, int sample);

/// The excursion of a joint beyond its limit in this window: from its last turning point before the
/// window to its first turning point after it. One wrong key moves the joint only within this time.
Interval excursion_around(const JudgedMotion& motion, const FindingWindow& window);

/// The time in which an angle is wrong: its excursion, and the time in which the COG deviates from
/// the command because of it.
Interval wrong_angle_around(const JudgedMotion& motion, const FindingWindow& window);

/// The flight of this window.
Interval flight_around(const JudgedMotion& motion, const FindingWindow& window);

/// The time around this sample from the rest before it to the rest after it (rests of 20 ms or
/// more).
Interval motion_around(const JudgedMotion& motion, int sample);

/// The phase in which a foot is planned to stand too early or to leave the ground too early, and
/// the time in which the foot is off the ground at that end of its contact.
Interval moved_phases(const JudgedMotion& motion, const Violation& foot);

/// Whether the joint comes back in this interval: its largest steps in both directions from one
/// sample to the next have about the same size (within a factor of 2).
bool comes_back(const JudgedMotion& motion, int dof, const Interval& interval);

/// The number of samples in 50 ms: forces change up to this long before and after a displacement.
int pad_samples(const JudgedMotion& motion);

}  // namespace ayumi
