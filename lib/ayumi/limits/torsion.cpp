// Torsional friction: about the normal through the ZMP, evenly pressed soles resist a moment of
//   |n_z| <= mu f_n r,
// where r is torsional_friction_arm(): the mean distance from the ZMP over the largest part of the
// support that is symmetric about it, a lower bound of what is possible (demand/ground_demand.hpp).
#include "ayumi/limits/judged_motion.hpp"

namespace ayumi {

namespace {

// Share of the moment that friction resists. Definition: at 1 the foot turns.
constexpr double kWholeMoment = 1;

// Nothing resists turning where the foot slides anyway, and a ZMP outside the support has no arm;
// both are findings of their own.
void judge_torsion(JudgedMotion& motion, const JudgedSample& s) {
  if (!s.has_zmp()) return;
  const GroundDemand& use = s.demand.use;
  const double grip = motion.friction * use.normal_force;
  const double ratio = use.tangential_force / grip;
  if (ratio >= 1 || use.margin <= motion.tolerance(FindingKind::support_margin)) return;
  const double arm = torsional_friction_arm(motion.dynamics.plane().polygon, use.zmp);
  const double yaw = std::abs(use.yaw_moment) / (grip * arm);
  motion.raise(FindingKind::yaw_moment, yaw);
  const double most = motion.tolerance(FindingKind::yaw_moment);
  if (yaw > most)
    motion.add(FindingKind::yaw_moment, 0, s.k, yaw, most, yaw,
               static_cast<int>(s.command.support));
}

bool torsion_holds(JudgedMotion& motion, const Violation& v, double pace) {
  const GroundDemand& use = motion.dynamics.at(v.sample, pace).use;
  return std::abs(use.yaw_moment) <=
         std::abs(v.limit) * motion.friction * use.normal_force *
             torsional_friction_arm(motion.dynamics.plane().polygon, use.zmp);
}

Advice torsion_advice(const JudgedMotion&, const FindingWindow& window) {
  return "the foot would turn on the ground: " + slow_down_text(std::sqrt(window.worst.value)) +
         " or swing the arms against the legs";
}

std::string torsion_obstacle(const Finding& f, double excess) {
  return "the foot would turn: " + ratio_text(excess) +
         " of the yaw moment that friction can resist (" + f.where + ")";
}

}  // namespace

const Limit& torsion_limit() {
  static const Limit limit = {
      .findings = {{.kind = FindingKind::yaw_moment,
                    .limit_class = LimitClass::force,
                    .unit = "1",
                    .tolerance = kWholeMoment,
                    .meaning =
                        "moment about the normal through the ZMP over what friction resists, "
                        "evenly pressed soles",
                    .figure = {.key = "max_yaw_ratio",
                               .label = "largest yaw moment",
                               .unit = "% of what friction resists",
                               .scale = 100,
                               .share_name = "yaw",
                               .line = 12},
                    .place = support_place,
                    .advice = torsion_advice,
                    .obstacle = torsion_obstacle,
                    .holds_at = torsion_holds}},
      .judge_sample = judge_torsion};
  return limit;
}

}  // namespace ayumi
