#include "ayumi/check/finding_kinds.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

const char* name_of(Severity severity) {
  switch (severity) {
    case Severity::error:
      return "error";
    case Severity::warning:
      return "warning";
    default:
      return "info";
  }
}

const std::vector<FindingKind>& finding_kinds() {
  static const std::vector<FindingKind> kinds = {
      {"cog_residual", "m", "COG of the posture from the commanded COG", 0.002},
      {"zmp_residual", "m", "ZMP of the full model from the commanded ZMP", 0.005},
      {"fz_residual", "m g",
       "vertical force the motion needs from the commanded one, tolerance as a share of the weight",
       0.05},
      {"point_mass_gap", "m",
       "ZMP of the mass-concentrated model (14)(15) from the commanded ZMP; tells how good that "
       "model is here, never an error",
       0.02},
      {"support_margin", "m",
       "distance of the ZMP inside the support polygon: an error outside, a warning when less than "
       "the tolerance inside",
       0.002},
      {"friction", "1", "tangential ground force over friction coefficient times normal force", 1},
      {"unilateral", "m g",
       "normal ground force in contact: an error when it would have to pull, a warning below the "
       "tolerance, a share of the weight",
       0.05},
      {"yaw_moment", "1",
       "moment about the normal through the ZMP over what friction resists, evenly pressed soles",
       1},
      {"ballistic", "m/s^2", "COG acceleration in flight from free fall", 0.5},
      {"angular_momentum", "N m", "rate of the angular momentum about the COG in flight", 0.1},
      {"foot_slip", "m", "horizontal way of a supporting sole from its place", 0.002},
      {"foot_penetration", "m", "depth of a sole below the ground", 0.001},
      {"foot_float", "m",
       "height of a supporting sole's highest corner above the ground; in s where a foot stands on "
       "after its contact",
       0.0003},
      {"joint_position", "rad", "joint angle beyond its limit", 1e-4},
      {"joint_speed", "1", "joint speed over its limit", 1},
      {"joint_acceleration", "rad/s^2", "joint acceleration; a warning, it tells a rough motion",
       500},
      {"joint_torque", "1", "motor torque over its peak limit", 1},
      {"continuous_torque", "1",
       "RMS motor torque over its continuous limit in the motor's thermal window; a warning when "
       "the motion is shorter than the window",
       1},
      {"servo_step", "1",
       "change of the joint angle per servo period over what the speed limit allows, where the "
       "joint speed itself does not tell it; a warning where only the servo's target, which leads "
       "the angle, steps by more",
       1},
      {"self_collision", "m",
       "clearance between bodies: an error when they meet, a warning below the tolerance", 0.002},
      {"landing_speed", "m/s", "speed of a sole into the ground as it lands; a warning", 0.15},
  };
  return kinds;
}

std::array<double, kKindCount> tolerances(const CheckOptions& options) {
  const std::vector<FindingKind>& kinds = finding_kinds();
  require(kinds.size() == kKindCount, "finding_kinds() and Kind differ in length");
  std::array<double, kKindCount> result;
  std::vector<std::string> names;
  for (int i = 0; i < kKindCount; ++i) {
    result[i] = kinds[i].tolerance;
    names.push_back(kinds[i].kind);
  }
  for (const auto& [name, value] : options.tolerances) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
      fail(ErrorCode::usage,
           "tolerance '" + name + "': no such kind of finding" + text::suggestion(name, names));
    if (!std::isfinite(value))
      fail(ErrorCode::usage,
           "tolerance '" + name + "': " + text::exact(value) + " is not a finite number");
    result[found - names.begin()] = value;
  }
  return result;
}

std::array<double, kKindCount> tolerances(const CheckOptions& options, const RobotModel& model,
                                          const CommandSeries& series) {
  constexpr double kMomentShare = 0.0065;
  std::array<double, kKindCount> result = tolerances(options);
  double& moment = result[static_cast<int>(Kind::angular_momentum)];
  if (!options.tolerances.contains("angular_momentum") && !series.samples.empty())
    moment =
        std::max(moment, kMomentShare * model.mass() * kGravity * series.samples.front().cog.z());
  return result;
}

bool is_of_posture(const Finding& f) {
  return f.kind.starts_with("foot_") || f.kind == "joint_position" || f.kind == "self_collision" ||
         f.kind == "cog_residual";
}

}  // namespace ayumi
