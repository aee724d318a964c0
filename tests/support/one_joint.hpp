#pragma once
// One joint in free fall on a base that is too heavy to move: the joint turns as a flywheel under
// its servo and a load torque. For comparison, the same joint is integrated in very small explicit
// steps, by separate formulas.

#include <cmath>
#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/sim/step.hpp"

namespace ayumi::test {

inline constexpr double kFlywheel = 0.05;  ///< inertia of the link about its joint [kg m^2]
inline constexpr double kHold = 1e-3;      ///< time for which a target is held [s]

/// A servo with the load on its joint.
struct OneJoint {
  std::string name;
  ServoDescription servo;
  /// Target at a tick's start [rad].
  std::function<double(double)> target = [](double) { return 0.0; };
  std::function<double(double)> load = [](double) { return 0.0; };  ///< load on the link [N m]
  double duration = 1;                                              ///< duration [s]
  double counts = 0;           ///< number of counts of the encoder per degree
  double peak = 0, speed = 0;  ///< limits [N m, rad/s]; 0 for no limit
  double error = 0;   ///< largest difference between Ayumi's plant at 1 ms and small steps [rad]
  double mujoco = 0;  ///< largest difference of the two plants [rad]
};

inline RobotModel model_of(const OneJoint& joint) {
  RobotDescription d;
  d.name = "flywheel";
  for (const char* name : {"base", "wheel"}) {
    LinkDescription link;
    link.name = name;
    link.has_inertial = true;
    const bool base = link.name == "base";
    link.inertia.mass = base ? 1e6 : 1;
    link.inertia.about_com =
        (base ? Eigen::Vector3d::Constant(1e6) : Eigen::Vector3d(0.04, kFlywheel, 0.04))
            .asDiagonal();
    d.links.push_back(link);
  }
  JointDescription hinge;
  hinge.name = "hinge";
  hinge.type = JointType::continuous;
  hinge.parent = "base";
  hinge.child = "wheel";
  hinge.axis = Eigen::Vector3d::UnitY();
  hinge.effort = joint.peak;
  hinge.velocity = joint.speed;
  d.joints.push_back(hinge);
  d.servos["hinge"] = joint.servo;
  if (joint.counts != 0) d.encoders["hinge"] = {1, joint.counts};
  return RobotModel(d);
}

/// The load of a step, as a couple on the wheel.
inline StepInput input_of(double load) {
  return {{1, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), {0, load, 0}}};
}

struct JointTrace {
  std::vector<double> theta, motor, torque;  ///< values at the end of every tick [rad, rad, N m]
};

/// Simulates the joint in a plant whose steps are 1 / `parts` of a tick.
template <typename Plant>
JointTrace simulate(const OneJoint& joint, const RobotModel& model, Plant& plant, int parts) {
  RobotState start = model.rest_state();
  start.base.position.z() = 1000;
  plant.set_state(start);
  JointTrace trace;
  for (int k = 0; k < std::lround(joint.duration / kHold); ++k) {
    StepReport report;
    for (int i = 0; i < parts; ++i)
      report = plant.step(Eigen::VectorXd::Constant(1, joint.target(k * kHold)),
                          input_of(joint.load((k + (i + 0.5) / parts) * kHold)), kHold / parts);
    trace.theta.push_back(plant.state().theta[0]);
    trace.motor.push_back(report.motor[0]);
    trace.torque.push_back(report.torque[0]);
  }
  return trace;
}

/// Simulates the same in explicit steps of 2 us. Dry friction stops the motor within a step if it
/// can.
inline JointTrace fine_simulation(const OneJoint& joint) {
  constexpr int kParts = 500;
  constexpr double h = kHold / kParts;
  const ServoDescription& s = joint.servo;
  const double gear = s.gear_stiffness > 0 ? s.gear_stiffness : 10 * s.kp;
  const double gear_damping =
      s.gear_damping > 0 ? s.gear_damping : 2 * std::sqrt(gear * s.rotor_inertia);
  const bool geared = s.backlash > 0 || s.gear_stiffness > 0;
  const double step = M_PI / 180 / (joint.counts > 0 ? joint.counts : 1);
  double theta = 0, rate = 0, phi = 0, dphi = 0, motor = 0, external = 0;
  JointTrace trace;
  for (int k = 0; k < std::lround(joint.duration / kHold); ++k) {
    for (int i = 0; i < kParts; ++i) {
      const double t = (k + (i + 0.5) / kParts) * kHold;
      double target = joint.target(std::max(0.0, kHold * std::floor((t - s.delay) / kHold)));
      double reading = phi - s.offset;
      if (s.quantized) {
        target = step * std::round(target / step);
        reading = step * std::round(reading / step);
      }
      double e = target - reading;
      e = e > s.dead_band ? e - s.dead_band : e < -s.dead_band ? e + s.dead_band : 0;
      double wanted = s.kp * e;
      if (s.speed_command_limit > 0)
        wanted = s.kd * std::clamp(wanted / s.kd, -s.speed_command_limit, s.speed_command_limit);
      motor = wanted - s.kd * dphi;
      if (joint.peak > 0) motor = std::clamp(motor, -joint.peak, joint.peak);
      if (s.stall_torque > 0)
        motor = std::clamp(motor, -s.stall_torque - s.back_emf * dphi,
                           s.stall_torque - s.back_emf * dphi);
      double mesh = 0;  // torque of the gear on the joint
      if (geared) {
        const double play = phi - theta, half = 0.5 * s.backlash;
        const double press = std::abs(play) > half ? play - std::copysign(half, play) : 0;
        if (press != 0 || half == 0) mesh = gear * press + gear_damping * (dphi - rate);
        if (half > 0 && mesh * press < 0) mesh = 0;
      }
      const double load = joint.load(t);
      const double inertia = geared ? s.rotor_inertia : s.rotor_inertia + kFlywheel;
      const double others = (geared ? -mesh : load) + motor - s.viscous * dphi;
      const double at_rest =
          s.stribeck_rate > 0
              ? std::exp(-std::pow(std::abs(dphi) / s.stribeck_rate, s.stribeck_exponent))
              : 0;
      double dry = s.coulomb + std::abs(s.load.external * external - s.load.motor * motor) +
                   at_rest * (s.stribeck_torque + std::abs(s.load.external_stribeck * external -
                                                           s.load.motor_stribeck * motor));
      if (external * motor < 0)
        dry += at_rest * (std::abs(motor) > std::abs(external)
                              ? s.load.external_quadratic * external * external
                              : s.load.motor_quadratic * motor * motor);
      const double stop = -(inertia * dphi / h + others);
      const double change = h / inertia * (others + std::clamp(stop, -dry, dry));
      dphi += change;
      phi += h * dphi;
      if (geared) {
        rate += h / kFlywheel * (load + mesh);
        theta += h * rate;
        external = -mesh;
      } else {
        rate = dphi, theta = phi;
        external = load - kFlywheel * change / h;
      }
    }
    trace.theta.push_back(theta);
    trace.motor.push_back(phi);
    trace.torque.push_back(motor);
  }
  return trace;
}

inline double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  for (size_t k = 0; k < std::min(a.size(), b.size()); ++k)
    most = std::max(most, std::abs(a[k] - b[k]));
  return a.size() == b.size() ? most : INFINITY;
}

/// A servo of the size of a small humanoid's knee: 5 Hz on the flywheel, well damped.
inline ServoDescription plain_servo() { return {.kp = 60, .kd = 3, .rotor_inertia = 0.01}; }

inline double sine(double t) { return 0.3 * std::sin(2 * M_PI * t); }
inline double triangle(double t) { return 0.2 * (t < 0.5 ? t : t < 1.5 ? 1 - t : t - 2); }

/// Largest differences of the two plants in steps of 1/8 ms, with joints at up to 2 rad/s [rad].
constexpr double kSmooth = 5e-4;  ///< Derived: two steps, one for each integrator
constexpr double kRubs = 2e-3;   ///< Measured 1.3e-3: MuJoCo's dry friction yields before it slides
constexpr double kPlays = 8e-3;  ///< Measured 5.4e-3: MuJoCo's flanks begin to push within the play

/// Every form of a servo on its own, and all of them at once.
inline std::deque<OneJoint> servo_forms() {
  std::deque<OneJoint> all;  // its elements stay in their places while it grows
  const auto add = [&](const char* name, double mujoco) -> OneJoint& {
    OneJoint& joint = all.emplace_back(OneJoint{.name = name, .servo = plain_servo()});
    joint.target = sine;
    joint.mujoco = mujoco;
    return joint;
  };
  add("stiffness_and_damping", kSmooth).target = [](double) { return 0.3; };
  add("delay", kSmooth).servo.delay = 0.0037;
  OneJoint& speed = add("speed_loop", kSmooth);
  speed.servo.speed_command_limit = 0.8;
  speed.target = [](double) { return 0.4; };
  OneJoint& friction = add("coulomb_and_viscous", kRubs);
  friction.servo.coulomb = 1.5;
  friction.servo.viscous = 0.4;
  OneJoint& stribeck = add("stribeck", kRubs);
  stribeck.servo.coulomb = 0.5;
  stribeck.servo.stribeck_torque = 0.8;
  stribeck.servo.stribeck_rate = 0.2;
  stribeck.servo.stribeck_exponent = 1.4;
  OneJoint& loaded = add("load_friction", kRubs);
  loaded.servo.coulomb = 0.2;
  loaded.servo.stribeck_torque = 0.2;
  loaded.servo.stribeck_rate = 0.3;
  loaded.servo.load = {.motor = 0.05,
                       .external = 0.15,
                       .motor_stribeck = 0.05,
                       .external_stribeck = 0.1,
                       .motor_quadratic = 0.005,
                       .external_quadratic = 0.005};
  loaded.load = [](double) { return 4.0; };
  OneJoint& backlash = add("backlash", kPlays);
  backlash.servo.backlash = 0.02;
  backlash.servo.viscous = 0.3;
  backlash.load = [](double t) { return t < 0.55 ? 1.0 : -1.0; };
  OneJoint& gear = add("gear_stiffness", kSmooth);
  gear.servo.gear_stiffness = 200;
  gear.servo.gear_damping = 1;
  gear.load = [](double t) { return t < 0.3 ? 0.0 : 3.0; };
  OneJoint& voltage = add("voltage", kSmooth);
  voltage.servo.stall_torque = 4;
  voltage.servo.back_emf = 2;
  voltage.load = [](double t) { return t < 0.5 ? 0.0 : 3.0; };
  OneJoint& band = add("dead_band", kSmooth);
  band.servo.dead_band = 0.05;
  band.servo.viscous = 0.5;
  OneJoint& counts = add("counts", kSmooth);
  counts.servo.quantized = true;
  counts.counts = 10;
  add("offset", kSmooth).servo.offset = 0.04;
  OneJoint& every = add("every_form", kPlays);
  every.servo = loaded.servo;
  every.servo.delay = 0.0037;
  every.servo.speed_command_limit = 3;
  every.servo.viscous = 0.3;
  every.servo.backlash = 0.01;
  every.servo.gear_stiffness = 800;
  every.servo.stall_torque = 12;
  every.servo.back_emf = 1;
  every.servo.dead_band = 0.002;
  every.servo.quantized = true;
  every.counts = 50;
  every.servo.offset = 0.03;
  every.load = [](double t) { return 2 + std::sin(9 * t); };
  return all;
}

}  // namespace ayumi::test
