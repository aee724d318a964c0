#include "ayumi/check/hints.hpp"

#include <cmath>

#include "ayumi/base/text.hpp"

namespace ayumi {

namespace {

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

std::string joint_hint(const RobotModel& model, const Violation& v) {
  const std::string joint = model.dofs()[v.item].name;
  const double ratio = std::abs(v.value / v.limit);
  switch (v.kind) {
    case Kind::joint_position:
      return "move " + joint + " back by " + text::fixed(std::abs(v.value - v.limit), 3) +
             " rad in this window, or repair";
    case Kind::joint_speed:
      return slow_down(ratio) + " or let " + joint + " swing through a smaller angle";
    case Kind::joint_acceleration:
      return "smooth " + joint + " here: a longer segment or minimum_jerk interpolation";
    case Kind::joint_torque:
      return "lower the load on " + joint + ": " + slow_down(std::sqrt(ratio)) +
             " where inertia is the cause, or straighten the leg where weight is";
    case Kind::continuous_torque:
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

std::string foot_hint(const Violation& v, double dt) {
  const std::string foot = name_of(foot_of(v));
  switch (v.kind) {
    case Kind::foot_slip:
      return "the " + foot + " sole moves " + mm(v.value) +
             " while it supports: keep the foot still, or repair";
    case Kind::foot_penetration:
      return "raise the " + foot + " sole by " + mm(v.value) + ", or repair";
    case Kind::foot_float:
      if (still_stands(v))
        return "the " + foot + " sole stands still for " + text::fixed(v.value, 3) +
               " s after its contact ends: end it that much later";
      if (v.detail != 0) return contact_edge_hint(v, foot, dt);
      return "the " + foot + " sole is " + mm(v.value) +
             " above the ground while it should support: begin its contact later or end it "
             "earlier, or lower the foot";
    default:
      return "let the " + foot + " foot come down slower than " + text::fixed(v.limit, 2) +
             " m/s: a lower lift or a longer step";
  }
}

std::string ground_hint(const Violation& v, double friction) {
  switch (v.kind) {
    case Kind::support_margin: {
      const std::string whose = v.item == 0 ? "the ZMP of the motion" : "the commanded ZMP";
      if (v.value < 0)
        return whose + " is " + mm(v.value) +
               " outside the support: move the COG that much less, "
               "give the step more time, or repair";
      return whose + " is only " + mm(v.value) + " inside the support, the margin asked for is " +
             mm(v.limit);
    }
    case Kind::friction:
      return "needs a friction coefficient of " + text::fixed(v.value * friction, 2) + ", has " +
             text::fixed(friction, 2) + ": " + slow_down(std::sqrt(v.value)) +
             " or take shorter steps";
    case Kind::unilateral:
      return "the ground cannot pull: lower the COG with less than free fall, or plan a flight "
             "phase";
    default:
      return "the foot would turn on the ground: " + slow_down(std::sqrt(v.value)) +
             " or swing the arms against the legs";
  }
}

}  // namespace

std::string where_text(const RobotModel& model, const std::vector<CollisionModel::Pair>& pairs,
                       const Violation& v) {
  switch (v.kind) {
    case Kind::cog_residual:
    case Kind::zmp_residual:
    case Kind::point_mass_gap:
    case Kind::ballistic:
    case Kind::angular_momentum:
      return axis_name(v.detail);
    case Kind::fz_residual:
      return "z";
    case Kind::support_margin:
    case Kind::friction:
    case Kind::unilateral:
    case Kind::yaw_moment:
      return name_of(static_cast<Support>(v.detail));
    case Kind::foot_slip:
    case Kind::foot_penetration:
    case Kind::foot_float:
    case Kind::landing_speed:
      return name_of(foot_of(v));
    case Kind::self_collision:
      return model.bodies()[pairs[v.item].a].name + " - " + model.bodies()[pairs[v.item].b].name;
    default:
      return model.dofs()[v.item].name;
  }
}

std::string hint_text(const RobotModel& model, const FindingWindow& window, double dt,
                      double friction) {
  const Violation& v = window.worst;
  switch (v.kind) {
    case Kind::cog_residual:
      return "the posture's COG is " + mm(v.value) + " from the commanded one, most along " +
             axis_name(v.detail) +
             ": change the COG key or the posture, or repair (which keeps "
             "the posture)";
    case Kind::zmp_residual:
      return "the motion's own ZMP is " + mm(v.value) + " from the commanded one, most along " +
             axis_name(v.detail) +
             ": change the ZMP key or the motion, or repair (which keeps "
             "the motion)";
    case Kind::fz_residual:
      return "the motion needs " + text::fixed(std::abs(v.value), 1) + " N " +
             (v.value > 0 ? "more" : "less") + " than the commanded f_z: leave f_z out, or repair";
    case Kind::point_mass_gap:
      return "the mass-concentrated model is " + mm(v.value) + " off here: judge by the full model";
    case Kind::ballistic:
      if (v.item == kMotionLeaps)
        return "the COG leaps by " + mm(v.value * dt * dt) +
               " where the flight begins or ends: nothing can throw it like that";
      return "the COG must fall freely for the " +
             text::fixed((window.last - window.first) * dt, 3) +
             " s of flight: leave the COG keys of the flight out";
    case Kind::angular_momentum:
      return "nothing can turn the robot in flight: keep its angular momentum, let arms and legs "
             "move against each other";
    case Kind::self_collision:
      return v.value < 0 ? "these bodies overlap by " + mm(v.value) + ": keep them apart"
                         : "only " + mm(v.value) + " between these bodies";
    case Kind::foot_slip:
    case Kind::foot_penetration:
    case Kind::foot_float:
    case Kind::landing_speed:
      return foot_hint(v, dt);
    case Kind::support_margin:
    case Kind::friction:
    case Kind::unilateral:
    case Kind::yaw_moment:
      return ground_hint(v, friction);
    default:
      return joint_hint(model, v);
  }
}

}  // namespace ayumi
