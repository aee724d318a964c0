#pragma once
// The input and the report of one step. They are the same for every plant.

#include <Eigen/Dense>
#include <array>
#include <optional>
#include <vector>

#include "ayumi/motion/ground_world.hpp"
#include "ayumi/sim/energy_balance.hpp"

namespace ayumi {

/// A force or a couple from outside that acts during one step.
struct ExternalWrench {
  int body = -1;  ///< body on which it acts; -1: through the whole-body COG, on the trunk
  /// Point in the world [m]; not used for body -1.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< force in the world [N]
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< torque in the world [N m]
};

/// A point mass that a link carries.
struct CarriedMass {
  int link = 0;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< point in the link frame [m]
  double mass = 0;                                  ///< [kg]
  bool operator==(const CarriedMass&) const = default;
};

/// A disc that rises from the ground.
struct RisingDisc {
  GroundBlock block;
  double rate = 0;  ///< rate of its height [m/s]
};

/// Changes of the servo and of the friction of one joint during a step.
struct JointFault {
  double gain = 1;                  ///< factor on kp and kd
  double coulomb = 0, viscous = 0;  ///< added friction [N m, N m s/rad or N, N s/m]
  double encoder = 0;               ///< error of the encoder's reading [rad, m]
};

/// Pose of the floor at the start of a step, and its velocity during the step.
struct FloorPose {
  /// Pose of the ground's frame in the world.
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< velocity of the frame's origin [m/s]
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< [rad/s]
};

/// Everything from outside that acts on the robot during one step.
struct StepInput {
  std::vector<ExternalWrench> wrenches;
  std::vector<CarriedMass> payloads;
  std::vector<JointFault> joints;  ///< faults by dof; empty: no faults
  std::optional<FloorPose> floor;  ///< empty: the world's slope at rest
  /// Friction of the whole ground, which replaces that of the world.
  std::optional<double> friction;
  std::vector<RisingDisc> bumps;  ///< bumps in addition to the world's blocks

  StepInput() = default;
  StepInput(std::vector<ExternalWrench> w) : wrenches(std::move(w)) {}
  StepInput(std::initializer_list<ExternalWrench> w) : wrenches(w) {}
};

/// The ground force at one vertex of a sole, where a load cell is. A force between the vertices is
/// distributed over them so that the total and the centre of pressure are right.
struct SoleForce {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< position in the world [m]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();     ///< force on the robot, in the world [N]
  double gap = 0;  ///< distance from the ground, negative inside [m]
};

/// The forces and events of a step. Forces are means over its duration.
struct StepReport {
  Eigen::VectorXd torque;  ///< torque of the servos [N m]
  /// The angle and the rate of the motors, where their encoders are [rad, rad/s]. They are those of
  /// the joints if the gears have neither backlash nor stiffness. Empty before the first step.
  Eigen::VectorXd motor, motor_rate;
  std::array<std::vector<SoleForce>, 2> soles;  ///< by Side, in the order of the sole's polygon
  bool body_contact = false;   ///< whether a body that is not a sole touches the ground
  int touching_body = -1;      ///< the first such body; -1: none, or unknown
  std::vector<int> saturated;  ///< dofs whose torque is at its limit
  int contact_iterations = 0;
  double contact_residual = 0;  ///< residual of the contact solve [m/s]
  double max_penetration = 0;   ///< largest penetration of a sole vertex [m]
  EnergyBalance work;           ///< work in this step
  /// The first pair of bodies of the robot that touch each other; -1: none.
  std::array<int, 2> self_contact = {-1, -1};
};

}  // namespace ayumi
