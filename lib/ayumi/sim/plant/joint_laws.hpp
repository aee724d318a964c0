#pragma once
// Everything that acts in the joints during one step: position servos, the gears between their
// motors and the joints, friction, and end stops. All laws are taken at the end of the step, so
// that they add to the diagonal of the step's equation and no gain makes a servo unstable. A motor
// behind a gear with backlash or stiffness has an angle of its own, whose equation is eliminated
// joint by joint. docs/theory_plant.md, (P1).

#include <Eigen/Dense>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/sim/energy_balance.hpp"
#include "ayumi/sim/servo.hpp"
#include "ayumi/sim/step.hpp"

namespace ayumi {

class JointLaws {
 public:
  /// Throws Error(bad_model) if a joint has no servo. The model must outlive this object.
  JointLaws(const RobotModel& model, const ActuatorLimits& limits);

  /// The motors move with the joints of `state`; earlier targets are removed.
  void reset(const RobotState& state);

  /// Takes the servo targets [rad, m] and the faults of the coming step of `dt` [s], with the joint
  /// positions `theta`.
  void set(const Eigen::VectorXd& targets, const std::vector<JointFault>& faults,
           const Eigen::VectorXd& theta, double dt);

  /// Starts a solve from these positions and rates: every servo obeys its law again, and the dry
  /// friction of a moving motor continues to slide.
  void start(const Eigen::VectorXd& theta, const double* rate, double dt);

  /// Adds the impulses of the laws to `impulse`, the joints' part of the right side (dof), and
  /// fills `diagonal` (dof) so that the step's equation reads
  ///   (M + diagonal) (v+ - v) = impulse,
  /// with `theta` and `rate` the joint positions and rates before the step of `dt` [s].
  void add(const Eigen::VectorXd& theta, const double* rate, double dt, double* impulse,
           std::vector<double>& diagonal);

  /// Compares the solved rates at the end of the step with the laws. If a servo passes its torque
  /// limit or the limit of its speed loop, if dry friction slips or sticks, or if a gear meets or
  /// leaves a flank, this joint follows another law from now on. Then it returns true, and the step
  /// has to be solved again.
  bool check(const Eigen::VectorXd& theta, const double* rate, double dt);

  /// The torque of each servo according to the last check() [N m, N].
  const Eigen::VectorXd& torque() const { return torque_; }
  /// Whether servo j is at its torque limit.
  bool saturated(int j) const { return joints_[static_cast<size_t>(j)].saturated; }

  /// Largest number of times that a solve can be repeated because of one joint. Derived: friction
  /// sticks and then slides; speed loop, torque limit and gear change once each; the bound of the
  /// torque has kBoundChanges more pieces.
  static constexpr size_t kChangesPerJoint = 8;

  /// Finishes the solved step: adds the work of servos, gears, friction and end stops with the
  /// joint rates before and after it, and moves the motors.
  void advance(const Eigen::VectorXd& theta, const double* before, const double* after, double dt,
               EnergyBalance& work);

  /// The angles [rad, m] and rates of the motors. Joints without a gear have `theta` and `rate`.
  void motors(const Eigen::VectorXd& theta, const Eigen::VectorXd& rate, Eigen::VectorXd& angle,
              Eigen::VectorXd& motor_rate) const;

 private:
  enum class Flank { low, none, high };
  struct Joint {
    double kp = 0, kd = 0;            // gains with the faults of the step [N m/rad, N m s/rad]
    double viscous = 0, coulomb = 0;  // [N m s/rad, N m]
    bool has_gear = false, needs_friction = false;
    // true: there are no counts and no dead band, so servo_error() only adds the offset.
    bool plain_error = false;
    double offset = 0;               // offset of the encoder [rad]
    double most = 0, fastest = 0;    // peak torque, and the speed up to which it holds [N m, rad/s]
    double stall = 0, back_emf = 0;  // values for voltage_torque(); stall torque 0: no bound
    double speed_command = 0;        // limit of the speed loop's command [rad/s]
    double gear = 0, gear_damping = 0;  // [N m/rad, N m s/rad]
    double rotor = 0, half_play = 0;  // inertia and backlash of a motor behind a gear [kg m^2, rad]
    double stop = 0, stop_damping = 0;  // end stop, with the meaning of kp and kd
    double lower = 0, upper = 0;        // range of the joint [rad, m]
    bool limited = false;
    double target = 0;         // with it, kp (target - phi) is the error's torque [rad, m]
    bool inside_band = false;  // true: the position error exerts no torque
    double phi = 0, dphi = 0;  // angle and rate of a motor behind a gear [rad, rad/s]
    double external = 0;       // torque on the joint from outside in the last step [N m]
    double last_torque = 0, last_rate = 0;  // torque and rate of the motor in the last step
    // State of one solve.
    bool saturated = false, sliding = false, speed_bound = false, gear_changed = false;
    bool stuck = false;  // true: the friction sticks, but was sliding at first
    Flank flank = Flank::none;
    double direction = 0;     // direction of the torque while it is saturated
    TorqueBound bound;        // piece of the bound that the torque then follows
    int bound_changes = 0;    // number of changes in this solve
    double speed_torque = 0;  // if speed_bound: the torque is speed_torque - kd dphi [N m, N]
    double slip_torque = 0;   // torque of the dry friction while it slides [N m, N]
    double momentum = 0, inertia = 0;  // for a motor: inertia dphi+ = momentum + slope dtheta+
    double mesh = 0, slope = 0;        // impulse of a gear: mesh + slope (dphi+ - dtheta+)
    bool beyond_range(double theta) const { return limited && (theta < lower || theta > upper); }
  };
  /// The impulse that acts on a motor or joint: sum - damping rate.
  struct Impulse {
    double sum = 0, damping = 0;
  };

  Impulse motor_impulse(const Joint& joint, double phi, double dt) const;
  void solve_motor(Joint& joint, double theta, double dt, Impulse& on_joint) const;
  bool check_bound(Joint& joint, size_t j, double dphi);
  bool check_servo(Joint& joint, size_t j, double phi, double dphi, double dt);
  static bool far_from_bounds(const Joint& joint, double torque, double dphi);
  static bool check_friction(Joint& joint, double dphi);
  static bool check_gear(Joint& joint, double theta, double rate, double dphi, double dt);
  /// The rate of the motor at the end of the step, for this rate of the joint.
  static double motor_rate(const Joint& joint, double rate);
  static double friction(const Joint& joint, double dphi);

  ActuatorLimits limits_;
  const RobotModel* model_;
  TargetDelay delay_;
  std::vector<Joint> joints_;
  Eigen::VectorXd torque_;
};

}  // namespace ayumi
