#pragma once
// What the check says of a pattern, as `ayumi check` asks it.

#include "ayumi/check/consistency.hpp"
#include "ayumi/plan/sample.hpp"

namespace ayumi::test {

inline ConsistencyReport report_of(const RobotModel& model, const Pattern& pattern) {
  CheckOptions options;
  options.friction = pattern.world.friction;
  options.profile = pattern.profile;
  return check_consistency(model, sample(model, pattern), options);
}

}  // namespace ayumi::test
