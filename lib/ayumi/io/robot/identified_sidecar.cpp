#include "ayumi/io/robot/identified_sidecar.hpp"

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "ayumi/base/text.hpp"

namespace ayumi {

namespace {

using OrderedJson = nlohmann::ordered_json;

// The number with one digit more than the interval of the value determines.
double sidecar_number(double value) { return std::stod(text::brief(value, 5)); }

// Largest zero offset that a sidecar may state [rad]. Definition: the reader of sidecars accepts no
// larger one.
constexpr double kWritableOffset = 0.5;

// The servo of a joint as the simulation gets it; its constants are those of `source`. If the
// stiffness is not determined, the lower end of its interval is written; if there is no such end,
// the robot keeps its own stiffness. If the recording shows no damping, the whole lag is written as
// damping and not as delay, because a servo without any damping would let the joint oscillate.
OrderedJson servo_group(const IdentifiedJoint& joint, const IdentifiedJoint& source,
                        const ServoDescription& own) {
  OrderedJson group = {{"joints", {joint.joint}}};
  if (!source.moved) return group;
  const bool has_kp = source.kp.known || source.kp.lower > 0;
  const double kp = source.kp.known ? source.kp.value : has_kp ? source.kp.lower : own.kp;
  const double share = kp / source.kp.value;
  const double lag = (joint.moved ? joint : source).lag.value;
  if (has_kp) group["kp"] = sidecar_number(kp);
  if (source.delay_is_lag || !has_kp) {
    group["kd"] = sidecar_number(kp * lag);
    group["viscous"] = 0;
    group["delay"] = 0;
  } else {
    group["kd"] = sidecar_number(share * (source.damping.value - source.viscous.value));
    group["viscous"] = sidecar_number(share * source.viscous.value);
    group["delay"] =
        sidecar_number((joint.moved && !joint.delay_is_lag ? joint : source).delay.value);
  }
  if (has_kp) group["coulomb"] = sidecar_number(share * source.coulomb.value);
  if (source.backlash.value > 0) group["backlash"] = sidecar_number(source.backlash.value);
  return group;
}

// The zero of the joint's encoder. Angles that were measured at the joint show it as the difference
// between the angle and its command without load. This difference is added to the offset that was
// known, so that the next table compensates for both. Readings of the encoder itself do not contain
// its zero, and a constant difference from the command is an error of the servo. So there is no
// result for these readings, and none for an offset that is larger than a sidecar may state.
std::optional<double> new_offset(const IdentifiedJoint& joint, const ServoDescription& own,
                                 MeasuredAt measured_at) {
  const double offset = sidecar_number(own.offset + joint.offset.value);
  if (measured_at == MeasuredAt::encoder || std::abs(offset) > kWritableOffset) return {};
  return offset;
}

}  // namespace

std::string identified_sidecar(const RobotModel& model, const Identification& found,
                               const IdentifiedNames& names) {
  OrderedJson groups = OrderedJson::array(), offsets = OrderedJson::array();
  std::map<std::string, const IdentifiedJoint*> of_type;
  for (const IdentifiedJoint& joint : found.joints) {
    const IdentifiedJoint*& best = of_type[joint.type];
    const auto width = [](const IdentifiedJoint& each) {
      return each.moved && each.kp.known ? (each.kp.upper - each.kp.lower) / each.kp.value
                                         : HUGE_VAL;
    };
    if (!best || width(joint) < width(*best) || (joint.moved && !best->moved)) best = &joint;
  }
  for (const IdentifiedJoint& joint : found.joints) {
    const IdentifiedJoint& source = joint.moved && joint.kp.known ? joint : *of_type.at(joint.type);
    const auto dof = static_cast<size_t>(model.find_dof(joint.joint));
    const ServoDescription& own = model.limits().servo[dof];
    OrderedJson group = servo_group(joint, source, own);
    // A sidecar can only state the offset of a joint whose servo is stated.
    const bool has_servo = group.contains("kp") ||
                           (model.limits().has_servo[dof] && !model.description().servos_inferred);
    if (const auto offset = new_offset(joint, own, found.measured_at); offset && has_servo) {
      group["offset"] = *offset;
      offsets.push_back({{"joints", {joint.joint}}, {"offset", *offset}});
    }
    if (group.size() > 1) groups.push_back(group);
  }
  OrderedJson json = {
      {"format", "ayumi.robot/1"},
      {"base", names.base},
      {"name", model.name() + " (" + names.name + ")"},
      {"servos", groups},
      {"assumptions",
       {"servos: identified from " + names.measured + " with the command " + names.command}}};
  // Servos of a profile override those of the robot. So the constants are written there too, for
  // the profile of the recording, and the offsets, which belong to the unit, for all profiles.
  for (const ActuatorProfile& profile : model.description().profiles) {
    const OrderedJson& own = profile.name == model.limits().name ? groups : offsets;
    if (!profile.servos.empty() && !own.empty())
      json["profiles"].push_back({{"name", profile.name}, {"servos", own}});
  }
  return json.dump(2) + "\n";
}

}  // namespace ayumi
