// A joint that accelerates very fast makes the motion rough. Differences across a jump between two
// samples give accelerations of jump / dt^2, far above those of a planned motion. This is only a
// warning, because motors have a limit of torque (joint_torque.cpp), but none of roughness.
#include <algorithm>

#include "ayumi/limits/judged_motion.hpp"
#include "ayumi/limits/row_site.hpp"

namespace ayumi {

namespace {

// Largest acceleration without a warning [rad/s^2] or [m/s^2]. Chosen: a jump of 0.03 degrees
// between two samples at 1 kHz. It is only a warning, but attribution assumes a jump in samples
// above it. With half of the value, the check of the case "arm" finds 1 warning of
// joint_acceleration; with twice, the check of the case "flight" finds 8 warnings of
// joint_acceleration instead of 13.
constexpr double kRoughAcceleration = 500;

void judge_joint_accelerations(JudgedMotion& motion, const JudgedSample& s) {
  const double most = motion.tolerance(FindingKind::joint_acceleration);
  for (int i = 0; i < motion.model.dof_count(); ++i) {
    const double acceleration = s.command.acceleration[6 + i];
    motion.raise(FindingKind::joint_acceleration, std::abs(acceleration), s.k, i);
    if (std::abs(acceleration) <= most) continue;
    motion.rough[s.k] = true;
    motion.add(FindingKind::joint_acceleration, i, s.k, acceleration, most, std::abs(acceleration),
               0, Severity::warning);
  }
}

const RowKind kRoughnessRows = {.name = "acceleration", .order = {3, 3}};

// A motion that is already rough becomes no rougher, because the check only warns about roughness.
void place_roughness_rows(RowSite& site) {
  const double most = site.tolerance(FindingKind::joint_acceleration);
  for (int i = 0; i < site.model.dof_count(); ++i) {
    if (site.is_locked(i)) continue;
    const auto size = [i](const CommandSample& s) { return std::abs(s.acceleration[6 + i]); };
    for (int point = 0; point < site.count(); ++point)
      site.add_largest(
          kRoughnessRows, point, JointQuantity::acceleration, i, site.most(point, size),
          site.settings.own_roughness ? std::max(most, size(site.given(point))) : most, 1);
  }
}

const char* acceleration_unit(const JudgedMotion& motion, const Violation& v) {
  return joint_unit(motion, v, "rad/s^2", "m/s^2");
}

Advice acceleration_advice(const JudgedMotion& motion, const FindingWindow& window) {
  return "make the motion of " + motion.model.dofs()[window.worst.item].name +
         " smoother here, with a longer segment or minimum_jerk interpolation";
}

}  // namespace

const Limit& joint_acceleration_limit() {
  static const Limit limit = {
      .findings = {{.kind = FindingKind::joint_acceleration,
                    .limit_class = LimitClass::rate,
                    .unit = "rad/s^2",
                    .tolerance = kRoughAcceleration,
                    .meaning = "acceleration of a joint. The finding is only a warning, because it "
                               "shows that a motion is rough",
                    .figure = {.key = "max_joint_acceleration_rad_s2",
                               .label = "largest joint acceleration",
                               .unit = "rad/s^2",
                               .line = 8},
                    .finding_unit = acceleration_unit,
                    .place = joint_place,
                    .advice = acceleration_advice}},
      .judge_sample = judge_joint_accelerations,
      .place_rows = place_roughness_rows};
  return limit;
}

}  // namespace ayumi
