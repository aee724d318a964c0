#pragma once
// What acts in the joints during one step: position servos with a torque limit, viscous and dry
// friction, and end stops. All laws are taken at the end of the step, so that they add to the
// diagonal of the step's equation and no gain makes a servo unstable.
// docs/theory_plant.md, (P1).

#include <Eigen/Dense>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/sim/energy_balance.hpp"
#include "ayumi/sim/step.hpp"

namespace ayumi {

class JointLaws {
 public:
  /// Throws Error(bad_model) when a joint has no servo. The model must outlive this object.
  JointLaws(const RobotModel& model, const ActuatorLimits& limits);

  /// Servo targets [rad, m] and faults of the coming step.
  void set(const Eigen::VectorXd& targets, const std::vector<JointFault>& faults);

  /// Starts a solve: every servo obeys its law again and every dry friction sticks.
  void start();

  /// Adds the impulses of the laws to `impulse`, the joints' part of the right side (dof), and
  /// fills `diagonal` (dof) so that the step's equation reads
  ///   (M + diagonal) (v+ - v) = impulse,
  /// with `theta` and `rate` the joint positions and rates before the step of `dt` [s].
  void add(const Eigen::VectorXd& theta, const double* rate, double dt, double* impulse,
           std::vector<double>& diagonal) const;

  /// Compares the solved rates at the end of the step with the laws. Where a servo passes its
  /// torque limit or dry friction slips, that joint gets a constant torque from now on; returns
  /// true when this happened, and the step has to be solved again.
  bool check(const Eigen::VectorXd& theta, const double* rate, double dt);

  /// Torque of each servo by the last check() [N m, N].
  const Eigen::VectorXd& torque() const { return torque_; }
  /// Whether servo j is at its torque limit.
  bool saturated(int j) const { return joints_[static_cast<size_t>(j)].saturated; }

  /// Adds the work of servos, friction and end stops in the step, with the joint rates before and
  /// after it.
  void add_work(const Eigen::VectorXd& theta, const double* before, const double* after, double dt,
                EnergyBalance& work) const;

 private:
  struct Law {
    double kp = 0, kd = 0;            // servo [N m/rad, N m s/rad; N/m, N s/m]
    double viscous = 0, coulomb = 0;  // friction [N m s/rad, N m; N s/m, N]
  };
  struct Joint {
    Law own, now;                       // of the sound joint; with the faults of the step
    double stop = 0, stop_damping = 0;  // end stop, as kp and kd
    double lower = 0, upper = 0;        // range [rad, m]
    bool limited = false;
    double target = 0;  // [rad, m]
    bool saturated = false, sliding = false;
    double limit_torque = 0;  // while saturated [N m, N]
    double slip_torque = 0;   // of the dry friction while it slides [N m, N]
    bool beyond_range(double theta) const { return limited && (theta < lower || theta > upper); }
  };

  ActuatorLimits limits_;
  std::vector<Joint> joints_;
  Eigen::VectorXd torque_;
};

}  // namespace ayumi
