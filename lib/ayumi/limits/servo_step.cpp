// A servo receives one target in each of its periods T, and its motor follows no step that is
// larger than the speed limit allows: |theta(k) - theta(k - T)| <= speed limit T. If the joint's
// planned speed itself is too large, this is a finding of joint_speed; a larger step is a jump
// between samples. exported_table judges the target, which leads the posture.
#include <algorithm>

#include "ayumi/base/text.hpp"
#include "ayumi/limits/judged_motion.hpp"

namespace ayumi {

namespace {

// Largest share of the step that the speed limit allows. Definition: at 1 the step is the largest
// one.
constexpr double kWholeStep = 1;

// Factor on the limit, because the mean speed of a period differs a little from the speeds at its
// ends. Chosen: half a percent, so that a motion planned at its speed limit has no step above it.
// No measured case changes between half and twice the value (constants.md).
constexpr double kMeanSpeedSpare = 1.005;

int servo_ticks(const JudgedMotion& motion) {
  const double period = motion.model.description().servo_period;
  return std::max(1, static_cast<int>(std::lround(period / motion.series.dt)));
}

void judge_servo_steps(JudgedMotion& motion) {
  const double dt = motion.series.dt;
  const int ticks = servo_ticks(motion);
  const double most = motion.tolerance(FindingKind::servo_step);
  for (int k = ticks; k < motion.count(); ++k) {
    const RobotState& from = motion.series.samples[k - ticks].state;
    const RobotState& to = motion.series.samples[k].state;
    for (int i = 0; i < motion.model.dof_count(); ++i) {
      const double limit = motion.limits.speed[i], allowed = limit * ticks * dt;
      if (!std::isfinite(allowed)) continue;
      const double step = to.theta[i] - from.theta[i], ratio = std::abs(step) / allowed;
      motion.raise(FindingKind::servo_step, ratio, k, i);
      if (ratio > kMeanSpeedSpare * most && std::abs(from.dtheta[i]) <= limit &&
          std::abs(to.dtheta[i]) <= limit)
        motion.add(FindingKind::servo_step, i, k, step, most * allowed, ratio);
    }
  }
}

bool servo_step_holds(JudgedMotion&, const Violation& v, double pace) {
  return std::abs(v.value) * pace <= std::abs(v.limit);
}

const char* step_unit(const JudgedMotion& motion, const Violation& v) {
  return joint_unit(motion, v, "rad", "m");
}

Advice step_advice(const JudgedMotion& motion, const FindingWindow& window) {
  const Violation& v = window.worst;
  const Dof& dof = motion.model.dofs()[v.item];
  return {
      dof.name + " jumps by " +
          (dof.prismatic ? in_mm(v.value) : angle_size(v.value, motion.degrees)) +
          " in one servo period",
      "spread the step over " + text::fixed(std::ceil(std::abs(v.value / v.limit)), 0) + " periods",
      ""};
}

std::string step_infeasibility(const Finding& f, double violation) {
  return f.where + " moves " + ratio_text(violation) +
         " times as far in one servo period as the speed limit allows";
}

}  // namespace

const Limit& servo_step_limit() {
  static const Limit limit = {
      .findings =
          {{.kind = FindingKind::servo_step,
            .limit_class = LimitClass::rate,
            .unit = "1",
            .tolerance = kWholeStep,
            .meaning =
                "change of the joint angle in one servo period, divided by the change that the "
                "speed limit allows. The step is reported only where the planned speed is within "
                "its limit",
            .figure = {.key = "max_servo_step_ratio",
                       .label = "largest step in a servo period",
                       .unit = "% of what the speed limit allows",
                       .scale = 100,
                       .line = 17},
            .actuator = {.line = 4},
            .repair = {.is_of_one_joint = true},
            .finding_unit = step_unit,
            .place = joint_place,
            .advice = step_advice,
            .infeasibility = step_infeasibility,
            .holds_at = servo_step_holds}},
      .judge_motion = judge_servo_steps};
  return limit;
}

}  // namespace ayumi
