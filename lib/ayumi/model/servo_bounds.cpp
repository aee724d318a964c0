#include "ayumi/model/servo_bounds.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/text.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/model/validate.hpp"

namespace ayumi {

namespace {

// Bounds of the rotor inertia and of the dry friction, with the robot's mass m, its stretched
// length L and gravity g. They are shares of m L^2, the inertia of the whole robot about one of its
// ends, and of m g L, the torque that holds the whole robot stretched out. Chosen: HOAP-1 has
// 1/1000 and 1/100 of these values; half or twice the bounds would accept the same servos.
constexpr double kInertiaShare = 1, kFrictionShare = 1;

// Largest stiffness, in m g L per radian. Chosen: with it, the weight of the whole robot stretched
// out bends the joint by 0.1 mrad; the measured servos of a HOAP-3 reach 80.
constexpr double kStiffnessShare = 1e4;

// Largest damping and viscous friction, in m g L sqrt(L / g). Chosen: with it, the robot would tilt
// for seconds; the servos of a HOAP-3 reach 0.7.
constexpr double kDampingShare = 100;

struct ServoBound {
  const char *key, *unit, *sliding_unit;
  double ServoDescription::*value;
  double most;
};

std::string place_of(const RobotModel& model, const ActuatorLimits& limits, int dof) {
  return "profile '" + limits.name + "': joint " + model.dofs()[static_cast<size_t>(dof)].name +
         ": ";
}

// The place of a joint's constants: in the profile if it has constants of its own for this joint,
// otherwise among the servos of the robot.
const char* pointer_of(const RobotDescription& robot, const std::string& profile,
                       const std::string& joint) {
  const bool own =
      std::any_of(robot.profiles.begin(), robot.profiles.end(), [&](const ActuatorProfile& each) {
        return each.name == profile && each.servos.contains(joint);
      });
  return own ? "/profiles" : "/servos";
}

}  // namespace

double stretched_length(const RobotModel& model) {
  std::vector<double> way(model.bodies().size(), 0);
  double longest = 0;
  for (size_t b = 0; b < model.bodies().size(); ++b) {
    const Body& body = model.bodies()[b];
    if (body.parent >= 0)
      way[b] = way[static_cast<size_t>(body.parent)] + body.placement.translation().norm();
    longest = std::max(longest, way[b] + body.inertia.com.norm());
  }
  return 2 * longest;
}

void require_servos_that_fit(const RobotModel& model) {
  const double length = stretched_length(model), weight = model.mass() * kGravity;
  if (!(length > 0 && weight > 0)) return;
  using S = ServoDescription;
  for (const std::string& profile : model.profile_names()) {
    const ActuatorLimits& limits = model.limits(profile);
    for (int j = 0; j < model.dof_count(); ++j) {
      // For a sliding joint, read metre instead of radian.
      const bool slides = model.dofs()[static_cast<size_t>(j)].prismatic;
      const double lever = slides ? 1 : length;
      const double friction = kFrictionShare * weight * lever,
                   stiffness = kStiffnessShare * weight / length * lever * lever,
                   damping = kDampingShare * weight / length * lever * lever *
                             std::sqrt(length / kGravity),
                   inertia = kInertiaShare * model.mass() * lever * lever;
      const ServoBound bounds[] = {{"rotor_inertia", "kg m^2", "kg", &S::rotor_inertia, inertia},
                                   {"coulomb", "N m", "N", &S::coulomb, friction},
                                   {"stribeck_torque", "N m", "N", &S::stribeck_torque, friction},
                                   {"kp", "N m/rad", "N/m", &S::kp, stiffness},
                                   {"kd", "N m s/rad", "N s/m", &S::kd, damping},
                                   {"viscous", "N m s/rad", "N s/m", &S::viscous, damping}};
      for (const ServoBound& bound : bounds) {
        const double value = limits.servo[static_cast<size_t>(j)].*bound.value;
        if (value <= bound.most) continue;
        const std::string unit = std::string(" ") + (slides ? bound.sliding_unit : bound.unit),
                          message = place_of(model, limits, j) + bound.key + " " +
                                    text::brief(value) + unit + " is too large for a robot of " +
                                    text::brief(model.mass(), 3) + " kg and " +
                                    text::brief(length, 3) + " m; the largest allowed value is " +
                                    text::brief(bound.most, 3) + unit +
                                    ". Check the unit of the constant, and the masses of the links";
        const RobotDescription& robot = model.description();
        if (robot.sidecar_file.empty())
          complain_urdf(robot, "", message);
        else
          complain_sidecar(
              robot, pointer_of(robot, limits.name, model.dofs()[static_cast<size_t>(j)].name),
              message);
      }
    }
  }
}

}  // namespace ayumi
