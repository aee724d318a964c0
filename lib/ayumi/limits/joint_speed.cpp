// A motor has a largest speed: |dtheta| <= speed limit of the actuator profile. The voltage of the
// motor and its gear determine it (data sheet of the robot, robot.json).
#include "ayumi/limits/judged_motion.hpp"
#include "ayumi/limits/row_site.hpp"

namespace ayumi {

namespace {

// Largest share of the speed limit. Definition: the data sheet states the largest speed.
constexpr double kWholeSpeed = 1;

void judge_joint_speeds(JudgedMotion& motion, const JudgedSample& s) {
  const double most = motion.tolerance(FindingKind::joint_speed);
  for (int i = 0; i < motion.model.dof_count(); ++i) {
    const double limit = motion.limits.speed[i], speed = s.command.state.dtheta[i];
    if (!std::isfinite(limit)) continue;
    const double ratio = std::abs(speed) / limit;
    motion.raise(FindingKind::joint_speed, ratio, s.k, i);
    if (ratio > most) motion.add(FindingKind::joint_speed, i, s.k, speed, most * limit, ratio);
  }
}

const RowKind kSpeedRows = {.name = "speed", .order = {3, 1}};

void place_speed_rows(RowSite& site) {
  const double most = site.tolerance(FindingKind::joint_speed);
  for (int i = 0; i < site.model.dof_count(); ++i) {
    if (site.is_locked(i)) continue;
    for (int point = 0; point < site.count(); ++point) {
      const double speed =
          site.most(point, [&](const CommandSample& s) { return std::abs(s.state.dtheta[i]); });
      site.add_largest(kSpeedRows, point, JointQuantity::speed, i, speed,
                       site.actuators.speed[i] * most, site.settings.limit_share,
                       site.settings.active);
    }
  }
}

bool joint_speed_holds(JudgedMotion&, const Violation& v, double pace) {
  return std::abs(v.value) * pace <= std::abs(v.limit);
}

const char* speed_unit(const JudgedMotion& motion, const Violation& v) {
  return joint_unit(motion, v, "rad/s", "m/s");
}

Advice speed_advice(const JudgedMotion& motion, const FindingWindow& window) {
  const Violation& v = window.worst;
  return slow_down_text(std::abs(v.value / v.limit)) + ", or turn " +
         motion.model.dofs()[v.item].name + " through a smaller angle";
}

std::string speed_infeasibility(const Finding& f, double violation) {
  return "the speed of " + f.where + " reaches " + ratio_text(violation) + " times its limit";
}

}  // namespace

const Limit& joint_speed_limit() {
  static const Limit limit = {.findings = {{.kind = FindingKind::joint_speed,
                                            .limit_class = LimitClass::rate,
                                            .unit = "1",
                                            .tolerance = kWholeSpeed,
                                            .meaning = "joint speed divided by its limit",
                                            .figure = {.key = "max_joint_speed_ratio",
                                                       .label = "largest joint speed",
                                                       .unit = "% of the limit",
                                                       .scale = 100,
                                                       .share_name = "speed",
                                                       .line = 7},
                                            .actuator = {.line = 3},
                                            .repair = {.is_of_one_joint = true},
                                            .finding_unit = speed_unit,
                                            .place = joint_place,
                                            .advice = speed_advice,
                                            .infeasibility = speed_infeasibility,
                                            .holds_at = joint_speed_holds}},
                              .judge_sample = judge_joint_speeds,
                              .place_rows = place_speed_rows};
  return limit;
}

}  // namespace ayumi
