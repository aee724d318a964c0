// A motor has a peak torque: |tau| <= peak torque of the actuator profile. tau follows from inverse
// dynamics with the ground wrench shared between the feet, plus the rotor's inertia and the viscous
// and Coulomb friction of the servo (demand/ground_demand.hpp, motor_torques()). Stribeck and
// load-dependent friction are not included, nor the loss of torque with speed that the voltage
// causes. A joint without a motor (kp of its servo is 0) gives no torque, whatever its files state
// as its peak. Near the beginning and end of a flight, accelerations have no meaning, so torques
// are not judged there.
#include <algorithm>

#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/limits/judged_motion.hpp"
#include "ayumi/limits/row_site.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

namespace {

// Largest share of the peak torque. Definition: the data sheet states the largest torque.
constexpr double kWholeTorque = 1;

// Torque that a joint without a motor may carry even if its stated dry friction is smaller: the
// weight of the robot times this lever [m]. Chosen: a limp hand hangs and swings freely, and the
// joints of a leg that stands on bent knees need 20 times as much. No measured case changes between
// half and twice the value, because the robots of these cases have motors in all joints.
constexpr double kLimpLever = 1e-3;

// The largest torque of a joint; infinite if nothing is known about it.
double peak_of(const JudgedMotion& motion, int dof) {
  const double peak = motion.limits.peak_torque[dof];
  if (!motion.limits.lacks_motor(dof)) return peak;
  const double friction = motion.limits.servo[static_cast<size_t>(dof)].coulomb;
  return std::min(peak, std::max(friction, kLimpLever * motion.model.mass() * kGravity));
}

void judge_joint_torques(JudgedMotion& motion, const JudgedSample& s) {
  const double most = motion.tolerance(FindingKind::joint_torque);
  if (!s.known) return;
  for (int i = 0; i < motion.model.dof_count(); ++i) {
    const double limit = peak_of(motion, i), torque = s.demand.torque[i];
    if (!std::isfinite(limit)) continue;
    const double ratio = std::abs(torque) / limit;
    if (ratio <= most && motion.limits.lacks_motor(i)) continue;  // no share of a motor's torque
    motion.raise(FindingKind::joint_torque, ratio, s.k, i);
    if (ratio > most) motion.add(FindingKind::joint_torque, i, s.k, torque, most * limit, ratio);
  }
}

// For each dof, the largest absolute torque over the watched samples.
Eigen::VectorXd watched_torques(RowSite& site, int point) {
  Eigen::VectorXd most = Eigen::VectorXd::Zero(site.model.dof_count());
  for (const CommandSample* s : site.watched(point)) {
    const Eigen::VectorXd force =
        inverse_dynamics(site.model, s->state, s->acceleration, site.data);
    const auto feet =
        shared_load(site.model, site.points[point], s->state.base.position, force.head<6>());
    most = most.cwiseMax(
        motor_torques(site.model, site.actuators, s->state, s->acceleration, force, feet, site.data)
            .cwiseAbs());
  }
  return most;
}

const RowKind kTorqueRows = {.name = "torque", .order = {5, 0}};

void place_torque_rows(RowSite& site) {
  const Eigen::VectorXd most =
      site.actuators.peak_torque * site.tolerance(FindingKind::joint_torque);
  for (int point = 0; point < site.count(); ++point) {
    if (!site.points[point].forces_known) continue;
    const Eigen::VectorXd torque = watched_torques(site, point);
    for (int i = 0; i < site.model.dof_count(); ++i)
      site.add_largest(kTorqueRows, point, JointQuantity::motor_torque, i, torque[i], most[i],
                       site.settings.limit_share, site.settings.active);
  }
}

bool joint_torque_holds(JudgedMotion& motion, const Violation& v, double pace) {
  return std::abs(motion.dynamics.at(v.sample, pace).torque[v.item]) <= std::abs(v.limit);
}

const char* torque_unit(const JudgedMotion& motion, const Violation& v) {
  return joint_unit(motion, v, "N m", "N");
}

Advice torque_advice(const JudgedMotion& motion, const FindingWindow& window) {
  const Violation& v = window.worst;
  if (motion.limits.lacks_motor(v.item))
    return "the motion needs a motor at " + motion.model.dofs()[v.item].name +
           ", but this joint has none (kp of its servo is 0). If the joint has a motor, state kp "
           "in the sidecar";
  return "lower the load on " + motion.model.dofs()[v.item].name +
         ". If the inertia is the cause, " +
         slow_down_text(std::sqrt(std::abs(v.value / v.limit))) +
         ". If the weight is the cause, shorten the lever arm of the weight" +
         straighter_leg(motion.model, v.item);
}

std::string torque_infeasibility(const Finding& f, double violation) {
  return "the torque of " + f.where + " reaches " + ratio_text(violation) + " times its limit";
}

}  // namespace

const Limit& joint_torque_limit() {
  static const Limit limit = {.findings = {{.kind = FindingKind::joint_torque,
                                            .limit_class = LimitClass::force,
                                            .unit = "1",
                                            .tolerance = kWholeTorque,
                                            .meaning = "motor torque divided by its peak limit",
                                            .figure = {.key = "max_torque_ratio",
                                                       .label = "largest torque",
                                                       .unit = "% of the limit",
                                                       .scale = 100,
                                                       .share_name = "torque",
                                                       .line = 9},
                                            .actuator = {.line = 1},
                                            .finding_unit = torque_unit,
                                            .place = joint_place,
                                            .advice = torque_advice,
                                            .infeasibility = torque_infeasibility,
                                            .holds_at = joint_torque_holds}},
                              .judge_sample = judge_joint_torques,
                              .place_rows = place_torque_rows};
  return limit;
}

}  // namespace ayumi
