#pragma once
// Feet that are planned to stand above the declared ground, or in it. The check compares a sole
// with its planned place, so it does not find them; but on the real ground, the robot would tilt.

#include <functional>
#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/pattern.hpp"
#include "ayumi/plan/foot_plan.hpp"

namespace ayumi {

struct RaisedFoot {
  std::string place;    ///< JSON pointer of the phase or keyframe that states the height
  std::string words;    ///< what is written, and the height of the ground there
  std::string instead;  ///< the remedy
  std::function<void(Pattern&)> mend;  ///< puts the foot on the ground
  double begin = 0;       ///< beginning of the phase that leads the foot to this height [s]
  bool relative = false;  ///< whether `mend` also moves all later steps
};

/// The landings and keys that put a foot more than 1 mm above the ground or below it, and the feet
/// that carry the robot again although their last key is in the air. Only level ground with blocks
/// is judged: nothing on slopes, height fields and moving floors.
std::vector<RaisedFoot> raised_feet(const RobotModel& model, const Pattern& pattern,
                                    const FootPlan& feet);

}  // namespace ayumi
