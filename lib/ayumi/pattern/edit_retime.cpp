// With t' = s t the same path has accelerations 1/s^2 as large:
//   f_z' = m (z'' / s^2 + g) = m g + (f_z - m g) / s^2.
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/base/version.hpp"
#include "ayumi/pattern/edit.hpp"
#include "ayumi/pattern/postures.hpp"
#include "ayumi/pattern/servo_lead.hpp"
#include "ayumi/pattern/viip_phases.hpp"

namespace ayumi {

Pattern retimed(const RobotModel& model, const Pattern& pattern, double scale) {
  if (!(scale >= 0.01 && scale <= 100))
    fail(ErrorCode::usage, "a time scale of " + text::exact(scale) + "; 0.01 to 100 is possible");
  refuse_viip_phases(pattern, "retimed");
  Pattern result = pattern;
  if (scale == 1) return result;
  const double weight = model.mass() * kGravity;
  for (Phase& phase : result.phases) phase.until *= scale;
  for (Keyframe& key : result.keyframes) {
    key.t *= scale;
    if (key.fz) *key.fz = weight + (*key.fz - weight) / (scale * scale);
  }
  for (Disturbance& push : result.scenario) push.at *= scale;
  for (auto& [begin, end] : result.repair.windows) {
    begin *= scale;
    end *= scale;
  }
  if (result.table) {
    *result.table = postures_of(model, *result.table);  // the lead is a time of the robot's
    result.table->dt *= scale;
    result.table->zmp.clear();
    result.table->fz.clear();
  }
  if (result.correction) {
    result.correction->begin *= scale;
    result.correction->spacing *= scale;
  }
  return result;
}

}  // namespace ayumi
