// With t' = s t the same path has accelerations 1/s^2 as large:
//   f_z' = m (z'' / s^2 + g) = m g + (f_z - m g) / s^2.
#include <cmath>

#include "ayumi/author/edit/edit.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/motion/pattern_context.hpp"
#include "ayumi/motion/servo_feedforward.hpp"
#include "ayumi/plan/viip_phases.hpp"

namespace ayumi {

Pattern retimed(const RobotModel& model, const Pattern& pattern, double scale) {
  if (!(scale >= 0.01 && scale <= 100))
    fail(ErrorCode::usage,
         "a time scale of " + text::exact(scale) + " is not possible; give 0.01 to 100");
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
    *result.table = postures_of(model, model.limits(result.profile),
                                *result.table);  // the lead is a property of the robot
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

Pattern stretched(const RobotModel& model, const Pattern& pattern, double begin, double end,
                  double factor) {
  if (!(factor >= 0.01 && factor <= 100) || !(begin < end))
    fail(ErrorCode::usage, "the part from " + text::exact(begin) + " to " + text::exact(end) +
                               " s cannot be stretched by the factor " + text::exact(factor) +
                               "; it must end after it begins, and the factor must be from 0.01 "
                               "to 100");
  refuse_viip_phases(pattern, "stretched");
  if (pattern.table || pattern.correction)
    fail(ErrorCode::bad_pattern, pattern.file +
                                     ": a time window of a table or of a correction cannot be "
                                     "stretched; stretch the whole motion");
  // Times closer than this are equal [s]. Chosen: above rounding.
  constexpr double kSame = 1e-9;
  const double weight = model.mass() * kGravity;
  const auto later = [&](double t) {
    return t <= begin ? t
           : t < end  ? begin + factor * (t - begin)
                      : t + (factor - 1) * (end - begin);
  };
  Pattern result = pattern;
  for (Phase& phase : result.phases) phase.until = later(phase.until);
  for (Keyframe& key : result.keyframes) {
    if (key.fz && key.t > begin - kSame && key.t < end + kSame)
      *key.fz = weight + (*key.fz - weight) / (factor * factor);
    key.t = later(key.t);
  }
  for (Disturbance& push : result.scenario) push.at = later(push.at);
  for (auto& window : result.repair.windows) window = {later(window.first), later(window.second)};
  return result;
}

}  // namespace ayumi
