#pragma once
// How far one fault reaches in time, in samples, the last one included.

#include "ayumi/check/check_pass.hpp"

namespace ayumi {

struct Span {
  int first = 0, last = 0;
  bool touches(const Span& other) const { return first <= other.last && last >= other.first; }
  bool touches(const FindingWindow& w) const { return first <= w.last && last >= w.first; }
  bool contains(const FindingWindow& w) const { return first <= w.first && w.last <= last; }
  bool contains(int sample) const { return first <= sample && sample <= last; }
};

/// The window with `slack` samples on either side.
Span around(const FindingWindow& window, int slack = 0);

inline Span around(const Span& span, int slack) { return {span.first - slack, span.last + slack}; }

/// The window, and what lies around it as far as the posture's COG is off the command.
Span deviation_around(const CheckPass& pass, const FindingWindow& window);

/// The window of a foot's fault, and what lies around it in the same contact as far as the sole is
/// out of its place by more than rounding.
Span displacement_around(const CheckPass& pass, const FindingWindow& window);

/// The largest way of a supporting sole from its place [m].
double displacement(const CheckPass& pass, int foot, int sample);

/// The stroke with which a joint goes beyond its limit in this window: from where it last turned
/// back before it to where it turns back after it. One key that is wrong moves no more than that.
Span stroke_around(const CheckPass& pass, const FindingWindow& window);

/// From rest to rest (20 ms and more), around this sample.
Span motion_around(const CheckPass& pass, int sample);

/// The phase in which a foot is said to stand too early or let go too early, and its time off the
/// ground at that end of its contact.
Span moved_phases(const CheckPass& pass, const Violation& foot);

/// The joint's largest step in this span is undone by another one in it.
bool comes_back(const CheckPass& pass, int dof, const Span& span);

/// 50 ms: forces answer before and after a displacement does.
int slack_samples(const CheckPass& pass);

}  // namespace ayumi
