#include "ayumi/sim/step_check.hpp"

#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"

namespace ayumi {

using Eigen::VectorXd;

namespace {

bool sound(double x) { return std::abs(x) < kLargestNumber; }

/// Whether every element is smaller than kLargestNumber and not NaN.
template <typename Derived>
bool sound(const Eigen::MatrixBase<Derived>& v) {
  for (Eigen::Index i = 0; i < v.size(); ++i)
    if (!sound(v(i))) return false;
  return true;
}

template <typename Derived>
double unsound(const Eigen::MatrixBase<Derived>& v) {
  for (Eigen::Index i = 0; i < v.size(); ++i)
    if (!sound(v(i))) return v(i);
  return 0;
}

bool sound(const GroundBlock& block) {
  return sound(block.low) && sound(block.high) && sound(block.center) && block.radius >= 0 &&
         sound(block.radius) && sound(block.height);
}

bool sound(const FloorPose& floor) {
  return sound(floor.pose.matrix()) && sound(floor.velocity) && sound(floor.angular_velocity);
}

bool sound(const JointFault& fault) {
  return fault.gain >= 0 && fault.coulomb >= 0 && fault.viscous >= 0 && sound(fault.gain) &&
         sound(fault.coulomb) && sound(fault.viscous) && sound(fault.encoder);
}

bool sound_friction(double mu) { return mu >= 0 && sound(mu); }

}  // namespace

void check_world(const RobotModel& model, const World& world) {
  const auto complain = [&](const std::string& what) {
    fail(ErrorCode::bad_pattern, model.name() + ": the world's " + what);
  };
  if (!sound_friction(world.friction))
    complain("friction is " + text::brief(world.friction) + ". The friction must be 0 or more");
  if (!sound(world.slope) || !sound(world.height)) complain("slope or height is not a number");
  for (size_t i = 0; i < world.blocks.size(); ++i)
    if (!sound(world.blocks[i]))
      complain("block " + std::to_string(i) +
               " is not valid. Its values must be numbers below 1e6, and its radius must not be "
               "negative");
  for (size_t i = 0; i < world.patches.size(); ++i) {
    const FrictionPatch& patch = world.patches[i];
    if (!sound(patch.low) || !sound(patch.high) || !sound_friction(patch.friction))
      complain("patch " + std::to_string(i) +
               " is not valid. Its values must be numbers below 1e6, and its friction must not be "
               "negative");
  }
  for (const HeightField& field : world.fields)
    if (!sound(field.origin) || !(field.spacing > 0) || !sound(field.heights))
      complain(
          "field is not valid. Its values must be numbers below 1e6, and its spacing must be above "
          "0");
}

void check_state(const RobotModel& model, const RobotState& state) {
  const auto check = [&](const char* what, const auto& value) {
    if (!sound(value))
      fail(ErrorCode::usage, model.name() + ": " + what + " of the plant's state is " +
                                 text::brief(unsound(value)) + ". Numbers below 1e6 are expected");
  };
  if (state.theta.size() != model.dof_count() || state.dtheta.size() != model.dof_count())
    fail(ErrorCode::usage, model.name() + ": the plant's state needs " +
                               std::to_string(model.dof_count()) + " joints");
  check("base position", state.base.position);
  check("base attitude", state.base.attitude.coeffs());
  check("base velocity", state.base_velocity);
  check("base angular velocity", state.base_angular_velocity);
  check("a joint position", state.theta);
  check("a joint rate", state.dtheta);
  const double length = state.base.attitude.norm();
  if (std::abs(length - 1) > 1e-6)
    fail(ErrorCode::usage, model.name() + ": base attitude of the plant's state has length " +
                               text::brief(length) + ". A unit quaternion is expected");
}

void check_report(const RobotModel& model, const StepReport& report) {
  if (report.torque.size() != model.dof_count())
    fail(ErrorCode::usage, "the plant reports " + std::to_string(report.torque.size()) +
                               " torques, but robot '" + model.name() + "' has " +
                               std::to_string(model.dof_count()) + " joints");
  const auto check = [&](const std::string& what, const auto& value) {
    if (!sound(value))
      fail(ErrorCode::usage, model.name() + ": the plant reports " + what + " " +
                                 text::brief(unsound(value)) + ". Numbers below 1e6 are expected");
  };
  check("a torque of", report.torque);
  check("an angle of a motor of", report.motor);
  check("a rate of a motor of", report.motor_rate);
  for (const Side side : {Side::left, Side::right}) {
    const std::vector<SoleForce>& forces = report.soles[static_cast<size_t>(side)];
    const size_t corners = model.sole(side).polygon.size();
    if (forces.size() != corners)
      fail(ErrorCode::usage, model.name() + ": the plant reports " + std::to_string(forces.size()) +
                                 " forces at the " + name_of(side) + " sole, which has " +
                                 std::to_string(corners) + " corners");
    for (const SoleForce& contact : forces) {
      check("a place of a sole at", contact.position);
      check("a force at a sole of", contact.force);
      if (!sound(contact.gap))
        fail(ErrorCode::usage, model.name() + ": the plant reports a gap of a sole of " +
                                   text::brief(contact.gap) + ". Numbers below 1e6 are expected");
    }
  }
}

void check_step(const RobotModel& model, const VectorXd& targets, const StepInput& input, double dt,
                double time) {
  const auto complain = [&](const std::string& what) {
    fail(ErrorCode::usage,
         model.name() + ": " + what + ", " + text::fixed(time, 3) + " s after the plant's start");
  };
  const std::string count = std::to_string(model.dof_count());
  if (!(dt > 0 && dt < 1)) complain("step length " + text::brief(dt) + " s is not within 0..1 s");
  if (targets.size() != model.dof_count())
    complain(std::to_string(targets.size()) + " servo targets are given, but the robot has " +
             count + " joints");
  for (int j = 0; j < model.dof_count(); ++j)
    if (!sound(targets[j]))
      complain("servo target of " + model.dofs()[j].name + " is " + text::brief(targets[j]) +
               ". A number below 1e6 is expected (with unstable gains, targets grow beyond this "
               "number: choose smaller gains)");
  for (const ExternalWrench& w : input.wrenches)
    if (!(sound(w.force) && sound(w.torque) && sound(w.point) && w.body >= -1 &&
          w.body < static_cast<int>(model.bodies().size())))
      complain(
          "an external force must consist of finite numbers below 1e6 and act on a body of the "
          "robot");
  if (!input.joints.empty() && static_cast<int>(input.joints.size()) != model.dof_count())
    complain("faults of " + std::to_string(input.joints.size()) +
             " joints are given, but the robot has " + count + " joints");
  for (size_t j = 0; j < input.joints.size(); ++j)
    if (!sound(input.joints[j]))
      complain("the fault of joint " + model.dofs()[j].name +
               " is negative or not a finite number below 1e6");
  for (const CarriedMass& carried : input.payloads)
    if (!(carried.mass >= 0 && sound(carried.mass) && sound(carried.point) && carried.link >= 0 &&
          carried.link < static_cast<int>(model.links().size())))
      complain("a payload needs a mass that is not negative, a point, and a link of the robot");
  if (input.floor && !sound(*input.floor))
    complain("a value of the floor's motion is not a number below 1e6");
  if (input.friction && !sound_friction(*input.friction))
    complain("the floor's friction is " + text::brief(*input.friction));
  for (const RisingDisc& bump : input.bumps)
    if (!sound(bump.block) || !sound(bump.rate))
      complain(
          "a bump is not valid. Its values must be numbers below 1e6, and its radius must not be "
          "negative");
}

}  // namespace ayumi
