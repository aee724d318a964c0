#include "ayumi/check/finding_kinds.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

const std::vector<FindingSpec>& finding_specs() {
  static const std::vector<FindingSpec> specs = {
      {FindingKind::cog_residual, "m", "COG of the posture from the commanded COG", 0.002},
      {FindingKind::zmp_residual, "m", "ZMP of the full model from the commanded ZMP", 0.005},
      {FindingKind::fz_residual, "m g",
       "vertical force the motion needs from the commanded one, tolerance as a share of the weight",
       0.05},
      {FindingKind::point_mass_gap, "m",
       "ZMP of the mass-concentrated model (14)(15) from the commanded ZMP; tells how good that "
       "model is here, never an error",
       0.02},
      {FindingKind::support_margin, "m",
       "distance of the ZMP inside the support polygon: an error outside, a warning when less than "
       "the tolerance inside",
       0.002},
      {FindingKind::friction, "1",
       "tangential ground force over friction coefficient times normal force", 1},
      {FindingKind::unilateral, "m g",
       "normal ground force in contact: an error when it would have to pull, a warning below the "
       "tolerance, a share of the weight",
       0.05},
      {FindingKind::yaw_moment, "1",
       "moment about the normal through the ZMP over what friction resists, evenly pressed soles",
       1},
      {FindingKind::ballistic, "m/s^2", "COG acceleration in flight from free fall", 0.5},
      {FindingKind::angular_momentum, "N m", "rate of the angular momentum about the COG in flight",
       0.1},
      {FindingKind::foot_slip, "m", "horizontal way of a supporting sole from its place", 0.002},
      {FindingKind::foot_penetration, "m", "depth of a sole below the ground", 0.001},
      {FindingKind::foot_float, "m",
       "height of a supporting sole's highest corner above the ground", 0.0003},
      {FindingKind::contact_ends_early, "s",
       "time for which a foot stands on in its place after its contact has ended", 0.030},
      {FindingKind::joint_position, "rad", "joint angle beyond its limit", 1e-4},
      {FindingKind::joint_speed, "1", "joint speed over its limit", 1},
      {FindingKind::joint_acceleration, "rad/s^2",
       "joint acceleration; a warning, it tells a rough motion", 500},
      {FindingKind::joint_torque, "1", "motor torque over its peak limit", 1},
      {FindingKind::continuous_torque, "1",
       "RMS motor torque over its continuous limit in the motor's thermal window; a warning when "
       "the motion is shorter than the window",
       1},
      {FindingKind::servo_step, "1",
       "change of the joint angle per servo period over what the speed limit allows, where the "
       "joint speed itself does not tell it; a warning where only the servo's target, which leads "
       "the angle, steps by more",
       1},
      {FindingKind::self_collision, "m",
       "clearance between bodies: an error when they meet, a warning below the tolerance", 0.002},
      {FindingKind::landing_speed, "m/s", "speed of a sole into the ground as it lands; a warning",
       0.15},
  };
  return specs;
}

Tolerances tolerances(const CheckOptions& options) {
  Tolerances result;
  for (const FindingSpec& spec : finding_specs()) result[spec.kind] = spec.tolerance;
  for (const auto& [name, value] : options.tolerances) {
    const std::optional<FindingKind> kind = finding_kind(name);
    if (!kind)
      fail(ErrorCode::usage, "tolerance '" + name + "': no such kind of finding" +
                                 text::suggestion(name, finding_kind_names()));
    if (!std::isfinite(value))
      fail(ErrorCode::usage,
           "tolerance '" + name + "': " + text::exact(value) + " is not a finite number");
    result[*kind] = value;
  }
  return result;
}

Tolerances tolerances(const CheckOptions& options, const RobotModel& model,
                      const CommandSeries& series) {
  constexpr double kMomentShare = 0.0065;
  Tolerances result = tolerances(options);
  double& moment = result[FindingKind::angular_momentum];
  if (!options.tolerances.contains(name_of(FindingKind::angular_momentum)) &&
      !series.samples.empty())
    moment =
        std::max(moment, kMomentShare * model.mass() * kGravity * series.samples.front().cog.z());
  return result;
}

bool is_of_posture(const Finding& f) {
  switch (f.kind) {
    case FindingKind::foot_slip:
    case FindingKind::foot_penetration:
    case FindingKind::foot_float:
    case FindingKind::contact_ends_early:
    case FindingKind::joint_position:
    case FindingKind::self_collision:
    case FindingKind::cog_residual:
      return true;
    default:
      return false;
  }
}

}  // namespace ayumi
