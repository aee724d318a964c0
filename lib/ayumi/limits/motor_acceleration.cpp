// A motor turns its own rotor first: with the rotor's inertia J, reflected through the gear, the
// peak torque tau_max and the torque tau_load of everything behind it,
//   J ddtheta = tau - tau_load,   so that an unloaded joint keeps |ddtheta| <= tau_max / J.
// The torque of joint_torque contains J ddtheta, but it has no meaning near the beginning and end
// of a flight, and a load that drives the joint hides it. This limit holds everywhere. Robots whose
// files state no rotor inertia have no such limit.
#include <limits>

#include "ayumi/limits/judged_motion.hpp"
#include "ayumi/limits/row_site.hpp"

namespace ayumi {

namespace {

// Largest share of tau_max / J. Definition: at 1 the motor only accelerates its rotor.
constexpr double kWholeMotorAcceleration = 1;

/// tau_max / J of every joint [rad/s^2], [m/s^2]; infinite if J is not stated.
Eigen::VectorXd motor_acceleration(const RobotModel& model, const ActuatorLimits& actuators) {
  Eigen::VectorXd most(model.dof_count());
  for (int i = 0; i < model.dof_count(); ++i) {
    const double inertia = actuators.servo[i].rotor_inertia;
    most[i] =
        inertia > 0 ? actuators.peak_torque[i] / inertia : std::numeric_limits<double>::infinity();
  }
  return most;
}

void judge_motor_accelerations(JudgedMotion& motion) {
  const Eigen::VectorXd limit = motor_acceleration(motion.model, motion.limits);
  const double most = motion.tolerance(FindingKind::motor_acceleration);
  for (int k = 0; k < motion.count(); ++k) {
    for (int i = 0; i < motion.model.dof_count(); ++i) {
      if (!std::isfinite(limit[i])) continue;
      const double acceleration = motion.series.samples[k].acceleration[6 + i];
      const double ratio = std::abs(acceleration) / limit[i];
      motion.raise(FindingKind::motor_acceleration, ratio, k, i);
      if (ratio > most)
        motion.add(FindingKind::motor_acceleration, i, k, acceleration, most * limit[i], ratio);
    }
  }
}

const RowKind kMotorRows = {.name = "motor_acceleration", .order = {3, 2}};

void place_motor_rows(RowSite& site) {
  const Eigen::VectorXd most = site.tolerance(FindingKind::motor_acceleration) *
                               motor_acceleration(site.model, site.actuators);
  for (int i = 0; i < site.model.dof_count(); ++i) {
    if (site.is_locked(i)) continue;
    for (int point = 0; point < site.count(); ++point) {
      const double acceleration =
          site.most(point, [&](const CommandSample& s) { return std::abs(s.acceleration[6 + i]); });
      site.add_largest(kMotorRows, point, JointQuantity::acceleration, i, acceleration, most[i],
                       site.settings.limit_share);
    }
  }
}

bool motor_acceleration_holds(JudgedMotion&, const Violation& v, double pace) {
  return std::abs(v.value) * pace * pace <= std::abs(v.limit);
}

const char* motor_acceleration_unit(const JudgedMotion& motion, const Violation& v) {
  return joint_unit(motion, v, "rad/s^2", "m/s^2");
}

Advice motor_acceleration_advice(const JudgedMotion& motion, const FindingWindow& window) {
  const Violation& v = window.worst;
  return {"the motor of " + motion.model.dofs()[v.item].name +
              " cannot accelerate its own rotor so fast",
          slow_down_text(std::sqrt(std::abs(v.value / v.limit))) +
              ", or make the motion of the joint smoother here",
          ""};
}

std::string motor_acceleration_infeasibility(const Finding& f, double violation) {
  return "the acceleration of " + f.where + " reaches " + ratio_text(violation) +
         " times the acceleration that its motor can give to its own rotor";
}

}  // namespace

const Limit& motor_acceleration_limit() {
  static const Limit limit = {
      .findings = {{.kind = FindingKind::motor_acceleration,
                    .limit_class = LimitClass::rate,
                    .unit = "1",
                    .tolerance = kWholeMotorAcceleration,
                    .meaning = "joint acceleration divided by the acceleration that the motor "
                               "reaches without a load (peak torque / rotor inertia)",
                    .figure = {.key = "max_motor_acceleration_ratio",
                               .label = "largest motor acceleration",
                               .unit = "% of peak torque / rotor inertia",
                               .scale = 100,
                               .line = 21},
                    .actuator = {.line = 5},
                    .finding_unit = motor_acceleration_unit,
                    .place = joint_place,
                    .advice = motor_acceleration_advice,
                    .infeasibility = motor_acceleration_infeasibility,
                    .holds_at = motor_acceleration_holds}},
      .judge_motion = judge_motor_accelerations,
      .place_rows = place_motor_rows};
  return limit;
}

}  // namespace ayumi
