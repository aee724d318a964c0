#pragma once
// The stiffness of a leg's joint from the weight that it carries on one foot, and does not carry on
// the other. In the slow part of a motion a servo is at rest:
//   measured - command(t - lag) = offset - s tau - dry sgn(rate) + late rate,  s = 1/kp.
// Quick loads, which come from the whole robot on its yielding servos and ground, are left out.

#include <vector>

#include "ayumi/identify/servo_response.hpp"

namespace ayumi {

struct StandingCompliance {
  bool found = false;
  double value = 0, half_width = 0;  ///< the value with half its 95 % interval [rad/(N m)]
};

/// The compliance of joints that share their constants and lag behind their commands by `lag` [s],
/// from the rows in which one foot carries the robot (JointRecording::settled). `load_error` is the
/// uncertainty of the torque of a standing leg [N m].
StandingCompliance standing_compliance(const std::vector<JointRecording>& joints, double lag,
                                       double load_error);

}  // namespace ayumi
