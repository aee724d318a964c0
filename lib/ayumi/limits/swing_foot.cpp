// A sole that comes down fast hits the ground: its speed along the normal n of its place is that of
// the last step before contact, -(n . (p_k - p_k-1)) / dt; at the first sample in contact the plan
// already stands still.
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/limits/judged_motion.hpp"

namespace ayumi {

namespace {

// [m/s] Chosen: a fall from 1 mm reaches 0.14 m/s. It is a warning only; half or twice of it
// changes no verdict. No measured case changes from half to twice (constants.md).
constexpr double kLandingTolerance = 0.15;

double landing_speed(const JudgedMotion& motion, Side side, const ContactInterval& contact) {
  const int k = contact.first;
  RobotData data(motion.model);
  const auto place = [&](int sample) {
    update_positions(motion.model, motion.series.samples[sample].state, data);
    return Eigen::Vector3d(sole_pose(motion.model, data, side).translation());
  };
  const double way = contact.sole.linear().col(2).dot(place(k) - place(k - 1));
  return -way / motion.series.dt;
}

void judge_landings(JudgedMotion& motion) {
  const double limit = motion.tolerance(FindingKind::landing_speed);
  for (Side side : {Side::left, Side::right}) {
    const int foot = static_cast<int>(side);
    for (const ContactInterval& contact : motion.plan.intervals[foot]) {
      if (!contact.contact || contact.first == 0) continue;
      const double speed = landing_speed(motion, side, contact);
      motion.raise(FindingKind::landing_speed, speed);
      if (speed > limit)
        motion.add(FindingKind::landing_speed, foot, contact.first, speed, limit, speed, 0,
                   Severity::warning);
    }
  }
}

Advice landing_advice(const JudgedMotion&, const FindingWindow& window) {
  return "let the " + std::string(name_of(foot_of(window.worst))) + " foot come down slower than " +
         text::fixed(window.worst.limit, 2) + " m/s: a lower lift or a longer step";
}

}  // namespace

const Limit& swing_foot_limit() {
  static const Limit limit = {
      .findings = {{.kind = FindingKind::landing_speed,
                    .limit_class = LimitClass::rate,
                    .unit = "m/s",
                    .tolerance = kLandingTolerance,
                    .meaning = "speed of a sole into the ground as it lands; a warning",
                    .figure = {.key = "max_landing_speed_m_s",
                               .label = "largest speed of a landing sole",
                               .unit = "m/s",
                               .line = 16},
                    .place = foot_place,
                    .advice = landing_advice}},
      .judge_motion = judge_landings};
  return limit;
}

}  // namespace ayumi
