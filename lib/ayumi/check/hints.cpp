#include "ayumi/check/hints.hpp"

#include <cmath>

#include "ayumi/base/text.hpp"

namespace ayumi {

namespace {

const std::string kOrRepair = ", or repair";

std::string mm(double metres) { return text::fixed(1000 * std::abs(metres), 1) + " mm"; }

std::string fine_mm(double metres) { return text::fixed(1000 * metres, 2) + " mm"; }

std::string slow_down(double factor) {
  return "slow this window down by " + text::fixed(std::ceil(100 * factor) / 100, 2);
}

const char* axis_name(int axis) { return axis == 0 ? "x" : axis == 1 ? "y" : "z"; }

std::string servo_target_hint(const RobotModel& model, const Violation& v) {
  const Dof& dof = model.dofs()[v.item];
  return "the target of " + dof.name + "'s servo, which leads the posture by kd/kp = " +
         text::brief(1e3 * dof.servo.kd / dof.servo.kp, 3) + " ms, steps by " +
         text::brief(std::abs(v.value / v.limit), 3) +
         " of what the speed limit allows, so that `export` refuses the table: accelerate " +
         dof.name + " less here";
}

Advice joint_hint(const RobotModel& model, const Violation& v) {
  const std::string joint = model.dofs()[v.item].name;
  const double ratio = std::abs(v.value / v.limit);
  switch (v.kind) {
    case FindingKind::joint_position:
      return {"move " + joint + " back by " + text::fixed(std::abs(v.value - v.limit), 3) +
                  " rad in this window",
              kOrRepair};
    case FindingKind::joint_speed:
      return slow_down(ratio) + " or let " + joint + " swing through a smaller angle";
    case FindingKind::joint_acceleration:
      return "smooth " + joint + " here: a longer segment or minimum_jerk interpolation";
    case FindingKind::joint_torque:
      return "lower the load on " + joint + ": " + slow_down(std::sqrt(ratio)) +
             " where inertia is the cause, or straighten the leg where weight is";
    case FindingKind::continuous_torque:
      return joint + " gets too hot when this goes on: rest it, or straighten the leg";
    default:
      if (v.detail == kServoTarget) return servo_target_hint(model, v);
      return joint + " jumps by " + text::brief(v.value, 3) +
             " rad in one servo period: spread the step over " + text::fixed(std::ceil(ratio), 0) +
             " periods";
  }
}

std::string contact_edge_hint(const Violation& v, const std::string& foot, double dt) {
  const std::string time = text::fixed(std::abs(v.detail) * dt, 3) + " s";
  return v.detail > 0 ? "the " + foot + " sole is still coming down, " + fine_mm(v.value) +
                            " to go, when its contact begins: begin it " + time + " later"
                      : "the " + foot + " sole has risen by " + fine_mm(v.value) +
                            " when its contact ends: end it " + time + " earlier";
}

Advice foot_hint(const Violation& v, double dt) {
  const std::string foot = name_of(foot_of(v));
  switch (v.kind) {
    case FindingKind::foot_slip:
      return {
          "the " + foot + " sole moves " + mm(v.value) + " while it supports: keep the foot still",
          kOrRepair};
    case FindingKind::foot_penetration:
      return {"raise the " + foot + " sole by " + mm(v.value), kOrRepair};
    case FindingKind::contact_ends_early:
      return "the " + foot + " sole stands still for " + text::fixed(v.value, 3) +
             " s after its contact ends: end it that much later";
    case FindingKind::foot_float:
      if (v.detail != 0) return contact_edge_hint(v, foot, dt);
      return "the " + foot + " sole is " + mm(v.value) +
             " above the ground while it should support: begin its contact later or end it "
             "earlier, or lower the foot";
    default:
      return "let the " + foot + " foot come down slower than " + text::fixed(v.limit, 2) +
             " m/s: a lower lift or a longer step";
  }
}

Advice ground_hint(const Violation& v, double friction) {
  switch (v.kind) {
    case FindingKind::support_margin: {
      const std::string whose = v.item == 0 ? "the ZMP of the motion" : "the commanded ZMP";
      if (v.value < 0)
        return {whose + " is " + mm(v.value) +
                    " outside the support: move the COG that much less, give the step more time",
                kOrRepair};
      return whose + " is only " + mm(v.value) + " inside the support, the margin asked for is " +
             mm(v.limit);
    }
    case FindingKind::friction:
      return "needs a friction coefficient of " + text::fixed(v.value * friction, 2) + ", has " +
             text::fixed(friction, 2) + ": " + slow_down(std::sqrt(v.value)) +
             " or take shorter steps";
    case FindingKind::unilateral:
      return "the ground cannot pull: lower the COG with less than free fall, or plan a flight "
             "phase";
    default:
      return "the foot would turn on the ground: " + slow_down(std::sqrt(v.value)) +
             " or swing the arms against the legs";
  }
}

}  // namespace

Place place_of(const std::vector<CollisionModel::Pair>& pairs, const Violation& v) {
  switch (v.kind) {
    case FindingKind::cog_residual:
    case FindingKind::zmp_residual:
    case FindingKind::point_mass_gap:
    case FindingKind::ballistic:
    case FindingKind::angular_momentum:
      return AxisPlace{v.detail};
    case FindingKind::fz_residual:
      return AxisPlace{2};
    case FindingKind::support_margin:
    case FindingKind::friction:
    case FindingKind::unilateral:
    case FindingKind::yaw_moment:
      return SupportPlace{static_cast<Support>(v.detail)};
    case FindingKind::foot_slip:
    case FindingKind::foot_penetration:
    case FindingKind::foot_float:
    case FindingKind::contact_ends_early:
    case FindingKind::landing_speed:
      return FootPlace{foot_of(v)};
    case FindingKind::self_collision:
      return BodyPairPlace{pairs[v.item].a, pairs[v.item].b};
    default:
      return JointPlace{v.item};
  }
}

std::string where_text(const RobotModel& model, const Place& place) {
  struct Words {
    const RobotModel& model;
    std::string operator()(std::monostate) const { return ""; }
    std::string operator()(const JointPlace& p) const { return model.dofs()[p.dof].name; }
    std::string operator()(const FootPlace& p) const { return name_of(p.side); }
    std::string operator()(const AxisPlace& p) const { return axis_name(p.axis); }
    std::string operator()(const SupportPlace& p) const { return name_of(p.support); }
    std::string operator()(const BodyPairPlace& p) const {
      return model.bodies()[p.a].name + " - " + model.bodies()[p.b].name;
    }
  };
  return std::visit(Words{model}, place);
}

Advice advice_for(const RobotModel& model, const FindingWindow& window, double dt,
                  double friction) {
  const Violation& v = window.worst;
  switch (v.kind) {
    case FindingKind::cog_residual:
      return {"the posture's COG is " + mm(v.value) + " from the commanded one, most along " +
                  axis_name(v.detail) + ": change the COG key or the posture",
              kOrRepair + " (which keeps the posture)"};
    case FindingKind::zmp_residual:
      return {"the motion's own ZMP is " + mm(v.value) + " from the commanded one, most along " +
                  axis_name(v.detail) + ": change the ZMP key or the motion",
              kOrRepair + " (which keeps the motion)"};
    case FindingKind::fz_residual:
      return {"the motion needs " + text::fixed(std::abs(v.value), 1) + " N " +
                  (v.value > 0 ? "more" : "less") + " than the commanded f_z: leave f_z out",
              kOrRepair};
    case FindingKind::point_mass_gap:
      return "the mass-concentrated model is " + mm(v.value) + " off here: judge by the full model";
    case FindingKind::ballistic:
      if (v.item == kMotionLeaps)
        return "the COG leaps by " + mm(v.value * dt * dt) +
               " where the flight begins or ends: nothing can throw it like that";
      return "the COG must fall freely for the " +
             text::fixed((window.last - window.first) * dt, 3) +
             " s of flight: leave the COG keys of the flight out";
    case FindingKind::angular_momentum:
      return "nothing can turn the robot in flight: keep its angular momentum, let arms and legs "
             "move against each other";
    case FindingKind::self_collision:
      return v.value < 0 ? "these bodies overlap by " + mm(v.value) + ": keep them apart"
                         : "only " + mm(v.value) + " between these bodies";
    case FindingKind::foot_slip:
    case FindingKind::foot_penetration:
    case FindingKind::foot_float:
    case FindingKind::contact_ends_early:
    case FindingKind::landing_speed:
      return foot_hint(v, dt);
    case FindingKind::support_margin:
    case FindingKind::friction:
    case FindingKind::unilateral:
    case FindingKind::yaw_moment:
      return ground_hint(v, friction);
    default:
      return joint_hint(model, v);
  }
}

}  // namespace ayumi
