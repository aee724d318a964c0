#pragma once
// Is haste what is wrong? The same path played slower: rates times a pace, accelerations times its
// square.

#include "ayumi/check/check_pass.hpp"

namespace ayumi {

class SlowerPace {
 public:
  explicit SlowerPace(CheckPass& pass) : pass_(pass) {}

  /// One pace at which neither of the two findings is left. Where the motion is broken by
  /// differences over a jump, no pace mends it: then it is haste's doing, unless it is that jump.
  bool mends(const Violation& cause, const Violation& v);

 private:
  bool holds(const Violation& v, double pace);
  bool rms_holds(const Violation& v, double pace);
  bool flight_is_free(int sample, double pace, double limit);
  bool ground_holds(const Violation& v, double pace);
  bool rough_near(int sample) const;

  CheckPass& pass_;
};

}  // namespace ayumi
