#pragma once
// The properties of a servo that every plant needs in addition to the linear law: the delay of its
// target, its error with dead band and counts, its dry friction, and the torque that its motor can
// give. docs/theory_plant.md, "Servos".

#include <Eigen/Dense>
#include <vector>

#include "ayumi/model/robot_model.hpp"

namespace ayumi {

/// Stiffness of a gear for which the files only give the backlash, as a multiple of the servo's kp.
/// Chosen: the gear then adds a tenth to the servo's own error under load.
inline constexpr double kGearStiffness = 10;

/// The stiffness [N m/rad] and the damping [N m s/rad] of the gear of a servo that has one. If the
/// files do not give the damping, it is critical for the rotor on the gear, so that the teeth do
/// not bounce.
double gear_stiffness(const ServoDescription& servo);
double gear_damping(const ServoDescription& servo);

/// The largest torque [N m, N] in `direction` (+1 or -1) that peak torque and speed limit allow at
/// the given joint rate [rad/s, m/s]. A motor cannot push a joint beyond its speed limit: the
/// torque falls linearly from the speed limit on, to 0 at 1.1 times the speed limit.
double available_torque(const ActuatorLimits& limits, int dof, double rate, double direction);

/// The motor's voltage bounds its torque in `direction` to stall_torque - back_emf rate direction;
/// infinite if the files give no motor. Beyond the no-load speed, this is negative: the motor
/// brakes.
double voltage_torque(const ServoDescription& servo, double rate, double direction);

/// The torques that a servo can give at a rate [N m, N], and whether the voltage bounds them there.
struct TorqueRange {
  double low = 0, high = 0;
  bool low_by_voltage = false, high_by_voltage = false;
};
/// The torques that peak torque, speed limit and voltage allow. Beyond its no-load speed, a motor
/// brakes, if necessary with more than its peak torque.
TorqueRange torque_range(const ActuatorLimits& limits, int dof, double rate);

/// The bound of the torque as a function of the rate consists of straight pieces: the peak torque
/// up to the speed limit, its fall beyond this limit, zero, and the bound by the voltage.
enum class TorquePiece { peak, fall, none, voltage };

/// One of these pieces for one direction: the torque is at most torque - slope * rate, where torque
/// and rate are positive in this direction.
struct TorqueBound {
  TorquePiece piece = TorquePiece::none;
  double torque = 0;  ///< torque at rest [N m, N]
  double slope = 0;   ///< loss of torque with speed [N m s/rad, N s/m]
};
/// The piece that bounds the torque in `direction` (+1 or -1) at this rate.
TorqueBound torque_bound(const ActuatorLimits& limits, int dof, double rate, double direction);

/// The dry friction [N m] of a servo whose motor turns at `rate` [rad/s] with the torque `motor`,
/// while everything else exerts the torque `external` on the joint [N m].
double dry_friction(const ServoDescription& servo, double rate, double motor, double external);

/// The input of the position loop in one step.
struct ServoError {
  double target = 0;    ///< target with which kp (target - phi) is the torque of the position error
  bool inside = false;  ///< whether the error is within the dead band, so that it exerts no torque
};
/// The input of the servo of `dof`, whose motor is at `phi` at the start of the step. `target` is
/// the target that the servo receives [rad].
ServoError servo_error(const ServoDescription& servo, const Dof& dof, double target, double phi);

/// The targets that the servos use. Each servo uses the target that it received one delay ago. A
/// target is constant from one step to the next; a delay that is not a whole number of steps gives
/// the mean over the step.
class TargetDelay {
 public:
  explicit TargetDelay(const std::vector<ServoDescription>& servos);

  /// Removes the targets. The servos then behave as if they had always had the targets of the next
  /// step.
  void reset() { count_ = 0; }

  /// `targets` [rad, m] apply during the coming step of `dt` [s]. The result is valid until the
  /// next call.
  const Eigen::VectorXd& step(const Eigen::VectorXd& targets, double dt);

 private:
  double mean(Eigen::Index joint, double delay, double dt) const;

  std::vector<double> delay_;  // delay by dof [s]
  double longest_ = 0;         // longest of these delays [s]
  Eigen::MatrixXd ring_;       // targets, dof x steps; the newest target is in column newest_
  std::vector<double> dt_;     // duration of each column [s]
  Eigen::Index newest_ = 0, count_ = 0;
  Eigen::VectorXd now_;
};

}  // namespace ayumi
