// Coulomb: a sole does not slide while the force along the ground stays inside the round cone,
//   f_t = |(f_x, f_y)| <= mu f_n,
// with (f_x, f_y, f_n) the demanded ground force in the axes of the support plane. The ratio
// f_t / (mu f_n) is the share of the cone that the motion uses; mu times it is the coefficient
// needed.
#include "ayumi/base/text.hpp"
#include "ayumi/limits/judged_motion.hpp"

namespace ayumi {

namespace {

// Share of the cone. Definition: at 1 the sole slides.
constexpr double kWholeCone = 1;

void judge_friction(JudgedMotion& motion, const JudgedSample& s) {
  if (!s.has_zmp()) return;
  const double grip = motion.friction * s.demand.use.normal_force;
  const double ratio = s.demand.use.tangential_force / grip;
  motion.raise(FindingKind::friction, ratio);
  const double most = motion.tolerance(FindingKind::friction);
  if (ratio > most)
    motion.add(FindingKind::friction, 0, s.k, ratio, most, ratio,
               static_cast<int>(s.command.support));
}

bool friction_holds(JudgedMotion& motion, const Violation& v, double pace) {
  const GroundDemand& use = motion.dynamics.at(v.sample, pace).use;
  return use.tangential_force <= std::abs(v.limit) * motion.friction * use.normal_force;
}

Advice friction_advice(const JudgedMotion& motion, const FindingWindow& window) {
  const Violation& v = window.worst;
  return "needs a friction coefficient of " + text::fixed(v.value * motion.friction, 2) + ", has " +
         text::fixed(motion.friction, 2) + ": " + slow_down_text(std::sqrt(v.value)) +
         " or take shorter steps";
}

std::string friction_obstacle(const Finding& f, double excess) {
  return "the motion needs " + ratio_text(excess) + " of the available friction (" + f.where + ")";
}

}  // namespace

const Limit& friction_limit() {
  static const Limit limit = {
      .findings = {{.kind = FindingKind::friction,
                    .limit_class = LimitClass::force,
                    .unit = "1",
                    .tolerance = kWholeCone,
                    .meaning =
                        "tangential ground force over friction coefficient times normal force",
                    .figure = {.key = "max_friction_ratio",
                               .label = "largest friction use",
                               .unit = "% of the cone",
                               .scale = 100,
                               .share_name = "friction",
                               .line = 11},
                    .place = support_place,
                    .advice = friction_advice,
                    .obstacle = friction_obstacle,
                    .holds_at = friction_holds}},
      .judge_sample = judge_friction};
  return limit;
}

}  // namespace ayumi
